"""A robot's further parts as tables of a file: motors that do not drive it, more sensors."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, TypeVar

from tuisim.config.reading import Section
from tuisim.core.parts import MOTOR_KINDS, InfraredSpec, MotorSpec, TouchSpec
from tuisim.core.spec import OUTPUT_PORTS, RobotSpec, UltrasonicSpec
from tuisim.errors import RobotError

Part = TypeVar("Part", UltrasonicSpec, TouchSpec, InfraredSpec)

MAX_RAYS = 100
_SENSOR_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
_ULTRASONIC_NUMBERS = ("x_mm", "y_mm", "angle_deg", "max_range_mm", "noise_mm")
ULTRASONIC_KEYS = ("port", *_ULTRASONIC_NUMBERS, "ray_angles_deg")
TOUCH_KEYS = ("port", "x_mm", "y_mm", "width_mm")
INFRARED_KEYS = ("port", "x_mm", "y_mm", "angle_deg")
PART_KEYS = ("motors", "ultrasonics", "touch_sensors", "infrared")
"""Keys of a robot's file for what it has besides the usual parts."""


def sensor_name(table: Section, name: str) -> str:
    """Return a key as the name of a sensor, or raise."""
    if not _SENSOR_NAME.fullmatch(name):
        raise table.wrong(name, "is no name for a sensor", "letters, digits and _, a letter first, at most 31")
    return name


def ultrasonic(table: Section, base: UltrasonicSpec) -> UltrasonicSpec:
    """Return an ultrasonic sensor; what the table leaves out is as in `base`."""
    table.allow(ULTRASONIC_KEYS)
    found: dict[str, Any] = {key: table.number(key) for key in _ULTRASONIC_NUMBERS if key in table}
    if "port" in table:
        found["port"] = table.text("port")
    if "ray_angles_deg" in table:
        angles = table.items("ray_angles_deg")
        if not 1 <= len(angles) <= MAX_RAYS:
            raise table.wrong("ray_angles_deg", f"must be 1 to {MAX_RAYS} angles, got {len(angles)}")
        numbered = Section({f"ray_angles_deg[{at}]": angle for at, angle in enumerate(angles, start=1)},
                           table.file, RobotError, table.key)  # fmt: skip
        found["ray_angles_deg"] = tuple(numbered.number(key, -360, 360) for key in numbered)
    return replace(base, **found)


def parts_from_table(table: Section, base: RobotSpec) -> dict[str, Any]:
    """Return the further parts that a robot's table names, by field of `RobotSpec`; others stay as in `base`.

    Raises:
        RobotError: a key or a value is wrong.
    """
    found: dict[str, Any] = {}
    if "motors" in table:
        found["extra_motors"] = _motors(table.section("motors"), base.extra_motors)
    if "ultrasonics" in table:
        section = table.section("ultrasonics")
        found["extra_ultrasonics"] = _named(
            section, base.extra_ultrasonics, ultrasonic, lambda name: UltrasonicSpec(name=name)
        )
    if "touch_sensors" in table:
        section = table.section("touch_sensors")
        found["touch_sensors"] = _named(section, base.touch_sensors, _touch, lambda name: TouchSpec(name=name))
    if "infrared" in table:
        on = table.raw("infrared") is not False
        infrared = _infrared(table.section("infrared"), base.infrared or InfraredSpec()) if on else None
        found["infrared"] = infrared
    return found


def _motors(table: Section, base: Iterable[MotorSpec]) -> tuple[MotorSpec, ...]:
    """Kinds by port; `false` takes the motor of the base away."""
    kinds = {motor.port: motor.kind for motor in base}
    table.allow(OUTPUT_PORTS)
    for port in table:
        if table.raw(port) is False:
            kinds.pop(port, None)
        else:
            kinds[port] = table.one_of(port, MOTOR_KINDS)
    return tuple(MotorSpec(port, kind) for port, kind in kinds.items())


def _named(
    table: Section, base: tuple[Part, ...], read: Callable[[Section, Part], Part], fresh: Callable[[str], Part]
) -> tuple[Part, ...]:
    """The sensors of the base as the table changes them, and the table's own."""
    found = {sensor.name: sensor for sensor in base}
    for name in table:
        if table.raw(name) is False:
            found.pop(name, None)
            continue
        sensor_name(table, name)
        section = table.section(name)
        if name not in found:
            # A further sensor has no port that is its own by custom.
            section.raw("port")
        with table.telling(table.key.rpartition(".")[0]):
            found[name] = read(section, found.get(name) or fresh(name))
    return tuple(found.values())


def _touch(table: Section, base: TouchSpec) -> TouchSpec:
    return _with_numbers(table, base, TOUCH_KEYS)


def _infrared(table: Section, base: InfraredSpec) -> InfraredSpec:
    with table.telling(table.key.rpartition(".")[0]):
        return _with_numbers(table, base, INFRARED_KEYS)


def _with_numbers(table: Section, base: Part, keys: tuple[str, ...]) -> Part:
    table.allow(keys)
    found: dict[str, Any] = {key: table.number(key) for key in keys if key != "port" and key in table}
    if "port" in table:
        found["port"] = table.text("port")
    return replace(base, **found)
