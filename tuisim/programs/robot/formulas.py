"""The size of the wheels in formulas, such as `cm / (math.pi * 5.6) * 360`, whose numbers have no name."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator


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
