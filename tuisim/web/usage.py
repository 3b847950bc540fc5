"""What the apps of a class use, with the programs that they run: memory, processes, and space for files."""

from __future__ import annotations

import errno
import os
import resource
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from tuisim.data_class import dataclass
from tuisim.runs.child.isolation import MOST_BYTES, MOST_FILES

MOST_MEMORY_BYTES = 1 << 30
"""Memory of an app and its programs together, without what they share with files."""
MOST_PROCESSES, MOST_THREADS = 24, 1_000
_PAGE_BYTES = resource.getpagesize()
_BLOCK_BYTES = 512
_HIDDEN = (errno.ENAMETOOLONG, errno.EACCES)
"""Errors of folders that are nested too deep to be looked at, or that a program has closed."""


@dataclass(slots=True)
class Usage:
    """What an app and its programs use."""

    memory_bytes: int = 0
    processes: int = 0
    threads: int = 0

    @property
    def exceeded(self) -> str:
        """Which limit is exceeded, as a sentence; empty if none is."""
        if self.memory_bytes > MOST_MEMORY_BYTES:
            return (
                f"The session has ended: it took more than {MOST_MEMORY_BYTES >> 30} GiB of memory."
            )
        if self.processes > MOST_PROCESSES:
            return f"The session has ended: it had more than {MOST_PROCESSES} processes."
        if self.threads > MOST_THREADS:
            return f"The session has ended: it had more than {MOST_THREADS:,} threads."
        return ""


def usages(pids: Iterable[int]) -> Mapping[int, Usage]:
    """Return what processes use, each with all that it has started; nothing where the system does not tell."""
    found: dict[int, tuple[int, int, int]] = {}
    with suppress(OSError):
        for name in os.listdir("/proc"):
            if name.isdigit():
                with suppress(OSError, ValueError, IndexError):
                    found[int(name)] = _of(name)
    started: dict[int, list[int]] = {}
    for pid, (parent, _, _) in found.items():
        started.setdefault(parent, []).append(pid)
    used = {}
    for pid in pids:
        used[pid] = usage = Usage()
        left = [pid] if pid in found else []
        while left:
            _, memory, threads = found[one := left.pop()]
            left += started.get(one, ())
            usage.memory_bytes += memory
            usage.processes += 1
            usage.threads += threads
    return used


def _of(pid: str) -> tuple[int, int, int]:
    """Return the parent of a process, its memory in bytes, and its threads."""
    # Its name, in parentheses, may hold anything.
    fields = Path(f"/proc/{pid}/stat").read_text("utf-8", "replace").rpartition(")")[2].split()
    _, resident, shared = map(int, Path(f"/proc/{pid}/statm").read_text("ascii").split()[:3])
    return int(fields[1]), (resident - shared) * _PAGE_BYTES, int(fields[17])


def files_exceeded(folders: Iterable[Path]) -> str:
    """Return which limit the files of a student exceed, as a sentence; empty if none."""
    files = size = 0
    left = [*map(str, folders)]
    while left:
        try:
            with os.scandir(left.pop()) as entries:
                for entry in entries:
                    # Programs write there: what is gone takes no space.
                    with suppress(FileNotFoundError):
                        files, size = (
                            files + 1,
                            size + _BLOCK_BYTES * entry.stat(follow_symlinks=False).st_blocks,
                        )
                    if entry.is_dir(follow_symlinks=False):
                        left.append(entry.path)
        except OSError as error:
            if error.errno in _HIDDEN:
                return "The session has ended: a folder of yours cannot be looked at. Ask your tutor to remove it."
        if files > MOST_FILES or size > MOST_BYTES:
            return (
                f"The session has ended: your files are more than {MOST_FILES:,}, or larger than "
                f"{MOST_BYTES >> 30} GiB together. Ask your tutor to make room."
            )
    return ""
