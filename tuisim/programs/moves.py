"""The calls of a program that move motors: moves that it does not wait for, and moves of one wheel after the other."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import copysign
from typing import TypeGuard

from tuisim.base.data_class import dataclass
from tuisim.programs.statements import find_call, find_number, list_blocks, name_call

STARTS = ("on", "run_forever", "run", "drive", "dc", "run_direct")
"""Methods that start motors, and return at once."""
_MOVES = (*STARTS, "on_for_degrees", "on_for_rotations", "on_for_seconds")
STOPS = ("off", "stop", "brake", "hold")


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
ANY_MOVE = (*_MOVES, *_ENDING)


def list_unwaited_moves(tree: ast.Module) -> Iterator[UnwaitedMove]:
    """Yield the calls of moves with `block=False` or `wait=False`."""
    for block in list_blocks(tree):
        for index, statement in enumerate(block):
            call = getattr(statement, "value", None)
            if isinstance(call, ast.Call) and (option := _find_option(statement)):
                next_line = _find_next_move(call, block[index + 1 :])
                last_line = statement.end_lineno or statement.lineno
                method = find_call(statement, ANY_MOVE)
                yield UnwaitedMove(statement.lineno, last_line, method, option, next_line)


def _find_option(statement: ast.stmt) -> str:
    """Return the argument by which a move does not wait for its end, such as `block=False`; empty for others."""
    match statement:
        case ast.Expr(value=ast.Call(keywords=keywords)) if find_call(statement, ANY_MOVE):
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
                if find_call(statement, (*ANY_MOVE, *STOPS)):
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


_VARIABLE = re.compile(rf"\.({'|'.join(STARTS)})\(.*\b[a-z]\w*\b(?!=)")
"""A call that starts motors with speeds that are not constants."""


def find_steering(tree: ast.Module, line: int) -> int:
    """Return the line around `line` that steers the robot again and again, as a line follower does; 0 if there is none.

    In a function, this is the function's first move. In a loop outside functions, it is the loop's first move, if the
    moves in the loop differ. Elsewhere, it is `line` itself, if this is a call such as `follow_line()`.

    Args:
        tree: The program.
        line: The line.
    """
    around = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or node.lineno)
    ]
    functions = [node for node in around if isinstance(node, ast.FunctionDef)]
    loops = [node for node in around if isinstance(node, ast.For | ast.While)]
    places: Sequence[ast.stmt] = functions or loops
    if not places:
        return line if any(name_call(node).startswith("follow") for node in around) else 0
    own = tuple(node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    calls = [node for node in ast.walk(places[0]) if isinstance(node, ast.Expr)]
    moves = sorted(
        (call.lineno, ast.unparse(call)) for call in calls if find_call(call, (*ANY_MOVE, *own))
    )
    is_varied = len({move for _, move in moves}) > 1 or any(
        find_call(call, own) or _VARIABLE.search(ast.unparse(call)) for call in calls
    )
    if functions or (moves and is_varied):
        return moves[0][0] if moves else line
    return 0


@dataclass(frozen=True, slots=True)
class PartedMove:
    """Two successive calls that move two motors by the same amount, where the first call waits for its end."""

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


def list_parted_moves(tree: ast.Module, is_straight: Callable[[int], bool]) -> Iterator[PartedMove]:
    """Yield each two successive calls that move two motors equally, if the first call waits for its end.

    Such a pair probably means one move of both motors. It counts only in a loop with other statements, or if a comment
    says that the robot drives straight on. A program that also moves both wheels by one call has no such pair: it
    probably moves one wheel alone on purpose.

    Args:
        tree: The program.
        is_straight: Takes a line; returns whether a comment says of it that the robot drives straight on.
    """
    nodes = [*ast.walk(tree)]
    if any(isinstance(node, ast.Name) and _PAIRS.match(node.id) for node in nodes):
        return
    loops = {id(node.body) for node in nodes if isinstance(node, ast.For | ast.While)}
    for block in list_blocks(tree):
        is_loop = len(block) > 2 and id(block) in loops
        for first, second in pairwise(block):
            if not (is_loop or is_straight(first.lineno)):
                continue
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


_TURNS_DEG = (45.0, 90.0, 180.0, 360.0)
_ANGLES = {
    "on_for_degrees": _TURNS_DEG,
    "on_for_rotations": (0.25,),
    "run_angle": _TURNS_DEG,
}
"""Angles by which robots are turned; a whole rotation in `on_for_rotations` is mostly meant for a wheel."""
_SPOT_STEERING = 100.0
"""The steering that turns the wheels against each other."""
_DEGREES = {"on_for_degrees": 1.0, "on_for_rotations": 360.0}
"""The degrees of a unit that a method counts in."""


@dataclass(frozen=True, slots=True)
class WheelTurn:
    """A call that turns both wheels by an angle, in opposite directions."""

    first_line: int
    last_line: int
    method: str
    angle_deg: float
    """The angle of the wheels."""


def list_wheel_turns(tree: ast.Module) -> Iterator[WheelTurn]:
    """Yield the calls of a program that turn the wheels in opposite directions by an angle usual for turns of robots.

    Two calls one after the other, each for one motor, are one turn.
    """
    for first_call, second_call in _list_pairs(tree):
        if (angle_deg := _find_pair_angle(first_call, second_call)) in _ANGLES["run_angle"]:
            end_line = second_call.end_lineno or second_call.lineno
            yield WheelTurn(first_call.lineno, end_line, "run_angle", angle_deg)
    for node in ast.walk(tree):
        match node:
            case ast.Call(
                func=ast.Attribute(attr=method), args=[first, second, amount, *_], keywords=[]
            ) if method in _DEGREES:
                numbers = [find_number(each) for each in (first, second, amount)]
                if not _is_known(numbers):
                    continue
                left, right, count = numbers
                is_turn = abs(left) == _SPOT_STEERING or left == -right
                if is_turn and abs(count) in _ANGLES[method]:
                    last_line = node.end_lineno
                    angle_deg = abs(count) * _DEGREES[method]
                    yield WheelTurn(node.lineno, last_line or node.lineno, method, angle_deg)


def _list_pairs(tree: ast.Module) -> Iterator[tuple[ast.Call, ast.Call]]:
    """Yield each pair of calls that follow each other as statements of the same block."""
    for block in list_blocks(tree):
        for pair in pairwise(block):
            match pair:
                case ast.Expr(value=ast.Call() as first), ast.Expr(value=ast.Call() as second):
                    yield first, second


def _find_pair_angle(*calls: ast.Call) -> float:
    """Return the angle in degrees by which two calls of `run_angle` turn two motors in opposite directions.

    The result is 0 for any other calls.
    """
    motors = set[str]()
    turns_deg: list[float] = []
    for call in calls:
        match call:
            case ast.Call(
                func=ast.Attribute(value=ast.Name(id=motor), attr="run_angle"),
                args=[speed, angle, *_],
            ):
                numbers = [find_number(speed), find_number(angle)]
                if _is_known(numbers):
                    motors.add(motor)
                    turns_deg.append(copysign(numbers[1], numbers[0] * numbers[1]))
    is_turn = len(motors) == len(turns_deg) == len(calls) and sum(turns_deg) == 0
    return abs(turns_deg[0]) if is_turn else 0.0


def _is_known(numbers: list[float | None]) -> TypeGuard[list[float]]:
    return None not in numbers
