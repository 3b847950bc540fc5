"""The folders of a class, and the secret part of each link, which stays the same from one start to the next."""

from __future__ import annotations

import csv
import fcntl
import io
import json
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tuisim.atomic import make_private_folder, replacing
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError, ExportError
from tuisim.logs.csv_cells import harmless
from tuisim.regular_file import read_regular
from tuisim.web.gate import new_token

LINKS_FILE = ".links.json"
_HOMES, _LOCK_FILE = ".homes", ".lock"
_TOKEN = re.compile(r"[\w-]{32,100}", re.ASCII)
_MOST_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class StudentLink:
    """One student of the class."""

    name: str
    token: str
    """The secret part of the link."""
    folder: Path
    """The working folder: programs, exports and what is dropped on the page."""
    home: Path
    """The folder that stands for `TUISIM_HOME`: settings and stored runs."""


@dataclass(frozen=True, slots=True)
class ClassLinks:
    """Who has which link."""

    tutor: str
    """The secret part of the tutor's link."""
    students: tuple[StudentLink, ...]
    lock_fd: int
    """Held while the server runs: two of them would give a student two sessions."""


def open_class(folder: Path, names: Sequence[str]) -> ClassLinks:
    """Make the folders of a class where they are missing, and return its links; new names get new ones.

    The links of names that are not in the class now are kept for the time when they are again, but are not served.

    Args:
        folder: The folder of all folders, for its owner only.
        names: The names of the class.

    Raises:
        ConfigError: a folder cannot be made, another server uses it, or the file of links is damaged.
    """
    folder = Path(os.path.realpath(folder))
    try:
        make_private_folder(folder)
        lock_fd = _locked(folder)
        try:
            return _opened(folder, names, lock_fd)
        # Also when the command is interrupted.
        except BaseException:
            os.close(lock_fd)
            raise
    except OSError as error:
        raise ConfigError(
            f"cannot be used: {error.strerror or error}", file=str(error.filename or folder)
        ) from error


def _opened(folder: Path, names: Sequence[str], lock_fd: int) -> ClassLinks:
    file = folder / LINKS_FILE
    known = _read(file)
    tutor, tokens = known.get("tutor") or new_token(), {**known.get("students", {})}
    for name in names:
        tokens.setdefault(name, new_token())
    with replacing(file, owner_only=True, follow_links=False) as handle:
        handle.write(
            json.dumps({"tutor": tutor, "students": tokens}, ensure_ascii=False, indent=1).encode()
        )
    students = [
        StudentLink(name, tokens[name], folder / name, folder / _HOMES / name) for name in names
    ]
    for each in (path for student in students for path in (student.folder, student.home)):
        make_private_folder(each)
        if each.is_symlink():
            raise ConfigError("is a link; a student's folder must be one", file=str(each))
    return ClassLinks(tutor, tuple(students), lock_fd)


def _locked(folder: Path) -> int:
    descriptor = os.open(
        folder / _LOCK_FILE, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600
    )
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        hint = "end that one, or name another folder with --homes"
        raise ConfigError(
            "another server serves the class of this folder", hint, file=str(folder)
        ) from None
    return descriptor


def _read(file: Path) -> Mapping[str, Any]:
    """Return what the file of links says; empty if there is none."""
    try:
        data = read_regular(file, _MOST_BYTES)
    except FileNotFoundError:
        return {}
    try:
        match json.loads(data):
            case {"tutor": str(tutor), "students": dict(students)} if _are_tokens(
                [tutor, *students.values()]
            ):
                return {"tutor": tutor, "students": students}
    except (ValueError, RecursionError):
        pass
    raise ConfigError(
        "is no file of links, or a damaged one",
        "delete it: everybody then gets a new link",
        file=str(file),
    )


def _are_tokens(found: Sequence[object]) -> bool:
    """Return whether these are secrets, each of them another one."""
    return all(isinstance(one, str) and _TOKEN.fullmatch(one) for one in found) and len(
        {*found}
    ) == len(found)


def write_links(path: Path, rows: Sequence[tuple[str, str]]) -> None:
    """Write names and links as CSV that only its owner can read; an existing file is replaced.

    Raises:
        ExportError: it cannot be written.
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(
        [("name", "link"), *((harmless(name), link) for name, link in rows)]
    )
    try:
        with replacing(path, owner_only=True) as handle:
            handle.write(text.getvalue().encode())
    except OSError as error:
        raise ExportError(f"cannot write {path}: {error.strerror or error}") from error
