"""Robots from the JSON files of the course's browser simulator.

The keys are translated to those of a robot's TOML table, so both formats are checked by the same rules.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tuisim.config.options import RobotChoice
from tuisim.config.reader import Section, shown, with_location
from tuisim.config.robot_table import robot_from_table
from tuisim.core.spec import MAX_LIGHT_NOISE, MAX_MOTOR_NOISE
from tuisim.errors import ConfigError

_COLOR_SENSOR = {"x": "x_mm", "y": "y_mm", "diameter": "diameter_mm"}
_PARTS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "pen": ("pen", {"x": "x_mm", "y": "y_mm", "color": "color", "width": "width_mm"}),
    "sensor1": ("color_sensors.left", _COLOR_SENSOR),
    "sensor2": ("color_sensors.right", _COLOR_SENSOR),
    "ultrasonic": ("ultrasonic", {"x": "x_mm", "y": "y_mm", "angle": "angle_deg", "noise": "noise_mm"}),
    "gyro": ("gyro", {}),
}
"""The key of each part in a robot's TOML table, and the names of its keys there."""

_KEYS = {
    "wheeldiameter": "wheel_diameter_mm",
    "wheelSpacing": "wheel_spacing_mm",
    "back": "back_mm",
    "weight": "weight",
}
_WHEEL_NOISE, _SENSOR_NOISE = "wheelNoise", "sensorNoise"
_DEFAULT_NOISE = 1
"""The simulator's default for motor and ultrasonic noise."""

_KEYS_SHOWN = 5

_WITHOUT_EFFECT = ("baseWeight", "width", "height")
"""Keys of saved files that do not affect a run."""


def robot_from_json(table: Section, name: str) -> RobotChoice:
    """Return the robot; missing keys are as in Default_Robot, its noise settings become those of the run.

    A key that the simulator did not know either is ignored, with a note.

    Args:
        table: The object in the file.
        name: The robot's name.

    Raises:
        RobotError: a key or a value is wrong.
    """
    ours: dict[str, Any] = {"color_sensors": {}}
    theirs: dict[str, str] = {}
    unknown: list[str] = []
    for key in table:
        if key in _KEYS:
            if key == "weight" and table.raw(key) in (None, ""):
                # Medium, as without the key.
                continue
            ours[_KEYS[key]] = table.raw(key)
            theirs[_KEYS[key]] = key
        elif key in _PARTS:
            place, keys = _PARTS[key]
            theirs |= {place: key, f"{place}.port": key} | {f"{place}.{to}": f"{key}.{of}" for of, to in keys.items()}
            outer, _, inner = place.rpartition(".")
            part = table.section(key)
            (ours[outer] if outer else ours)[inner] = _part(part, keys)
            unknown += [f"{key}.{name}" for name in part if name not in ("enabled", *keys)]
        elif key not in (_WHEEL_NOISE, _SENSOR_NOISE, *_WITHOUT_EFFECT):
            unknown.append(key)
    motor, light = _noise(table, _WHEEL_NOISE, MAX_MOTOR_NOISE), _noise(table, _SENSOR_NOISE, MAX_LIGHT_NOISE)
    try:
        choice = robot_from_table(table.instead(ours), name)
    except ConfigError as error:
        raise with_location(error, table.file, theirs.get(error.key, error.key)) from None
    notes = (f"{table.file}: ignored unknown keys: {shown_keys(unknown)}",) if unknown else ()
    return replace(choice, motor_noise=_DEFAULT_NOISE if motor is None else motor, light_noise=light, notes=notes)


def _noise(table: Section, key: str, most: int) -> int | None:
    return None if key not in table or table.raw(key) is None else table.whole(key, 0, most)


def shown_keys(keys: Sequence[str]) -> str:
    """Return a short list of keys for a message, whatever their number and length."""
    names = [shown(key)[1:-1] for key in keys[:_KEYS_SHOWN]]
    return ", ".join(names) + (f" and {len(keys) - _KEYS_SHOWN} more" if len(keys) > _KEYS_SHOWN else "")


def _part(part: Section, keys: Mapping[str, str]) -> dict[str, object] | bool:
    """Return a sensor or the pen with the keys of a TOML table; False if it is not enabled."""
    if "pen" != part.key and "enabled" in part and not part.flag("enabled"):
        return False
    found = {keys[key]: part.raw(key) for key in part if key in keys}
    if "noise" in keys and found.get("noise_mm") is None:
        found["noise_mm"] = _DEFAULT_NOISE
    return found
