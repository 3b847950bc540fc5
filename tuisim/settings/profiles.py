"""Profiles by name or from a TOML file, which needs only the keys that differ from its `base`."""

from __future__ import annotations

from typing import Any

from tuisim.base.errors import ProfileError
from tuisim.engine.core.profile import MAX_COST_MS, MS, PROFILES, ProfileSpec
from tuisim.engine.core.values import Number, list_values
from tuisim.engine.files import (
    Location,
    one_of,
    read_named,
    read_value,
    table,
    toml_lines,
    with_values,
)

DEFAULT_PROFILE = "robolab"

_COST_MS = Number(0, MAX_COST_MS)
_NS = "_ns"
_MS = "_ms"


def load_profile(word: str, key: str = "") -> ProfileSpec:
    """Return the profile that a word names: one of tuisim's profiles, or the profile in a TOML file.

    Args:
        word: The name of the profile, or the path of the file.
        key: The option that gives the word, for errors.

    Raises:
        ProfileError: the name is unknown, or the file is wrong.
    """
    if word in PROFILES:
        return PROFILES[word]
    return parse_profile(*read_named(word, "profile", PROFILES, ProfileError, key, (".toml",)))


def parse_profile(
    data: object, name: str, location: Location, changes_to: ProfileSpec | None = None
) -> ProfileSpec:
    """Return the profile in a table; costs in it are in ms or ns.

    Args:
        data: The table.
        name: The name of the profile, unless the table gives one.
        location: The location of the table, for errors.
        changes_to: The profile that provides keys missing in the table, unless the table names its base; None for the
            default profile.

    Raises:
        ProfileError: a key or a value is wrong.
    """
    values = list_values(ProfileSpec)
    in_ms = {_build_ms_key(key): key for key in values if key.endswith(_NS)}
    listed = ("base", *(key for key in values if not key.endswith(_NS)), *in_ms)
    entries = table(data, location, listed, unlisted=frozenset(in_ms.values()))
    named = PROFILES[one_of(entries.get("base", DEFAULT_PROFILE), location.at("base"), PROFILES)]
    base = named if changes_to is None or "base" in entries else changes_to
    changes: dict[str, Any] = {"name": name}
    for key, value in entries.items():
        if key in in_ms:
            if in_ms[key] in entries:
                raise location.at(key).wrong(
                    f"cannot be combined with {in_ms[key]}", f"give {key} or {in_ms[key]}"
                )
            changes[in_ms[key]] = round(read_value(value, _COST_MS, location.at(key)) * MS)
        elif key in values:
            changes[key] = read_value(value, values[key], location.at(key))
    if changes["name"] in PROFILES:
        raise location.at("name").wrong(
            f"{changes['name']!r} is the name of a built-in profile", "choose another name"
        )
    return with_values(base, changes, location)


def _build_ms_key(key: str) -> str:
    return key.removesuffix(_NS) + _MS


def format_profile(spec: ProfileSpec, parent: str = "") -> list[str]:
    """Return a profile as TOML lines, with every value.

    Args:
        spec: The profile.
        parent: The name of its table; empty for a file of its own.
    """
    values = {}
    for key in list_values(ProfileSpec):
        value = getattr(spec, key)
        cost_ms = value / MS if key.endswith(_NS) else 0.0
        if cost_ms and round(cost_ms * MS) == value:
            values[_build_ms_key(key)] = cost_ms
        else:
            values[key] = value
    return [*([f"[{parent}]"] if parent else []), *toml_lines(values)]
