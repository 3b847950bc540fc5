"""Profiles by name or from a TOML file, which needs only the keys that differ from its `base`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from tuisim.config.options import nearest
from tuisim.config.reader import Section, means_file, name_of, read_file
from tuisim.config.toml_writer import Scalar, toml_lines
from tuisim.core.profile import EARLIER_KEYS, MS, PROFILES, MotorLaw, ProfileSpec, law_of_earlier
from tuisim.errors import ProfileError

DEFAULT_PROFILE = "robolab"
MAX_COST_MS = 60_000.0

_NS, _MS = "_ns", "_ms"
_RANGES: dict[str, tuple[float, float]] = {
    "tick_hz": (1, 1000),
    "max_speed_dps": (1, 100_000),
    "reflected_max": (1, 1000),
    "ultrasonic_period_ticks": (1, 1000),
}
"""Ranges of numbers; all others are from 0 to a million."""
_ANY = (0.0, 1e6)

_OLD = "measured on the old simulator"
_NEW = "choice of this project"

SOURCES: Mapping[str, str] = {
    "tick_hz": f"{_NEW}: 100; {_OLD}: 30",
    "color_read_ns": f"{_OLD}: it waits before it takes the value",
    "color_code_read_ns": f"{_OLD}: it waits twice; ev3: a reading like any other",
    "ultrasonic_read_ns": f"{_OLD}: it waits before it takes the value",
    "gyro_read_ns": f"{_OLD}: it waits twice; ev3: a reading like any other",
    "attribute_read_ns": f"{_NEW}, so that polling takes time; {_OLD}: nothing",
    "clock_read_ns": f"{_NEW}, so that loops on the clock end; {_OLD}: nothing",
    "display_update_ns": f"{_NEW}, an estimate: 130 steps per pixel at the brick's 300 MHz; the old simulator has none",
    "motor_law": f"brick: moves end at their target, as with the EV3 motor driver; nbev3devsim: {_OLD}",
    "max_speed_dps": "EV3 motor driver table: large motor without a load",
    "reflected_max": "ev3dev2 library: 100; the course and the old simulator: 255",
    "ambient_percent": f"{_NEW}: a sensor close to the mat is in its own shadow; {_OLD}: always 0",
    "halfway_heading": f"{_NEW}, so that arcs are round; {_OLD}: the heading before the turn",
    "ultrasonic_period_ticks": _OLD,
    "solid": "obstacles are solid on a real field, but not in the old simulator",
    "mend_library": f"{_NEW}: see README; ev3: the library as it is",
    "starts_in_own_folder": "ev3dev starts a program in its own folder; a course starts it in the notebook's",
}
"""The source of each key's numbers."""


def load_profile(word: str, key: str = "") -> ProfileSpec:
    """Return a profile by name, or from a TOML file.

    Args:
        word: The name or the path.
        key: The switch to name in errors about an unknown name, such as `--profile`.

    Raises:
        ProfileError: the name is unknown, or the file is wrong.
    """
    if word in PROFILES:
        return PROFILES[word]
    if not means_file(word):
        hint = f"{nearest(word, PROFILES)}; or a .toml file"
        raise ProfileError(f"no such profile {word!r}", hint, key=key)
    path = Path(word).expanduser()
    if path.suffix.lower() != ".toml":
        raise ProfileError("is not a .toml file", "the suffix selects the format", file=str(path))
    return profile_from_table(Section(read_file(path, ProfileError), str(path), ProfileError), name_of(path))


def profile_from_table(table: Section, name: str) -> ProfileSpec:
    """Return the profile in a table. Costs may be given in ms instead of ns.

    Args:
        table: The table.
        name: The profile's name, unless the table has one.

    Raises:
        ProfileError: a key or a value is wrong.
    """
    kinds = {field.name: str(field.type) for field in fields(ProfileSpec)}
    in_ms = {_in_ms(key): key for key in kinds if key.endswith(_NS)}
    in_ns = frozenset(in_ms.values())
    earlier = EARLIER_KEYS | {_in_ms(key) for key in EARLIER_KEYS if key.endswith(_NS)}
    table.allow(("base", *(key for key in kinds if key not in in_ns), *in_ms), unlisted=in_ns | earlier)
    base = PROFILES[table.one_of("base", PROFILES) if "base" in table else DEFAULT_PROFILE]
    found: dict[str, Any] = {"name": name}
    law = law_of_earlier({key: table.flag(key) for key in ("halve_position_moves",) if key in table})
    if law is not None:
        found["motor_law"] = law
    for key in table:
        if key in earlier:
            continue
        if key in in_ms:
            if in_ms[key] in table:
                raise table.wrong(key, f"is given together with {in_ms[key]}", "give only one of them")
            found[in_ms[key]] = round(table.number(key, 0, MAX_COST_MS) * MS)
        elif key != "base":
            found[key] = _value(table, key, kinds[key])
    if found["name"] in PROFILES:
        raise table.wrong("name", f"{found['name']!r} is the name of a built-in profile", "choose another name")
    return replace(base, **found)


def _value(table: Section, key: str, kind: str) -> object:
    low, high = _RANGES.get(key, (0.0, MAX_COST_MS * MS) if key.endswith(_NS) else _ANY)
    match kind:
        case "MotorLaw":
            return MotorLaw(table.one_of(key, [law.value for law in MotorLaw]))
        case "bool":
            return table.flag(key)
        case "int":
            return table.whole(key, int(low), int(high))
        case "float":
            return table.number(key, low, high)
        case _:
            return table.text(key)


def _in_ms(key: str) -> str:
    return key.removesuffix(_NS) + _MS


def profile_lines(spec: ProfileSpec, parent: str = "") -> list[str]:
    """Return a profile as TOML lines, with every value.

    Args:
        spec: The profile.
        parent: The name of its table; empty for a file of its own.
    """
    values: dict[str, Scalar] = {}
    for field in fields(ProfileSpec):
        value = getattr(spec, field.name)
        cost_ms = value / MS if field.name.endswith(_NS) else 0.0
        if cost_ms and round(cost_ms * MS) == value:
            values[_in_ms(field.name)] = cost_ms
        else:
            values[field.name] = value
    return [*([f"[{parent}]"] if parent else []), *toml_lines(values)]
