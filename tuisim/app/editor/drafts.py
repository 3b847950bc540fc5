"""Drafts: edited text that is not saved yet, kept where a crash does not reach it."""

from __future__ import annotations

import hashlib
import json
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from tuisim.atomic import make_private_folder, replacing
from tuisim.errors import ConfigError

FOLDER = "drafts"


@dataclass(frozen=True, slots=True)
class Draft:
    """One program as it was edited."""

    path: str
    """Of the program, absolute; empty for a new one that has no file."""
    text: str
    written_s: float
    """When it was kept, in seconds since 1970."""


def _file(path: str) -> Path:
    from tuisim.config.home import home_folder

    return home_folder() / FOLDER / f"{hashlib.sha256(path.encode(errors='surrogateescape')).hexdigest()[:24]}.json"


def keep_draft(path: str, text: str) -> None:
    """Keep the text of a program; an older draft of it is replaced.

    Raises:
        ConfigError: it cannot be written.
    """
    file = _file(path)
    data = json.dumps(asdict(Draft(path, text, time.time()))).encode("ascii")
    try:
        make_private_folder(file.parent)
        with replacing(file, owner_only=True) as handle:
            handle.write(data)
    except OSError as error:
        reason = error.strerror or error
        raise ConfigError(f"unsaved work cannot be kept: {reason}", "save it soon", file=str(file)) from None


def find_draft(path: str) -> Draft | None:
    """Return the draft of a program, None if there is none that can be read."""
    try:
        found = json.loads(_file(path).read_bytes())
        draft = Draft(str(found["path"]), str(found["text"]), float(found["written_s"]))
    except (OSError, ValueError, KeyError, TypeError):
        # Drafts are written whole; what is no draft all the same has nothing to give back.
        return None
    return draft if draft.path == path else None


def drop_draft(path: str) -> None:
    """Forget the draft of a program; one that cannot be removed is offered again."""
    # The folder may be read-only by now; the text itself is safe.
    with suppress(OSError):
        _file(path).unlink(missing_ok=True)
