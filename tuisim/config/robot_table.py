"""A robot as a table of keys and values, in a file of its own or inside a world.

A table may say only what differs from its `base`. Sensors that the base has and the table does not name
stay; `false` in the place of a sensor takes it away.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from tuisim.config.presets import ROBOTS
from tuisim.config.reading import MAX_NAME, Section
from tuisim.config.robot_parts import PART_KEYS, parts_from_table
from tuisim.core.spec import ROBOT_WEIGHTS, PenSpec
from tuisim.switches import RobotChoice, pen_color

DEFAULT_ROBOT = "Default_Robot"
LENGTH_KEYS = ("wheel_diameter_mm", "wheel_spacing_mm", "wheel_width_mm", "back_mm")
PORT_KEYS = ("left_port", "right_port")
_TOP = ("base", "name", *LENGTH_KEYS, "weight", *PORT_KEYS, *PART_KEYS, "pen")
PEN_KEYS = ("x_mm", "y_mm", "color", "width_mm", "down")


def robot_from_table(table: Section, name: str) -> RobotChoice:
    """Return the robot that a table describes.

    Args:
        table: The table.
        name: What the robot is called if the table does not say it.

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
    """Return the name of something, or raise."""
    name = table.text(key)
    if len(name) > MAX_NAME:
        raise table.wrong(key, f"must be at most {MAX_NAME} characters, got {len(name)}")
    return name


def weight(table: Section, key: str) -> float:
    """Return a weight, given by its name or as a number."""
    value = table.raw(key)
    if isinstance(value, str):
        return ROBOT_WEIGHTS[table.one_of(key, ROBOT_WEIGHTS)]
    return table.number(key)


def pen(table: Section, base: PenSpec, keys: Iterable[str] = PEN_KEYS) -> PenSpec:
    """Return a pen; what the table leaves out is as in `base`."""
    table.allow(keys)
    found: dict[str, Any] = {key: table.number(key) for key in ("x_mm", "y_mm", "width_mm") if key in table}
    if "color" in table:
        found["color"] = table.converted("color", pen_color)
    if "down" in table:
        found["down"] = table.flag("down")
    with table.telling(table.key.removesuffix("pen").removesuffix(".")):
        return replace(base, **found)
