"""What the user has chosen in the app and finds again: values by name, in `preferences.json` of the data folder."""

from __future__ import annotations

import json
from pathlib import Path

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.folders import session_folder
from tuisim.base.regular_file import read_regular

_MAX_BYTES = 1 << 20


def find_preferences_file() -> Path:
    """Return the path of the file with preferences; the file may not exist."""
    return session_folder() / "preferences.json"


def get_preference(name: str) -> object:
    """Return the stored value of the preference `name`; None if there is none, or the file is damaged."""
    return _read_all().get(name)


def keep(name: str, value: object) -> None:
    """Store a preference, a value that JSON can represent; None removes it.

    Raises:
        OSError: the folder cannot be written.
    """
    preferences = {key: old for key, old in {**_read_all(), name: value}.items() if old is not None}
    file = find_preferences_file()
    make_private_folder(file.parent)
    with replacing(file, durable=False, owner_only=True) as handle:
        handle.write(json.dumps(preferences, indent=1, sort_keys=True).encode() + b"\n")


def _read_all() -> dict[str, object]:
    try:
        preferences = json.loads(
            read_regular(find_preferences_file(), _MAX_BYTES, follow_links=True)
        )
    except (OSError, ValueError, RecursionError):
        return {}
    return preferences if isinstance(preferences, dict) else {}
