"""The user's own keys: the table of keys with those of `[keys]` in `config.toml` in place of ours."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

from textual.keys import KEY_NAME_REPLACEMENTS, Keys

from tuisim.app.action import Action, label_of_key
from tuisim.app.themes import list_themes
from tuisim.base.errors import nearest
from tuisim.engine.files import Location
from tuisim.settings.user_config import THEME, Section, UserConfig
from tuisim.terminal.textual_internals import find_key

Host = TypeVar("Host")
Now = TypeVar("Now")

_TAKEN = {
    "escape": "leaves a field",
    "tab": "goes to the next panel or field",
    "shift+tab": "goes to the panel or field before",
    "enter": "applies a field",
    "ctrl+c": "copies",
    "ctrl+q": "quits",
}
"""Keys that the user cannot give to an action, and what each of them does."""
_SAME = {
    "ctrl+i": "tab",
    "ctrl+m": "enter",
    "ctrl+left_square_bracket": "escape",
    "esc": "escape",
    "return": "enter",
}
"""Keys for which a terminal sends another key, and other names of keys, each with the key that it stands for."""
_NAMED = frozenset(
    key.value.rpartition("+")[2] for key in Keys if key.value.isprintable() and key.value[0] != "<"
)
_MODIFIERS = re.compile(r"(?:(?:ctrl|alt|shift)\+)*")
_HOW = "a character such as x or ?, or a name such as f5, ctrl+x, shift+f5, pageup, space"


def key_of(text: str, at: Location) -> str:
    """Return Textual's notation of a key.

    Args:
        text: The key as the user writes it: a character, or a name with modifiers, such as `ctrl+x`.
        at: File and entry in which it is written, for errors.

    Raises:
        ConfigError: there is no such key, or it has a meaning that cannot be changed.
    """
    match = _MODIFIERS.match(text.lower())
    modifiers = match[0] if match and len(text) > 1 else ""
    last = text[len(modifiers) :]
    if len(last) == 1 and last.isprintable():
        name = find_key(last.lower() if modifiers else last)
    else:
        name = KEY_NAME_REPLACEMENTS.get(last.lower(), last.lower())
        if name not in _NAMED and name not in _SAME:
            raise at.wrong(f"no such key {text!r}", _HOW)
    key = _SAME.get(modifiers + name, modifiers + name)
    if does := _TAKEN.get(key):
        raise at.wrong(f"{text} {does} and cannot be another action's key", "choose another key")
    return key


def apply_keys(
    actions: Mapping[str, Action[Host, Now]], config: UserConfig
) -> dict[str, Action[Host, Now]]:
    """Return the table of actions in which the user's own keys replace the usual ones.

    Raises:
        ConfigError: an id or a key does not exist, or a key belongs to two actions.
    """
    location = Location(str(config.path)).at(Section.KEYS)
    table = dict(actions)
    for name, keys in config.keys.items():
        here = location.at(name)
        if name not in table:
            raise here.wrong(
                "no such action", f"{nearest(name, table)}; `tuisim guide keys` lists the ids"
            )
        written = ",".join(dict.fromkeys(key_of(key, here) for key in keys))
        table[name] = replace(table[name], key=written, shown_key="", footer_key="")
    _check_clashes(table, config, location)
    return table


def _check_clashes(
    actions: Mapping[str, Action[Any, Any]], config: UserConfig, location: Location
) -> None:
    owners: dict[str, str] = {}
    for name, action in actions.items():
        for key in action.key.split(","):
            other = owners.setdefault(key, name)
            if other == name:
                continue
            # The error names a key that the user has chosen: of the usual keys, no two are the same.
            blamed, has = (name, other) if name in config.keys else (other, name)
            title = actions[has].title
            raise location.at(blamed).wrong(
                f"{label_of_key(key)} is also the key of {has} ({title})",
                f"give {blamed} or {has} another key",
            )


def check_theme(config: UserConfig) -> None:
    """Check that the theme in the user's settings exists.

    Raises:
        ConfigError: there is no such theme.
    """
    name = str(config.value(THEME))
    if name not in list_themes():
        location = Location(str(config.path)).at(THEME)
        raise location.wrong(f"no such theme {name!r}", nearest(name, list_themes()))
