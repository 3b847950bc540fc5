"""Units that the names of columns and variables tell by their ends."""

from __future__ import annotations

import re
from typing import NamedTuple


class Unit(NamedTuple):
    """One unit."""

    sign: str
    """As it stands behind a number."""
    words: str
    """As a file says it."""


_LEVEL = Unit("", "mean of 0 to 255")
UNITS = {
    "_rate_dps": Unit("°/s", "degrees per second, clockwise"),
    "_dps": Unit("°/s", "degrees per second"),
    "_mm": Unit("mm", "mm"),
    "_deg": Unit("°", "degrees"),
    "_proximity": Unit("%", "percent of 700 mm"),
    "_ms": Unit("ms", "ms"),
    "_s": Unit("s", "s"),
    "_red": _LEVEL,
    "_green": _LEVEL,
    "_blue": _LEVEL,
}
"""Every unit by the end of a name; of two ends that fit, the first counts."""

_NONE = Unit("", "")

SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
"""Units that a column of times may have, in seconds."""


MAX_LEVEL = 255.0
"""Most that a reading of light comes to, in percent or from 0 to 255."""

_LIGHT = re.compile(
    r"colou?r|light|reflect|ambient|bright|intensity|(?:^|[\W_])(?:red|green|blue|gr[ae]y)", re.IGNORECASE
)
_PERCENT = re.compile(r"(?:%|_pc|percent|_proximity)$", re.IGNORECASE)


def begins_at_zero(name: str, low: float, high: float) -> bool:
    """Return whether values are those of a reading whose range is known to begin at 0.

    Args:
        name: Of a variable, which tells a reading of light or a percentage.
        low, high: The least and the greatest value: outside of 0 to 255 it is something else.
    """
    name = name.partition(" #")[0]
    return 0 <= low and high <= MAX_LEVEL and bool(_LIGHT.search(name) or _PERCENT.search(name))


def unit_of(name: str) -> Unit:
    """Return the unit that a name tells; both its texts are empty if it tells none."""
    return next((unit for end, unit in UNITS.items() if name.endswith(end)), _NONE)
