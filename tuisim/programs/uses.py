"""Mistakes in the use of values: readings that a program never renews, and assignments to the wrong name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeGuard

from tuisim.base.data_class import dataclass
from tuisim.programs.comparisons import find_attribute, read_comparison
from tuisim.programs.line_values import walk_scope
from tuisim.programs.moves import STARTS, STOPS
from tuisim.programs.questions import Word
from tuisim.programs.statements import find_call, list_blocks
from tuisim.programs.waits import LoopEnd, has_exit

_Function = ast.FunctionDef | ast.AsyncFunctionDef
_Loop = ast.For | ast.While
_PURE = {"abs", "max", "min", "round", "int", "float"}
"""Functions whose values depend only on their arguments."""
_BEFORE = re.compile(
    r"start|begin|first|init|base|old|last|prev|calib|white|black|zero", re.IGNORECASE
)
"""Names with these words are for readings that are meant to stay, such as the first one."""
_SPEEDS = "Speed"
"""How the names of classes of speeds begin."""


def list_stale_reads(tree: ast.Module, constants: Mapping[str, Word]) -> Iterator[LoopEnd]:
    """Yield each use of an old reading in a loop: the program took the reading before the loop, and never again in it.

    A use is a comparison with a constant, another test, or a move. The result has the lines of the loop. Its operator
    is empty if the use is not a comparison with a constant.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
    """
    shared = _list_shared(ast.walk(tree))
    for scope in _list_scopes(tree):
        nodes = [*walk_scope(scope)]
        for loop in nodes:
            if isinstance(loop, _Loop):
                for name, read in _list_reads_before(loop, nodes).items():
                    if name not in shared:
                        yield from _list_uses(loop, name, read, constants)


def _list_shared(nodes: Iterable[ast.AST]) -> set[str]:
    """Return the names that functions share with each other or with the program: those after `global` or `nonlocal`."""
    shared = (node for node in nodes if isinstance(node, ast.Global | ast.Nonlocal))
    return {name for node in shared for name in node.names}


def _list_scopes(tree: ast.Module) -> Iterator[ast.Module | _Function]:
    yield tree
    yield from (node for node in ast.walk(tree) if isinstance(node, _Function))


def _list_reads_before(loop: _Loop, nodes: list[ast.AST]) -> dict[str, ast.Assign]:
    """Return the last assignment of each variable before a loop, by name, if it reads an attribute of a device.

    Variables that the loop assigns itself are left out.

    Args:
        loop: The loop.
        nodes: The nodes of the scope that contains the loop.
    """
    reads: dict[str, ast.Assign] = {}
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)]) if node.lineno < loop.lineno:
                if name not in reads or reads[name].lineno < node.lineno:
                    reads[name] = node
    if isinstance(loop, ast.For) and not any(map(_is_reaction, ast.walk(loop))):
        return {}
    renewed = _list_stored(loop)
    return {
        name: node
        for name, node in reads.items()
        if name not in renewed and not _BEFORE.search(name) and _find_read(node.value, loop, name)
    }


def _find_read(value: ast.expr, loop: _Loop, name: str) -> str:
    """Return the attribute, such as `distance`, that an assignment before a loop reads; empty if it reads none.

    For a comparison such as `near = us.distance < 20`, the attribute is returned only if the loop is `while near` or
    `while not near`, and no statement such as `break` leaves it.

    Args:
        value: The assigned expression.
        loop: The loop.
        name: The variable.
    """
    match value, loop:
        case ast.Compare(left=left, comparators=[right]), ast.While(test=test) if _is_truth(
            test, name
        ) and not has_exit(loop):
            return find_attribute(left) or find_attribute(right)
    return find_attribute(value)


def _is_reaction(node: ast.AST) -> bool:
    """Return whether a node only starts or stops motors, or leaves a loop; it thus may be a reaction to a reading."""
    is_call = isinstance(node, ast.Expr) and bool(find_call(node, (*STARTS, *STOPS)))
    return is_call or isinstance(node, ast.Break)


def _list_stored(node: ast.AST) -> set[str]:
    return {
        part.id
        for part in ast.walk(node)
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)
    }


def _list_uses(
    loop: _Loop, name: str, read: ast.Assign, constants: Mapping[str, Word]
) -> Iterator[LoopEnd]:
    """Yield the comparisons and moves in a loop that depend only on a reading before the loop, and on constants.

    Args:
        loop: The loop.
        name: The variable with the reading.
        read: The assignment that reads it.
        constants: Values of names in the program; see `list_constants`.
    """
    stale = _find_derived(loop, name)
    fresh = _list_stored(loop) - stale
    last_line = loop.end_lineno or loop.lineno

    def build_use(line: int, operator: str, limit: Word) -> LoopEnd:
        attribute = _find_read(read.value, loop, name)
        place = line, loop.lineno, last_line
        return LoopEnd(*place, operator, limit, attribute, read.lineno, name, read.lineno)

    for node in ast.walk(loop):
        match node:
            case ast.If(test=test) | ast.While(test=test):
                for part in test.values if isinstance(test, ast.BoolOp) else [test]:
                    match read_comparison(part, constants, is_break=True):
                        case (ast.Name(id=compared), operator, limit) if compared == name:
                            yield build_use(node.lineno, operator, limit)
                    if _is_truth(part, name):
                        yield build_use(node.lineno, "", 0)
            case ast.Call(func=ast.Attribute(attr=method), args=args) if method in STARTS:
                if any(_depends(arg, stale, fresh) for arg in args):
                    yield build_use(node.lineno, "", 0)


def _is_truth(test: ast.expr, name: str) -> bool:
    """Return whether a test is a name alone, `not` and the name, or compares the name with True or False."""
    match test:
        case ast.Compare(
            left=left,
            ops=[ast.Eq() | ast.NotEq() | ast.Is()],
            comparators=[ast.Constant(value=bool())],
        ):
            return _is_truth(left, name)
        case ast.Name(id=asked) | ast.UnaryOp(op=ast.Not(), operand=ast.Name(id=asked)):
            return asked == name
    return False


def _find_derived(loop: _Loop, name: str) -> set[str]:
    """Return a name, and the names that a loop computes only from this name and from values set before the loop."""
    stored = _list_stored(loop)
    derived = {name}
    assigns = [node for node in ast.walk(loop) if isinstance(node, ast.Assign)]
    for _ in assigns:
        for node in assigns:
            match node.targets:
                case [ast.Name(id=target)] if _depends(node.value, derived, stored - derived):
                    derived.add(target)
    return derived


def _depends(node: ast.expr, stale: set[str], fresh: set[str]) -> bool:
    """Return whether an expression depends only on old values: it uses a name in `stale`, but no name in `fresh`.

    An expression that reads an attribute, or calls something that may read a new value, does not depend only on old
    values.
    """
    names = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
    reads = any(
        isinstance(part, ast.Attribute) or (isinstance(part, ast.Call) and not _is_pure(part))
        for part in ast.walk(node)
    )
    return bool(names & stale) and not names & fresh and not reads


def _is_pure(call: ast.Call) -> bool:
    match call.func:
        case ast.Name(id=name):
            return name in _PURE or name.startswith(_SPEEDS)
    return False


@dataclass(frozen=True, slots=True)
class LoneStop:
    """An `if`, outside of `while` loops, that stops motors after a single reading."""

    line: int
    """The line of the `if`."""
    read_line: int
    stop_line: int
    start_line: int
    is_direct: bool
    """Whether the program does not wait between the start of the motors and the reading."""
    test: LoopEnd | None
    """The comparison; None for another test, such as whether a button is pressed."""


def list_lone_stops(tree: ast.Module, constants: Mapping[str, Word]) -> Iterator[LoneStop]:
    """Yield each `if` outside of `while` loops that stops motors which the same block has just started.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
    """
    again = {
        part for node in ast.walk(tree) if isinstance(node, ast.While) for part in ast.walk(node)
    }
    for block in list_blocks(tree):
        start, is_direct, read = 0, True, None
        for statement in block:
            match statement:
                case ast.If(test=test, body=body, orelse=[]) if start and statement not in again:
                    if stop := next((each for each in body if find_call(each, STOPS)), None):
                        lines = statement.lineno, _find_read_line(test, read), stop.lineno, start
                        comparison = _read_test(test, read, constants)
                        yield LoneStop(*lines, is_direct, comparison)
                    start = 0
                case ast.Assign(targets=[ast.Name()], value=value):
                    read = statement if find_attribute(value) else None
                case ast.Expr(value=ast.Call()) if find_call(statement, STARTS):
                    start, is_direct = statement.lineno, True
                case ast.Expr(value=ast.Call()) if find_call(statement, ("sleep", "wait")):
                    is_direct = False
                case ast.Expr(value=ast.Call()) if find_call(statement, ("print", "reset")):
                    pass
                case _:
                    start = 0


def _find_read_line(test: ast.expr, read: ast.Assign | None) -> int:
    """Return the line on which a test gets its reading.

    This is the line of `read` if the test uses the variable that `read` assigns. Otherwise it is the line of the test.
    """
    names = {part.id for part in ast.walk(test) if isinstance(part, ast.Name)}
    is_named = read is not None and names & _list_stored(read)
    return read.lineno if is_named and read else test.lineno


def _read_test(
    test: ast.expr, read: ast.Assign | None, constants: Mapping[str, Word]
) -> LoopEnd | None:
    """Return the comparison of a reading with a constant that a test makes; None if it is another test.

    Args:
        test: The test.
        read: An assignment before the test, whose reading the test may use; None for none.
        constants: Values of names in the program; see `list_constants`.
    """
    comparison = read_comparison(test, constants, is_break=True)
    if comparison is None:
        return None
    value, operator, limit = comparison
    line = _find_read_line(value, read)
    attribute = find_attribute(read.value if read and line == read.lineno else value)
    lines = test.lineno, test.lineno, test.lineno
    return LoopEnd(*lines, operator, limit, attribute, line) if attribute else None


@dataclass(frozen=True, slots=True)
class LostValue:
    """A value that a function assigns to a local name, although it probably means a global one: `global` is missing."""

    line: int
    name: str
    function: str
    lines: tuple[int, int]
    """The first and the last line of the function."""
    call_line: int
    """The first line of the program itself, outside of functions, that calls the function; 0 for none."""
    set_line: int
    """The line that sets the program's name."""
    is_certain: bool
    """Whether a program that comes to its end has called the function: the call is in no other block."""


def list_lost_values(tree: ast.Module) -> Iterator[LostValue]:
    """Yield each value that a function assigns to a local name and never uses, if the program uses this name, too.

    Printing the value does not count as a use. Returning it counts only if a call uses the result of the function.
    """
    functions = [node for node in tree.body if isinstance(node, _Function)]
    outside = [*walk_scope(tree)]
    nodes = [*ast.walk(tree)]
    bare = {node.value for node in nodes if isinstance(node, ast.Expr)}
    all_calls = [node for node in nodes if isinstance(node, ast.Call)]
    for function in functions:
        inside = {*ast.walk(function)}
        calls = [node for node in all_calls if _is_call(node, function.name) and node not in inside]
        if not calls:
            continue
        own = _list_parameters(function) | _list_shared(inside)
        used = [*_walk_used(function, has_result=not bare.issuperset(calls))]
        lines = [node.lineno for node in outside if _is_call(node, function.name)]
        call_line = min(lines, default=0)
        is_certain = any(
            _is_call(getattr(step, "value", step), function.name) for step in tree.body
        )
        for node in walk_scope(function):
            match node:
                case ast.Assign(targets=[ast.Name(id=name)]) if name not in own:
                    set_line = _find_set_line(name, outside)
                    is_meant = set_line and _is_meant(name, call_line, outside, functions)
                    if is_meant and not _is_loaded(name, used):
                        span = function.lineno, function.end_lineno or function.lineno
                        yield LostValue(
                            *(node.lineno, name, function.name, span, call_line, set_line),
                            is_certain,
                        )


def _list_parameters(function: _Function) -> set[str]:
    return {part.arg for part in ast.walk(function.args) if isinstance(part, ast.arg)}


def _is_meant(
    name: str, call_line: int, outside: list[ast.AST], functions: list[_Function]
) -> bool:
    """Return whether a program uses a global name to which a function should have assigned a value.

    The program must use the name after the call of the function, in a loop, or in another function.

    Args:
        name: The name.
        call_line: The line of the first call of the function; 0 for none.
        outside: The nodes of the program outside of functions.
        functions: The functions.
    """
    later = [node for node in outside if getattr(node, "lineno", 0) >= call_line]
    loops = [part for node in outside if isinstance(node, _Loop) for part in ast.walk(node)]
    others = [[*walk_scope(function)] for function in functions]
    shared = [nodes for nodes in others if not _find_set_line(name, nodes)]
    return any(_is_loaded(name, nodes) for nodes in (later, loops, *shared))


def _walk_used(node: ast.AST, *, has_result: bool) -> Iterator[ast.AST]:
    """Yield the nodes in a function that may show that a value is used.

    Nodes in a `print` are left out; nodes in a `return`, too, if `has_result` is False.
    """
    for part in ast.iter_child_nodes(node):
        is_returned = isinstance(part, ast.Return) and not has_result
        if not is_returned and not _is_call(part, "print"):
            yield part
            yield from _walk_used(part, has_result=has_result)


def _is_call(node: ast.AST, name: str) -> TypeGuard[ast.Call]:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name


def _find_set_line(name: str, nodes: Iterable[ast.AST]) -> int:
    """Return the first line that assigns a name; 0 for none."""
    lines = [
        node.lineno
        for node in nodes
        if isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Store)
    ]
    return min(lines, default=0)


def _is_loaded(name: str, nodes: Iterable[ast.AST]) -> bool:
    return any(
        isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load)
        for node in nodes
    )
