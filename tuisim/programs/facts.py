"""What the text of a program says, read once: how it is made, what it calls, asks, waits for and compares."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.source import PRELUDE_TEXTS, PYBRICKS, Program
from tuisim.base.syntax_tree import parse_module
from tuisim.engine.core.sensors.color import LightRead
from tuisim.engine.core.spec import RobotSpec
from tuisim.programs import moves, uses
from tuisim.programs.comparisons import list_constants
from tuisim.programs.fixed_conditions import list_fixed_conditions
from tuisim.programs.idle_moves import list_idle_moves, list_stopping_loops
from tuisim.programs.mistakes import (
    explain_error,
    find_fault,
    find_idle_definition,
    list_slips,
)
from tuisim.programs.questions import Question, QuestionReader, Word
from tuisim.programs.robot.scopes import Binding, Bound, Imported, Scope, build_scope
from tuisim.programs.robot.source import Module, parse
from tuisim.programs.robot.thresholds import (
    ProgramThreshold,
    find_light_reads,
    find_sensor_names,
    find_thresholds,
)
from tuisim.programs.waits import (
    LoopEnd,
    find_first_drive,
    find_turns,
    list_counts,
    list_loop_ends,
)

if TYPE_CHECKING:
    from tuisim.programs.remarks import Remarks

_Function = ast.FunctionDef | ast.AsyncFunctionDef
_BLOCKS = (ast.For, ast.While, ast.If, ast.With, ast.Try, _Function, ast.ClassDef)


def _list_nodes(tree: ast.Module, *kinds: type[ast.AST]) -> list[ast.AST]:
    return [node for node in ast.walk(tree) if isinstance(node, kinds) and not _is_dead(node)]


def _is_dead(node: ast.AST) -> bool:
    """Return whether a loop, `if` or function does nothing: its body has no effect, or its condition is never true.

    A `while` with an empty body is not dead, because it waits.
    """
    if (
        isinstance(node, ast.While | ast.If)
        and isinstance(node.test, ast.Constant)
        and not node.test.value
    ):
        return True
    # A `while` with an empty body is not dead: it waits.
    return isinstance(node, ast.For | ast.If | _Function) and all(
        _is_idle(statement) for statement in node.body
    )


def _is_idle(statement: ast.stmt) -> bool:
    is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    return is_text or isinstance(statement, ast.Pass | ast.Continue | ast.Break)


def _count(*kinds: type[ast.AST]) -> Callable[[ast.Module], int]:
    return partial(lambda tree, wanted: len(_list_nodes(tree, *wanted)), wanted=kinds)


def _count_functions(tree: ast.Module) -> int:
    """Return the number of functions that the program defines and uses."""
    defined = _list_nodes(tree, _Function)  # type: ignore[arg-type]
    named = [
        node.id if isinstance(node, ast.Name) else node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Name | ast.Attribute)
    ]
    return len(
        {node.name for node in defined if isinstance(node, _Function) and node.name in named}
    )


def _count_lines(tree: ast.Module) -> int:
    """Return the number of lines with code, without comments and docstrings."""
    statements = (
        node for node in ast.walk(tree) if isinstance(node, ast.stmt) and not _is_idle(node)
    )
    return len({line for node in statements for line in _list_span(node)})


def _list_span(statement: ast.stmt) -> Iterator[int]:
    """Yield the numbers of a statement's lines; for a statement with a block, such as a loop, only the first."""
    is_block = isinstance(statement, _BLOCKS)
    yield from range(
        statement.lineno, statement.lineno + 1 if is_block else (statement.end_lineno or 0) + 1
    )


def _measure_depth(node: ast.AST) -> int:
    """Return the greatest number of blocks, such as loops, that are nested in each other in a syntax tree."""
    inner = max(map(_measure_depth, ast.iter_child_nodes(node)), default=0)
    return inner + isinstance(node, _BLOCKS)


STRUCTURES: Mapping[str, Callable[[ast.Module], int]] = {
    "loops": _count(ast.For, ast.While),
    "for": _count(ast.For),
    "while": _count(ast.While),
    "if": _count(ast.If),
    "functions": _count_functions,
    "classes": _count(ast.ClassDef),
    "try": _count(ast.Try),
    "lines": _count_lines,
    "depth": _measure_depth,
}
"""What can be counted in a program's text, by name."""


__all__ = [
    "STRUCTURES",
    "LoopEnd",
    "ProgramFacts",
    "ProgramThreshold",
    "Question",
    "read_facts",
]

MAX_TEXT = 100_000
"""Characters of the longest text that is read for what it waits for; it takes time for each line."""


class ProgramFacts:
    """Facts that the text of a program shows without being executed.

    Args:
        program: The program.
    """

    def __init__(self, program: Program) -> None:
        self._program = program

    @cached_property
    def _tree(self) -> ast.Module:
        """The syntax tree of the program; raises the errors of `parse_module`."""
        return parse_module(self._program.text)

    @cached_property
    def tree(self) -> ast.Module:
        """The syntax tree of the program; an empty tree if the program is not Python, or too long."""
        text = self._program.text
        return (parse(text) if len(text) <= MAX_TEXT else None) or ast.Module([], [])

    @cached_property
    def fault(self) -> tuple[str, int] | None:
        """Why the program does not compile, and the number of the faulty line, or 0 if unknown; None if it compiles."""
        return find_fault(self._program.text)

    def count_structure(self, name: str) -> int:
        """Return how often the program has a structure, such as a loop.

        Args:
            name: The structure, one of `STRUCTURES`.

        Raises:
            SyntaxError, ValueError, RecursionError: the program is not Python.
        """
        return STRUCTURES[name](self._tree)

    def find_calls(self, call: str) -> list[int]:
        """Return the numbers of the lines with a call, in ascending order.

        Args:
            call: A function such as `time.sleep`; a method of an object that programs have from the start, such as
                `tank_drive.on`; or the name of a function or method alone. Methods of other objects of the same class
                are found as well.

        Raises:
            SyntaxError, ValueError, RecursionError: the program is not Python.
        """
        return list_calls(self._tree, self._program.prelude, call)

    @cached_property
    def _question_reader(self) -> QuestionReader:
        return QuestionReader(self.tree)

    def find_question(self, line: int) -> Question:
        """Return how the program uses the value that it reads on a line, for example with which colours it compares it.

        The result is `Question()` if the program's text does not show this.
        """
        return self._question_reader.find_question(line)

    @cached_property
    def constants(self) -> Mapping[str, Word]:
        """The texts and numbers that names in the program always have; see `list_constants`."""
        return list_constants(self.tree)

    @cached_property
    def loop_ends(self) -> tuple[LoopEnd, ...]:
        """The loops that end when a comparison in the text becomes true, the inner loops first."""
        return list_loop_ends(self.tree, self.constants)

    @cached_property
    def counts(self) -> tuple[tuple[int, LoopEnd], ...]:
        """The lines in loops that count, such as `n += 1` below `if light < 20`, each with the comparison before it."""
        return tuple(list_counts(self.tree, self.constants))

    @cached_property
    def remarks(self) -> Remarks:
        """What the comments, prints and names of the program say."""
        # Imported on demand: only a search for the reasons why a run went wrong needs it.
        from tuisim.programs.remarks import Remarks

        return Remarks(self._program.text, self.tree)

    def find_steering(self, line: int) -> int:
        """Return the line around `line` that steers the robot again and again; see `moves.find_steering`."""
        return moves.find_steering(self.tree, line)

    def list_unwaited_moves(self) -> list[moves.UnwaitedMove]:
        """Return the calls of moves with `block=False` or `wait=False`."""
        return [*moves.list_unwaited_moves(self.tree)]

    def list_parted_moves(self) -> Iterator[moves.PartedMove]:
        """Yield each two calls that move the wheels equally, but one after the other; see `moves.list_parted_moves`."""
        return moves.list_parted_moves(self.tree, self.remarks.has_straight_comment)

    def list_wheel_turns(self) -> Iterator[moves.WheelTurn]:
        """Yield the calls that turn the wheels in opposite directions by an angle usual for turns of robots."""
        return moves.list_wheel_turns(self.tree)

    def list_stopping_loops(self) -> Iterator[tuple[int, str, range]]:
        """Yield the lines in loops that stop the motors in the first pass; see `idle_moves.list_stopping_loops`."""
        return list_stopping_loops(self.tree)

    def list_stale_reads(self) -> Iterator[LoopEnd]:
        """Yield each use in a loop of a reading that the program took before it, and never again in it."""
        return uses.list_stale_reads(self.tree, self.constants)

    def list_lone_stops(self) -> Iterator[uses.LoneStop]:
        """Yield each `if` outside of `while` loops that stops motors which the same block has just started."""
        return uses.list_lone_stops(self.tree, self.constants)

    def list_lost_values(self) -> Iterator[uses.LostValue]:
        """Yield each value that a function assigns to a local name, although it probably means a global one."""
        return uses.list_lost_values(self.tree)

    def find_turns(self, line: int) -> tuple[float, str] | None:
        """Return by how much a call on a line turns a motor or both wheels, and the unit: `rotations` or `degrees`.

        The result is None if the line has no such call.
        """
        return find_turns(self.tree, self.constants, line)

    @cached_property
    def first_drive(self) -> int:
        """The first line that starts motors; 0 for none."""
        return find_first_drive(self.tree)

    @cached_property
    def slips(self) -> tuple[tuple[int, str], ...]:
        """The lines that probably contain a mistake, such as `motor.stop` without `()`, each with a description."""
        return (
            *list_slips(self.tree),
            *list_fixed_conditions(self.tree, self.constants),
            *list_idle_moves(self.tree),
        )

    def explain_error(self, error: str, line: int) -> str:
        """Return what in a line caused an error that Python's text does not name; empty if that is not known."""
        return explain_error(self.tree, error, line)

    @cached_property
    def idle_definition(self) -> tuple[int, str] | None:
        """In a program with definitions only, the line of the last function or class, and why it does nothing.

        The value is None for any other program.
        """
        return find_idle_definition(self.tree)

    @cached_property
    def _places(self) -> Mapping[int, tuple[int, range]]:
        places: dict[int, tuple[int, range]] = {}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.stmt):
                lines = range(node.lineno, (node.end_lineno or node.lineno) + 1)
                for line in lines:
                    function, known = places.get(line, (0, range(0)))
                    if isinstance(node, _Function):
                        places[line] = node.lineno, range(0)
                    elif not known or isinstance(node, ast.While | ast.For):
                        places[line] = function, lines
        return places

    def find_place(self, line: int) -> tuple[int, range]:
        """Return the first line of the function that contains a line, and the lines of the loop that contains it.

        Outside functions, the first result is 0. Outside loops, the second is the range of the statement's lines.
        """
        return self._places.get(line, (0, range(0)))

    def find_light_reads(self, robot: RobotSpec) -> Mapping[str, LightRead]:
        """Return how the program reads each colour sensor, such as in percent, by the sensor's name.

        If it reads a sensor in several ways, the first one that it compares with a value counts, else the first of all.
        """
        return find_light_reads(self._program, robot)

    def find_sensor_names(self, robot: RobotSpec) -> Mapping[str, str]:
        """Return the names that the program gives the robot's sensors, such as `colorLeft`, by port."""
        return find_sensor_names(self._program, robot)

    def find_thresholds(self, robot: RobotSpec) -> Mapping[str, tuple[ProgramThreshold, ...]]:
        """Return the values with which the program compares each colour sensor, by sensor name, in order of lines."""
        return find_thresholds(self._program, robot)


@lru_cache(8)
def read_facts(program: Program) -> ProgramFacts:
    """Return the facts that the text of a program shows; they are cached."""
    return ProgramFacts(program)


# Names are followed as far as they are clear from the text: imports under other names, a variable that is assigned
# another name or a new object of a class, and the names that a prelude defines. Nothing is executed.

_MAX_MEANING = 200
"""Longer meanings of names, in characters, are not followed."""
_MAX_MEANINGS = 24
"""More meanings of one expression are not followed."""
_DEFAULT_PRELUDE = "preloaded"
"""The prelude whose names a goals file uses, whatever prelude a program has."""


@dataclass(slots=True)
class _Names:
    """Finds the full names of the objects behind a program's names, such as `ev3dev2.motor.MoveTank`.

    Args:
        prelude: The scope of the program's prelude, which runs before it and defines names such as `tank_drive`.
    """

    prelude: Scope
    _known: dict[tuple[ast.expr, Scope], tuple[str, ...]] = field(default_factory=dict)

    def list_meanings(self, node: ast.expr, scope: Scope) -> tuple[str, ...]:
        """Return the full names that an expression can refer to, such as `ev3dev2.motor.MoveTank().on`.

        Args:
            node: The expression.
            scope: The scope that contains it.
        """
        key = (node, scope)
        if key not in self._known:
            # If the name refers to itself, the recursion finds this empty result.
            self._known[key] = ()
            meanings = (
                meaning for meaning in self._follow(node, scope) if len(meaning) <= _MAX_MEANING
            )
            self._known[key] = tuple(dict.fromkeys(meanings))[:_MAX_MEANINGS]
        return self._known[key]

    def _follow(self, node: ast.expr, scope: Scope) -> Iterator[str]:
        match node:
            case ast.Name(id=name):
                bindings = scope.find_bindings(name) or self.prelude.find_bindings(name)
                yield from self._follow_bindings(name, bindings)
            case ast.Attribute(value=value, attr=attr):
                if isinstance(value, ast.Name) and value.id == "self" and scope.owner:
                    for binding in scope.owner.attributes.get(attr, ()):
                        yield from self._follow_bindings("", [binding])
                yield from (f"{inner}.{attr}" for inner in self.list_meanings(value, scope))
            case ast.Call(func=func):
                yield from (f"{inner}()" for inner in self.list_meanings(func, scope))

    def _follow_bindings(self, name: str, bindings: list[Binding]) -> Iterator[str]:
        meanings: list[str] = []
        for binding in bindings:
            match binding:
                case Imported(module=module, name=imported):
                    meanings.append(f"{module}.{imported}" if imported else module)
                case Bound(node=node, scope=scope, path=(), is_item=False):
                    meanings += self.list_meanings(node, scope)
        yield from meanings or ([name] if name else [])


@lru_cache
def _build_prelude_scope(prelude: str) -> Scope:
    return build_scope(Module("", "", parse_module(PRELUDE_TEXTS.get(prelude, ""))))


def _name_prelude(name: str, prelude: str) -> str:
    """Return the full name of an object that a prelude defines, such as `tank_drive`.

    A name that the prelude does not define is returned unchanged.

    Args:
        name: The name by which programs use the object.
        prelude: The code that runs before the program and defines such names: a key of `PRELUDE_TEXTS`.
    """
    names = _Names(_build_prelude_scope(prelude))
    return next(iter(names.list_meanings(ast.Name(name), names.prelude)))


def _list_scopes(scope: Scope) -> list[Scope]:
    return [scope, *(each for inner in scope.inner.values() for each in _list_scopes(inner))]


def list_calls(tree: ast.Module, prelude: str, wanted: str) -> list[int]:
    """Return the numbers of a program's lines with a call, in ascending order.

    Args:
        tree: The program.
        prelude: The code that runs before the program and defines names such as `tank_drive`: a key of `PRELUDE_TEXTS`.
        wanted: A function such as `time.sleep`; a method of an object that the prelude defines, such as
            `tank_drive.on`; or the name of a function or method alone. Methods of other objects of the same class are
            found as well.
    """
    scopes = _list_scopes(build_scope(Module("", "", tree)))
    names = _Names(_build_prelude_scope(prelude))
    calls = [
        ({ast.unparse(call.func), *names.list_meanings(call.func, scope)}, call.lineno)
        for scope in scopes
        for call in scope.body
        if isinstance(call, ast.Call)
    ]
    wanted = wanted.removesuffix("()")
    head, _, rest = wanted.partition(".")
    # A name without a dot, such as `sleep`, means any function or method of that name.
    if not rest:
        return sorted(
            {
                line
                for meanings, line in calls
                if any(wanted == meaning.rpartition(".")[2] for meaning in meanings)
            }
        )
    meant = _name_prelude(head, _DEFAULT_PRELUDE)
    # `MoveTank.on` also means the method `on` of any object of the class.
    owner, _, method = f"{meant}.{rest}".rpartition(".")
    whole = {wanted, f"{meant}.{rest}", f"{owner}().{method}"}
    # `DriveBase.straight` also means the method of the class that the program imports from Pybricks.
    for own in {
        meaning for scope in scopes for meaning in names.list_meanings(ast.Name(head), scope)
    }:
        if own.partition(".")[0] == PYBRICKS:
            whole |= {f"{own}.{rest}", f"{own}().{rest}"}
    # After `from ev3dev2.motor import *`, programs write only `MoveTank`, so the name without the module is accepted.
    starred = [f"{module}." for scope in scopes for module in scope.stars]
    whole |= {
        meaning.removeprefix(module)
        for module in starred
        for meaning in whole
        if meaning.startswith(module)
    }
    return sorted({line for meanings, line in calls if meanings & whole})
