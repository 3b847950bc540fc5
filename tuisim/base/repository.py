"""Finds a module that Python does not find, elsewhere in the repository of the program."""

from __future__ import annotations

import os
from collections.abc import Iterator

_MAX_LEVELS_UP = 8
_MAX_DEPTH = 5
_MAX_FOLDERS = 200


def find_module_folder(name: str, folder: str) -> str:
    """Search the repository that contains a program for a module that the program imports; return the module's folder.

    The result is a path relative to `folder`. It is empty if no folder, or only `folder` itself, contains the module.

    Args:
        name: The name of the module, without dots.
        folder: The folder of the program.
    """
    folder = os.path.abspath(folder)
    if not os.path.isdir(folder):
        return ""
    for place in _folders_in(_root_of(folder)):
        if place != folder and (
            os.path.isfile(os.path.join(place, f"{name}.py"))
            or os.path.isfile(os.path.join(place, name, "__init__.py"))
        ):
            return os.path.relpath(place, folder)
    return ""


def _root_of(folder: str) -> str:
    """Return the root folder of the repository that contains `folder`; without a repository, the parent of `folder`."""
    root = folder
    for _ in range(_MAX_LEVELS_UP):
        if os.path.exists(os.path.join(root, ".git")):
            return root
        root = os.path.dirname(root)
    return os.path.dirname(folder)


def _folders_in(root: str) -> Iterator[str]:
    """Yield the folder `root` and its subfolders, level by level; hidden folders and links are left out."""
    level = [root]
    seen = 0
    for _ in range(_MAX_DEPTH):
        below: list[str] = []
        for place in level:
            yield place
            seen += 1
            if seen >= _MAX_FOLDERS:
                return
            try:
                names = sorted(os.listdir(place))
            except OSError:
                continue
            paths = (os.path.join(place, name) for name in names if not name.startswith("."))
            below += [path for path in paths if os.path.isdir(path) and not os.path.islink(path)]
        level = below
