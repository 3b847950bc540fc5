"""The source of an analysis: a log, and its runs if they are in the store."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.logs.annotations import notes_of_file, notes_of_run

if TYPE_CHECKING:
    from tuisim.logs.log import Log
    from tuisim.runs.run_folder import StoredRun


@dataclass(frozen=True, slots=True)
class LogRequest:
    """The log to open: a file, or runs."""

    file: str = ""
    """Path, or `-` for the standard input; empty for runs."""
    runs: tuple[str, ...] = ()
    """Numbers, ids, or `last`."""
    telemetry: bool = False
    """Use the telemetry of the first run instead of samples."""
    time: str | None = None
    """Time column, None to guess."""
    values: tuple[str, ...] = ()
    """Value columns, empty to guess."""
    unit: str = ""
    """Unit of numeric times, empty to guess."""


@dataclass(frozen=True, slots=True)
class OpenedLog:
    """An open log, possibly not completely read yet."""

    wanted: LogRequest
    log: Log
    runs: tuple[StoredRun, ...] = ()
    """In the order of the log's run column; none for a file."""
    part: float = 1.0
    """Fraction that has been read, 0 to 1; NaN if unknown."""
    done: bool = True

    def notes_places(self) -> tuple[Path, ...]:
        """Return the files with the notes: one per run, one for a file, none for the standard input.

        Raises:
            LogError: the file no longer exists.
        """
        if self.runs:
            return tuple(notes_of_run(run.folder) for run in self.runs)
        file = Path(self.wanted.file)
        return (notes_of_file(file),) if file.is_file() else ()

    def stamp(self) -> object:
        """Return a token that changes when the source grows."""
        if self.runs:
            return tuple((run.telemetry.count if self.wanted.telemetry else run.output.length) for run in self.runs)
        try:
            return Path(self.wanted.file).stat().st_size
        except OSError:
            return None


def opening(wanted: LogRequest) -> Iterator[OpenedLog]:
    """Open a log; yield what has been read, soon after the start and then repeatedly.

    Slow for a large file: call it in a thread.

    Raises:
        LogError: there is no such run or file, or it cannot be read.
    """
    from tuisim.logs.reader import log_of_runs, read_pieces, telemetry_log
    from tuisim.runs.store import RunStore

    if not wanted.file:
        store = RunStore()
        runs = tuple(store.load_run(word) for word in wanted.runs)
        log = telemetry_log(runs[0]) if wanted.telemetry else log_of_runs(runs)
        yield OpenedLog(wanted, log, runs[:1] if wanted.telemetry else runs)
        return
    for loaded in read_pieces(wanted.file, wanted.time, wanted.values, wanted.unit):
        if loaded.log is not None:
            yield OpenedLog(wanted, loaded.log, (), loaded.part, loaded.done)
