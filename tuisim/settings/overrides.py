"""Single keys of world and robot files, such as `noise.motor` or `robot.wheel_diameter_mm`, as settings of a run."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.base.errors import ProfileError, RobotError
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.values import NamedPart
from tuisim.engine.files import Location, read_part
from tuisim.settings.options import RUN_VALUES, Settings
from tuisim.settings.profiles import load_profile, profile_from_table
from tuisim.settings.robots import RobotChoice, choose_robot, robot_from_table
from tuisim.settings.worlds import world_from_table

_NOT_VARIED = (
    "world",
    "title",
    "goal",
    "program",
    "autorun",
    "rays",
    "panels",
    "hidden_panels",
    "obstacle",
    "remote",
    "press",
    "inputs",
)
"""Keys of a world file that do not affect a run, or that have no single value."""
_PARTS = {path: one.default for path, one in RUN_VALUES.items() if isinstance(one.value, NamedPart)}
"""The default of each value that has others inside it: a key of one leaves the others as they are."""


def settings_of_keys(values: Mapping[str, Any], chosen: Settings, path: Path) -> dict[str, Any]:
    """Return the settings that some keys of a world file set, by path.

    Args:
        values: By key; tables are written with dots. `arguments` is a text, split into words as a shell does.
        chosen: The settings to be changed: a key of a robot or profile leaves the other keys as they are.
        path: The file to blame in errors; paths are relative to its folder.

    Raises:
        ConfigError: a key is unknown, or a value is wrong.
    """
    at = Location(str(path))
    table = _nested(values, at)
    for key in _NOT_VARIED:
        if key in table:
            raise at.at(key).wrong("cannot be varied", "any other key of a world file can")
    if "arguments" in table:
        table["arguments"] = _words(table["arguments"], at.at("arguments"))
    changed = {
        key: table.pop(key) for key in ("robot", "profile") if isinstance(table.get(key), dict)
    }
    named = {key: table.pop(f"{key}=") for key in ("robot", "profile") if f"{key}=" in table}
    parts = {
        key: table.pop(key) for key, base in _PARTS.items() if isinstance(table.get(key), dict)
    }
    world = world_from_table(table | named, path, chosen["mats"], changes=True)
    found = dict(world.settings)
    for key, inside in parts.items():
        found[key] = read_part(inside, chosen[key] or _PARTS[key], at.at(key))
    if "robot" in changed:
        word = found.get("robot", chosen["robot"])
        found["robot"] = _changed_robot(changed["robot"], word, at.at("robot", RobotError))
    if "profile" in changed:
        word = found.get("profile", chosen["profile"])
        found["profile"] = _changed_profile(
            changed["profile"], word, at.at("profile", ProfileError)
        )
    return found


def _nested(values: Mapping[str, Any], at: Location) -> dict[str, Any]:
    """Return keys with dots as nested tables; a robot or profile that is also named has its name under `robot=`."""
    table: dict[str, Any] = {}
    for key, value in values.items():
        *outer, last = key.split(".")
        if key in ("robot", "profile") and any(other.startswith(f"{key}.") for other in values):
            last = f"{key}="
        inside = table
        for part in outer:
            inside = inside.setdefault(part, {})
            if not isinstance(inside, dict):
                raise at.at(key).wrong(f"is inside {part}, which has a value")
        if last in inside:
            raise at.at(key).wrong(
                "cannot be combined with keys inside it", "give only one of them"
            )
        inside[last] = value
    return table


def _words(value: object, at: Location) -> list[str]:
    try:
        return shlex.split(value if isinstance(value, str) else str(value))
    except ValueError as error:
        raise at.wrong(f"cannot be split into words: {error}") from None


def _changed_robot(table: object, chosen: str | RobotChoice, at: Location) -> RobotChoice:
    base = chosen if isinstance(chosen, RobotChoice) else choose_robot(chosen, "-r")
    found = robot_from_table(table, base.spec.name, at, base.spec)
    return replace(base, spec=found.spec, own_places=base.own_places or found.own_places)


def _changed_profile(table: object, chosen: str | ProfileSpec, at: Location) -> ProfileSpec:
    base = chosen if isinstance(chosen, ProfileSpec) else load_profile(chosen, "--profile")
    return profile_from_table(table, f"{base.name}, changed", at, base)
