"""Expressions of a program that only read and compute, so that nothing changes when they are evaluated."""

from __future__ import annotations

import ast

READ_METHODS = {
    *("ambient", "angle", "color", "distance", "force", "heading", "hsv", "presence", "pressed"),
    *("reflection", "rotation", "speed"),
}
"""Methods of Pybricks that read a device; in `ev3dev2`, names such as `color` are values."""

_PURE = ("abs", "float", "int", "len", "max", "min", "round", "str")

_PURE_METHODS = {*READ_METHODS, "any", "done", "is_pressed", "ready", "stalled", "time", "value"}
"""Functions and methods that read and compute, and change nothing."""


def has_effect(test: ast.expr) -> bool:
    """Return whether evaluating a condition may change a value in it."""
    return any(
        isinstance(node, ast.NamedExpr | ast.Await | ast.Yield | ast.YieldFrom)
        or (isinstance(node, ast.Call) and not _is_pure(node))
        for node in ast.walk(test)
    )


def is_reading(node: ast.expr) -> bool:
    """Return whether an expression has the same value if it is evaluated twice in one condition.

    For example, `sensor.distance()` has, but `next(values)` has not.
    """
    match node:
        case ast.Name() | ast.Constant():
            return True
        case ast.Attribute(value=value) | ast.UnaryOp(operand=value):
            return is_reading(value)
        case ast.Subscript(value=value, slice=index):
            return is_reading(value) and is_reading(index)
        case ast.BinOp(left=left, right=right):
            return is_reading(left) and is_reading(right)
        case ast.Call(args=args, keywords=[]):
            return _is_pure(node) and all(map(is_reading, args))
    return False


def _is_pure(call: ast.Call) -> bool:
    match call.func:
        case ast.Name(id=name):
            return name in _PURE
        case ast.Attribute(attr=method):
            return method in _PURE_METHODS
    return False
