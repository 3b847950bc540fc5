"""The size of the wheels in formulas, such as `cm / (math.pi * 5.6) * 360`, whose numbers have no name."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator

MIN_GIRTH_CM, MAX_GIRTH_CM = 4.7, 37.7
"""The way of wheels of 15 and of 120 mm in one turn."""
_TURN_DEG = 360


def find_formula_size(node: ast.AST) -> tuple[str, float] | None:
    """Return the name and the number of a wheel's size in a formula that divides by the wheel's circumference.

    For example, `distance / (math.pi * 56)` gives `wheel_diameter` and 56. The result is None for other expressions.
    """
    match node:
        case ast.BinOp(op=ast.Div(), right=product) if isinstance(product, ast.BinOp):
            return read_girth(product)
        case (
            ast.BinOp(
                op=ast.Mult(),
                left=ast.BinOp(op=ast.Div(), right=ast.Constant(value=float(girth))),
                right=ast.Constant(value=number),
            )
            | ast.BinOp(
                op=ast.Div(),
                left=ast.BinOp(op=ast.Mult(), left=ast.Constant(value=number))
                | ast.BinOp(op=ast.Mult(), right=ast.Constant(value=number)),
                right=ast.Constant(value=float(girth)),
            )
        ) if number == _TURN_DEG:
            return _check_girth(girth)
        case ast.Call(func=ast.Attribute(attr="on_for_rotations"), args=[*_, last]):
            match last:
                case ast.BinOp(op=ast.Div(), right=ast.Constant(value=float(girth))):
                    return _check_girth(girth)
    return None


def read_girth(product: ast.expr) -> tuple[str, float] | None:
    """Return the name and the number of the wheel's size in a product for a circumference, such as `math.pi * 56`.

    The name is `wheel_diameter` or, for a product 2 · π · r, `wheel_radius`. The result is None for other products.
    """
    factors = [*_list_factors(product)]
    numbers = [
        float(factor.value)
        for factor in factors
        if isinstance(factor, ast.Constant) and isinstance(factor.value, int | float)
    ]
    pis = [number for number in numbers if math.isclose(number, math.pi, rel_tol=0.002)]
    named = [factor for factor in factors if ast.unparse(factor) in ("pi", "math.pi")]
    lengths = [number for number in numbers if number not in pis]
    if len(pis) + len(named) != 1 or len(numbers) + len(named) != len(factors):
        return None
    match sorted(lengths):
        case [diameter] if diameter != 2.0:
            return "wheel_diameter", diameter
        case [2.0, radius]:
            return "wheel_radius", radius
    return None


def _list_factors(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        yield from _list_factors(node.left)
        yield from _list_factors(node.right)
    else:
        yield node


def _check_girth(girth_cm: float) -> tuple[str, float] | None:
    # A whole number may be an angle in degrees, so only fractions are accepted.
    is_girth = MIN_GIRTH_CM <= girth_cm <= MAX_GIRTH_CM and not girth_cm.is_integer()
    return ("wheel_circumference_cm", girth_cm) if is_girth else None
