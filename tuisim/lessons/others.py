"""The other worlds of a step in a lesson's file: tables with keys of a world, `where`, and perhaps goals."""

from __future__ import annotations

from pathlib import Path

from tuisim.config import files
from tuisim.config.files import Location
from tuisim.config.worlds import world_from_table
from tuisim.goals.files import goals_from_list
from tuisim.lessons.spec import MAX_OTHERS, OtherWorld

_OWN_KEYS = ("where", "goals", "goal")
_WORLD_KEYS = ("background", "start", "robot", "noise", "drift", "obstacles", "obstacle")


def others_of(data: object, goals: tuple[str, ...], at: Location, path: Path) -> tuple[OtherWorld, ...]:
    """Return the other worlds of a step.

    Args:
        data: The list of tables.
        goals: Names of the goals of the step, which count where a table names none and has none of its own.
        at: The place of the list in the file.
        path: The lesson's file, for the files that a world names.

    Raises:
        ConfigError: one is wrong; the error names its key.
    """
    others: list[OtherWorld] = []
    for entry, place in files.entries(data, at, MAX_OTHERS, "other worlds"):
        other = _other(entry, goals, place, path)
        if any(other.where == one.where for one in others):
            raise place.at("where").wrong(f"there are two {other.where!r}", "say what is other in each")
        others.append(other)
    return tuple(others)


def _other(entry: object, goals: tuple[str, ...], at: Location, path: Path) -> OtherWorld:
    found = files.table(entry, at, (*_OWN_KEYS, *_WORLD_KEYS))
    where = files.convert(files.required(found, "where", at), str, at.at("where"))
    own = goals_from_list(found["goal"], at.at("goal"), path.parent) if "goal" in found else ()
    named = files.convert(found.get("goals", []), tuple[str, ...], at.at("goals"))
    wanted = (*named, *(goal.name for goal in own)) or goals
    world = world_from_table({key: value for key, value in found.items() if key in _WORLD_KEYS}, path)
    if not world.settings:
        raise at.wrong("is the lesson's world", f"one of {', '.join(_WORLD_KEYS)}")
    return OtherWorld(where, world.settings, wanted, own)
