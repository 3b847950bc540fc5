"""The source of an analysis: a log, its runs if they are in the store, and notes on it.

The notes are kept with the run, or for a file in the user's data folder.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder
from tuisim.base.regular_file import open_regular, read_regular
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.log import Log
from tuisim.logs.reader import STDIN
from tuisim.settings.preferences import get_preference, keep

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun

# The choices are kept in the user's data folder by path, size and date, never beside the file.

MAX_FILES = 200
_NAME = "logs"


@dataclass(frozen=True, slots=True)
class _Reading:
    """The choices with which a file was read, with the file's size and time, which tell whether it has changed."""

    path: str
    size_bytes: int
    mtime_ns: int
    choices: ReadChoices = NO_CHOICES


def find_choices(file: str) -> ReadChoices | None:
    """Return the stored choices of how to read a file; None if there are none, or the file has changed since."""
    reading = _look_up(file)
    return next(
        (old.choices for old in _load() if replace(old, choices=NO_CHOICES) == reading), None
    )


def _look_up(file: str) -> _Reading | None:
    """Return the path, size and time of a file as a `_Reading`, which has no choices of how to read the file.

    The result is None if it is not a regular file.
    """
    try:
        status = os.stat(file) if LogRequest(file).is_readable_again else None
    except OSError:
        return None
    path = os.path.realpath(file)
    return status and _Reading(path, status.st_size, status.st_mtime_ns)


def _load() -> list[_Reading]:
    """Return the stored choices for all files, the newest last; damaged entries are left out."""
    entries = get_preference(_NAME)
    readings = []
    for entry in entries if isinstance(entries, list) else ():
        with suppress(msgspec.ValidationError, LogError):
            readings.append(msgspec.convert(entry, _Reading))
    return readings


@dataclass(frozen=True, slots=True)
class LogRequest:
    """The request to open a log: a file, or runs of the store."""

    file: str = ""
    """Path of the log file to open, or `-` for the standard input; empty if stored runs are opened."""
    runs: tuple[str, ...] = ()
    """The stored runs to open, each by its number, its id, or `last`; empty for a file."""
    telemetry: bool = False
    """Whether to open the first run's telemetry, which has a row for each tick, instead of its printed samples."""
    choices: ReadChoices = NO_CHOICES
    """The user's choices of how to read the file, such as its separator."""
    is_remembered: bool = False
    """Whether `choices` were stored when the user opened the same, unchanged file before."""

    @property
    def is_readable_again(self) -> bool:
        """Whether the log is a regular file, and can be read twice: a pipe cannot, and runs are in no file."""
        return self.file not in ("", STDIN) and os.path.isfile(self.file)

    def remember(self, choices: ReadChoices) -> None:
        """Store the choices of how to read the file, in place of its earlier choices.

        Only the choices for the last `MAX_FILES` files are kept. For a file that is no regular one, nothing is stored.

        Raises:
            OSError: the choices cannot be stored.
        """
        if (reading := _look_up(self.file)) is not None:
            others = [old for old in _load() if old.path != reading.path]
            newest = [*others, replace(reading, choices=choices)][-MAX_FILES:]
            keep(_NAME, list(map(asdict, newest)))

    def mark(self, log: Log) -> Log:
        """Return a log with a note on how it was read, if it was read by stored choices; otherwise the log itself."""
        if not self.is_remembered or self.choices == NO_CHOICES:
            return log
        options = " ".join(self.choices.format_options())
        note = f"read as chosen in the analyser: {options} (giving one of these options replaces all of them)"
        return replace(log, notes=(note, *log.notes))

    def open_pieces(self) -> Iterator[OpenedLog]:
        """Open the log, and yield the part that was read so far, soon after the start and then repeatedly.

        This is slow for a large file: call it in a thread.

        Raises:
            LogError: there is no such run or file, or it cannot be read.
        """
        from tuisim.engine.runs.store import RunStore
        from tuisim.logs.reader import build_log, build_telemetry_log, read_pieces

        if not self.file:
            store = RunStore()
            runs = tuple(store.load_run(word) for word in self.runs)
            log = build_telemetry_log(runs[0]) if self.telemetry else build_log(runs)
            yield OpenedLog(self, log, runs[:1] if self.telemetry else runs)
            return
        for loaded in read_pieces(self.file, self.choices):
            if loaded.log is not None:
                yield OpenedLog(self, self.mark(loaded.log), (), loaded.part, loaded.done)

    @classmethod
    def restore(cls, file: str, choices: ReadChoices = NO_CHOICES) -> LogRequest:
        """Return the request to open a file; without `choices`, it has the choices stored for the file, if any."""
        remembered = find_choices(file) if choices == NO_CHOICES else None
        return cls(file, choices=remembered or choices, is_remembered=remembered is not None)


@dataclass(frozen=True, slots=True)
class OpenedLog:
    """An open log with its runs and its request; it may not be completely read yet."""

    request: LogRequest
    log: Log
    runs: tuple[StoredRun, ...] = ()
    """The runs of the log, in the order of its run column; none for a file."""
    part: float = 1.0
    """Share of the file that has been read, 0 to 1; NaN if the share is unknown."""
    done: bool = True

    def find_notes_files(self) -> tuple[Path, ...]:
        """Return the files with the notes: one per run, one for a file, none for the standard input.

        Raises:
            LogError: the file no longer exists.
        """
        if self.runs:
            return tuple(run.folder / NOTES_FILE for run in self.runs)
        file = Path(self.request.file)
        return (find_notes_file(file),) if file.is_file() else ()

    def stamp(self) -> object:
        """Return an object that is equal to an earlier result only if the log has not grown since.

        Callers compare two results to notice that there are new rows.
        """
        if self.runs:
            return tuple(
                (run.telemetry.count if self.request.telemetry else run.output.length)
                for run in self.runs
            )
        try:
            return Path(self.request.file).stat().st_size
        except OSError:
            return None


NOTES_FILE = "notes.jsonl"
"""Name of the file, in the folder of a run, with the user's notes on the run."""
_HASHED_BYTES = 1 << 16
"""The first line, within so many bytes, identifies a log file for its notes, also when the file grows."""
_MAX_NOTES_BYTES = 64 << 20


@dataclass(frozen=True, slots=True)
class Note:
    """A user's note on a sample or a time range of a log."""

    text: str
    start_s: float
    """Time of the sample that the note is about, or beginning of the time span."""
    stop_s: float
    """End of the time span that the note is about; the same as `start_s` for a sample."""
    variable: str = ""
    """Name of the variable that the note is about; empty if it is about none in particular."""


def find_notes_file(path: Path) -> Path:
    """Return the path of the file with the notes on a log file; the file need not exist yet.

    The path depends on the path and the first line of the log file: another log at the same path has other notes.

    Raises:
        LogError: the log file cannot be read.
    """
    try:
        with open_regular(path, follow_links=True) as handle:
            beginning = handle.read(_HASHED_BYTES).partition(b"\n")[0]
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from error
    key = hashlib.sha256(bytes(path.resolve()) + b"\0" + beginning).hexdigest()[:32]
    return home_folder() / "notes" / f"{key}.jsonl"


def read_notes(place: Path) -> tuple[Note, ...]:
    """Return the notes in a file; if the file does not exist, there are none.

    Raises:
        LogError: the file cannot be read, or a row is not a note.
    """
    try:
        lines = [line for line in read_regular(place, _MAX_NOTES_BYTES).split(b"\n") if line]
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(place)) from error
    notes = []
    for row, line in enumerate(lines, 1):
        try:
            fields = json.loads(line)
            start_s, stop_s = float(fields["start_s"]), float(fields["stop_s"])
            notes.append(
                Note(str(fields["text"]), start_s, stop_s, str(fields.get("variable", "")))
            )
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
            raise LogError("not a note", file=str(place), row=row) from error
    return tuple(notes)


def write_notes(place: Path, notes: Sequence[Note]) -> None:
    """Write notes to a file, in place of the notes that it has.

    Raises:
        LogError: the file cannot be written; it is unchanged.
    """
    try:
        make_private_folder(place.parent)
        with replacing(place, owner_only=True) as handle:
            for note in notes:
                # A lone surrogate, half of a character, becomes an escape of JSON.
                text = json.dumps(asdict(note), ensure_ascii=False).encode(
                    errors="backslashreplace"
                )
                handle.write(text + b"\n")
    except OSError as error:
        raise LogError(f"cannot write: {error.strerror or error}", file=str(place)) from error
