"""Copies of what students have handed in: each run gets its own, so that no program changes what others see."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.base.errors import LogError
from tuisim.base.regular_file import open_regular, read_regular
from tuisim.base.source import Program
from tuisim.tasks.marks.files import LEFT_OUT, copy_file, copy_tree
from tuisim.tasks.marks.students import SUFFIX, Student

_MAX_MODULES_BYTES = 1 << 20


def copy_files(student: Student, place: Path) -> Path:
    """Copy a student's files into a new folder, `place`, and return it.

    Files that cannot be read are left out, as the program could not read them either.

    Raises:
        LogError: the copy cannot be written.
    """
    try:
        if os.path.isdir(student.path):
            copy_tree(student.path, place)
        else:
            place.mkdir()
            copy_file(student.path, place / student.main)
    except OSError as error:
        raise LogError(f"its copy cannot be written: {error.strerror or error}") from error
    return place


def build_program(student: Student, folder: Path, **changes: Any) -> Program:
    """Return a student's main program, which runs in a folder with a copy of the student's files.

    Args:
        student: The student.
        folder: The folder, which becomes the working directory.
        **changes: Other attributes of the program.
    """
    assert student.source is not None
    program = student.source.program
    if program.module_folder:
        # The program is a cell of a notebook, which has no file of its own.
        return replace(program, module_folder=str(folder), working_directory=str(folder), **changes)
    return replace(
        program, path=str(folder / student.main), working_directory=str(folder), **changes
    )


def compute_digest(student: Student) -> str:
    """Return a hash of the names and contents of a student's files, hexadecimal."""
    digest = hashlib.sha256()
    for path in _list_files(student.path):
        relative = os.path.relpath(path, student.path.parent)
        digest.update(os.fsencode(relative) + b"\0")
        try:
            # A link is hashed by its target's path, since the target itself may not be the student's file.
            if path.is_symlink():
                digest.update(hashlib.sha256(os.fsencode(os.readlink(path))).digest())
            else:
                with open_regular(path, follow_links=True) as file:
                    content = hashlib.file_digest(file, "sha256")  # type: ignore[arg-type]
                    digest.update(content.digest())
        except OSError as error:
            digest.update(str(error.errno).encode())
    return digest.hexdigest()


def read_modules(student: Student) -> Iterator[str]:
    """Yield the texts of a student's main program and other Python files, up to the size that is compared."""
    yield student.text
    left = _MAX_MODULES_BYTES
    for path in _list_files(student.path) if os.path.isdir(student.path) else ():
        if path.suffix == SUFFIX and path != student.path / student.main:
            with suppress(OSError):
                data = read_regular(path, left)
                left -= len(data)
                yield data.decode("utf-8", "replace")


def _list_files(path: Path) -> Iterator[Path]:
    if not os.path.isdir(path):
        yield path
        return
    for folder, folders, names in os.walk(path):
        left_out = LEFT_OUT(folder, folders)
        folders[:] = sorted(name for name in folders if name not in left_out)
        # Only regular files are read: a named pipe or a device would block.
        yield from (file for name in sorted(names) if os.path.isfile(file := Path(folder, name)))
