"""Units that the names of columns and variables tell by their ends."""

from __future__ import annotations

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


def unit_of(name: str) -> Unit:
    """Return the unit that a name tells; both its texts are empty if it tells none."""
    return next((unit for end, unit in UNITS.items() if name.endswith(end)), _NONE)
