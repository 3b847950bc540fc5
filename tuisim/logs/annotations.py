"""Notes on samples and spans of a log, kept with the run, or for a file in the user's data folder."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from tuisim.atomic import make_private_folder, replacing
from tuisim.config.folders import home_folder
from tuisim.errors import LogError

NOTES_FILE = "notes.jsonl"
_HASHED_BYTES = 1 << 16
"""Bytes at the beginning of a file that identify it, also if it grows."""


@dataclass(frozen=True, slots=True)
class Note:
    """A note on a sample or a span."""

    text: str
    start_s: float
    """Time of the sample, or beginning of the span."""
    stop_s: float
    """End of the span; the same as `start_s` for a sample."""
    variable: str = ""
    """The variable; empty for none in particular."""


def notes_of_run(folder: Path) -> Path:
    """Return the file with the notes of a run, by its folder."""
    return folder / NOTES_FILE


def notes_of_file(path: Path) -> Path:
    """Return the file with the notes of a log file, which depends on its path and its beginning.

    Raises:
        LogError: the file cannot be read.
    """
    try:
        with path.open("rb") as handle:
            beginning = handle.read(_HASHED_BYTES).partition(b"\n")[0]
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from error
    key = hashlib.sha256(bytes(path.resolve()) + b"\0" + beginning).hexdigest()[:32]
    return home_folder() / "notes" / f"{key}.jsonl"


def read_notes(place: Path) -> tuple[Note, ...]:
    """Return the notes in a file, none if there is no such file.

    Raises:
        LogError: it cannot be read, or a row is not a note.
    """
    try:
        lines = [line for line in place.read_bytes().split(b"\n") if line]
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(place)) from error
    found = []
    for row, line in enumerate(lines, 1):
        try:
            fields = json.loads(line)
            start_s, stop_s = float(fields["start_s"]), float(fields["stop_s"])
            found.append(Note(str(fields["text"]), start_s, stop_s, str(fields.get("variable", ""))))
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise LogError("not a note", file=str(place), row=row) from error
    return tuple(found)


def write_notes(place: Path, notes: Sequence[Note]) -> None:
    """Replace the notes in a file.

    Raises:
        LogError: they cannot be written; the file is unchanged.
    """
    try:
        make_private_folder(place.parent)
        with replacing(place, owner_only=True) as handle:
            handle.writelines(json.dumps(asdict(note), ensure_ascii=False).encode() + b"\n" for note in notes)
    except OSError as error:
        raise LogError(f"cannot write: {error.strerror or error}", file=str(place)) from error
