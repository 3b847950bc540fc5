"""The tree of device files: which paths it has, and which entry is at each."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable
from typing import Any

from tuisim.engine.shim.device_files import CLASSES_FOLDER, DeviceFiles
from tuisim.engine.shim.files.entries import AttributeFile, DeviceFile, Folder

INPUT_FOLDER = "/dev/input"
FOLDERS = (CLASSES_FOLDER, INPUT_FOLDER)
"""Folders in which a program sees only the files of the simulated brick, whatever files this computer has there."""
MAYBE_OURS = ("/sys/", "/dev/", "/tmp/current_platform", "//")
"""The beginnings of all paths that can be those of the brick's files; any other path is one of this computer."""

Entry = Folder | DeviceFile


class DeviceTree:
    """The tree of all device files of a brick.

    Args:
        brick: The devices.
        files: The files that are not attributes of devices.
    """

    def __init__(self, brick: DeviceFiles, files: Iterable[DeviceFile]) -> None:
        self._brick = brick
        self._files = {file.path: file for file in files}
        self._attributes: dict[str, AttributeFile] = {}

    def find(self, path: Any) -> Entry | None:
        """Return the file or folder of the brick at a path; None if the path is of this computer, or is no path.

        Raises:
            FileNotFoundError: the path is of the brick, and nothing is there.
        """
        text = path if isinstance(path, str) else _text_of(path)
        if text is None or not text.startswith(MAYBE_OURS):
            return None
        text = os.path.normpath(text)
        if text.startswith("//"):
            text = text[1:]
        if (file := self._files.get(text)) is not None:
            return file
        if not any(text == folder or text.startswith(f"{folder}/") for folder in FOLDERS):
            return None
        entry = self._attribute(text) or self._folder(text)
        if entry is None:
            raise self._missing(text)
        return entry

    def _attribute(self, path: str) -> AttributeFile | None:
        at = path.split("/", 5)
        if (
            len(at) < 6
            or (device := self._brick.by_path.get("/".join(at[:5]))) is None
            or not device.has(at[5])
        ):
            return None
        if path not in self._attributes:
            self._attributes[path] = AttributeFile(path, device, at[5])
        return self._attributes[path]

    def _folder(self, path: str) -> Folder | None:
        below = path + "/"
        paths: list[str] = [f"{CLASSES_FOLDER}/{name}" for name in self._brick.classes] + list(
            self._files
        )
        for device_path, device in self._brick.by_path.items():
            paths.append(device_path)
            if (device_path + "/").startswith(below) or path.startswith(device_path + "/"):
                paths += [f"{device_path}/{name}" for name in device.attributes()]
        names = {
            one[len(below) :].partition("/")[0]: None for one in paths if one.startswith(below)
        }
        return Folder(path, tuple(names)) if names or path in paths else None

    def _missing(self, path: str) -> FileNotFoundError:
        """Return the error for a missing file, with a note that lists the files of its folder."""
        error = FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
        folder = path
        while (found := self._folder(folder)) is None:
            folder = os.path.dirname(folder)
        error.add_note(f"{folder} has: {', '.join(sorted(found.names)) or 'nothing'}")
        return error


def _text_of(path: Any) -> str | None:
    """Return a path as text; None for anything that is not a path, such as a descriptor."""
    if isinstance(path, bytes | os.PathLike):
        return os.fsdecode(path)
    return None
