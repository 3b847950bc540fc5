"""What a program waits for by its text: the comparison that ends a loop, the turns of a motor."""

from __future__ import annotations

import ast
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeGuard

from tuisim.base.data_class import dataclass
from tuisim.programs.questions import COLOR_WORDS, Word, shorten
from tuisim.programs.robot.source import OPERATORS, SIGNS, TURNED

_OPPOSITE = {">=": "<", ">": "<=", "<=": ">", "<": ">=", "!=": "==", "==": "!="}
"""For the operator of a `while` condition, the one with which the loop ends."""
_Loop = ast.For | ast.While
_PARALLEL = {"threading", "_thread", "asyncio", "multiprocessing", "multitask"}
"""Names of modules and functions with which parts of a program run at the same time."""


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
    """The variable that is compared; empty for none, as in an endless loop that only computes."""
    set_line: int = 0
    """The line before the loop that read this variable, if nothing in the program changes it afterwards; else 0."""
    is_silent: bool = False
    """Whether nothing in the loop calls or reads anything: it only computes."""

    @property
    def is_endless(self) -> bool:
        """Whether the loop cannot end: the compared value never changes, or the loop only computes without an end."""
        return bool(self.set_line) or (self.is_silent and not self.name)

    @property
    def color(self) -> str:
        """The colour with which the loop compares, in lower case; empty for none."""
        return COLOR_WORDS.get(shorten(self.limit), "")


def list_blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    """Yield the statements of each block in a tree: of the module, and of what its statements contain."""
    for node in ast.walk(tree):
        for name in ("body", "orelse"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield block


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
    return sum(map(_is_set, places)) == 2 and parts.isdisjoint(places)


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
    mentioned = {node.id for node in nodes if isinstance(node, ast.Name) and not _is_set(node)}
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
    """Yield the comparisons that end a loop: from its condition or, for an endless loop, from that of a `break`."""
    is_endless = isinstance(loop.test, ast.Constant) and bool(loop.test.value)
    if not is_endless:
        yield from _find_end(loop, loop.test, tree, constants, is_break=False)
    for step in loop.body if is_endless else ():
        if isinstance(step, ast.If) and any(isinstance(way, ast.Break) for way in step.body):
            yield from _find_end(loop, step.test, tree, constants, is_break=True)
    if is_endless and not any(map(_does_something, ast.walk(loop))) and not _has_threads(tree):
        line = loop.lineno
        yield LoopEnd(line, line, _find_last_line(loop), "", "", read_line=line, is_silent=True)


def _does_something(node: ast.AST) -> bool:
    """Return whether a node in an endless loop may leave the loop, wait, read or move something."""
    match node:
        case ast.Call(func=ast.Name(id="print")):
            return False
        case ast.Call() | ast.Attribute() | ast.Break() | ast.Return() | ast.Raise():
            return True
    return isinstance(node, ast.Await | ast.Yield | ast.YieldFrom)


def _has_threads(tree: ast.Module) -> bool:
    """Return whether a program imports a module of threads or tasks, which may go on beside an endless loop."""
    return any(
        isinstance(node, ast.Import | ast.ImportFrom)
        and _PARALLEL.intersection(
            [getattr(node, "module", ""), *(each.name for each in node.names)]
        )
        for node in ast.walk(tree)
    )


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
    comparison = read_comparison(test, words, is_break=is_break)
    if comparison is None:
        return
    value, ending, limit = comparison
    name, set_line, read_line, attribute = "", 0, value.lineno, find_attribute(value)
    is_silent = not _has_any(loop, ast.Call, ast.Attribute)
    if isinstance(value, ast.Name):
        name = value.id
        values = _find_values(name, tree)
        inner = [value for line, value in values if loop.lineno <= line <= _find_last_line(loop)]
        if inner:
            read_line = inner[-1].lineno
            attribute = find_attribute(inner[-1])
        if values and values[-1][0] < loop.lineno and find_attribute(values[-1][1]):
            set_line = values[-1][0]
        is_silent = is_silent and bool(inner)
    if attribute or (name and not _has_exit(loop) and (set_line or is_silent)):
        lines = test.lineno, loop.lineno, _find_last_line(loop)
        yield LoopEnd(*lines, ending, limit, attribute, read_line, name, set_line, is_silent)


def read_comparison(
    test: ast.expr, constants: Mapping[str, Word], *, is_break: bool
) -> tuple[ast.expr, str, Word] | None:
    """Return the compared expression, the operator and the constant of a comparison that ends a loop.

    The result is None for other tests.

    Args:
        test: The comparison.
        constants: Values of names in the program; see `list_constants`.
        is_break: Whether the loop ends if it is true; otherwise the operator is reversed.
    """
    match test:
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            sign = SIGNS.get(type(operator), "")
        case _:
            return None
    ending = sign if is_break else _OPPOSITE.get(sign, "")
    limit = find_constant(right, constants)
    if limit is None:
        left, limit, ending = right, find_constant(left, constants), TURNED.get(ending, ending)
    return None if limit is None or not ending else _split_sum(left, ending, limit, constants)


def _split_sum(
    value: ast.expr, ending: str, limit: Word, constants: Mapping[str, Word]
) -> tuple[ast.expr, str, Word]:
    """Return a comparison in which numbers added to the value are subtracted from the limit instead.

    Args:
        value: The compared expression.
        ending: The operator.
        limit: The constant.
        constants: Values of names in the program.

    Returns:
        The expression without these numbers, the operator, and the new limit.
    """
    while isinstance(limit, int | float):
        match value:
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                sign = 1 if isinstance(op, ast.Add) else -1
                number = find_constant(right, constants)
                if number is None and sign > 0:
                    left, number = right, find_constant(left, constants)
                if not isinstance(number, int | float):
                    break
                value, limit = left, limit - sign * number
            case _:
                break
    return value, ending, limit


def _has_any(loop: _Loop, *kinds: type[ast.AST]) -> bool:
    return any(isinstance(node, kinds) for node in ast.walk(loop))


def _has_exit(loop: _Loop) -> bool:
    """Return whether something else than a loop's condition can end it, such as a `break` or a call of `exit`."""
    return _has_any(loop, ast.Break, ast.Return, ast.Raise) or any(map(_is_exit, ast.walk(loop)))


def _is_exit(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            return name.strip("_") in ("exit", "quit")
    return False


def _find_last_line(node: ast.stmt) -> int:
    return node.end_lineno or node.lineno


def list_constants(tree: ast.Module) -> dict[str, Word]:
    """Return the texts and numbers that names in a program always have, by name.

    These are names that are assigned once, and parameters that have the same value in all calls.
    """
    nodes = [*ast.walk(tree)]
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    times_set = Counter(
        [
            *(node.id for node in nodes if isinstance(node, ast.Name) and _is_set(node)),
            *(node.arg for node in nodes if isinstance(node, ast.arg)),
        ]
    )
    constants: dict[str, Word] = {}

    def add(name: str, values: Iterable[ast.expr]) -> None:
        words = {find_constant(value, constants) for value in values}
        if times_set[name] == 1 and len(words) == 1 and (word := words.pop()) is not None:
            constants[name] = word

    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                add(name, [value])
    calls_by_name: dict[str, list[list[ast.expr]]] = defaultdict(list)
    for node in nodes:
        match node:
            case ast.Call(func=ast.Name(id=name), args=values):
                calls_by_name[name].append(values)
    for function in functions:
        calls = calls_by_name[function.name]
        for index, parameter in enumerate(function.args.args):
            if all(len(values) > index for values in calls):
                add(parameter.arg, [values[index] for values in calls])
    return constants


def _is_set(node: ast.Name) -> bool:
    return not isinstance(node.ctx, ast.Load)


def find_constant(node: ast.expr, constants: Mapping[str, Word]) -> Word | None:
    """Return the text or number of a constant expression, or a name in capitals such as `RED`; None for others."""
    match node:
        case ast.Name(id=name):
            return constants.get(name)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
            match find_constant(left, constants), find_constant(right, constants):
                case (int() | float() as number, int() | float() as other) if other:
                    return OPERATORS[type(op)](number, other)
            return None
        case ast.Constant(value=str() | int() | float() as value) if not isinstance(value, bool):
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -value
        case ast.Attribute(attr=attr) if attr.isupper():
            return attr
    return None


def find_attribute(node: ast.expr) -> str:
    """Return the attribute that an expression reads, or the method that it calls without an argument or with 0.

    The result is empty for other expressions.
    """
    match node:
        case (
            ast.Attribute(attr=attr)
            | ast.Call(func=ast.Attribute(attr=attr), args=[] | [ast.Constant(value=0)])
        ):
            return attr
    return ""


def _find_values(name: str, tree: ast.Module) -> list[tuple[int, ast.expr]]:
    """Return the lines that assign a variable, each with the assigned expression, or the name's node if unknown.

    The result is empty if several functions share the variable, since their order is not known.
    """
    values: list[tuple[int, ast.expr]] = []
    for node in ast.walk(tree):
        match node:
            case ast.Global(names=names) | ast.Nonlocal(names=names) if name in names:
                return []
            case ast.Name(id=other, ctx=ast.Store()) if other == name:
                values.append((node.lineno, node))
            case ast.Assign(targets=[ast.Name(id=other)], value=value) if other == name:
                values.append((node.lineno, value))
    known = {line for line, value in values if not isinstance(value, ast.Name)}
    return [
        (line, value)
        for line, value in sorted(values, key=lambda each: each[0])
        if not (line in known and isinstance(value, ast.Name))
    ]
