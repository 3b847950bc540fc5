"""When breakpoints match: expressions of line breakpoints, values after each tick, printed rows."""

from __future__ import annotations

import ast
import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from tuisim.engine.breakpoints import Breakpoint, LineBreak, StallBreak, TimeBreak
from tuisim.engine.core.columns import find_column_name
from tuisim.engine.core.conditions import Edge, Operator, ValueCondition, ValueSource, format_value
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.sensors import build_reader, list_columns
from tuisim.engine.runs.records import SAMPLE_STREAMS, Stream
from tuisim.engine.runs.samples import build_value_reader
from tuisim.engine.runtime.debugger.value_text import evaluate_truth
from tuisim.engine.runtime.session import Session

_SCALARS = (bool, int, float, str, types.NoneType)
_PLAIN_NODES = (
    ast.Expression,
    ast.BoolOp,
    ast.And,
    ast.Or,
    ast.UnaryOp,
    ast.Not,
    ast.USub,
    ast.UAdd,
    ast.BinOp,
    ast.Add,
    ast.Sub,
    ast.Div,
    ast.FloorDiv,
    ast.Mod,
    ast.Compare,
    ast.Eq,
    ast.NotEq,
    ast.Lt,
    ast.LtE,
    ast.Gt,
    ast.GtE,
    ast.Is,
    ast.IsNot,
    ast.Name,
    ast.Load,
    ast.Constant,
)

Apart = Callable[[Callable[[], bytes]], bytes | None]


class LineCondition:
    """The condition of one line breakpoint.

    A condition that cannot run code of the program is evaluated in this process, any other in a copy of the process.

    Args:
        text: An expression without syntax errors.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        tree = ast.parse(text, mode="eval")
        nodes = list(ast.walk(tree))
        self._code = compile(tree, "<break>", "eval", dont_inherit=True)
        self._names = tuple({node.id for node in nodes if isinstance(node, ast.Name)})
        # On strings, % and + produce at most the combined length of their operands; * and ** could produce far more.
        self._plain = all(isinstance(node, _PLAIN_NODES) for node in nodes)

    def holds(self, frame: types.FrameType, apart: Apart) -> str:
        """Return why the condition pauses the program at a line, such as `is true`; empty if the program goes on.

        Args:
            frame: The frame of the line, in which the expression is evaluated.
            apart: Calls a function in a copy of the process.
        """
        names: Mapping[str, Any] = frame.f_locals
        if self._plain and type(names) is dict:
            values = {
                name: names.get(name, frame.f_globals.get(name, self)) for name in self._names
            }
            values = {
                name: value
                for name, value in values.items()
                if value is not self or name in frame.f_builtins
            }
            if all(type(value) in _SCALARS for value in values.values()):
                return self._evaluate_here(values)
        answer = apart(
            lambda: evaluate_truth(
                self._text, {**frame.f_globals, **names}, frame.f_builtins
            ).encode("utf-8", "backslashreplace")
        )
        return "takes too long" if answer is None else answer.decode()[1:]

    def _evaluate_here(self, values: dict[str, Any]) -> str:
        try:
            return "is true" if eval(self._code, {"__builtins__": {}}, values) else ""
        except NameError:
            # Names that do not exist yet make the condition false.
            return ""
        except Exception as error:  # an expression can raise anything, which the user should see
            return f"cannot be evaluated: {type(error).__name__}: {error}"


Value = Callable[[], float]


class Watcher:
    """All breakpoints of a run that are not on a line: conditions on values, times, stalls and printed rows.

    The session calls it after ticks and at printed rows, only if it has such breakpoints.

    Args:
        session: The run.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._after_tick: dict[str, Callable[[], str]] = {}
        """Functions that return the value that matches now, empty without a match, by the text of the breakpoint."""
        self._on_row: dict[str, Callable[[str], str]] = {}

    @property
    def ticks(self) -> bool:
        """Whether a breakpoint must be checked after each tick."""
        return bool(self._after_tick)

    @property
    def rows(self) -> bool:
        """Whether a breakpoint must be checked at each printed row."""
        return bool(self._on_row)

    def set(self, breaks: Iterable[Breakpoint]) -> None:
        """Replace the breakpoints.

        A breakpoint that was set before remembers the earlier values of its column or sample.
        """
        ticks = self._after_tick
        rows = self._on_row
        self._after_tick = {}
        self._on_row = {}
        for break_point in breaks:
            match break_point.rule:
                case LineBreak():
                    pass
                case ValueCondition(source=ValueSource.SAMPLE | ValueSource.PRINT) as condition:
                    self._on_row[break_point.text] = rows.get(break_point.text) or _build_row_check(
                        condition
                    )
                case rule:
                    check = ticks.get(break_point.text) or self._tick_check(rule)
                    if check is not None:
                        self._after_tick[break_point.text] = check

    def match_tick(self) -> tuple[str, str] | None:
        """Return a breakpoint whose condition has become true in this tick; None if there is none.

        Returns:
            The text of the breakpoint, and the value that its condition tests, as text.
        """
        return _find_first((text, check()) for text, check in self._after_tick.items())

    def match_row(self, row: str, stream: Stream) -> tuple[str, str] | None:
        """Return a breakpoint whose condition is met by a printed row; None if there is none.

        Args:
            row: The text of the row.
            stream: The stream of the row.

        Returns:
            The text of the breakpoint, and the value in the row that its condition tests, as text.
        """
        if stream not in SAMPLE_STREAMS:
            return None
        return _find_first((text, check(row)) for text, check in self._on_row.items())

    # Checks

    def _tick_check(
        self, rule: ValueCondition | TimeBreak | StallBreak
    ) -> Callable[[], str] | None:
        match rule:
            case TimeBreak(time_s=time_s):
                value: Value | None = self._time_s
                condition = ValueCondition(
                    "time", Operator.GREATER_EQUAL, repr(time_s - 0.5 / NS_PER_S)
                )
            case StallBreak():
                value, condition = (
                    self._list_stalled,
                    ValueCondition("stall", Operator.GREATER, "0"),
                )
            case ValueCondition():
                value = self._build_reader(rule.name)
                condition = rule
        if value is None:
            return None
        edge = Edge(condition)
        if isinstance(rule, TimeBreak) and self._time_s() >= rule.time_s:
            # The time has passed already: the condition must not become true at the next tick.
            edge.update(rule.time_s)

        def check() -> str:
            number = value()
            return format_value(number, condition.name) if edge.update(number) else ""

        return check

    def _time_s(self) -> float:
        return self._session.sim.compute_due_ns(self._session.sim.tick) / NS_PER_S

    def _list_stalled(self) -> float:
        sim = self._session.sim
        return float(sum(motor.blocked_ticks >= sim.stall_ticks for motor in sim.motors))

    def _build_reader(self, column: str) -> Value | None:
        """Return a function that returns the present value of a column; None if this robot does not have the column."""
        session = self._session
        sim = self._session.sim
        spec = sim.spec
        read = build_reader(find_column_name(column, list_columns(spec)) or "", spec)
        if read is None:
            return None
        return lambda: read(sim.build_instant(with_motors=True), sim.spec, session.field)


def _find_first(matches: Iterator[tuple[str, str]]) -> tuple[str, str] | None:
    """Return the first match; None if there is none.

    The iterator is read to its end, because each of its checks has to process each new value.
    """
    met = [(text, value) for text, value in matches if value]
    return met[0] if met else None


def _build_row_check(condition: ValueCondition) -> Callable[[str], str]:
    read, edge = build_value_reader(condition), Edge(condition)

    def check(row: str) -> str:
        value = read(row)
        return row if value is not None and edge.update(value) else ""

    return check
