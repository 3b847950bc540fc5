"""Runs that are not listed: their recordings are in temporary files until they have been evaluated."""

from __future__ import annotations

import json
import os
import tempfile
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any

from tuisim.base.errors import LogError
from tuisim.base.folders import remove_tree
from tuisim.base.source import Program
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import Ended
from tuisim.engine.runs.records import OUTPUT_FILE, TELEMETRY_FILE
from tuisim.engine.runs.run_folder import (
    RUN_FILE,
    StoredRun,
    build_run_data,
    open_run,
    write_run_file,
)
from tuisim.engine.runs.side_files import SIDE_FILES, hold, is_held
from tuisim.engine.runs.store import NewRun

_MEMORY = Path("/dev/shm")
"""A file system in memory, on Linux: to create and delete files on a disk takes longer than a short run."""
_FREE_BYTES = 2 << 30
"""`_MEMORY` is used if it has at least this much space: programs may print a lot."""
_PREFIX = "tuisim-"
"""Beginning of the name of each folder that is created here."""
_BATCH_PREFIX = f"{_PREFIX}batch-"


def create_batch_folder() -> Path:
    """Create and return a folder for the temporary runs of a batch.

    Raises:
        LogError: it cannot be created.
    """
    return create_owned_folder(_BATCH_PREFIX, _find_parent())


def create_owned_folder(prefix: str = _PREFIX, parent: Path | None = None) -> Path:
    """Create and return a folder that is marked as in use while this process lives; its name begins with the prefix.

    Folders that killed processes have left in `parent`, and in the system's folders for temporary files, are removed.

    Raises:
        LogError: it cannot be created.
    """
    default = Path(tempfile.gettempdir())
    parent = parent or default
    for place in (parent, default, _MEMORY):
        _remove_abandoned(place)
    folder = _create_folder(parent, prefix)
    with _held_lock:
        for old in [old for old in _held if not old.exists()]:
            os.close(_held.pop(old))
        # A folder that cannot be locked is not marked as in use, but other processes never remove one without a lock.
        with suppress(OSError):
            _held[folder] = hold(folder)
    return folder


_held: dict[Path, int] = {}
"""The locks of the folders of this process."""
_held_lock = threading.Lock()
"""Held while `_held` is changed: threads of an app try programs at the same time."""


@cache
def _remove_abandoned(parent: Path) -> None:
    """Remove folders of this user whose process has ended; a folder without a lock belongs to another program."""
    for folder in parent.glob(f"{_PREFIX}*"):
        with suppress(OSError):
            if folder.lstat().st_uid == os.getuid() and is_held(folder) is False:
                remove_tree(folder)


@contextmanager
def create_temporary_home(prefix: str = _PREFIX) -> Iterator[Path]:
    """Return a context with a new home folder for temporary runs, which is deleted at its end.

    The name of the folder begins with the prefix.

    Raises:
        LogError: it cannot be created.
    """
    folder = create_owned_folder(prefix)
    try:
        yield folder
    finally:
        remove_tree(folder)


def _create_folder(parent: Path, prefix: str = "") -> Path:
    try:
        return Path(tempfile.mkdtemp(prefix=prefix, dir=parent))
    except OSError as error:
        reason = error.strerror or error
        raise LogError(
            f"no folder for temporary runs can be created: {reason}", file=str(parent)
        ) from error


def _find_parent() -> Path:
    default = Path(tempfile.gettempdir())
    try:
        space = os.statvfs(_MEMORY)
    except OSError:
        return default
    has_room = space.f_bavail * space.f_frsize >= _FREE_BYTES
    return _MEMORY if has_room and os.access(_MEMORY, os.W_OK) else default


class TemporaryRun:
    """The folder of one run, which is deleted at the end of a `with` block. A `RunHandle` uses it in place of a store.

    Args:
        parent: Where it is created; see `create_batch_folder`.

    Raises:
        LogError: it cannot be created.
    """

    def __init__(self, parent: Path) -> None:
        self.folder = _create_folder(parent)
        self._data: dict[str, Any] = {}
        """The contents of `run.json`: the program could change the file."""
        self._parts: tuple[PluggedPart, ...] = ()
        self._end: Ended | None = None

    def __enter__(self) -> TemporaryRun:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        remove_tree(self.folder)

    def create_run(
        self,
        program: Program,
        spec: RunSpec,
        field: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        live: bool = False,
    ) -> NewRun:
        """Write the `run.json` of a run that is about to start; return the run.

        The arguments are those of `RunStore.create_run`.

        Raises:
            LogError: it cannot be written.
        """
        created = datetime.now(UTC).isoformat(timespec="milliseconds")
        run_id = self.folder.name
        self._data = data = build_run_data(run_id, 0, created, program, spec, field, options, live)
        self._program, self._spec = program, spec
        file = self.folder / RUN_FILE
        try:
            file.write_text(json.dumps(data), "utf-8")
            return NewRun(run_id, 0, self.folder, hold(self.folder), data)
        except OSError as error:
            raise LogError(
                f"cannot be written: {error.strerror or error}", file=str(file)
            ) from error

    def finish(self, _run: NewRun, end: Ended) -> None:
        """Note the end of the run; nothing is written yet."""
        self._end = end

    def note_plugged(self, _run: NewRun, parts: Sequence[PluggedPart]) -> None:
        """Record which parts have been plugged in so far."""
        self._parts = tuple(parts)
        self._data["plugged"] = [part.to_plain() for part in parts]

    def forget(self, _run_id: str) -> None:
        """Do nothing: the folder is deleted at the end of the `with` block."""

    def load_run(self, folder: Path) -> StoredRun:
        """Return the run in the folder.

        Raises:
            LogError: the program has deleted it, or it is damaged.
        """
        if not folder.is_dir():
            raise LogError("its folder was deleted while it ran", file=str(folder))
        return open_run(folder, self._data, self._program, self._spec, self._parts, self._end)

    def write_end(self, end: Ended) -> None:
        """Write the end of the run to its folder, which is then as complete as that of a stored run.

        Raises:
            LogError: it cannot be written.
        """
        self._data["end"] = asdict(end)
        write_run_file(self.folder, self._data)

    def read_files(self, end: Ended) -> dict[str, bytes]:
        """Write the end of the run to its folder, and return all recorded files of the run by name.

        Raises:
            LogError: the end cannot be written.
        """
        self.write_end(end)
        names = (RUN_FILE, TELEMETRY_FILE, OUTPUT_FILE, *SIDE_FILES)
        paths = (self.folder / name for name in names)
        return {path.name: path.read_bytes() for path in paths if path.is_file()}
