"""Colours as the sensor of a hub measures them, and the nearest of several colours."""

from __future__ import annotations

from collections.abc import Sequence
from colorsys import rgb_to_hsv
from math import cos, dist, radians, sin
from typing import Any

MAX_GREY_SATURATION = 40
MAX_DARK_VALUE = 1
"""A measurement with up to `MAX_GREY_SATURATION` percent of saturation, or up to `MAX_DARK_VALUE` percent of value, is
a grey, if the program distinguishes only ideal colours: full ones, greys, black and white.
"""


def measure_hsv(red: int, green: int, blue: int) -> tuple[int, int, int]:
    """Return hue (degrees), saturation and value (percent) of a measured colour, as the firmware computes them.

    Args:
        red, green, blue: The measured numbers, each from 0 to 1024.
    """
    turn, purity, brightest = rgb_to_hsv(red, green, blue)
    # Rounded first, so that 120 degrees do not become 119.
    hue, saturation = int(round(360 * turn, 6)), int(round(100 * purity, 6))
    value = int(101 * brightest / 1024)
    if hue >= 350:
        hue = (350 + 2 * (hue - 350)) % 360
    elif hue < 40:
        hue += 10
    elif hue < 60:
        hue = 50 + (hue - 40) // 2
    return hue, saturation * (200 - saturation) // 100, value * (300 - value) // 200


def find_nearest(measured: tuple[int, int, int], colors: Sequence[Any]) -> Any:
    """Return the colour in `colors` that is nearest to a measured hue (degrees), saturation and value (percent)."""
    hue, saturation, value = measured
    if any((color.s, color.v) != (100, 100) and (color.h, color.s) != (0, 0) for color in colors):
        place = _find_place(measured)
        return min(colors, key=lambda color: dist(place, _find_place((*color,))))
    is_grey = saturation <= MAX_GREY_SATURATION or value <= MAX_DARK_VALUE
    alike = [color for color in colors if (color.s == 0) == is_grey] or colors
    if alike[0].s == 0:
        return min(alike, key=lambda color: abs(color.v - value))
    return min(alike, key=lambda color: abs((color.h - hue + 180) % 360 - 180))


def _find_place(color: tuple[int, int, int]) -> tuple[float, float, float]:
    """Return the three coordinates of a colour in the space in which the firmware compares colours, a double cone.

    `color` is hue, saturation and value.
    """
    hue, saturation, value = color
    chroma = max(0, value) * saturation
    angle = radians(hue)
    return chroma * cos(angle), chroma * sin(angle), (200 - saturation) * value
