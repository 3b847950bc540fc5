"""The calls of a program that move motors: moves that it does not wait for, and moves of one wheel after the other."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import pairwise

from tuisim.base.data_class import dataclass
from tuisim.programs.waits import list_blocks

STARTS = ("on", "run_forever", "run", "drive", "dc", "run_direct")
"""Methods that start motors, and return at once."""
_MOVES = (*STARTS, "on_for_degrees", "on_for_rotations", "on_for_seconds")
STOPS = ("off", "stop", "brake", "hold")


def find_call(statement: ast.stmt, names: tuple[str, ...]) -> str:
    """Return the name of the function or method that a statement calls, if it is one of `names`; else an empty text."""
    name = name_call(statement)
    return name if name in names else ""


def name_call(statement: ast.stmt) -> str:
    """Return the name of the function or method that a statement calls; empty if the statement is not only a call."""
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name))):
            return name
    return ""


@dataclass(frozen=True, slots=True)
class UnwaitedMove:
    """A call that begins a move of limited length, such as a turn by an angle, without waiting for its end."""

    line: int
    last_line: int
    method: str
    option: str
    """The argument because of which the program does not wait, such as `block=False`."""
    next_line: int
    """The line of the next move or stop in the same block, if only calls are in between; 0 for none."""


_OPTIONS = ("block", "wait")
_ENDING = (
    "on_to_position",
    "straight",
    "turn",
    "curve",
    "arc",
    "run_angle",
    "run_target",
    "run_time",
)
_ANY_MOVE = (*_MOVES, *_ENDING)


def list_unwaited_moves(tree: ast.Module) -> Iterator[UnwaitedMove]:
    """Yield the calls of moves with `block=False` or `wait=False`."""
    for block in list_blocks(tree):
        for index, statement in enumerate(block):
            call = getattr(statement, "value", None)
            if isinstance(call, ast.Call) and (option := _find_option(statement)):
                next_line = _find_next_move(call, block[index + 1 :])
                last_line = statement.end_lineno or statement.lineno
                method = find_call(statement, _ANY_MOVE)
                yield UnwaitedMove(statement.lineno, last_line, method, option, next_line)


def _find_option(statement: ast.stmt) -> str:
    """Return the argument because of which a move does not block, such as `block=False`; empty for other statements."""
    match statement:
        case ast.Expr(value=ast.Call(keywords=keywords)) if find_call(statement, _ANY_MOVE):
            for keyword in keywords:
                if keyword.arg in _OPTIONS and getattr(keyword.value, "value", None) is False:
                    return f"{keyword.arg}=False"
    return ""


def _find_next_move(move: ast.Call, rest: list[ast.stmt]) -> int:
    """Return the line of the next move or stop after a move, preferably one of the same object; 0 if there is none.

    Only calls directly after the move are considered, up to the first other statement or call that waits.

    Args:
        move: The call.
        rest: The statements after it.
    """
    owner = _name_object(move.func)
    lines: list[tuple[bool, int]] = []
    for statement in rest:
        match statement:
            case ast.Expr(value=ast.Call(func=func)) if not _find_waiting(statement):
                if find_call(statement, (*_ANY_MOVE, *STOPS)):
                    lines.append((_name_object(func) != owner, statement.lineno))
            case _:
                break
    return min(lines, default=(False, 0))[1]


def _find_waiting(statement: ast.stmt) -> bool:
    return any(
        isinstance(node, ast.Attribute) and node.attr.startswith("wait_")
        for node in ast.walk(statement)
    )


def _name_object(func: ast.expr) -> str:
    return ast.unparse(func.value) if isinstance(func, ast.Attribute) else ""


@dataclass(frozen=True, slots=True)
class PartedMove:
    """Two calls, one after the other, that move two motors by the same amount, of which the first call waits."""

    first_line: int
    """The line of the first call."""
    next_line: int
    """That of the second call."""
    method: str
    option: str
    """The argument with which the first call would not wait."""


_OPTIONS_BY_METHOD = {
    "run_angle": "wait=False",
    "run_time": "wait=False",
    "on_for_degrees": "block=False",
    "on_for_rotations": "block=False",
    "on_for_seconds": "block=False",
}


_PAIRS = re.compile("Move[A-Z]|DriveBase|tank_|steering_")
"""How the names begin of what moves both wheels with one call."""


def list_parted_moves(tree: ast.Module) -> Iterator[PartedMove]:
    """Yield each pair of equal moves of two motors in which the first call blocks by default, without an argument.

    Programs that also move both wheels by one call, and loops with no other statements, are left out: they probably
    move one wheel alone on purpose.
    """
    names = [node.id for node in ast.walk(tree) if isinstance(node, ast.Name)]
    if any(map(_PAIRS.match, names)):
        return
    walks = [
        node.body
        for node in ast.walk(tree)
        if isinstance(node, ast.For | ast.While) and len(node.body) == 2
    ]
    for block in list_blocks(tree):
        for first, second in pairwise(block if block not in walks else ()):
            match first, second:
                case (
                    ast.Expr(value=ast.Call(func=ast.Attribute(value=motor, attr=method)) as move),
                    ast.Expr(
                        value=ast.Call(func=ast.Attribute(value=other, attr=same)) as follower
                    ),
                ) if method == same and method in _OPTIONS_BY_METHOD:
                    is_plain = not any(word.arg in _OPTIONS for word in move.keywords)
                    is_equal = _list_arguments(move) == _list_arguments(follower)
                    if is_plain and is_equal and ast.dump(motor) != ast.dump(other):
                        lines = first.lineno, second.lineno
                        yield PartedMove(*lines, method, _OPTIONS_BY_METHOD[method])


def _list_arguments(call: ast.Call) -> list[str]:
    """Return the arguments of a move in words, without those that say whether to wait."""
    named = [word for word in call.keywords if word.arg not in _OPTIONS]
    return [ast.unparse(each) for each in (*call.args, *named)]
