"""Records which files the program reads that existed before it, or that it looked for in vain.

They may come from an earlier run, and the same program may do something else without them.
"""

from __future__ import annotations

import builtins
import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from tuisim.engine.runs.side_files import (
    MAX_READS,
    FileRead,
    note_read,
    note_reads_left_out,
    read_state,
)
from tuisim.engine.runtime.modules import OWN_FILES, is_own
from tuisim.engine.runtime.patches.replacement import replace

MAX_KNOWN = 100_000
"""Number of opened files that are remembered."""
MAX_PATH = 4096
"""Longest path in characters: no system opens a file with a longer one."""
_SYSTEM = ("/usr", "/etc", "/proc", "/sys", "/dev")
_SHARED = "/dev/shm/"
_MODES = frozenset("rwxabt+")


def _get_argument(index: int, name: str, given: Sequence[Any], named: Mapping[str, Any]) -> Any:
    """Return an argument of a call by its position or its name; None if the call lacks it.

    The real function, which is called afterwards, raises the error about the missing argument.

    Args:
        index: The position of the argument.
        name: The name of the argument.
        given: The positional arguments of the call.
        named: The keyword arguments of the call.
    """
    return given[index] if index < len(given) else named.get(name)


class FileReads:
    """A record of the files that a program reads. It follows the files that the program opens."""

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._run_folder = os.sep
        self._ignored: tuple[str, ...] = ()
        self._program_file = ""
        self._seen: set[str] = set()
        self._made: set[str] = set()
        """Files that the run has created itself: reading them is not recorded."""
        self._before: dict[str, FileRead] = {}
        """Files to which the run has added something, as they were before."""
        self._noted = self._left_out = 0

    def patch(self) -> None:
        """Replace the functions that open and rename files by functions that also keep this record."""
        real_open = builtins.open
        real_os_open = os.open

        def open_noted(*given: Any, **named: Any) -> Any:
            if self._folder is not None:
                self._note_open(
                    *(
                        _get_argument(index, name, given, named)
                        for index, name in enumerate(("file", "mode"))
                    )
                )
            return real_open(*given, **named)

        def os_open_noted(*given: Any, **named: Any) -> Any:
            # With `dir_fd`, the folder of the file is not known.
            if self._folder is not None and named.get("dir_fd") is None:
                self._note_os_open(
                    *(
                        _get_argument(index, name, given, named)
                        for index, name in enumerate(("path", "flags"))
                    )
                )
            return real_os_open(*given, **named)

        replace(builtins, "open", open_noted)
        replace(os, "open", os_open_noted)
        for name in ("rename", "replace"):
            replace(os, name, self._note_move(getattr(os, name)))

    def _note_move(self, real: Any) -> Any:
        def move(*given: Any, **named: Any) -> None:
            real(*given, **named)
            if (
                self._folder is not None
                and len(given) == 2
                and not named
                and self._resolve_path(given[0]) in self._made
            ):
                self._make(self._resolve_path(given[1]))

        return move

    def begin(self, folder: Path, own_folder: str, program_file: str) -> None:
        """Begin to record which files the program reads.

        Args:
            folder: The run folder.
            own_folder: The folder of the program.
            program_file: The program itself, which is not recorded as a file that it reads.
        """
        self._program_file = os.path.abspath(program_file)
        around = {
            place
            for place in (sys.prefix, sys.base_prefix)
            if not f"{own_folder}{os.sep}".startswith(place)
        }
        self._run_folder = f"{folder}{os.sep}"
        self._ignored = tuple(f"{place}{os.sep}" for place in (*_SYSTEM, *sorted(around)))
        self._folder = folder

    def end(self) -> None:
        """Record how many files the program has read besides those that are listed."""
        if self._folder is not None and self._left_out:
            # If the number cannot be written, the list of files is still valid.
            with suppress(OSError):
                note_reads_left_out(self._folder, self._left_out)

    def _note_open(self, file: Any, mode: Any) -> None:
        mode = "r" if mode is None else mode
        if isinstance(mode, str) and _MODES.issuperset(mode):
            makes = "w" in mode or "x" in mode
            self._note_opened(
                file, "r" in mode or "+" in mode, makes or "a" in mode or "+" in mode, makes
            )

    def _note_os_open(self, path: Any, flags: Any) -> None:
        if isinstance(flags, int):
            access = flags & os.O_ACCMODE
            makes = bool(flags & (os.O_TRUNC | os.O_EXCL))
            self._note_opened(path, access != os.O_WRONLY, access != os.O_RDONLY or makes, makes)

    def _note_opened(self, file: Any, reads: bool, writes: bool, makes: bool) -> None:
        path = self._resolve_path(file)
        if not path or path in self._made or path in self._seen or not self._is_data(path):
            return
        if makes:
            self._make(path)
            return
        was = self._before.get(path) or read_state(path)
        if was is None:
            return
        if writes and not was.there:
            self._make(path)
        elif reads:
            self._note(was)
        elif len(self._before) < MAX_KNOWN:
            self._before[path] = was

    def _make(self, path: str) -> None:
        if len(self._made) < MAX_KNOWN:
            self._made.add(path)

    @staticmethod
    def _resolve_path(file: Any) -> str:
        """Return the absolute path of a file; empty for a descriptor, and for anything else that is not a path."""
        if isinstance(file, os.PathLike):
            file = os.fspath(file)
        if not isinstance(file, str | bytes) or len(file) > MAX_PATH:
            return ""
        try:
            return os.path.abspath(os.fsdecode(file))
        except OSError:
            # The working directory is gone.
            return ""

    def _is_data(self, path: str) -> bool:
        if path.startswith(self._run_folder) or (
            path.startswith(self._ignored) and not path.startswith(_SHARED)
        ):
            return False
        return is_own(path) and path != self._program_file and path not in OWN_FILES

    def _note(self, read: FileRead) -> None:
        assert self._folder is not None
        if len(self._seen) >= MAX_KNOWN:
            return
        self._seen.add(read.path)
        if self._noted >= MAX_READS:
            self._left_out += 1
            return
        self._noted += 1
        # If the disk is full, the recordings of the run end it and report that.
        with suppress(OSError):
            note_read(self._folder, read)
