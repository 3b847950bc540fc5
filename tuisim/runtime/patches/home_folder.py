"""The home folder of the brick: files under `/home/robot` are those beside the program."""

from __future__ import annotations

import builtins
import io
import os
from collections.abc import Callable, Sequence
from typing import Any

from tuisim.runtime.patches.replacement import replace

HOME = "/home/robot"
_OF_FILES = ("open", "stat", "lstat", "access")
_OF_FOLDERS = ("listdir", "scandir", "chdir")
"""Functions of `os` that take the path of a folder: one that is not there is that of the program."""


class HomeFolder:
    """Lets the functions that take paths find files of the brick's home folder beside the program.

    Args:
        own_folder: Returns the folder of the program.
    """

    def __init__(self, own_folder: Callable[[], str]) -> None:
        self._own_folder = own_folder

    def patch(self) -> None:
        """Replace the functions."""
        self._wrap(builtins, "open", self._file)
        vars(io)["open"] = builtins.open
        for name in _OF_FILES:
            self._wrap(os, name, self._file)
        for name in _OF_FOLDERS:
            self._wrap(os, name, self._folder)

    @staticmethod
    def _wrap(module: Any, name: str, moved: Callable[[Any], Any]) -> None:
        real = getattr(module, name)

        def call(*given: Any, **named: Any) -> Any:
            return real(moved(given[0]), *given[1:], **named) if given else real(**named)

        replace(module, name, call)

    def _file(self, path: Any) -> Any:
        """Return the path of a file; one that is not there is to be made in the program's folder."""
        if (parts := self._parts(path)) is None:
            return path
        if known := self._known(parts):
            return known
        own_folder = self._own_folder()
        for first in range(len(parts) - 1):
            if os.path.isdir(folder := os.path.join(own_folder, *parts[first:-1])):
                return os.path.join(folder, parts[-1])
        return os.path.join(own_folder, parts[-1])

    def _folder(self, path: Any) -> Any:
        """Return the path of a folder; one that is not there is that of the program."""
        parts = self._parts(path)
        return path if parts is None else self._known(parts) or self._own_folder()

    def _known(self, parts: Sequence[str]) -> str:
        """Return the path that is there; the program's folder may be anywhere in the home folder of the brick."""
        ends = (parts[first:] for first in range(len(parts)))
        paths = (os.path.join(self._own_folder(), *end) for end in ends)
        return next((path for path in paths if os.path.exists(path)), "")

    def _parts(self, path: Any) -> list[str] | None:
        """Return the parts of a path in the home folder; None for another one, or if the program itself is there."""
        text = path if path.__class__ is str else _text_of(path)
        if text is None or not text.startswith(HOME):
            return None
        text = os.path.normpath(text)
        if not _is_in_home(text) or _is_in_home(self._own_folder()):
            return None
        return text[len(HOME) + 1 :].split(os.sep)


def _text_of(path: Any) -> str | None:
    """Return the text of a path that is an object; None if it is something else, such as a descriptor."""
    if isinstance(path, os.PathLike):
        text = os.fspath(path)
        return text if isinstance(text, str) else None
    return None


def _is_in_home(path: str) -> bool:
    return path == HOME or path.startswith(f"{HOME}{os.sep}")
