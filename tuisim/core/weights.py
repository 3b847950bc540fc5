"""Weights of the pixels of a disc in a colour reading."""

from __future__ import annotations

import math
from functools import lru_cache

from tuisim.core.field import disc_mask

GAUSSIAN_SCALE = 1000
CENTRE_WEIGHT = 3


@lru_cache(maxsize=32)
def disc_weights(diameter: int, strategy: str) -> tuple[int, ...]:
    """Return the weight of each pixel of a box, row-major, 0 outside the disc.

    diameter: Diameter of the disc in pixels.
        strategy: `mean`: equal weights. `gaussian`: a bell curve whose standard deviation is half
        the radius. `centre`: threefold weight within half the radius.
            the radius. `centre`: the inner half of the radius counts threefold.
    """
    radius = diameter / 2
    weights = []
    for row, inside_row in enumerate(disc_mask(diameter)):
        for col, inside in enumerate(inside_row):
            squared = (row - radius) ** 2 + (col - radius) ** 2
            weights.append(_weight(squared, radius, strategy) if inside else 0)
    return tuple(weights)


def _weight(squared: float, radius: float, strategy: str) -> int:
    match strategy:
        case "gaussian":
            return round(GAUSSIAN_SCALE * math.exp(-squared / (2 * (radius / 2) ** 2)))
        case "centre":
            return CENTRE_WEIGHT if squared < (radius / 2) ** 2 else 1
        case _:
            return 1


def weighted_mean(box: bytes, diameter: int, strategy: str) -> tuple[float, float, float]:
    """Return the weighted mean red, green and blue of a box of RGB pixels."""
    weights = disc_weights(diameter, strategy)
    total = sum(weights)
    red, green, blue = (sum(map(int.__mul__, box[channel::3], weights)) / total for channel in range(3))
    return red, green, blue
