"""Breakpoints: when a run pauses, in a small language shared by app, command line and child.

| text | pauses when |
| --- | --- |
| `12` | line 12 is about to run (or the next line of code, if 12 is blank or a comment) |
| `12 if x > 3` | … and the expression is true there |
| `left_red_pc < 10`, `ultrasonic_mm <= 200`, `x_mm > 1000` | this becomes true, checked after each tick |
| `left_color changes`, `left_color == Blue` | the value changes, or becomes the given colour |
| `sample Colour < 50`, `sample Colour changes`, `sample Colour` | a printed sample matches |
| `print matches REGEX` | a printed line matches |
| `time 3.5` | 3.5 simulated seconds have passed |
| `stall` | an obstacle stalls a running motor |

A leading `#` disables a breakpoint. A comparison triggers when it
becomes true, not while it stays true.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from tuisim.core.columns import column_name
from tuisim.core.comparison import COMPARE, comparison_form, comparison_in, finite_number
from tuisim.core.sensors import columns_of, number_in
from tuisim.core.sensors.color import COLOR_NAMES
from tuisim.core.spec import RobotSpec
from tuisim.errors import ConfigError, nearest, see_page

CHANGES, SEEN = "changes", "is seen"
"""Relations without a number: the value has changed; a sample was printed, with any value."""

ALLOWED = (
    f"{comparison_form()}, such as left_red_pc < 10 · x_mm > 1000 · sample Colour < 50; or 12 · 12 if x > 3 · "
    "left_color changes · print matches REGEX · time 3.5 · stall"
)


@dataclass(frozen=True, slots=True)
class LineBreak:
    """Pauses when a line of the program is about to run."""

    line: int
    condition: str = ""
    """A Python expression that must be true; empty for none."""


@dataclass(frozen=True, slots=True)
class ValueBreak:
    """Pauses on a value of a sensor or of the robot's motion."""

    column: str
    """Name of a column, see `core.columns`."""
    relation: str
    """An `Operator`, or `CHANGES`."""
    number: float = 0.0


@dataclass(frozen=True, slots=True)
class SampleBreak:
    """Pauses on a printed sample."""

    name: str
    relation: str
    """An `Operator`, `CHANGES` or `SEEN`."""
    number: float = 0.0


@dataclass(frozen=True, slots=True)
class PrintBreak:
    """Pauses on a printed line that contains a match of a regular expression."""

    pattern: str


@dataclass(frozen=True, slots=True)
class TimeBreak:
    """Pauses when a simulated time is reached."""

    time_s: float


@dataclass(frozen=True, slots=True)
class StallBreak:
    """Pauses when a running motor is blocked."""


BreakRule = LineBreak | ValueBreak | SampleBreak | PrintBreak | TimeBreak | StallBreak


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """A breakpoint: its rule, its text, and whether it is enabled."""

    rule: BreakRule
    text: str
    """The normalized text, without the mark of a disabled breakpoint."""
    disabled: bool = False

    def written(self) -> str:
        """The text from which `parse_break` creates this breakpoint again."""
        return f"# {self.text}" if self.disabled else self.text


_LINE = re.compile(r"(?:line\s+)?(\d+)(?:\s+if\s+(.*))?", re.DOTALL)
_NAME = re.compile(r"\w+(?:[. ]\w+)*\s*%?")


def parse_break(text: str, robot: RobotSpec | None = None) -> Breakpoint:
    """Return the breakpoint that a text describes; without a robot any name of a sensor is accepted.

    Raises:
        ConfigError: the text is not a valid breakpoint; the hint lists what is allowed.
    """
    stripped = text.strip()
    disabled = stripped.startswith("#")
    bare = stripped.lstrip("#").strip()
    rule = _rule(bare, robot)
    return Breakpoint(rule, _common_text(rule, bare), disabled)


def parse_breakpoints(texts: Iterable[str], robot: RobotSpec | None = None) -> tuple[Breakpoint, ...]:
    """Return the breakpoints of several texts; see `parse_break`."""
    return tuple(parse_break(text, robot) for text in texts)


def break_lines(breaks: Iterable[Breakpoint]) -> dict[int, Breakpoint]:
    """Return the line breakpoints by line; of several on one line, an enabled one takes precedence."""
    found: dict[int, Breakpoint] = {}
    for one in sorted(breaks, key=lambda one: not one.disabled):
        line = break_line_of(one)
        if line:
            found[line] = one
    return found


def break_line_of(one: Breakpoint) -> int:
    """Return the line of a breakpoint; 0 if it has none."""
    return one.rule.line if isinstance(one.rule, LineBreak) else 0


def moved(one: Breakpoint, line: int) -> Breakpoint:
    """Return a copy of a line breakpoint on another line."""
    if not isinstance(one.rule, LineBreak):
        return one
    rule = LineBreak(line, one.rule.condition)
    return Breakpoint(rule, _common_text(rule, one.text), one.disabled)


def _refuse(text: str, why: str, hint: str = f"{ALLOWED}; {see_page('breakpoints')}") -> ConfigError:
    return ConfigError(f"{text!r}: {why}", hint, key="break")


def _rule(text: str, robot: RobotSpec | None) -> BreakRule:
    if not text:
        raise _refuse(text, "is empty")
    word, _, rest = text.partition(" ")
    rest = rest.strip()
    if found := _LINE.fullmatch(text):
        return _line_rule(text, int(found[1]), found[2])
    if text == "stall":
        return StallBreak()
    if word == "time":
        return TimeBreak(_number(text, rest.removesuffix("s").strip(), least=0.0))
    if word == "print":
        return _print_rule(text, rest)
    if word == "sample":
        return _sample_rule(text, rest)
    return _value_rule(text, robot)


def _line_rule(text: str, line: int, condition: str | None) -> LineBreak:
    if line < 1:
        raise _refuse(text, "lines count from 1")
    if condition is None:
        return LineBreak(line)
    condition = condition.strip()
    if why := _why_no_expression(condition):
        raise _refuse(text, why, "such as: 12 if x > 3")
    return LineBreak(line, condition)


def _why_no_expression(text: str) -> str:
    """Return why Python cannot parse an expression; empty if it can."""
    try:
        ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        return f"{text!r} is not an expression: {getattr(error, 'msg', None) or error}"
    return ""


def parse_watch(text: str) -> str:
    """Return a watch expression without surrounding whitespace.

    Raises:
        ConfigError: Python cannot parse it.
    """
    text = text.strip()
    if why := _why_no_expression(text):
        raise ConfigError(why, "such as len(values)", key="watch")
    return text


def _print_rule(text: str, rest: str) -> PrintBreak:
    word, _, pattern = rest.partition(" ")
    if word != "matches" or not pattern.strip():
        raise _refuse(text, "what is printed can only be matched", "such as: print matches black|white")
    try:
        re.compile(pattern.strip())
    except (re.error, OverflowError, RecursionError) as error:
        raise _refuse(text, f"not a regular expression: {error}", "such as: print matches black|white") from error
    return PrintBreak(pattern.strip())


def _sample_rule(text: str, rest: str) -> SampleBreak:
    name, relation, value = _relation(rest)
    if not name.isidentifier():
        raise _refuse(
            text, "a sample has a name", f"{comparison_form()}, such as: sample Colour < 50, sample Colour changes"
        )
    return SampleBreak(name, relation or SEEN, _number(text, value) if value else 0.0)


def _value_rule(text: str, robot: RobotSpec | None) -> ValueBreak:
    written, relation, value = _relation(text)
    if not relation:
        raise _refuse(text, "is not a breakpoint")
    name = written
    if robot is not None:
        columns = columns_of(robot)
        name = column_name(written, columns) or ""
        if not name:
            raise _refuse(text, f"this robot has no {written!r}", nearest(written, (one.name for one in columns)))
    if not _NAME.fullmatch(name):
        raise _refuse(text, f"there is no {written!r}")
    try:
        return ValueBreak(name, relation, number_in(value, name) if value else 0.0)
    except ValueError as error:
        raise _refuse(text, str(error)) from None


def _relation(text: str) -> tuple[str, str, str]:
    """Return the quantity, the operator (or `CHANGES`, or an empty string) and the number as text."""
    words = text.split()
    if len(words) > 1 and words[-1] == CHANGES:
        return text[: -len(CHANGES)].strip(), CHANGES, ""
    found = comparison_in(text)
    return (found.name, found.operator, found.value) if found and found.operator in COMPARE else (text, "", "")


def is_color(column: str) -> bool:
    """Return whether the values of a column are codes of colours, which have names."""
    return column.endswith(("_color", ".color"))


def _number(text: str, written: str, least: float = -math.inf) -> float:
    try:
        value = finite_number(written)
    except ValueError as error:
        raise _refuse(text, str(error)) from None
    if value < least:
        raise _refuse(text, f"{written!r} is not possible here")
    return value


def _common_text(rule: BreakRule, written: str) -> str:
    match rule:
        case LineBreak(line=line, condition=condition):
            return f"{line} if {condition}" if condition else str(line)
        case ValueBreak(column=name, relation=relation) | SampleBreak(name=name, relation=relation):
            head = f"sample {name}" if isinstance(rule, SampleBreak) else name
            if relation in COMPARE:
                return f"{head} {relation} {_shown_number(rule)}"
            return head if relation == SEEN else f"{head} {CHANGES}"
        case PrintBreak(pattern=pattern):
            return f"print matches {pattern}"
        case TimeBreak(time_s=time_s):
            return f"time {time_s:.12g}"
        case StallBreak():
            return written


def _shown_number(rule: ValueBreak | SampleBreak) -> str:
    if isinstance(rule, ValueBreak) and is_color(rule.column) and rule.number in range(len(COLOR_NAMES)):
        return COLOR_NAMES[int(rule.number)]
    return f"{rule.number:.12g}"
