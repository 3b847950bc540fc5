"""The calls of a program that turn its wheels against each other by an angle that could be meant for the robot."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise
from math import copysign
from typing import TypeGuard

from tuisim.base.data_class import dataclass

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
    """Yield the calls of a program that turn the wheels in opposite directions by an angle such as robots turn by.

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
                numbers = [_find_number(each) for each in (first, second, amount)]
                if not _is_known(numbers):
                    continue
                left, right, count = numbers
                is_turn = abs(left) == _SPOT_STEERING or left == -right
                if is_turn and abs(count) in _ANGLES[method]:
                    last_line = node.end_lineno
                    angle_deg = abs(count) * _DEGREES[method]
                    yield WheelTurn(node.lineno, last_line or node.lineno, method, angle_deg)


def _list_pairs(tree: ast.Module) -> Iterator[tuple[ast.Call, ast.Call]]:
    """Yield two calls that are statements of a block one after the other."""
    for node in ast.walk(tree):
        for block in (getattr(node, name, None) for name in ("body", "orelse")):
            for pair in pairwise(block if isinstance(block, list) else ()):
                match pair:
                    case ast.Expr(value=ast.Call() as first), ast.Expr(value=ast.Call() as second):
                        yield first, second


def _find_pair_angle(*calls: ast.Call) -> float:
    """Return the angle by which two calls of `run_angle` turn two motors against each other; 0 if they do not."""
    motors = set[str]()
    turns_deg: list[float] = []
    for call in calls:
        match call:
            case ast.Call(
                func=ast.Attribute(value=ast.Name(id=motor), attr="run_angle"),
                args=[speed, angle, *_],
            ):
                numbers = [_find_number(speed), _find_number(angle)]
                if _is_known(numbers):
                    motors.add(motor)
                    turns_deg.append(copysign(numbers[1], numbers[0] * numbers[1]))
    is_turn = len(motors) == len(turns_deg) == len(calls) and sum(turns_deg) == 0
    return abs(turns_deg[0]) if is_turn else 0.0


def _is_known(numbers: list[float | None]) -> TypeGuard[list[float]]:
    return None not in numbers


def _find_number(node: ast.expr) -> float | None:
    """Return a number, also that in a speed such as `SpeedPercent(30)`; None for other expressions."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            number = _find_number(operand)
            return None if number is None else -number
        case ast.Call(func=ast.Name(id=name), args=[speed]) if name.startswith("Speed"):
            return _find_number(speed)
    return None
