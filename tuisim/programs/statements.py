"""The statements of a program's syntax tree: their blocks, and the calls and numbers in them."""

from __future__ import annotations

import ast
from collections.abc import Iterator


def list_blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    """Yield the lists of statements in a syntax tree: the body of the module, of each function, loop and branch."""
    for node in ast.walk(tree):
        for name in ("body", "orelse"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield block


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


def find_number(node: ast.expr) -> float | None:
    """Return the number in an expression, which may be in a speed such as `SpeedPercent(30)`.

    The result is None for other expressions.
    """
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            number = find_number(operand)
            return None if number is None else -number
        case ast.Call(func=ast.Name(id=name), args=[speed]) if name.startswith("Speed"):
            return find_number(speed)
    return None
