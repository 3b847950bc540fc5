"""What programs read of sensors and motors: the columns that have it, and in which unit."""

from __future__ import annotations

from collections.abc import Mapping

LIGHT_COLUMNS = ("red_pc", "mean_pc")
RED = ("red_pc", 1.0, "")
_DEGREES = ("deg", 1.0, "°")
_DISTANCE = ("mm", 1.0, " mm")
COLUMNS: Mapping[str, tuple[str, float, str]] = {
    "reflected_light_intensity": RED,
    "reflected_light_intensity_pc": ("red_pc", 1.0, " %"),
    "reflection": ("red_pc", 1.0, " %"),
    "full_reflected_light_intensity": ("mean_pc", 1.0, " %"),
    "color": ("color", 1.0, ""),
    "color_name": ("color", 1.0, ""),
    "angle": _DEGREES,
    "heading": _DEGREES,
    "rate": ("rate_dps", 1.0, "°/s"),
    "distance_centimeters": ("mm", 0.1, " cm"),
    "distance_inches": ("mm", 1 / 25.4, " in"),
    "distance": _DISTANCE,
    "proximity": ("proximity", 1.0, " %"),
}
"""What programs read: the end of its column's name, the factor from the column's unit to theirs, and theirs."""
COLUMNS_BY_MODE: Mapping[str, tuple[str, float, str]] = {
    "COL-REFLECT": RED,
    "COL-COLOR": ("color", 1.0, ""),
    "GYRO-ANG": _DEGREES,
    "US-DIST-CM": _DISTANCE,
    "IR-PROX": ("proximity", 1.0, " %"),
}
"""As `COLUMNS`, for `value()`, by mode."""
TURN_COLUMNS: Mapping[str, tuple[str, float, str]] = {
    "position": _DEGREES,
    "degrees": _DEGREES,
    "angle": _DEGREES,
    "rotations": ("deg", 1 / 360, " rotations"),
}
"""As `COLUMNS`, for the motor of a wheel."""
