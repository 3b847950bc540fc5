"""The home folder of the brick: files that a program looks for under `/home/robot` lie in its own folder."""

from __future__ import annotations

import os
from collections.abc import Sequence

HOME = "/home/robot"


def parts_in_home(path: str, own_folder: str) -> list[str] | None:
    """Return the parts of a path in the brick's home folder, such as `logs` and `a.csv` for `/home/robot/logs/a.csv`.

    Return None for a path outside this folder. If the program itself is in a folder `/home/robot` of this computer, the
    result is always None.
    """
    if not path.startswith(HOME):
        return None
    path = os.path.normpath(path)
    if not _is_in_home(path) or _is_in_home(own_folder):
        return None
    return path[len(HOME) + 1 :].split(os.sep)


def find_beside(parts: Sequence[str], own_folder: str) -> str:
    """Return the file or folder in the program's folder for a path in the brick's home folder; empty if none exists.

    The home folder may contain the program's folder at any depth. So for the path `a/b/c` in the home folder, `a/b/c`
    is looked for in the program's folder, then `b/c`, then `c`.

    Args:
        parts: The parts of the path below the home folder, such as `a`, `b` and `c`.
        own_folder: The program's folder.
    """
    ends = (parts[first:] for first in range(len(parts)))
    paths = (os.path.join(own_folder, *end) for end in ends)
    return next((path for path in paths if os.path.exists(path)), "")


def place_folder(path: str, own_folder: str) -> str:
    """Return the folder on this computer that stands for a folder that the program names.

    A path outside the brick's home folder is returned unchanged. For a path in it, the result is the matching folder in
    the program's folder, or else the program's folder itself.
    """
    parts = parts_in_home(path, own_folder)
    return path if parts is None else find_beside(parts, own_folder) or own_folder


def _is_in_home(path: str) -> bool:
    return path == HOME or path.startswith(f"{HOME}{os.sep}")
