"""The files that visitors bring: written to the working directory piece by piece, so that they take no memory."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import AsyncIterable
from itertools import count
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

from tuisim.base.errors import ConfigError

MAX_FILE_BYTES = 64 << 20
"""The size of the largest file that a visitor can bring."""
MAX_BYTES = 1 << 30
"""The most bytes of all files together that visitors can bring while a server runs."""
_MAX_NAME_BYTES = 200
_PIECE = 1 << 20


class Uploads:
    """Stores the files that visitors upload, within a limit of total size."""

    def __init__(self) -> None:
        self._used_bytes = 0

    async def take(self, folder: Path, name: str, content: AsyncIterable[bytes]) -> Path:
        """Store an uploaded file in a folder and return its path; if another file has its name, a number is added.

        Raises:
            ConfigError: the name has parts of a path or is hidden, there is no room, or the file cannot be written.
        """
        _check_name(name)
        size = 0
        path = None
        try:
            # The file has no name yet, so nothing remains of it if this process is killed.
            with TemporaryFile(dir=folder) as file:
                async for piece in content:
                    size = size + len(piece)
                    self._used_bytes = self._used_bytes + len(piece)
                    self._check_room(size)
                    await asyncio.to_thread(file.write, piece)
                path = await asyncio.to_thread(keep_file, folder, name, file)
        except ConnectionError:
            raise
        except OSError as error:
            raise ConfigError(f"{name} cannot be written: {error.strerror or error}") from error
        finally:
            if path is None:
                self._used_bytes -= size
        return path

    def _check_room(self, size: int) -> None:
        if size > MAX_FILE_BYTES:
            raise ConfigError(f"larger than {MAX_FILE_BYTES >> 20} MB")
        if self._used_bytes > MAX_BYTES:
            raise ConfigError(
                f"no room: {MAX_BYTES >> 30} GB of files have been dropped on this server"
            )


def _check_name(name: str) -> None:
    # Hidden files are refused, as other programs may read settings from them.
    if (
        not name.isprintable()
        or set("/\\") & set(name)
        or name.startswith(".")
        or not 0 < len(name.encode("utf-8", "replace")) <= _MAX_NAME_BYTES
    ):
        raise ConfigError(
            f"not a name for a file: {name!r}",
            "letters, digits and a suffix, such as lab.py",
            key="name",
        )


def keep_file(folder: Path, name: str, content: IO[bytes]) -> Path:
    """Store a file in a folder, and return its path.

    A file with the same name and the same content is not stored again. If its content differs, a number is added to the
    new file's name.

    Raises:
        OSError: it cannot be written.
    """
    stem = Path(name).stem
    suffix = Path(name).suffix
    for number in count(1):
        path = folder / (name if number == 1 else f"{stem}-{number}{suffix}")
        content.seek(0)
        try:
            with path.open("xb") as file:
                try:
                    shutil.copyfileobj(content, file, _PIECE)
                except OSError:
                    path.unlink()
                    raise
            return path
        except FileExistsError:
            if path.is_file() and not path.is_symlink() and _has_content(path, content):
                return path
    raise AssertionError


def _has_content(path: Path, content: IO[bytes]) -> bool:
    """Return whether a file contains the same bytes as `content`."""
    with path.open("rb") as file:
        while piece := content.read(_PIECE):
            if file.read(_PIECE) != piece:
                return False
        return not file.read(1)
