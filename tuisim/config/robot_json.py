"""Robots from the JSON that the browser simulator of the course saved.

Its keys are translated, so that one set of rules holds for both formats.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from tuisim.config.reading import Section, relocated
from tuisim.config.robot_table import robot_from_table
from tuisim.core.spec import MAX_MOTOR_NOISE
from tuisim.errors import ConfigError
from tuisim.switches import RobotChoice

_COLOR_SENSOR = {"x": "x_mm", "y": "y_mm", "diameter": "diameter_mm"}
_PLACES: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "pen": ("pen", {"x": "x_mm", "y": "y_mm", "color": "color", "width": "width_mm"}),
    "sensor1": ("color_sensors.left", _COLOR_SENSOR),
    "sensor2": ("color_sensors.right", _COLOR_SENSOR),
    "ultrasonic": ("ultrasonic", {"x": "x_mm", "y": "y_mm", "angle": "angle_deg", "noise": "noise_mm"}),
    "gyro": ("gyro", {}),
}
"""Where a part of the robot stands in our own table, and what its keys are called there."""

_KEYS = {
    "wheeldiameter": "wheel_diameter_mm",
    "wheelSpacing": "wheel_spacing_mm",
    "back": "back_mm",
    "weight": "weight",
}
_WHEEL_NOISE = "wheelNoise"


def robot_from_json(table: Section, name: str) -> RobotChoice:
    """Return the robot; what the table leaves out is as in Default_Robot, its wheel noise goes to the run.

    Args:
        table: The object in the file.
        name: What the robot is called.

    Raises:
        RobotError: a key or a value is wrong.
    """
    table.allow((*_KEYS, _WHEEL_NOISE, *_PLACES))
    ours: dict[str, Any] = {"color_sensors": {}}
    theirs: dict[str, str] = {}
    for key in table:
        if key in _KEYS:
            ours[_KEYS[key]] = table.raw(key)
            theirs[_KEYS[key]] = key
        elif key in _PLACES:
            place, keys = _PLACES[key]
            theirs |= {place: key, f"{place}.port": key} | {f"{place}.{to}": f"{key}.{of}" for of, to in keys.items()}
            outer, _, inner = place.rpartition(".")
            (ours[outer] if outer else ours)[inner] = _part(table.section(key), keys, key != "pen")
    noise = table.whole(_WHEEL_NOISE, 0, MAX_MOTOR_NOISE) if _WHEEL_NOISE in table else None
    try:
        choice = robot_from_table(table.instead(ours), name)
    except ConfigError as error:
        raise relocated(error, table.file, theirs.get(error.key, error.key)) from None
    return replace(choice, motor_noise=noise)


def _part(part: Section, keys: Mapping[str, str], may_be_off: bool) -> dict[str, object] | bool:
    """A sensor or the pen in our own keys; False for one that is not enabled."""
    part.allow(("enabled", *keys) if may_be_off else keys)
    if "enabled" in part and not part.flag("enabled"):
        return False
    return {keys[key]: part.raw(key) for key in part if key != "enabled"}
