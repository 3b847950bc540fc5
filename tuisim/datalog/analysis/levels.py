"""Levels of light: what noise does to them, and what they are called."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import sqrt
from types import MappingProxyType

from tuisim.core.css import css_names

NEAR_PERCENT = 2.0
"""A grey farther off than this is another one."""

FULL = 255.0

_PLAIN_NAMES = MappingProxyType({0: "black", 128: "grey", 255: "white", 211: "light grey", 220: "pale grey",
                                 169: "dark grey", 105: "dim grey", 192: "silver"})  # fmt: skip
"""Names as people say them, by channel value; the others are the names of CSS."""


@dataclass(frozen=True, slots=True)
class Grey:
    """A grey with a name."""

    name: str
    percent: float
    """100 is white."""


@cache
def greys() -> Mapping[int, Grey]:
    """Return every grey that has a name, by channel value 0 to 255."""
    found = {red: name for name, (red, green, blue) in css_names().items() if red == green == blue}
    found |= _PLAIN_NAMES
    return {value: Grey(name, 100.0 * value / FULL) for value, name in sorted(found.items())}


def nearest_grey(percent: float) -> Grey | None:
    """Return the grey nearest to a level of 0 to 100 %, None if none is within NEAR_PERCENT."""
    best = min(greys().values(), key=lambda grey: abs(grey.percent - percent))
    return best if abs(best.percent - percent) <= NEAR_PERCENT else None


def without_clamping(percent: float, noise: int) -> float:
    """Return the level that a mean of noisy pixels stands for.

    Noise moves each pixel by up to ±`noise`, evenly spread, and what would leave 0 to 255
    is clamped: near both ends the mean comes out too far inside. The mean of a pixel of
    value 255 - u, u below the noise, is 255 - (noise + u)² / (4 noise).

    Args:
        percent: Mean level, 0 to 100.
        noise: Light noise of the run, 0 to 128.
    """
    if not noise:
        return percent
    value = percent * FULL / 100.0
    return 100.0 * _unclamped(FULL - _unclamped(FULL - value, noise), noise) / FULL


def _unclamped(below: float, noise: int) -> float:
    """Undo the clamping at one end; `below` counts from that end."""
    if below >= noise:
        return below
    return max(0.0, 2.0 * sqrt(noise * max(below, 0.0)) - noise)
