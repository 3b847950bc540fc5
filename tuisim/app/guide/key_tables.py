"""Reference tables of the keys and the panels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

from textual.dom import DOMNode
from textual.widgets import Input

from tuisim.app.action import FIELD_KEYS, Action, KeyWord, label_of_key, list_bindings
from tuisim.app.editor.area import EDITOR_KEYS
from tuisim.app.keymap import apply_keys
from tuisim.app.panels import PANELS
from tuisim.base.errors import ConfigError
from tuisim.guide.tables import Table, code
from tuisim.settings.user_config import UserConfig

EVERYWHERE = (("tab", "Next panel or field"), ("Escape", "Leave a field"))
"""Keys that have an effect on every screen and are no actions in the app's table, and what each does."""


_FEW = 3
"""Up to so many keys with the same effect are all named; of more keys, only the first and the last are."""


def own_keys(widgets: Iterable[DOMNode]) -> list[KeyWord]:
    """Return the keys that widgets handle themselves, such as the keys of a field and of the panel around it."""
    keys: dict[str, list[str]] = {}
    fields: Sequence[KeyWord] = ()
    for widget in widgets:
        fields = FIELD_KEYS if isinstance(widget, Input) else fields
        # Textual's own classes name keys for scrolling and selecting that nobody looks for.
        kinds = [kind for kind in type(widget).__mro__ if kind.__module__.startswith("tuisim.")]
        for bound in [bound for kind in kinds for bound in list_bindings(kind)]:
            keys.setdefault(bound.description, []).extend(map(label_of_key, bound.key.split(",")))
    return [*fields, *((_join_keys(labels), does) for does, labels in keys.items())]


def _join_keys(keys: Sequence[str]) -> str:
    return " ".join(keys) if len(keys) <= _FEW else f"{keys[0]} … {keys[-1]}"


def _list_keys(actions: Iterable[Action[Any, Any]]) -> list[tuple[str, ...]]:
    return [(code(action.key_label), action.title, action.group) for action in actions]


def _load_actions(module: str) -> Mapping[str, Action[Any, Any]]:
    # The table is imported by its name, because its actions import this guide in turn.
    table: Mapping[str, Action[Any, Any]] = import_module(module).ACTIONS
    return table


def list_app_keys() -> Table:
    """Return the table of the app's keys, with the user's own keys in place of those that they replace."""
    actions = _load_actions("tuisim.app.actions.keys")
    # The app and `tuisim config` report wrong keys, so the guide need not.
    with suppress(ConfigError):
        actions = apply_keys(actions, UserConfig.load())
    rows = [
        (*row, code(name)) for row, name in zip(_list_keys(actions.values()), actions, strict=True)
    ]
    everywhere = [(code(key), does, "Everywhere", "") for key, does in EVERYWHERE]
    return Table(("key", "does", "group", "id"), [*rows, *everywhere])


def list_analyser_keys() -> Table:
    """Return the table of the analyser's keys."""
    return Table(
        ("key", "does", "group"),
        _list_keys(_load_actions("tuisim.app.analyser.actions.keys").values()),
    )


def list_editor_keys() -> Table:
    """Return the table of the keys in the code panel."""
    return Table(
        ("key", "does"), [(" ".join(map(code, keys.split())), does) for keys, does in EDITOR_KEYS]
    )


def list_panels() -> Table:
    """Return the table of the panels: the key of each, and from which size of terminal it is shown at the start."""
    rows = [
        (
            code(label_of_key(panel.key)),
            panel.title,
            f"from a {panel.sizes[0]} terminal" if panel.sizes else "when you open it",
        )
        for panel in PANELS.values()
    ]
    return Table(("key", "panel", "shown"), rows)
