"""The home folder of the brick: files under `/home/robot` are those beside the program."""

from __future__ import annotations

import builtins
import io
import os
from collections.abc import Callable
from typing import Any

from tuisim.engine.brick_home import HOME, find_beside, parts_in_home, place_folder
from tuisim.engine.runtime.patches.replacement import replace

_FILE_CALLS = ("open", "stat", "lstat", "access")
_FOLDER_CALLS = ("listdir", "scandir", "chdir")
"""Functions of `os` that take the path of a folder: one that is not there is that of the program."""


class HomeFolder:
    """Makes functions that take paths find files of the brick's home folder beside the program.

    Args:
        own_folder: Returns the folder of the program.
    """

    def __init__(self, own_folder: Callable[[], str]) -> None:
        self._own_folder = own_folder

    def patch(self) -> None:
        """Replace the functions."""
        self._wrap(builtins, "open", self._find_file)
        vars(io)["open"] = builtins.open
        for name in _FILE_CALLS:
            self._wrap(os, name, self._find_file)
        for name in _FOLDER_CALLS:
            self._wrap(os, name, self._find_folder)

    @staticmethod
    def _wrap(module: Any, name: str, moved: Callable[[Any], Any]) -> None:
        real = getattr(module, name)

        def call(*given: Any, **named: Any) -> Any:
            return real(moved(given[0]), *given[1:], **named) if given else real(**named)

        replace(module, name, call)

    def _find_file(self, path: Any) -> Any:
        """Return the real path of a file; a missing file of the home folder will be created in the program's folder."""
        if not (text := _parse_home_path(path)):
            return path
        own_folder = self._own_folder()
        if (parts := parts_in_home(text, own_folder)) is None:
            return path
        if known := find_beside(parts, own_folder):
            return known
        for first in range(len(parts) - 1):
            if os.path.isdir(folder := os.path.join(own_folder, *parts[first:-1])):
                return os.path.join(folder, parts[-1])
        return os.path.join(own_folder, parts[-1])

    def _find_folder(self, path: Any) -> Any:
        """Return the real path of a folder; a missing folder of the home folder is the program's folder."""
        return place_folder(text, self._own_folder()) if (text := _parse_home_path(path)) else path


def _parse_home_path(path: Any) -> str:
    """Return a path in the brick's home folder as text; empty for any other path, and for a descriptor."""
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    return text if isinstance(text, str) and text.startswith(HOME) else ""
