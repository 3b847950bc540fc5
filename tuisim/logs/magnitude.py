"""Huge and tiny numbers: scaled, so that their sums, squares and differences do not overflow."""

from __future__ import annotations

import math

_MAX_EXPONENT = 400
"""Sums of the squares of numbers neither overflow nor vanish if the numbers are between 2**-400 and 2**400."""


def find_scale(low: float, high: float) -> float:
    """Return the power of two by which to divide numbers, so that sums of them do not overflow.

    The result is 1 unless the numbers are huge or tiny.

    Args:
        low, high: The least and the greatest of the numbers, finite.
    """
    exponent = math.frexp(max(-low, high))[1]
    return math.ldexp(1.0, exponent - min(max(exponent, -_MAX_EXPONENT), _MAX_EXPONENT))
