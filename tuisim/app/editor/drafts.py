"""Drafts: unsaved text, stored in case of a crash."""

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
    """The unsaved text of a program."""

    path: str
    """Absolute path of the program; empty for a new one without a file."""
    text: str
    written_s: float
    """When it was stored, in seconds since 1970."""


def _file(path: str) -> Path:
    from tuisim.config.folders import home_folder

    return home_folder() / FOLDER / f"{hashlib.sha256(path.encode(errors='surrogateescape')).hexdigest()[:24]}.json"


def keep_draft(path: str, text: str) -> None:
    """Store the text of a program, replacing an older draft.

    Raises:
        ConfigError: the draft cannot be written.
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
    """Return the draft of a program, None if there is no readable one."""
    try:
        found = json.loads(_file(path).read_bytes())
        draft = Draft(str(found["path"]), str(found["text"]), float(found["written_s"]))
    except (OSError, ValueError, KeyError, TypeError):
        # Drafts are written atomically; a malformed file has nothing to restore.
        return None
    return draft if draft.path == path else None


def drop_draft(path: str) -> None:
    """Delete the draft of a program; one that cannot be deleted is offered again."""
    # The folder may be read-only by now; the text itself is safe.
    with suppress(OSError):
        _file(path).unlink(missing_ok=True)
