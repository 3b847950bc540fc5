"""The user's choices for reading files, remembered as long as a file stays the same.

The choices are kept in the user's data folder by path, size and date, never beside the file.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import asdict, replace

import msgspec

from tuisim.analysis.source import LogRequest
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.log import Log
from tuisim.logs.reader import STDIN, read_beginning
from tuisim.settings.preferences import get_preference, keep

MAX_FILES = 200
_NAME = "logs"


@dataclass(frozen=True, slots=True)
class _Reading:
    """How a file was read, with its size and time, by which a changed file is noticed."""

    path: str
    size_bytes: int
    mtime_ns: int
    choices: ReadChoices = NO_CHOICES


def request_file(file: str, choices: ReadChoices = NO_CHOICES) -> LogRequest:
    """Return the request for a file; without choices, it gets those that the user made for this file before."""
    remembered = find_choices(file) if choices == NO_CHOICES else None
    return LogRequest(file, choices=remembered or choices, is_remembered=remembered is not None)


def find_choices(file: str) -> ReadChoices | None:
    """Return the choices that the user made for a file; None if there are none, or the file has changed since."""
    reading = _look_up(file)
    return next(
        (old.choices for old in _load() if replace(old, choices=NO_CHOICES) == reading), None
    )


def remember_choices(file: str, choices: ReadChoices) -> None:
    """Store the choices for a file in place of earlier ones; the oldest files are forgotten if there are too many.

    Raises:
        OSError: they cannot be stored.
    """
    if (reading := _look_up(file)) is not None:
        others = [old for old in _load() if old.path != reading.path]
        newest = [*others, replace(reading, choices=choices)][-MAX_FILES:]
        keep(_NAME, list(map(asdict, newest)))


def read_doubtful(request: LogRequest) -> Log | None:
    """Return the first rows of a file if the user should check how it is read, since something was guessed; else None.

    Raises:
        LogError: it cannot be read, or has no row.
    """
    is_known = request.is_remembered or request.choices != NO_CHOICES
    if is_known or not is_readable_again(request.file):
        return None
    log = read_beginning(request.file, NO_CHOICES)
    # The lines that a program printed are read in one way only: there is nothing to choose.
    is_guessed = not log.layout.sure or bool(log.form.separator and log.notes)
    return log if is_guessed and not log.metadata else None


def is_readable_again(file: str) -> bool:
    """Return whether a log is a regular file; a pipe has its rows only once, and runs are not in a file."""
    return file not in ("", STDIN) and os.path.isfile(file)


def _look_up(file: str) -> _Reading | None:
    """Return path, size and time of a file; None if it is not a regular one."""
    try:
        status = os.stat(file) if is_readable_again(file) else None
    except OSError:
        return None
    path = os.path.realpath(file)
    return status and _Reading(path, status.st_size, status.st_mtime_ns)


def _load() -> list[_Reading]:
    """Return the stored readings, the newest last; damaged ones are left out."""
    entries = get_preference(_NAME)
    readings = []
    for entry in entries if isinstance(entries, list) else ():
        with suppress(msgspec.ValidationError, LogError):
            readings.append(msgspec.convert(entry, _Reading))
    return readings
