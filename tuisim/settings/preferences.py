"""What the user has chosen in the app and finds again: values by name, in `preferences.json` of the data folder."""

from __future__ import annotations

import json
from pathlib import Path

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.folders import session_folder
from tuisim.base.regular_file import read_regular

_MOST_BYTES = 1 << 20


def preferences_file() -> Path:
    """Return the path of the file; it may not exist."""
    return session_folder() / "preferences.json"


def preference(name: str) -> object:
    """Return what was kept under a name; None if nothing was, or the file is damaged."""
    return _all().get(name)


def keep(name: str, value: object) -> None:
    """Keep a value that JSON can hold; None forgets it.

    Raises:
        OSError: the folder cannot be written.
    """
    kept = {key: old for key, old in {**_all(), name: value}.items() if old is not None}
    file = preferences_file()
    make_private_folder(file.parent)
    with replacing(file, durable=False, owner_only=True) as handle:
        handle.write(json.dumps(kept, indent=1, sort_keys=True).encode() + b"\n")


def _all() -> dict[str, object]:
    try:
        found = json.loads(read_regular(preferences_file(), _MOST_BYTES, follow_links=True))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}
