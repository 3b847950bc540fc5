"""What a program waits for by its text: the comparison that ends a loop, the turns of a motor."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TypeGuard

from tuisim.base.data_class import dataclass
from tuisim.engine.core.conditions import COMPARE
from tuisim.programs.comparisons import (
    build_difference,
    find_attribute,
    find_constant,
    find_values,
    is_set,
    read_comparison,
    split_start,
)
from tuisim.programs.questions import COLOR_WORDS, Word, shorten

_Loop = ast.For | ast.While


@dataclass(frozen=True, slots=True)
class LoopEnd:
    """A comparison of a value with a constant that ends a loop, as in `while light > 20`."""

    line: int
    """The line of the comparison."""
    first_line: int
    """That on which the loop begins."""
    last_line: int
    operator: str
    """The operator that ends the loop, such as `>=`."""
    limit: Word
    """The constant; of a name such as `COLOR_RED` its last part."""
    attribute: str = ""
    """The attribute of a device that is read for the comparison; empty for none."""
    read_line: int = 0
    """The line that reads it."""
    name: str = ""
    """The variable that is compared; empty for none."""
    set_line: int = 0
    """The line before the loop that set this variable, if nothing in the program changes it afterwards; else 0."""
    is_count: bool = False
    """Whether `set_line` set a number, with which the loop cannot end, and not a reading."""
    called_lines: tuple[int, ...] = ()
    """If it is a count, the first lines of the functions that the loop calls."""
    start_line: int = 0
    """The line of an earlier reading of the same device that is subtracted from the value; 0 for none."""

    @property
    def color(self) -> str:
        """The colour with which the loop compares, in lower case; empty for none."""
        return COLOR_WORDS.get(shorten(self.limit), "")


def list_loop_ends(tree: ast.Module, constants: Mapping[str, Word]) -> tuple[LoopEnd, ...]:
    """Return the loops of a program that end when a comparison in the text becomes true or false, inner loops first.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
    """
    loops = [node for node in ast.walk(tree) if isinstance(node, ast.While)]
    loops.sort(key=lambda loop: -loop.lineno)
    return tuple(end for loop in loops for end in _find_ends(loop, tree, constants))


def list_counts(tree: ast.Module, constants: Mapping[str, Word]) -> Iterator[tuple[int, LoopEnd]]:
    """Yield each line in a loop that adds 1 to a variable when a value passes a constant, with that comparison.

    The variable is assigned nowhere else except for its first value, and no division uses it.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
    """
    loops = [node for node in ast.walk(tree) if isinstance(node, _Loop)]
    for loop in loops:
        for step in loop.body:
            match step:
                case ast.If(test=ast.Compare() as test, body=[count, *rest], orelse=[]) if (
                    (name := _find_counted(count))
                    and all(isinstance(each, ast.Expr) for each in rest)
                    and _is_only_counted(name, tree)
                ):
                    for end in _find_end(loop, test, tree, constants, is_break=True):
                        yield count.lineno, end


def _find_counted(node: ast.stmt) -> str:
    """Return the variable to which a statement adds 1; empty for any other statement."""
    match node:
        case ast.AugAssign(target=ast.Name(id=name), op=ast.Add(), value=ast.Constant(value=1)):
            return name
        case ast.Assign(
            targets=[ast.Name(id=name)],
            value=ast.BinOp(left=ast.Name(id=other), op=ast.Add(), right=ast.Constant(value=1)),
        ) if name == other:
            return name
    return ""


def _is_only_counted(name: str, tree: ast.Module) -> bool:
    """Return whether a variable is assigned only at its start and where it is counted, and used in no division."""
    nodes = [*ast.walk(tree)]
    places = [node for node in nodes if isinstance(node, ast.Name) and node.id == name]
    shares = [
        node for node in nodes if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)
    ]
    parts = {part for share in shares for part in ast.walk(share)}
    return sum(map(is_set, places)) == 2 and parts.isdisjoint(places)


def find_turns(
    tree: ast.Module, constants: Mapping[str, Word], line: int
) -> tuple[float, str] | None:
    """Return by how much a call on a line turns a motor or both wheels, and the unit: `rotations` or `degrees`.

    The result is None if the line has no such call.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
        line: The line.
    """
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Attribute(attr=attr), lineno=lineno) if lineno == line:
                amounts = [*node.args, *(each.value for each in node.keywords)]
                values = [find_constant(each, constants) for each in amounts]
                numbers = [each for each in values if isinstance(each, int | float)]
                if numbers and attr in ("on_for_rotations", "on_for_degrees"):
                    return numbers[-1], attr.removeprefix("on_for_")
                if len(numbers) > 1 and attr == "run_angle":
                    return numbers[1], "degrees"
    return None


def find_first_drive(tree: ast.Module) -> int:
    """Return the first line of a program that starts motors; 0 for none.

    Lines in functions that the program never mentions are ignored.
    """
    nodes = [*ast.walk(tree)]
    mentioned = {node.id for node in nodes if isinstance(node, ast.Name) and not is_set(node)}
    idle = {
        part
        for node in nodes
        if isinstance(node, ast.FunctionDef) and node.name not in mentioned
        for part in ast.walk(node)
    }
    return min((node.lineno for node in nodes if node not in idle and _is_drive(node)), default=0)


def _is_drive(node: ast.AST) -> TypeGuard[ast.Call]:
    match node:
        case ast.Call(func=ast.Attribute(attr="on"), args=args):
            # `on` with an attribute such as `Color.RED` is for a lamp of Pybricks, not for motors.
            return not any(isinstance(part, ast.Attribute) for part in args)
        case ast.Call(func=ast.Attribute(attr=attr)) if attr.startswith(("on_for_", "run_")):
            return True
        case ast.Call(func=ast.Attribute(attr="run" | "dc" | "drive"), args=[speed, *_]):
            return isinstance(speed, ast.Constant | ast.Name | ast.UnaryOp)
    return False


def _find_ends(
    loop: ast.While, tree: ast.Module, constants: Mapping[str, Word]
) -> Iterator[LoopEnd]:
    """Yield the comparisons that end a loop: those in its condition or, if it is endless, those before a `break`."""
    is_endless = isinstance(loop.test, ast.Constant) and bool(loop.test.value)
    if not is_endless:
        yield from _find_end(loop, loop.test, tree, constants, is_break=False)
    for step in loop.body if is_endless else ():
        if isinstance(step, ast.If) and any(isinstance(way, ast.Break) for way in step.body):
            yield from _find_end(loop, step.test, tree, constants, is_break=True)


def _find_end(
    loop: _Loop,
    test: ast.expr,
    tree: ast.Module,
    words: Mapping[str, Word],
    *,
    is_break: bool,
) -> Iterator[LoopEnd]:
    """Yield the comparisons with constants in a condition that end a loop.

    Args:
        loop: The loop.
        test: The condition.
        tree: The program.
        words: Values of names in the program, which are read as constants.
        is_break: Whether the loop ends if the condition is true; otherwise it ends if it is false.
    """
    if isinstance(test, ast.BoolOp):
        ends = [_find_end(loop, part, tree, words, is_break=is_break) for part in test.values]
        if isinstance(test.op, ast.Or) is is_break:
            yield from (end for each in ends for end in each if end.attribute)
        return
    comparison = read_comparison(test, words, is_break=is_break) or read_comparison(
        build_difference(test), words, is_break=is_break
    )
    if comparison and (end := _build_end(loop, test, comparison, tree, words)):
        yield end


def _build_end(
    loop: _Loop,
    test: ast.expr,
    comparison: tuple[ast.expr, str, Word],
    tree: ast.Module,
    words: Mapping[str, Word],
) -> LoopEnd | None:
    """Return the end of a loop that a comparison describes; None if the text does not show what the value depends on.

    The value must be read from a device in the loop. It may also have been set before the loop, if nothing else can end
    the loop: then the loop never ends.

    Args:
        loop: The loop.
        test: The condition.
        comparison: The compared expression, the operator with which it is true at the end, and the constant.
        tree: The program.
        words: Values of names in the program, which are read as constants.
    """
    value, ending, limit, start_line = split_start(*comparison, tree, words)
    name, set_line, is_count = "", 0, False
    if isinstance(value, ast.Name):
        name = value.id
        values = find_values(name, tree)
        inner = [value for line, value in values if loop.lineno <= line <= _find_last_line(loop)]
        if inner:
            value, ending, limit, line = split_start(inner[-1], ending, limit, tree, words)
            start_line = start_line or line
        elif values and values[-1][0] < loop.lineno:
            is_count = _is_short(words.get(name), ending, limit)
            set_line = values[-1][0] if is_count or find_attribute(values[-1][1]) else 0
    attribute = find_attribute(value)
    if not attribute and (not set_line or has_exit(loop)):
        return None
    lines = test.lineno, loop.lineno, _find_last_line(loop)
    called_lines = tuple(_list_called(loop, tree)) if is_count else ()
    end = LoopEnd(*lines, ending, limit, attribute, value.lineno, name, set_line)
    return replace(end, is_count=is_count, called_lines=called_lines, start_line=start_line)


def _is_short(number: Word | None, operator: str, limit: Word) -> bool:
    """Return whether a variable must still change before a comparison with a limit is true, as a counter must.

    The result is False if one of the two is not a number. It is also False if the variable may be a flag, which can
    keep its value: if the operator is `!=`, or one number is 0 and the limit is 1, or the reverse.

    Args:
        number: The variable's value before the loop.
        operator: The operator with which the comparison ends the loop.
        limit: The constant with which the variable is compared.
    """
    is_number = isinstance(number, int | float) and isinstance(limit, int | float)
    is_flag = operator == "!=" or {number, limit} == {0, 1}
    return is_number and not is_flag and not COMPARE[operator](number, limit)


def _list_called(loop: _Loop, tree: ast.Module) -> Iterator[int]:
    """Yield the first lines of the program's functions that a loop calls."""
    calls = [ast.unparse(node.func) for node in ast.walk(loop) if isinstance(node, ast.Call)]
    names = {call.rpartition(".")[2] for call in calls}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and node.name in names:
            yield node.lineno


def has_exit(loop: _Loop) -> bool:
    """Return whether something else than a loop's condition can end it, such as a `break` or a call of `exit`."""
    return any(map(_is_exit, ast.walk(loop)))


def _is_exit(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            return name.strip("_") in ("exit", "quit")
    return isinstance(node, ast.Break | ast.Return | ast.Raise)


def _find_last_line(node: ast.stmt) -> int:
    return node.end_lineno or node.lineno
