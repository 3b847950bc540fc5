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
from tuisim.settings.profiles import load_profile, parse_profile
from tuisim.settings.robots import RobotChoice
from tuisim.settings.worlds import parse_world

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
"""The default of each value with inner values, of which a key changes only one."""


def resolve_keys(values: Mapping[str, Any], chosen: Settings, path: Path) -> dict[str, Any]:
    """Return the settings, by path, for some keys of a world file.

    Args:
        values: The values by key, with dots for tables, such as `noise.light`. The value of `arguments` is a text,
            which is split into words as in a shell.
        chosen: The settings before the change. A key such as `robot.weight` changes only this value of their robot.
        path: The file for errors; paths are relative to its folder.

    Raises:
        ConfigError: a key is unknown, or a value is wrong.
    """
    location = Location(str(path))
    table = _nest(values, location)
    for key in _NOT_VARIED:
        if key in table:
            raise location.at(key).wrong("cannot be varied", "any other key of a world file can")
    if "arguments" in table:
        table["arguments"] = _split_words(table["arguments"], location.at("arguments"))
    changed = {
        key: table.pop(key) for key in ("robot", "profile") if isinstance(table.get(key), dict)
    }
    named = {key: table.pop(f"{key}=") for key in ("robot", "profile") if f"{key}=" in table}
    parts = {
        key: table.pop(key) for key, base in _PARTS.items() if isinstance(table.get(key), dict)
    }
    world = parse_world(table | named, path, chosen["mats"], changes=True)
    settings = dict(world.settings)
    for key, inside in parts.items():
        settings[key] = read_part(inside, chosen[key] or _PARTS[key], location.at(key))
    if "robot" in changed:
        word = settings.get("robot", chosen["robot"])
        settings["robot"] = _change_robot(changed["robot"], word, location.at("robot", RobotError))
    if "profile" in changed:
        word = settings.get("profile", chosen["profile"])
        settings["profile"] = _change_profile(
            changed["profile"], word, location.at("profile", ProfileError)
        )
    return settings


def _nest(values: Mapping[str, Any], location: Location) -> dict[str, Any]:
    """Return keys with dots, such as `noise.light`, as nested tables.

    If both `robot` and keys such as `robot.name` are given, the value of `robot` is under the key `robot=`. The same is
    true of `profile`.

    Args:
        values: The values, by key with dots.
        location: The file, for errors.

    Raises:
        ConfigError: a key is inside another one that has a value.
    """
    table: dict[str, Any] = {}
    for key, value in values.items():
        *outer, last = key.split(".")
        if key in ("robot", "profile") and any(other.startswith(f"{key}.") for other in values):
            last = f"{key}="
        inside = table
        for part in outer:
            inside = inside.setdefault(part, {})
            if not isinstance(inside, dict):
                raise location.at(key).wrong(f"is inside {part}, which has a value")
        if last in inside:
            raise location.at(key).wrong(
                "is given as a whole, and so are keys inside it",
                "give the whole or the keys, not both",
            )
        inside[last] = value
    return table


def _split_words(value: object, location: Location) -> list[str]:
    try:
        return shlex.split(value if isinstance(value, str) else str(value))
    except ValueError as error:
        raise location.wrong(f"cannot be split into words: {error}") from None


def _change_robot(table: object, chosen: str | RobotChoice, location: Location) -> RobotChoice:
    base = RobotChoice.load(chosen, "-r")
    robot = RobotChoice.parse(table, base.spec.name, location, base.spec)
    return replace(base, spec=robot.spec, own_places=base.own_places or robot.own_places)


def _change_profile(table: object, chosen: str | ProfileSpec, location: Location) -> ProfileSpec:
    base = chosen if isinstance(chosen, ProfileSpec) else load_profile(chosen, "--profile")
    return parse_profile(table, f"{base.name}, changed", location, base)
