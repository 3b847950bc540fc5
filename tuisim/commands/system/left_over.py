"""What killed processes have left: folders and files that belong to no run, and that no living process uses."""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from tuisim.atomic import LEFT_OVER_S, PART_SUFFIX
from tuisim.config.folders import cache_folder
from tuisim.data_class import dataclass
from tuisim.runs.catalogue import CATALOGUE_FILE
from tuisim.runs.removal import remove_tree
from tuisim.runs.run_folder import RUN_FILE
from tuisim.runs.side_files import LOCK_FILE, is_held, is_locked
from tuisim.runs.store import REMOVED, RUNS_FOLDER
from tuisim.runs.temporary import PREFIX, places

_QUIET_S = 60.0
"""What was changed in the last minute may be in use, without anything that shows it."""
_PROCESSES = Path("/proc")


@dataclass(frozen=True, slots=True)
class LeftOver:
    """A file or a folder that is left over."""

    path: Path
    what: str
    """What it is, in words."""
    size_bytes: int


def left_over(home: Path) -> list[LeftOver]:
    """Return what is left over in a home folder, in the cache, and in the folders for temporary runs."""
    use = _Use()
    found = [*_of_runs(home / RUNS_FOLDER, use), *_half_written(home, use), *_temporary(use)]
    return [LeftOver(path, what, _size(path)) for path, what in sorted(found)]


def remove(found: LeftOver) -> None:
    """Remove what is left over.

    Raises:
        OSError: it cannot be removed.
    """
    try:
        if found.path.is_dir() and not found.path.is_symlink():
            remove_tree(found.path, ignore_errors=False)
        else:
            found.path.unlink()
    except FileNotFoundError:
        # Another process has been faster.
        return


class _Use:
    """Tells what living processes use."""

    def __init__(self) -> None:
        self._now_s = time.time()

    def is_free(self, path: Path) -> bool:
        """Return whether nobody seems to use a file or a folder that shows no owner."""
        try:
            age_s = self._now_s - path.lstat().st_mtime
        except OSError:
            return False
        if self._open is None:
            return age_s > LEFT_OVER_S
        return age_s > _QUIET_S and not any(
            one == str(path) or one.startswith(f"{path}{os.sep}") for one in self._open
        )

    def is_unlocked(self, folder: Path) -> bool:
        """Return whether no process holds a folder by its lock; one without a lock may be about to get it."""
        locks = [
            path for path in folder.glob(f"*{LOCK_FILE}*") if stat.S_ISREG(path.lstat().st_mode)
        ]
        return (
            self.is_free(folder) if not locks else all(is_locked(path) is False for path in locks)
        )

    @cached_property
    def _open(self) -> frozenset[str] | None:
        """The paths of all files that processes of this machine have open; None where that cannot be known."""
        if not (_PROCESSES / "self" / "fd").is_dir():
            return None
        found = set()
        for links in _PROCESSES.glob("[0-9]*/fd"):
            # Processes of others, and those that have just ended.
            with suppress(OSError):
                for link in links.iterdir():
                    with suppress(OSError):
                        found.add(os.readlink(link))
        return frozenset(found)


def _entries(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


def _of_runs(folder: Path, use: _Use) -> Iterator[tuple[Path, str]]:
    """Yield folders that are no runs, and half-written files of runs that are over."""
    for path in _entries(folder):
        if path.name.startswith(".") and path.name.endswith(REMOVED):
            yield path, "a removed run"
        elif path.is_symlink() or not path.is_dir():
            continue
        elif not os.path.lexists(path / RUN_FILE):
            if _is_run_id(path.name) and use.is_unlocked(path):
                yield path, "a run that did not begin"
        elif parts := list(_parts(path)):
            yield from (
                (part, "a half-written file")
                for part in parts
                if use.is_unlocked(path) and use.is_free(part)
            )


def _is_run_id(name: str) -> bool:
    """Return whether a folder has the name of a run; another one is not ours."""
    day, _, rest = name.partition("T")
    return day.isdecimal() and len(day) == 8 and "-" in rest


def _parts(folder: Path) -> Iterator[Path]:
    # Beside a new list of runs, SQLite keeps files of its own.
    for pattern in (f".*{PART_SUFFIX}", f".{CATALOGUE_FILE}.*{PART_SUFFIX}-*"):
        yield from folder.glob(pattern)


def _half_written(home: Path, use: _Use) -> Iterator[tuple[Path, str]]:
    inside = [
        path
        for path in _entries(home)
        if path.name != RUNS_FOLDER and path.is_dir() and not path.is_symlink()
    ]
    for folder in dict.fromkeys((home, *inside, *_entries(cache_folder()))):
        yield from ((part, "a half-written file") for part in _parts(folder) if use.is_free(part))


def _temporary(use: _Use) -> Iterator[tuple[Path, str]]:
    """Yield folders of temporary runs of this user."""
    for place in places():
        for path in _entries(place):
            if not path.name.startswith(PREFIX) or path.is_symlink() or not path.is_dir():
                continue
            # One without a lock is of an earlier version, or another program's.
            if path.lstat().st_uid == os.getuid() and is_held(path) is False:
                yield path, "temporary runs"


def _size(path: Path) -> int:
    """Return the space on the disk that a file, or a folder with all in it, takes."""
    found = 0
    for inner in (path, *(path.rglob("*") if path.is_dir() and not path.is_symlink() else ())):
        with suppress(OSError):
            found += inner.lstat().st_blocks * 512
    return found
