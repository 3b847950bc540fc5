"""Which files have changed on the disk since they were last looked at."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

PERIOD_S = 1.0
"""How often the app looks."""

_Stamp = tuple[int, int, int]


def _stamp(path: Path) -> _Stamp | None:
    """What tells one version of a file from the next, None while there is no file."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    # Editors write a new file and rename it: that has another inode, whatever its time and size.
    return found.st_mtime_ns, found.st_size, found.st_ino


class Watch:
    """Remembers files as they were. Looking costs one `stat` a file; nothing is read."""

    def __init__(self) -> None:
        self._known: dict[Path, _Stamp | None] = {}

    def follow(self, paths: Iterable[Path]) -> None:
        """Watch these files from now on, and no others; those already watched keep what is known of them."""
        self._known = {path: self._known[path] if path in self._known else _stamp(path) for path in paths}

    def note(self, path: Path) -> None:
        """Take a file as it is now: it was changed from here."""
        if path in self._known:
            self._known[path] = _stamp(path)

    def changed(self) -> list[Path]:
        """Return the files that are new or other than at the last look. One that is gone may come again."""
        found = []
        for path, known in self._known.items():
            now = _stamp(path)
            if now is not None and now != known:
                self._known[path] = now
                found.append(path)
        return found
