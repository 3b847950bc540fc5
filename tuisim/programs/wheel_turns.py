"""The calls of a program that turn its wheels against each other by an angle that could be meant for the robot."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import TypeGuard

from tuisim.base.data_class import dataclass

_ANGLES = {"on_for_degrees": (45.0, 90.0, 180.0, 360.0), "on_for_rotations": (0.25,)}
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
    """Yield the calls of a program that turn the wheels in opposite directions by an angle such as robots turn by."""
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
