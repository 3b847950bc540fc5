"""Huge and tiny numbers: scaled, so that their sums, squares and differences do not overflow."""

from __future__ import annotations

import math

import numpy as np

from tuisim.engine.runs.arrays import FloatArray

_MAX_EXPONENT = 400
"""Of numbers between this power of two and its inverse, the sums of squares neither overflow nor vanish."""
MAX_DRAWN = 1e300
"""Charts draw larger numbers at this one: the distances between places on an axis must not overflow."""


def find_scale(low: float, high: float) -> float:
    """Return the power of two by which to divide numbers, so that sums of them do not overflow.

    The result is 1 unless the numbers are huge or tiny.

    Args:
        low, high: The least and the greatest of the numbers, finite.
    """
    exponent = math.frexp(max(-low, high))[1]
    return math.ldexp(1.0, exponent - min(max(exponent, -_MAX_EXPONENT), _MAX_EXPONENT))


def limit_drawn(numbers: FloatArray) -> FloatArray:
    """Return numbers with all finite numbers limited to ±`MAX_DRAWN`, for charts."""
    if not len(numbers) or (numbers.min() >= -MAX_DRAWN and numbers.max() <= MAX_DRAWN):
        return numbers
    return np.where(np.isfinite(numbers), numbers.clip(-MAX_DRAWN, MAX_DRAWN), numbers)
