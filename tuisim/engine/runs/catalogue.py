"""The catalogue of runs: one SQLite file beside the run folders.

It contains only data that the folders contain, too, so that a missing, damaged or foreign file is rebuilt from them.
Each operation opens the file again, because several processes may use it at the same time.
"""

from __future__ import annotations

import fcntl
import os
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from tuisim.base.atomic import make_private_folder, private, sweep
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, shortened
from tuisim.engine.protocol import RUN_STATES, RunState

CATALOGUE_FILE = "runs.db"
LOCK_FILE = "runs.lock"
_SIDE_FILES = ("-wal", "-shm")
"""Ends of the names of the files that SQLite keeps beside a database."""
_SCHEMA_VERSION = 2
_BUSY_S = 10.0

_Result = TypeVar("_Result")

_FULL = "no space left on device"
_LEAST_FREE_BYTES = 1 << 16
HOME_HINT = "TUISIM_HOME may name another folder"

_CREATE = """
CREATE TABLE runs (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE,
    created TEXT NOT NULL,
    program TEXT NOT NULL,
    background TEXT NOT NULL,
    profile TEXT NOT NULL,
    seed TEXT NOT NULL,
    "end" TEXT NOT NULL,
    ticks INTEGER,
    time_s REAL,
    samples INTEGER,
    summary TEXT NOT NULL,
    tags TEXT NOT NULL
)
"""


@dataclass(frozen=True, slots=True)
class RunInfo:
    """One row of the catalogue, which describes a run."""

    number: int
    """Sequential number of the run, from 1; 0 requests the next number."""
    id: str
    created: str
    """Time at which the run was created, as text in ISO 8601, UTC."""
    program: str
    background: str
    profile: str
    seed: int
    end: RunState | None = None
    """How the run ended, or its state without an end; None, and empty in the file, until that is known."""
    ticks: int | None = None
    time_s: float | None = None
    samples: int | None = None
    """Number of samples; None, and empty in the file, until they are counted."""
    summary: str = ""
    tags: str = ""
    """Tags, separated by spaces."""

    def find_tag(self, prefix: str) -> str:
        """Return the run's first tag that begins with a prefix, without the prefix; empty if there is none."""
        return next(
            (tag.removeprefix(prefix) for tag in self.tags.split() if tag.startswith(prefix)), ""
        )


STUDENT_TAG = "student:"
"""Prefix of the tag that names the student of a run."""
_MAX_RUNS = 1 << 40
"""Largest number of a run; a file with a larger one is damaged, and would leave no number for the next run."""
_MAX_ID = 255
"""Longest name of a folder in bytes."""
_NAMES = tuple(field.name for field in fields(RunInfo))
_COLUMNS = ", ".join(f'"{name}"' for name in _NAMES)
_INSERT = f"INSERT INTO runs ({_COLUMNS}) VALUES ({', '.join('?' * len(_NAMES))})"
_SELECT = f"SELECT {_COLUMNS} FROM runs ORDER BY number"


class _ForeignFile(sqlite3.DatabaseError):
    """The error about a database of another application, or of another version of tuisim."""


class Catalogue:
    """The database in a home folder that lists all runs.

    Args:
        home: The folder; it need not exist.
        scan: Reads all run folders, to rebuild the catalogue.

    Raises:
        LogError: if the file cannot be read or written. All methods but `rows` raise it.
    """

    def __init__(self, home: Path, scan: Callable[[], Iterable[RunInfo]]) -> None:
        self._home = home
        self._path = home / CATALOGUE_FILE
        self._scan = scan

    def add(self, info: RunInfo) -> int:
        """Add a run and return its number; if its number is already in use, the run gets the next free one.

        A run that is already listed keeps its row and number.
        """
        return self._write(lambda connection: _insert(connection, info))

    def update(self, run_id: str, **values: str | int | float | None) -> None:
        """Change columns of a run's row in the catalogue; a run that is not listed is ignored.

        Args:
            run_id: The id of the run.
            values: The new values, by the name of the column.

        Raises:
            ValueError: a column does not exist.
            LogError: the catalogue cannot be written.
        """
        self.update_all([(run_id, values)])

    def update_all(
        self, changes: Sequence[tuple[str, Mapping[str, str | int | float | None]]]
    ) -> None:
        """Change columns of the rows of many runs as `update` does, in one transaction."""
        unknown = {name for _, values in changes for name in values} - set(_NAMES)
        if unknown:
            raise ValueError(f"no such column: {', '.join(sorted(unknown))}")

        def change(connection: sqlite3.Connection) -> None:
            for run_id, values in changes:
                assignments = ", ".join(f'"{name}" = ?' for name in values)
                connection.execute(
                    f"UPDATE runs SET {assignments} WHERE id = ?", (*values.values(), run_id)
                )

        self._write(change)

    def remove(self, run_ids: Iterable[str]) -> None:
        """Remove the rows of the runs with these ids from the catalogue; an id that is not listed is ignored."""
        ids = [(run_id,) for run_id in run_ids]
        self._write(lambda connection: connection.executemany("DELETE FROM runs WHERE id = ?", ids))

    def rows(self) -> list[RunInfo]:
        """Return the rows of all runs in the catalogue, oldest first."""
        try:
            return self._do(_fetch_rows)
        except LogError:
            # SQLite must be able to write even to read. If it cannot, the rows are built from the run folders in
            # memory.
            with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
                self._fill(connection)
                return _fetch_rows(connection)

    def _write(self, operation: Callable[[sqlite3.Connection], _Result]) -> _Result:
        def write(connection: sqlite3.Connection) -> _Result:
            with _begin_transaction(connection):
                return operation(connection)

        return self._do(write)

    def _do(self, operation: Callable[[sqlite3.Connection], _Result]) -> _Result:
        try:
            try:
                with closing(_open(self._path)) as connection:
                    return operation(connection)
            except sqlite3.DatabaseError as error:
                if not _must_be_made_again(error):
                    raise
            self._make_again()
            with closing(_open(self._path)) as connection:
                return operation(connection)
        except (sqlite3.Error, OSError) as error:
            # On a full disk, SQLite's message may only be "disk I/O error".
            reason, hint = (
                (_FULL, "free some space, or " + HOME_HINT)
                if _is_full(self._home)
                else (error, HOME_HINT)
            )
            raise LogError(
                f"the list of runs cannot be used: {reason}", hint, file=str(self._path)
            ) from error

    def _make_again(self) -> None:
        """Replace an invalid catalogue by a new one, filled from the run folders."""
        with lock_home(self._home):
            # Another process may have replaced the catalogue while this one waited for the lock.
            if _is_sound(self._path):
                return
            sweep(self._path.parent, CATALOGUE_FILE)
            fresh = self._path.with_name(f".{CATALOGUE_FILE}.{os.urandom(4).hex()}.tmp")
            try:
                # SQLite creates the files beside it with the same permissions.
                os.close(private(str(fresh), os.O_CREAT | os.O_EXCL | os.O_RDWR))
                with closing(sqlite3.connect(fresh, isolation_level=None)) as connection:
                    connection.execute("PRAGMA journal_mode = WAL")
                    self._fill(connection)
                # A journal of the old file would be applied to the new one.
                for suffix in _SIDE_FILES:
                    self._path.with_name(CATALOGUE_FILE + suffix).unlink(missing_ok=True)
                os.replace(fresh, self._path)
            finally:
                # If SQLite could not finish writing, its files are still there: remove them.
                for suffix in ("", *_SIDE_FILES):
                    fresh.with_name(fresh.name + suffix).unlink(missing_ok=True)

    def _fill(self, connection: sqlite3.Connection) -> None:
        with _begin_transaction(connection):
            connection.execute(_CREATE)
            # Runs with a stored number come first, so that none of the others takes it.
            for info in sorted(
                self._scan(), key=lambda info: (not info.number, info.number, info.created)
            ):
                _insert(connection, info)
            connection.execute(f"PRAGMA user_version = {_SCHEMA_VERSION}")


def _is_full(folder: Path) -> bool:
    import shutil

    try:
        return shutil.disk_usage(folder).free < _LEAST_FREE_BYTES
    except OSError:
        return False


@contextmanager
def lock_home(home: Path) -> Iterator[None]:
    """Return a context that holds the lock of a home folder, for changes to several of its files.

    It blocks while another process holds the lock.

    Raises:
        LogError: the folder, or the lock in it, cannot be used.
    """
    file = home / LOCK_FILE
    try:
        make_private_folder(home)
        descriptor = private(str(file), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC)
    except OSError as error:
        raise LogError(
            f"cannot be opened: {error.strerror or error}", HOME_HINT, file=str(file)
        ) from error
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        except OSError as error:
            raise LogError(
                f"cannot be locked: {error.strerror or error}", HOME_HINT, file=str(file)
            ) from error
        yield
    finally:
        os.close(descriptor)


@contextmanager
def _begin_transaction(connection: sqlite3.Connection) -> Iterator[None]:
    # The lock is requested now, and waited for: if it is requested only at the first write, SQLite fails immediately.
    connection.execute("BEGIN IMMEDIATE")
    with connection:
        yield


def _open(path: Path) -> sqlite3.Connection:
    # SQLite must not create a missing file: it is created under the lock, and filled from the run folders.
    connection = sqlite3.connect(
        f"{path.absolute().as_uri()}?mode=rw", uri=True, timeout=_BUSY_S, isolation_level=None
    )
    try:
        # Waiting for the disk would delay the end of every run. After a power failure, a damaged catalogue is rebuilt.
        connection.execute("PRAGMA synchronous = OFF")
        version = connection.execute("PRAGMA user_version").fetchone()[0]
        if version != _SCHEMA_VERSION:
            raise _ForeignFile(f"version {version}")
    # SQLite quotes a damaged schema in its message, which Python then cannot read.
    except UnicodeDecodeError as error:
        connection.close()
        raise _ForeignFile(f"its schema is damaged: {error}") from error
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def _must_be_made_again(error: sqlite3.DatabaseError) -> bool:
    """Return whether an error means that the catalogue's file is missing, damaged or of another application."""
    if isinstance(error, _ForeignFile):
        return True
    code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_OK) & 0xFF
    # SQLITE_ERROR means a missing table or column: the SQL is constant, so nothing else can be wrong with it.
    return code in (
        sqlite3.SQLITE_CANTOPEN,
        sqlite3.SQLITE_CORRUPT,
        sqlite3.SQLITE_NOTADB,
        sqlite3.SQLITE_ERROR,
    )


def _is_sound(path: Path) -> bool:
    try:
        with closing(_open(path)) as connection:
            if connection.execute("PRAGMA quick_check(1)").fetchone()[0] != "ok":
                return False
            _fetch_rows(connection)
            return True
    except sqlite3.DatabaseError as error:
        if _must_be_made_again(error):
            return False
        raise


def _insert(connection: sqlite3.Connection, info: RunInfo) -> int:
    """Insert a run, and return its number: the one in `info` if that is free, else the next one.

    If the run is listed already, only return its number.
    """
    listed = connection.execute("SELECT number FROM runs WHERE id = ?", (info.id,)).fetchone()
    if listed is not None:
        return int(listed[0])
    is_sound = 0 < info.number <= _MAX_RUNS
    taken = (
        is_sound
        and connection.execute("SELECT 1 FROM runs WHERE number = ?", (info.number,)).fetchone()
    )
    number = info.number if is_sound and not taken else None
    # The seed is stored as text, because it may exceed the integers of SQLite.
    changed = {"number": number, "seed": str(info.seed), "end": info.end or ""}
    row = [changed.get(name, getattr(info, name)) for name in _NAMES]
    # Lone surrogates, which stand for invalid bytes of a file name, are replaced by `?`.
    row = [
        cell.encode("utf-8", "replace").decode() if isinstance(cell, str) else cell for cell in row
    ]
    return int(connection.execute(_INSERT, row).lastrowid or 0)


def _fetch_rows(connection: sqlite3.Connection) -> list[RunInfo]:
    # Texts are read as bytes, and decoded later: invalid UTF-8 is then reported as damage, like a wrong type.
    connection.text_factory = bytes
    try:
        return [_build_info(row) for row in connection.execute(_SELECT)]
    except (ValueError, KeyError, AttributeError, TypeError) as error:
        raise _ForeignFile(f"a row is damaged: {error}") from error


def _build_info(row: tuple[Any, ...]) -> RunInfo:
    number, *texts, seed, end, ticks, time_s, samples, summary, tags = row
    for count, kind in ((number, int), (ticks, int), (time_s, float), (samples, int)):
        if not isinstance(count, kind) and (count is not None or count is number):
            raise ValueError(f"{count!r} is not a number")
    words = (text.decode() for text in (*texts, end, summary, tags))
    run_id, created, program, background, profile, end, summary, tags = words
    if (
        not run_id
        or run_id.startswith(".")
        or {os.sep, "\0"} & set(run_id)
        or len(os.fsencode(run_id)) > _MAX_ID
    ):
        # The id must be the name of a folder among the run folders, because the user may delete that.
        raise ValueError(f"{shortened(run_id)} is not an id")
    state = RUN_STATES[end] if end else None
    return RunInfo(
        number,
        run_id,
        created,
        program,
        background,
        profile,
        int(seed),
        state,
        ticks,
        time_s,
        samples,
        summary,
        tags,
    )
