"""The side files of a run folder: lock, user actions, tick of a stop, own modules, and files that were read.

Pure Python, because the child imports it and writes them.
"""

from __future__ import annotations

import fcntl
import json
import os
import stat
from binascii import crc32
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tuisim.base.atomic import private
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, TuisimError
from tuisim.base.regular_file import read_regular
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.protocol import SetNoise, UserAction
from tuisim.engine.runs.records import COMMANDS_FILE, MOTORS_FILE, READINGS_FILE

LOCK_FILE = "lock"
"""Locked by the process that runs the program, as long as it lives.

The kernel releases the lock when the process ends in any way, which distinguishes a run without an end from one that
is still running.
"""

ACTIONS_FILE = "actions.jsonl"
"""The user's actions, one JSON object per line."""

STOP_FILE = "stop.json"
"""The tick before which the user's stop reached the program; missing if it was stopped elsewhere."""

MODULES_FILE = "modules.jsonl"
"""Copies of the program's own modules that it has imported, one JSON object per line.

They allow repeating the run after the modules have changed or are gone.
"""

READS_FILE = "reads.jsonl"
"""Files outside the run folder that the program has opened for reading, one JSON object per line."""
MAX_READS = 100
"""Largest number of files that `READS_FILE` lists; further files are only counted."""


LOG_FILE = "child.log"
"""The stderr of the child, for errors below Python; missing if there were none."""

STACK_FILE = "stack.txt"
"""The stack of a child that was stuck."""

SIDE_FILES = (
    ACTIONS_FILE,
    STOP_FILE,
    MODULES_FILE,
    READS_FILE,
    READINGS_FILE,
    MOTORS_FILE,
    COMMANDS_FILE,
    LOG_FILE,
    STACK_FILE,
)
"""Names of all these files, except the lock."""

MAX_BYTES = 64 << 20
"""Larger than any side file that is read whole."""


def hold(folder: Path) -> int:
    """Lock a run folder, and return the descriptor of the lock.

    The lock is released when the descriptor and all its copies are closed.

    Raises:
        OSError: the folder cannot be written to, or not be locked.
    """
    # The file is locked before it gets its name: `is_held` never finds it without an owner.
    name = folder / f".{LOCK_FILE}-{os.getpid()}"
    descriptor = private(str(name), os.O_RDONLY | os.O_CREAT | os.O_CLOEXEC)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.rename(name, folder / LOCK_FILE)
    except OSError:
        os.close(descriptor)
        with suppress(OSError):
            os.unlink(name)
        raise
    return descriptor


def is_held(folder: Path) -> bool | None:
    """Return whether a living process holds the lock of a run folder.

    Return None if the folder has no lock file, or if this machine cannot find out.
    """
    try:
        # With O_NONBLOCK, a pipe that a program has put in the place of the file does not block.
        descriptor = os.open(folder / LOCK_FILE, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return None
    finally:
        os.close(descriptor)
    return False


def read_actions(folder: Path) -> tuple[tuple[UserAction, ...], str]:
    """Return the user's actions in a run folder, and a note if the last one is incomplete, otherwise an empty string.

    Raises:
        LogError: a line other than the last is invalid.
    """
    path = folder / ACTIONS_FILE
    try:
        data = read_regular(path, MAX_BYTES)
    except FileNotFoundError:
        return (), ""
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from error
    *lines, rest = data.split(b"\n")
    actions = []
    for row, line in enumerate(lines, 1):
        try:
            action = UserAction.from_plain(json.loads(line))
            if isinstance(action.command, SetNoise):
                NoiseSpec(int(action.command.light), int(action.command.motor))
            actions.append(action)
        except (
            ValueError,
            TypeError,
            KeyError,
            AttributeError,
            OverflowError,
            RecursionError,
            TuisimError,
        ) as error:
            raise LogError("not a user action", file=str(path), row=row) from error
    return tuple(
        actions
    ), f"{ACTIONS_FILE}: the last line is incomplete and is ignored" if rest else ""


@contextmanager
def _convert_errors(path: Path) -> Iterator[None]:
    """Return a context in which any error of reading or parsing a file is raised as a LogError."""
    try:
        yield
    except (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
        raise LogError(f"cannot be read: {error}", file=str(path)) from error


def _read_rows(path: Path) -> Iterator[Any]:
    """Yield the rows of a file of JSON lines, without an incomplete last row. A missing file has no rows."""
    try:
        *lines, _ = read_regular(path, MAX_BYTES).split(b"\n")
    except FileNotFoundError:
        lines = []
    return map(json.loads, lines)


def _append(path: Path, row: Mapping[str, object]) -> None:
    """Append a row to a file of JSON lines."""
    with open(path, "ab", opener=private) as file:
        file.write(json.dumps(row).encode() + b"\n")


def write_stop_tick(folder: Path, tick: int) -> None:
    """Record the last tick before the user's stop reached the program.

    Raises:
        OSError: it cannot be written.
    """
    # The file is renamed after writing: if the process is killed before, there is no file, never a part of it.
    part = folder / f"{STOP_FILE}.part"
    with open(part, "w", encoding="utf-8", opener=private) as file:
        file.write(json.dumps({"tick": tick}))
    os.replace(part, folder / STOP_FILE)


def read_stop_tick(folder: Path) -> int | None:
    """Return the last tick before the user's stop reached the program; None if the file is missing.

    Raises:
        LogError: the file is damaged.
    """
    path = folder / STOP_FILE
    with _convert_errors(path):
        try:
            data = read_regular(path, MAX_BYTES)
        except FileNotFoundError:
            return None
        return int(json.loads(data)["tick"])


@dataclass(frozen=True, slots=True)
class OwnModule:
    """One module that the program imported: its file and text, or only the name of a module that was not found."""

    name: str
    """Full name with packages, such as `tools.drive`."""
    file: str = ""
    """Path of the module's file; empty for a folder without a file, and for a name that was not found."""
    folders: tuple[str, ...] | None = None
    """The folders of the modules of a package; None for another module."""
    text: str = ""
    """The source; bytes that are not valid UTF-8 as lone surrogates."""

    @property
    def missing(self) -> bool:
        """Whether no module of that name was found."""
        return not self.file and self.folders is None


def note_module(run_folder: Path, module: OwnModule) -> None:
    """Record that the program of a run has imported a module.

    Raises:
        LogError: it cannot be written.
    """
    try:
        _append(run_folder / MODULES_FILE, asdict(module))
    except OSError as error:
        raise LogError(
            f"cannot be written: {error.strerror or error}", file=str(run_folder / MODULES_FILE)
        ) from error


def read_modules(run_folder: Path) -> list[OwnModule]:
    """Return the modules of a run in the order of their import; an incomplete last one is ignored.

    Raises:
        LogError: the file is damaged.
    """
    path = run_folder / MODULES_FILE
    with _convert_errors(path):
        return [
            OwnModule(
                row["name"],
                row["file"],
                None if row["folders"] is None else tuple(row["folders"]),
                row["text"],
            )
            for row in _read_rows(path)
        ]


def copy_modules(source: Path, target: Path) -> None:
    """Copy the modules that are stored with a run to the folder of another run; do nothing if there are none.

    Args:
        source: The folder of the run that has the modules.
        target: The folder of the other run.

    Raises:
        LogError: they cannot be copied.
    """
    try:
        with suppress(FileNotFoundError):
            (target / MODULES_FILE).write_bytes(read_regular(source / MODULES_FILE, MAX_BYTES))
    except OSError as error:
        raise LogError(
            f"cannot be copied: {error.strerror or error}", file=str(source / MODULES_FILE)
        ) from error


@dataclass(frozen=True, slots=True)
class FileRead:
    """The state of a file when a program first opened it to read it.

    With it, a re-run can tell whether the file has changed since then.
    """

    path: str
    there: bool
    """Whether there was a file."""
    bytes: int = 0
    mtime_ns: int = 0
    crc32: int = -1
    """Checksum of the contents; -1 if there is none."""

    def is_same(self, other: FileRead) -> bool:
        """Return whether two states of a file have equal contents, as far as this is known."""
        if not (self.there and other.there):
            return self.there == other.there
        if self.crc32 < 0 or other.crc32 < 0:
            return (self.bytes, self.mtime_ns) == (other.bytes, other.mtime_ns)
        return (self.bytes, self.crc32) == (other.bytes, other.crc32)

    def read_now(self) -> FileRead | None:
        """Return the present state of the file; None if there is something else now, such as a folder."""
        return read_state(self.path)


@dataclass(frozen=True, slots=True)
class FilesRead:
    """The files that a program has read during a run."""

    files: tuple[FileRead, ...] = ()
    left_out: int = 0
    """Number of files that were read and are not listed."""

    @classmethod
    def read(cls, run_folder: Path) -> FilesRead:
        """Return the files that the program of a run has read; an incomplete last row is ignored.

        Raises:
            LogError: the file is damaged.
        """
        path = run_folder / READS_FILE
        reads: dict[str, FileRead] = {}
        left_out = 0
        with _convert_errors(path):
            for row in _read_rows(path):
                if "left_out" in row:
                    left_out = int(row["left_out"])
                    continue
                name = str(row["path"])
                reads.setdefault(
                    name,
                    FileRead(
                        name,
                        bool(row["there"]),
                        int(row["bytes"]),
                        int(row["mtime_ns"]),
                        int(row["crc32"]),
                    ),
                )
        return cls(tuple(reads.values())[:MAX_READS], left_out + max(0, len(reads) - MAX_READS))


_stat = os.stat
_open = os.open
_read = os.read
_close = os.close
"""Saved before a program's `os` functions are replaced by ones that note what it opens."""
_PART_BYTES = 1 << 20
MAX_SUMMED_BYTES = 1 << 22
"""Largest size in bytes of a file with a checksum; of a larger one, size and time tell whether it has changed."""


def read_state(path: str) -> FileRead | None:
    """Return the present state of a regular file or of a missing one; None for anything else, such as a folder."""
    try:
        status = _stat(path)
    except (OSError, ValueError) as error:
        gone = isinstance(error, FileNotFoundError | NotADirectoryError)
        return FileRead(path, there=False) if gone else None
    if not stat.S_ISREG(status.st_mode):
        return None
    return FileRead(
        path, True, status.st_size, status.st_mtime_ns, _compute_checksum(path, status.st_size)
    )


def _compute_checksum(path: str, size: int) -> int:
    if size > MAX_SUMMED_BYTES:
        return -1
    total = 0
    try:
        descriptor = _open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NONBLOCK)
    except OSError:
        return -1
    try:
        for _ in range(0, MAX_SUMMED_BYTES + 1, _PART_BYTES):
            total = crc32(_read(descriptor, _PART_BYTES), total)
    except OSError:
        return -1
    finally:
        _close(descriptor)
    return total


def note_read(run_folder: Path, read: FileRead) -> None:
    """Record that the program has read a file.

    Raises:
        OSError: it cannot be written.
    """
    _append(run_folder / READS_FILE, asdict(read))


def note_reads_left_out(run_folder: Path, count: int) -> None:
    """Record how many files were read beyond those that are listed.

    Raises:
        OSError: it cannot be written.
    """
    _append(run_folder / READS_FILE, {"left_out": count})
