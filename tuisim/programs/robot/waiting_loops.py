"""The loops and calls in which a program waits until a motor stands still, or until a touch sensor is pressed."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tuisim.base.data_class import dataclass


@dataclass(frozen=True, slots=True)
class StateTest:
    """A test of a motor's state in a program, such as whether it is stalled."""

    motor: ast.expr
    state: ast.expr
    """The word that is looked for."""
    waits: bool
    """Whether the program waits for that state."""


def find_state_test(node: ast.expr) -> StateTest | None:
    """Return an expression as a test of a motor's state; None if it is something else."""
    match node:
        case ast.Compare(left=state, comparators=[ast.Attribute(value=motor, attr="state")]):
            return StateTest(motor, state, waits=False)
        case (
            ast.Call(func=ast.Attribute(value=motor, attr="wait_until"), args=[state, *_])
            | ast.Call(
                func=ast.Attribute(value=motor, attr="wait"),
                args=[ast.Lambda(body=ast.Compare(left=state)), *_],
            )
        ):
            return StateTest(motor, state, waits=True)
    return None


def find_stopped_motors(loop: ast.While) -> Iterator[tuple[ast.expr, bool]]:
    """Yield each motor that must be slow or stand still before a loop ends, and whether this is certain.

    It is certain if the loop compares positions of the motor; if it compares a speed, it may wait for something else.
    """
    match loop.test:
        case ast.Compare(left=left, ops=[ast.Gt() | ast.GtE() | ast.NotEq()], comparators=[right]):
            pass
        case _:
            return
    if (motor := _find_speed_owner(left)) is not None:
        yield motor, False
    # The loop may compare the motor's position with that of the previous iteration.
    stored = [node.value for node in loop.body if isinstance(node, ast.Assign)]
    if any(map(_find_position_owner, stored)):
        yield from ((motor, True) for motor in map(_find_position_owner, (left, right)) if motor)


def _find_speed_owner(node: ast.expr) -> ast.expr | None:
    """Return the motor in an expression for its speed, such as `abs(motor.speed())`; None for other expressions."""
    match node:
        case ast.Call(func=ast.Name(id="abs"), args=[inner]):
            return _find_speed_owner(inner)
        case (
            ast.Attribute(value=base, attr="speed")
            | ast.Call(func=ast.Attribute(value=base, attr="speed"))
        ):
            return base
    return None


def _find_position_owner(node: ast.expr) -> ast.expr | None:
    return node.value if isinstance(node, ast.Attribute) and node.attr == "position" else None


def find_awaited_touch(statement: ast.stmt) -> ast.expr | None:
    """Return the touch sensor for whose press a statement waits; None if it waits for something else."""
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=base, attr="wait_for_pressed"))):
            return base
        case ast.While(test=ast.Constant(value=True | 1)):
            return next(_find_ends(statement), None)
        case ast.While(test=test):
            return _find_released(test)
    return None


def _find_ends(loop: ast.While) -> Iterator[ast.expr]:
    """Yield the touch sensors whose press ends a loop."""
    for node in loop.body:
        match node:
            case ast.If(test=test, body=[*_, ast.Break() | ast.Return()]):
                if base := _find_pressed(test):
                    yield base


def _find_released(test: ast.expr) -> ast.expr | None:
    """Return the touch sensor in a condition that is true while the sensor is not pressed, such as `not ts.is_pressed`.

    The result is None for other conditions.
    """
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=value):
            return _find_pressed(value)
        case ast.Compare(
            left=value, ops=[ast.Eq() | ast.Is()], comparators=[ast.Constant(value=0)]
        ):
            return _find_pressed(value)
        case ast.Compare(
            left=value, ops=[ast.NotEq() | ast.IsNot()], comparators=[ast.Constant(value=1)]
        ):
            return _find_pressed(value)
        case ast.Attribute(value=base, attr="is_released"):
            return base
    return None


def _find_pressed(test: ast.expr) -> ast.expr | None:
    """Return the touch sensor in a condition that is true while the sensor is pressed, such as `ts.is_pressed`.

    The result is None for other conditions.
    """
    match test:
        case (
            ast.Attribute(value=base, attr="is_pressed")
            | ast.Call(func=ast.Attribute(value=base, attr="value" | "pressed"))
        ):
            return base
        case ast.Compare(
            left=value, ops=[ast.Eq() | ast.Is()], comparators=[ast.Constant(value=1)]
        ):
            return _find_pressed(value)
    return None
