"""What the name of a column says: its type in our own frames, and its unit."""

from __future__ import annotations

import re
from typing import NamedTuple

TIMEDELTA = ("index",)
TEXT = ("variable",)
WHOLE = ("run", "line")
"""Columns of the frames by type; all others are floating-point numbers."""


class Unit(NamedTuple):
    """A unit of measurement in a column's name."""

    sign: str
    """The symbol after a number."""
    words: str
    """The description in files."""


_LEVEL = Unit("", "mean of 0 to 255")
UNITS = {
    "_mm_s": Unit("mm/s", "mm per second"),
    "_rate_dps": Unit("°/s", "degrees per second, clockwise"),
    "_dps": Unit("°/s", "degrees per second"),
    "_mm": Unit("mm", "mm"),
    "_deg": Unit("°", "degrees"),
    "_proximity": Unit("%", "percent of 700 mm"),
    "_pc": Unit("%", "percent"),
    "_ms": Unit("ms", "ms"),
    "_s": Unit("s", "s"),
    "_color": Unit("", "code of the colour, 1 to 7"),
    "_red": _LEVEL,
    "_green": _LEVEL,
    "_blue": _LEVEL,
}
"""Every unit by the suffix of a name; the first match counts."""

_NONE = Unit("", "")

MAX_LEVEL = 255.0
"""Maximum of a light reading, in percent or on the scale 0 to 255."""

_LIGHT = re.compile(
    r"colou?r|light|reflect|ambient|bright|intensity|(?:^|[\W_])(?:red|green|blue|gr[ae]y)",
    re.IGNORECASE,
)
_LEVEL_NAME = re.compile(
    r"reflect|ambient|bright|intensity|%|_pc$|percent|_(?:red|green|blue)$", re.IGNORECASE
)
_PERCENT = re.compile(r"(?:%|_pc|percent|_proximity)$", re.IGNORECASE)


_OTHER = re.compile(
    r"gyro|angle|heading|yaw|pitch|roll|dist|ultra|sonic|range|proximity|speed|veloc|rate|accel|pos|batt|volt|curr"
    r"|temp|press|torque|power|rpm|count|step|error|time|duty|force|weight|touch|(?:^|_)[xyz](?:_mm)?$"
    r"|[(\[](?!%|lx|lux)[^)\]]+[)\]]$",
    re.IGNORECASE,
)
"""Names of variables that are no light, or have a unit that light has not."""


def drop_run(name: str) -> str:
    """Return the name of a variable without the number of its run, which follows ` #` in a log of several runs."""
    return name.partition(" #")[0]


def names_level(name: str) -> bool:
    """Return whether the name of a variable says that it is a level of light, and not the code of a colour."""
    return bool(_LEVEL_NAME.search(drop_run(name)))


def can_be_light(name: str) -> bool:
    """Return whether a variable may be the reading of a colour sensor, as its name does not say otherwise."""
    name = drop_run(name)
    return bool(_LIGHT.search(name)) or not (
        _OTHER.search(name) or parse_unit(name).sign not in ("", "%")
    )


def begins_at_zero(name: str, low: float, high: float) -> bool:
    """Return whether the scale of a variable begins at 0, as for readings of light and percentages.

    Args:
        name: Name of the variable; the result is only True if the name says that it is light or a percentage.
        low, high: Minimum and maximum of its values; the result is only True if they are within 0 to 255.
    """
    name = drop_run(name)
    return 0 <= low and high <= MAX_LEVEL and bool(_LIGHT.search(name) or _PERCENT.search(name))


def parse_unit(name: str) -> Unit:
    """Return the unit in the suffix of a column's name; both of its texts are empty if there is none."""
    return next((unit for end, unit in UNITS.items() if name.endswith(end)), _NONE)
