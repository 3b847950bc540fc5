"""Reads a robot, its sensors and extra motors from a table of a robot or world file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields, replace
from typing import Any

from tuisim.config.options import RobotChoice, pen_color
from tuisim.config.presets import ROBOTS
from tuisim.config.reader import MAX_NAME, Section
from tuisim.core.parts import MOTOR_KINDS, MotorSpec
from tuisim.core.spec import MOUNTS, OUTPUT_PORTS, ROBOT_WEIGHTS, Mount, PenSpec, RobotSpec, SensorSpec
from tuisim.errors import RobotError

MAX_WHOLE = 10**9
MAX_ITEMS = 1000
SENSOR_KEYS = tuple(mount.key for mount in MOUNTS)
PART_KEYS = ("motors", *SENSOR_KEYS)
"""Keys of a robot file for the mounted parts, except wheels and pen."""
_SENSOR_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")


def keys_of(spec: type) -> tuple[str, ...]:
    """Return the keys of a sensor in a file: every field of its class except the name."""
    return tuple(field.name for field in fields(spec) if field.name != "name")


def parts_from_table(table: Section, base: RobotSpec) -> dict[str, Any]:
    """Return the parts in a robot's table, keyed by field of `RobotSpec`; others stay as in `base`.

    Raises:
        RobotError: a key or a value is wrong.
    """
    found: dict[str, Any] = {}
    if "motors" in table:
        wheels = {table.text(key) if key in table else getattr(base, key): key for key in ("left_port", "right_port")}
        found |= _motors(table.section("motors"), base.extra_motors, wheels)
    for mount in MOUNTS:
        if mount.key in table:
            found[mount.field] = _named(table, mount, base) if mount.many else _single(table, mount, base)
    return found


def _motors(table: Section, base: Iterable[MotorSpec], wheels: Mapping[str, str]) -> dict[str, Any]:
    """Return motor kinds by port, as fields of `RobotSpec`; `false` removes a motor of the base.

    Args:
        table: The table.
        base: The extra motors of the base.
        wheels: `left_port` and `right_port`, keyed by the port that they name.
    """
    kinds = {motor.port: motor.kind for motor in base}
    found: dict[str, Any] = {}
    table.allow(OUTPUT_PORTS)
    for port in table:
        if port in wheels and table.raw(port) is False:
            raise table.wrong(port, "drives a wheel", f"it cannot be removed; {wheels[port]} sets its port")
        if port in wheels:
            found[wheels[port].replace("port", "motor")] = table.one_of(port, MOTOR_KINDS)
        elif table.raw(port) is False:
            kinds.pop(port, None)
        else:
            kinds[port] = table.one_of(port, MOTOR_KINDS)
    return {**found, "extra_motors": tuple(MotorSpec(port, kind) for port, kind in kinds.items())}


def _single(table: Section, mount: Mount, base: RobotSpec) -> SensorSpec | None:
    """Return the only sensor of its kind; None for `false`, which removes it."""
    if table.raw(mount.key) is False:
        return None
    with table.telling():
        sensor: SensorSpec = _sensor(table.section(mount.key), getattr(base, mount.field) or mount.spec())
    return sensor


def _named(robot: Section, mount: Mount, base: RobotSpec) -> tuple[SensorSpec, ...]:
    """Return the base's sensors with the table's changes, and those that the table adds; `false` removes one."""
    table = robot.section(mount.key)
    found = {sensor.name: sensor for sensor in base.sensors_in(mount)}
    for name in table:
        if table.raw(name) is False:
            found.pop(name, None)
            continue
        if not _SENSOR_NAME.fullmatch(name):
            raise table.wrong(name, "is not a valid sensor name", "letters, digits and _, a letter first, at most 31")
        section = table.section(name)
        with table.telling():
            found[name] = _sensor(section, found[name]) if name in found else _new_sensor(section, mount, name)
    # A file that names all of them also sets their order.
    order = [name for name in table if name in found]
    return tuple(found[name] for name in (order if len(order) == len(found) else found))


def _new_sensor(table: Section, mount: Mount, name: str) -> Any:
    """Return a sensor that the base does not have; it has no default port, so the table must have one."""
    table.allow(keys_of(mount.spec))
    for field in fields(mount.spec):
        if field.name == "port" or (field.default is MISSING and field.name != "name"):
            table.raw(field.name)
    return mount.spec(name=name, **_values(table, mount.spec))


def _sensor(table: Section, base: Any) -> Any:
    """Return a sensor from a table; missing keys are as in `base`."""
    table.allow(keys_of(type(base)))
    return replace(base, **_values(table, type(base)))


def _values(table: Section, spec: type) -> dict[str, Any]:
    """Return the values of a sensor's table, by field."""
    return {field.name: _value(table, field.name, field.type) for field in fields(spec) if field.name in table}


def _value(table: Section, key: str, kind: object) -> Any:
    """Return a value converted to the declared type of its field."""
    match kind:
        case "bool":
            return table.flag(key)
        case "str":
            return table.text(key)
        case "int":
            return table.whole(key, -MAX_WHOLE, MAX_WHOLE)
        case "float":
            return table.number(key)
    items = table.items(key)
    if len(items) > MAX_ITEMS:
        raise table.wrong(key, f"must be at most {MAX_ITEMS} numbers, got {len(items)}")
    numbered = Section({f"{key}[{at}]": item for at, item in enumerate(items, 1)}, table.file, RobotError, table.key)
    return tuple(numbered.number(each) for each in numbered)


DEFAULT_ROBOT = "Default_Robot"
LENGTH_KEYS = ("wheel_diameter_mm", "wheel_spacing_mm", "wheel_width_mm", "back_mm")
PORT_KEYS = ("left_port", "right_port")
_TOP = ("base", "name", *LENGTH_KEYS, "weight", *PORT_KEYS, *PART_KEYS, "pen")
PEN_KEYS = ("x_mm", "y_mm", "color", "width_mm", "down")


def robot_from_table(table: Section, name: str) -> RobotChoice:
    """Return the robot in a table.

    Args:
        table: The table.
        name: The robot's name, unless the table has one.

    Raises:
        RobotError: a key or a value is wrong.
    """
    table.allow(_TOP)
    base = ROBOTS[table.one_of("base", ROBOTS)] if "base" in table else ROBOTS[DEFAULT_ROBOT]
    found: dict[str, Any] = {"name": robot_name(table, "name") if "name" in table else name}
    found |= {key: table.number(key) for key in LENGTH_KEYS if key in table}
    found |= {key: table.text(key) for key in PORT_KEYS if key in table}
    if "weight" in table:
        found["weight"] = weight(table, "weight")
    own_places = False
    if "color_sensors" in table:
        sensors = table.section("color_sensors")
        own_places = any(sensors.raw(key) is not False and "x_mm" in sensors.section(key) for key in sensors)
    if "pen" in table:
        found["pen"] = pen(table.section("pen"), base.pen)
    found |= parts_from_table(table, base)
    with table.telling():
        return RobotChoice(replace(base, **found), own_places=own_places)


def robot_name(table: Section, key: str) -> str:
    """Return a robot's name; raise if it is too long."""
    name = table.text(key)
    if len(name) > MAX_NAME:
        raise table.wrong(key, f"must be at most {MAX_NAME} characters, got {len(name)}")
    return name


def weight(table: Section, key: str) -> float:
    """Return a weight that is given by name or as a number."""
    value = table.raw(key)
    if isinstance(value, str):
        return ROBOT_WEIGHTS[table.one_of(key, ROBOT_WEIGHTS)]
    return table.number(key)


def pen(table: Section, base: PenSpec, keys: Iterable[str] = PEN_KEYS) -> PenSpec:
    """Return a pen; missing keys are as in `base`."""
    table.allow(keys)
    found: dict[str, Any] = {key: table.number(key) for key in ("x_mm", "y_mm", "width_mm") if key in table}
    if "color" in table:
        found["color"] = table.converted("color", pen_color)
    if "down" in table:
        found["down"] = table.flag("down")
    with table.telling(table.key.removesuffix("pen").removesuffix(".")):
        return replace(base, **found)
