"""Detects files that other programs change."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

PERIOD_S = 1.0
"""Seconds between two checks for changed files."""

_Stamp = tuple[int, int, int]


def _stamp(path: Path) -> _Stamp | None:
    """Return a value that changes when a file changes; None if there is no file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    # Editors write a new file and rename it: the new file has another inode, whatever its time and size.
    return status.st_mtime_ns, status.st_size, status.st_ino


class FileWatch:
    """Detects changed files, by one `stat` per file at each check; it reads no file."""

    def __init__(self) -> None:
        self._known: dict[Path, _Stamp | None] = {}

    def follow(self, paths: Iterable[Path]) -> None:
        """Watch only these files; a file that is watched already keeps its last known state."""
        self._known = {
            path: self._known[path] if path in self._known else _stamp(path) for path in paths
        }

    def note(self, path: Path) -> None:
        """Store the state of a file after the app itself has written it, so that `changed` does not return it."""
        if path in self._known:
            self._known[path] = _stamp(path)

    def changed(self) -> list[Path]:
        """Return the files that were made or changed since the last call, without deleted files."""
        changed_paths = []
        for path, known in self._known.items():
            now = _stamp(path)
            if now is not None and now != known:
                self._known[path] = now
                changed_paths.append(path)
        return changed_paths
