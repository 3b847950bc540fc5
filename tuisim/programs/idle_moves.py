"""Starts and stops of motors in a program that have no effect, since of the next one, or a loop, comes at once."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from tuisim.programs.moves import ANY_MOVE, STARTS, STOPS
from tuisim.programs.pure_expressions import has_effect
from tuisim.programs.statements import find_call, find_number, list_blocks
from tuisim.programs.wrong_calls import find_makers

_LEAVES = (ast.Break, ast.Return, ast.Raise)


def list_idle_moves(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the lines with a start or stop of motors that has no effect, each with a description.

    Of each kind of mistake, only the first line is yielded.
    """
    makers = _map_motors(tree)
    blocks = [*_list_blocks(tree)]
    for list_lines in (_list_stopped_starts, _list_overruled, _list_restarts):
        if first := min(list_lines(blocks, makers), default=None):
            yield first


def _list_blocks(tree: ast.Module) -> Iterator[list[ast.stmt]]:
    """Yield each list of statements in a program, such as the body of a loop, without the calls of `print` in it.

    Such calls take no time, so the motors do not move between the statement before and the one after.
    """
    for block in list_blocks(tree):
        yield [step for step in block if not _is_print(step)]


def _is_print(step: ast.stmt) -> bool:
    match step:
        case ast.Expr(value=ast.Call(func=ast.Name(id="print"), args=args)):
            return not any(map(has_effect, args))
    return False


def _map_motors(tree: ast.Module) -> dict[str, str]:
    """Return for each motor and each pair of motors, by name, a text that is the same for the same motors."""
    return {name: maker.arguments or name for name, maker in find_makers(tree).items()}


def _find_owner(step: ast.stmt, methods: Sequence[str], makers: Mapping[str, str]) -> str:
    """Return the name of the motor, or pair of motors, whose method a statement calls; empty for other statements."""
    match step:
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr=method))):
            name = ast.unparse(owner)
            return name if method in methods and name in makers else ""
    return ""


def _list_stopped_starts(
    blocks: Sequence[Sequence[ast.stmt]], makers: Mapping[str, str]
) -> Iterator[tuple[int, str]]:
    """Yield each line that starts motors which the next statement stops at once, with a description."""
    for block in blocks:
        for step, following in pairwise(block):
            owner = _find_owner(step, STARTS, makers)
            is_stopped = owner and owner == _find_owner(following, STOPS, makers)
            # A stop with a value, such as the way to brake, tries out how motors stop.
            if is_stopped and ast.unparse(following).endswith("()") and _is_moving(step):
                text = f"line {following.lineno} stops at once what this line starts: {_name_wait(step)}"
                yield step.lineno, text


def _is_moving(step: ast.stmt) -> bool:
    """Return whether a statement calls a method with a speed other than 0, or without any number."""
    match step:
        case ast.Expr(value=ast.Call(args=args, keywords=keywords)):
            values = [find_number(each) for each in (*args, *(each.value for each in keywords))]
            return any(value != 0 for value in values)
    return False


def _name_wait(step: ast.stmt) -> str:
    """Return what to write so that the motors run for a while, such as `wait in between lets them run`.

    Args:
        step: The statement that starts the motors; the next statement stops them.
    """
    match step:
        case ast.Expr(
            value=ast.Call(func=ast.Attribute(value=owner, attr="drive"), args=[speed, turn])
        ) if (way := find_number(speed)) and find_number(turn) == 0:
            return f"{ast.unparse(owner)}.straight({way:g}) drives {way:g} mm"
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr="on"))):
            return "sleep in between lets them run, or on_for_seconds in its place"
    return "wait in between lets them run"


def _list_overruled(
    blocks: Sequence[Sequence[ast.stmt]], makers: Mapping[str, str]
) -> Iterator[tuple[int, str]]:
    """Yield each line in an `if` that starts motors in vain, with a description.

    The next statement is a second `if` with an `else`. Each of its cases starts the same motors anew, so that the first
    start has no effect.
    """
    for block in blocks:
        for step, following in pairwise(block):
            match step, following:
                case ast.If(body=[*_, start], orelse=[]), ast.If():
                    motors = makers.get(_find_owner(start, STARTS, makers))
                    begins = [
                        makers.get(_find_owner(branch[0], ANY_MOVE, makers))
                        for branch in _list_branches(following)
                    ]
                    if motors and {*begins} == {motors}:
                        text = (
                            f"line {following.lineno} and on overrule at once what this line starts: "
                            f"write elif in line {following.lineno}"
                        )
                        yield start.lineno, text


def _list_branches(branch: ast.If) -> list[list[ast.stmt]]:
    """Return the bodies of an `if`, of its `elif` and of its `else`, exactly one of which runs.

    The result is empty if there is no `else`, or if a condition calls something that may wait.
    """
    branches = []
    while not has_effect(branch.test):
        branches.append(branch.body)
        match branch.orelse:
            case [ast.If() as branch]:
                pass
            case [_, *_]:
                return [*branches, branch.orelse]
            case _:
                break
    return []


def _list_restarts(
    blocks: Sequence[Sequence[ast.stmt]], makers: Mapping[str, str]
) -> Iterator[tuple[int, str]]:
    """Yield the line of each `break` after a stop of motors that ends only an inner loop, with a description.

    The outer loop then starts the motors again, which was probably not meant.
    """
    for block in blocks:
        for loop in block:
            match loop:
                case ast.While(
                    test=ast.Constant(value=True), body=[*starts, ast.While(body=steps) as inner]
                ):
                    motors = {makers.get(_find_owner(start, STARTS, makers)) for start in starts}
                    if len(motors) != 1 or not all(map(_has_numbers, starts)):
                        continue
                    leaves = [node for node in ast.walk(inner) if isinstance(node, _LEAVES)]
                    for step in steps:
                        match step:
                            case ast.If(body=[*_, stop, ast.Break() as leave], orelse=[]) if (
                                leaves == [leave]
                                and makers.get(_find_owner(stop, STOPS, makers)) in motors - {None}
                            ):
                                text = (
                                    f"this break ends only the loop of line {inner.lineno}, and line "
                                    f"{starts[0].lineno} starts the motors again: the outer loop needs its own"
                                )
                                yield leave.lineno, text


def _has_numbers(step: ast.stmt) -> bool:
    """Return whether all values of a call are numbers, so that it always does the same."""
    match step:
        case ast.Expr(value=ast.Call(args=args, keywords=[])):
            return all(find_number(each) is not None for each in args)
    return False


def list_stopping_loops(tree: ast.Module) -> Iterator[tuple[int, str, range]]:
    """Yield the lines in a `while` loop that stop the motors in its first pass, although the loop waits while they run.

    Yields:
        The line, a description, and the lines of the loop.
    """
    makers = _map_motors(tree)
    functions = [node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    for block in _list_blocks(tree):
        for start, loop in pairwise(block):
            if not isinstance(loop, ast.While) or isinstance(loop.test, ast.Constant):
                continue
            motors = makers.get(_find_owner(start, STARTS, makers))
            nodes = [*ast.walk(loop)]
            goes_on = any(
                isinstance(node, _LEAVES)
                or (isinstance(node, ast.stmt) and find_call(node, (*ANY_MOVE, *functions)))
                for node in nodes
            )
            for step in loop.body if motors and not goes_on else ():
                if makers.get(_find_owner(step, STOPS, makers)) == motors:
                    call = ast.unparse(step)
                    text = (
                        "this stops the motors in the first pass of the loop: "
                        f"write {call} after the loop, with fewer blanks before it"
                    )
                    yield (
                        step.lineno,
                        text,
                        range(loop.lineno, (loop.end_lineno or loop.lineno) + 1),
                    )
