"""Files of students: copies have only regular files, without their holes; a zip is read as the folder that it is."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import zipfile
import zlib
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from tuisim.base.errors import ConfigError, LogError
from tuisim.base.folders import remove_tree
from tuisim.base.regular_file import open_regular
from tuisim.engine.runs.child.isolation import MOST_FILES

LEFT_OUT = shutil.ignore_patterns(
    *("__pycache__", "__MACOSX", "._*", ".DS_Store", ".git", ".venv", "venv", "node_modules")
)
"""Names in a hand-in that do not come from the student, such as `__MACOSX`."""
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS)
"""Codes of errors that concern the copy, not the student's file."""
_PIECE = 1 << 20
_LOOSE_BYTES = 64 << 20
_MAX_RATIO = 100
"""A zip may unpack to so many bytes, or so many times its size: each of a class could fill the disk of all others."""
_ODD_ZIP = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    OSError,
    RuntimeError,
    ValueError,
)
"""Exceptions of damaged, encrypted and unusual zips."""


def copy_tree(folder: Path, place: Path) -> None:
    """Copy a folder's regular files, and its links as links, into a new folder, `place`; all copies are writable.

    Files that cannot be read are left out, as the program could not read them either.

    Raises:
        LogError, OSError: the copy cannot be written.
    """
    pending = [(folder, place)]
    while pending:
        source, target = pending.pop()
        target.mkdir(exist_ok=True)
        names = []
        with suppress(OSError):
            names = os.listdir(source)
        for name in set(names) - LEFT_OUT(str(source), names):
            path = source / name
            mode = path.lstat().st_mode
            if stat.S_ISLNK(mode):
                os.symlink(os.readlink(path), target / name)
            elif stat.S_ISDIR(mode):
                pending.append((path, target / name))
            elif stat.S_ISREG(mode):
                copy_file(path, target / name)


def copy_file(source: Path, target: Path) -> None:
    """Copy a regular file; a file that cannot be read is left out.

    Holes in the file, which are zeros that take no space on the disk, stay holes in the copy.

    Raises:
        LogError: the copy cannot be written.
    """
    try:
        with open_regular(source) as file, open(target, "wb") as copy:
            size = os.fstat(file.fileno()).st_size
            place = 0
            while place < size:
                start, stop = _find_data(file, place, size)
                file.seek(start)
                copy.seek(start)
                while start < stop and (piece := file.read(min(_PIECE, stop - start))):
                    copy.write(piece)
                    start += len(piece)
                place = stop
            copy.truncate(size)
    except OSError as error:
        if error.errno in _FULL:
            raise LogError(f"its copy cannot be written: {error.strerror}") from error


def _find_data(file: BinaryIO, place: int, size: int) -> tuple[int, int]:
    """Return the start and the end of the next data in a file, in bytes; both are `size` if no data follow.

    The file may have holes before and after the data: zeros that take no space on the disk.

    Args:
        file: The file.
        place: The position from which to search.
        size: The size of the file in bytes.
    """
    try:
        start = os.lseek(file.fileno(), place, os.SEEK_DATA)
        return start, min(os.lseek(file.fileno(), start, os.SEEK_HOLE), size)
    except OSError as error:
        # ENXIO means that no data follow; other errors, that the file system does not support holes.
        return (size, size) if error.errno == errno.ENXIO else (place, size)


def unpack_zip(path: Path, place: Path, max_bytes: int) -> None:
    """Unpack the regular files of a zip into a new folder.

    Args:
        path: The zip.
        place: The new folder.
        max_bytes: The largest total size of the files.

    Raises:
        ConfigError: the file is no zip, is too large, or has links or paths out of its folder.
    """
    try:
        with open_regular(path, follow_links=True) as file, zipfile.ZipFile(file) as archive:
            _check_density(archive, os.fstat(file.fileno()).st_size)
            _unpack(archive, place, max_bytes)
    except _ODD_ZIP as error:
        remove_tree(place)
        reason = error.strerror if isinstance(error, OSError) else error
        raise ConfigError(f"cannot be unpacked: {reason}", file=path.name) from error


def _check_density(archive: zipfile.ZipFile, packed_bytes: int) -> None:
    size = sum(entry.file_size for entry in archive.infolist())
    if size > max(_LOOSE_BYTES, _MAX_RATIO * packed_bytes):
        raise ValueError(f"it unpacks to more than {_MAX_RATIO} times its size")


def _unpack(archive: zipfile.ZipFile, place: Path, max_bytes: int) -> None:
    if len(archive.infolist()) > MOST_FILES:
        raise ValueError(f"it has more than {MOST_FILES:,} files")
    if sum(entry.file_size for entry in archive.infolist()) > max_bytes:
        raise ValueError(f"it has more than {max_bytes >> 20:,} MiB")
    place.mkdir()
    left = max_bytes
    for entry in archive.infolist():
        inside = PurePosixPath(entry.filename.replace("\\", "/"))
        if inside.is_absolute() or ".." in inside.parts:
            raise ValueError(f"{entry.filename} leads out of it")
        mode = stat.S_IFMT(entry.external_attr >> 16)
        if mode not in (0, stat.S_IFREG, stat.S_IFDIR):
            raise ValueError(f"{entry.filename} is a link or no file")
        if any(LEFT_OUT("", [part]) for part in inside.parts):
            continue
        target = place / inside
        target.parent.mkdir(parents=True, exist_ok=True)
        if entry.is_dir() or mode == stat.S_IFDIR:
            target.mkdir(exist_ok=True)
            continue
        with archive.open(entry) as file, open(target, "wb") as copy:
            while piece := file.read(_PIECE):
                left -= len(piece)
                if left < 0:
                    raise ValueError(f"it has more than {max_bytes >> 20:,} MiB")
                copy.write(piece)
