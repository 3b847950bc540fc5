"""Profiles by name or from a TOML file, which needs only the keys that differ from its `base`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from functools import lru_cache
from typing import Annotated, Any, get_type_hints

from msgspec import Meta

from tuisim.config.files import Location, Scalar, convert, one_of, read_named, table, toml_lines
from tuisim.core.profile import EARLIER_KEYS, MS, PROFILES, MotorLaw, ProfileSpec, law_of_earlier
from tuisim.errors import ProfileError

DEFAULT_PROFILE = "robolab"
MAX_COST_MS = 60_000

_COST_MS: Any = Annotated[float, Meta(ge=0, le=MAX_COST_MS)]
_NS, _MS = "_ns", "_ms"
_RANGES: dict[str, tuple[int, int]] = {
    "tick_hz": (1, 1000),
    "max_speed_dps": (1, 100_000),
    "reflected_max": (1, 1000),
    "ultrasonic_period_ticks": (1, 1000),
}
"""Ranges of numbers; all others are from 0 to a million."""
_ANY = (0, 1_000_000)

_OLD = "measured on the old simulator"
_NEW = "choice of this project"

_LAW_SOURCES = {
    MotorLaw.BRICK: "moves end at their target, as with the EV3 motor driver",
    MotorLaw.NBEV3DEVSIM: _OLD,
}

SOURCES: Mapping[str, str] = {
    "tick_hz": f"{_NEW}: 100; {_OLD}: 30",
    "color_read_ns": f"{_OLD}: it waits before it takes the value",
    "color_code_read_ns": f"{_OLD}: it waits twice; ev3: a reading like any other",
    "ultrasonic_read_ns": f"{_OLD}: it waits before it takes the value",
    "gyro_read_ns": f"{_OLD}: it waits twice; ev3: a reading like any other",
    "attribute_read_ns": f"{_NEW}, so that polling takes time; {_OLD}: nothing",
    "clock_read_ns": f"{_NEW}, so that loops on the clock end; {_OLD}: nothing",
    "display_update_ns": f"{_NEW}, an estimate: 130 steps per pixel at the brick's 300 MHz; the old simulator has none",
    "motor_law": "; ".join(f"{law}: {_LAW_SOURCES[law]}" for law in MotorLaw),
    "max_speed_dps": "EV3 motor driver table: large motor without a load",
    "reflected_max": "ev3dev2 library: 100; the course and the old simulator: 255",
    "ambient_percent": f"{_NEW}: a sensor close to the mat is in its own shadow; {_OLD}: always 0",
    "halfway_heading": f"{_NEW}, so that arcs are round; {_OLD}: the heading before the turn",
    "ultrasonic_period_ticks": _OLD,
    "solid": "obstacles are solid on a real field, but not in the old simulator",
    "mend_library": f"{_NEW}: see `tuisim guide library-differences`; ev3: the library as it is",
    "starts_in_own_folder": "ev3dev starts a program in its own folder; a course starts it in the notebook's",
}
"""The source of each key's numbers."""


def load_profile(word: str, key: str = "") -> ProfileSpec:
    """Return a profile by name, or from a TOML file; errors about a name blame the option `key`.

    Raises:
        ProfileError: the name is unknown, or the file is wrong.
    """
    if word in PROFILES:
        return PROFILES[word]
    return profile_from_table(*read_named(word, "profile", PROFILES, ProfileError, key, (".toml",)))


def profile_from_table(data: object, name: str, at: Location, changes_to: ProfileSpec | None = None) -> ProfileSpec:
    """Return the profile in a table, called `name` unless the table says otherwise; costs are in ms or ns.

    Args:
        changes_to: The profile with the keys that the table leaves out, unless it names its base.

    Raises:
        ProfileError: a key or a value is wrong.
    """
    names = [field.name for field in fields(ProfileSpec)]
    in_ms = {_in_ms(key): key for key in names if key.endswith(_NS)}
    earlier = EARLIER_KEYS | {_in_ms(key) for key in EARLIER_KEYS if key.endswith(_NS)}
    listed = ("base", *(key for key in names if not key.endswith(_NS)), *in_ms)
    given = table(data, at, listed, unlisted=earlier | frozenset(in_ms.values()))
    named = PROFILES[one_of(given.get("base", DEFAULT_PROFILE), at.at("base"), PROFILES)]
    base = named if changes_to is None or "base" in given else changes_to
    found: dict[str, Any] = {"name": name}
    if "halve_position_moves" in given:
        halved = convert(given["halve_position_moves"], bool, at.at("halve_position_moves"))
        found["motor_law"] = law_of_earlier({"halve_position_moves": halved})
    for key, value in given.items():
        if key in in_ms:
            if in_ms[key] in given:
                raise at.at(key).wrong(f"is given together with {in_ms[key]}", "give only one of them")
            found[in_ms[key]] = round(convert(value, _COST_MS, at.at(key)) * MS)
        elif key in names:
            found[key] = convert(value, _kinds()[key], at.at(key))
    if found["name"] in PROFILES:
        raise at.at("name").wrong(f"{found['name']!r} is the name of a built-in profile", "choose another name")
    return replace(base, **found)


@lru_cache
def _kinds() -> Mapping[str, Any]:
    """Return the type of each field, numbers with their range."""
    kinds = get_type_hints(ProfileSpec)
    for key, kind in kinds.items():
        if kind in (int, float):
            low, high = _RANGES.get(key, (0, MAX_COST_MS * MS) if key.endswith(_NS) else _ANY)
            kinds[key] = Annotated[kind, Meta(ge=low, le=high)]
    return kinds


def _in_ms(key: str) -> str:
    return key.removesuffix(_NS) + _MS


def profile_lines(spec: ProfileSpec, parent: str = "") -> list[str]:
    """Return a profile as TOML lines, with every value: the table `parent`, or a file of its own."""
    values: dict[str, Scalar] = {}
    for field in fields(ProfileSpec):
        value = getattr(spec, field.name)
        cost_ms = value / MS if field.name.endswith(_NS) else 0.0
        if cost_ms and round(cost_ms * MS) == value:
            values[_in_ms(field.name)] = cost_ms
        else:
            values[field.name] = value
    return [*([f"[{parent}]"] if parent else []), *toml_lines(values)]
