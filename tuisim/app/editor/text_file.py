"""Program files, read and written back in their encoding and line ends; drafts of unsaved text, in case of a crash."""

from __future__ import annotations

import codecs
import hashlib
import io
import json
import os
import re
import stat
import time
import tokenize
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import programs_folder, session_folder
from tuisim.base.regular_file import read_regular
from tuisim.base.source import decode_source
from tuisim.programs.program_file import MAX_PROGRAM_BYTES


@dataclass(frozen=True, slots=True)
class TextFormat:
    """The encoding and the line ends of a program file, with which its text is written back."""

    encoding: str = "utf-8"
    """Python's name of the encoding; `utf-8` also for a file with a byte order mark."""
    has_mark: bool = False
    """Whether the file begins with a byte order mark."""
    newline: str = "\n"
    """The line end that most lines of the file have."""


def read_text(path: Path) -> tuple[str, TextFormat]:
    """Return a program's text with newlines as line ends, and its format.

    Raises:
        ConfigError: the file cannot be read, or is not Python text.
    """
    try:
        data = read_regular(path, MAX_PROGRAM_BYTES, follow_links=True)
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(path)) from None
    text, encoding = decode_source(data, str(path))
    ends = {end: len(re.findall(pattern, text)) for end, pattern in _ENDS.items()}
    form = TextFormat(
        encoding.removesuffix("-sig"),
        data.startswith(codecs.BOM_UTF8),
        max(ends, key=lambda end: ends[end]),
    )
    return text.replace("\r\n", "\n").replace("\r", "\n"), form


_ENDS = {"\n": r"(?<!\r)\n", "\r\n": r"\r\n", "\r": r"\r(?!\n)"}


def write_text(path: Path, text: str, form: TextFormat) -> None:
    """Write a program completely or not at all; an existing file keeps its permissions, and a link stays a link.

    Raises:
        ConfigError: the file cannot be written, or its encoding lacks a character of the text.
    """
    data = (codecs.BOM_UTF8 if form.has_mark else b"") + _encode_text(text, form, path)
    try:
        mode = stat.S_IMODE(path.stat().st_mode) if os.path.exists(path) else None
        with replacing(path) as file:
            if mode is not None:
                os.fchmod(file.fileno(), mode)
            file.write(data)
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None


def _encode_text(text: str, form: TextFormat, path: Path) -> bytes:
    try:
        # The first two lines may name another encoding by now.
        encoding, _ = tokenize.detect_encoding(
            io.BytesIO(text.encode("utf-8", "surrogateescape")).readline
        )
        target = (
            form.encoding if encoding == "utf-8" and _is_declared(form.encoding, text) else encoding
        )
        return text.replace("\n", form.newline).encode(target)
    except (SyntaxError, UnicodeError, LookupError) as error:
        raise ConfigError(
            f"cannot be written: {error}", "change that or the coding line", file=str(path)
        ) from None


def _is_declared(encoding: str, text: str) -> bool:
    """Return whether Python would decode a file with this text in this encoding.

    Python does so if this is the default encoding, or the first two lines of the text name it.
    """
    return encoding == "utf-8" or encoding in "\n".join(text.split("\n", 2)[:2])


def is_example(path: Path) -> bool:
    """Return whether a program's file is one of the examples."""
    return path.resolve().parent == programs_folder().resolve()


def is_protected(path: Path) -> bool:
    """Return whether the app must not write to a program's file: it is an example, or read-only."""
    return is_example(path) or (os.path.exists(path) and not os.access(path, os.W_OK))


FOLDER = "drafts"


@dataclass(frozen=True, slots=True)
class Draft:
    """A text of a program with unsaved changes, which is stored in case of a crash."""

    path: str
    """Absolute path of the program; empty for a new one without a file."""
    text: str
    written_s: float
    """When the draft was stored, in seconds since 1970."""


def find_program_data(folder: str, path: str) -> Path:
    """Return the path of the JSON file in which the app stores data about a program; the file need not exist.

    Args:
        folder: Name of the folder of the app's data, such as the one for drafts.
        path: Path of the program, or its name if it has no file.
    """
    return (
        session_folder()
        / folder
        / f"{hashlib.sha256(path.encode(errors='surrogateescape')).hexdigest()[:24]}.json"
    )


def write_json(file: Path, data: object) -> None:
    """Write data as JSON to a file, completely or not at all; only the owner of the file may read it.

    Raises:
        OSError: the file cannot be written.
    """
    make_private_folder(file.parent)
    with replacing(file, owner_only=True) as handle:
        handle.write(json.dumps(data).encode("ascii"))


def keep_draft(path: str, text: str) -> None:
    """Store the text of a program as its draft, in place of an older one.

    Raises:
        ConfigError: the draft cannot be written.
    """
    path = _locate(path)
    file = find_program_data(FOLDER, path)
    try:
        write_json(file, asdict(Draft(path, text, time.time())))
    except OSError as error:
        reason = error.strerror or error
        raise ConfigError(
            f"unsaved changes cannot be backed up: {reason}", "save it soon", file=str(file)
        ) from None


def find_draft(path: str) -> Draft | None:
    """Return the stored draft of a program; None if there is none, or it cannot be read."""
    path = _locate(path)
    draft = _read_draft(find_program_data(FOLDER, path))
    return draft if draft and draft.path == path else None


def list_drafts() -> list[Draft]:
    """Return the stored drafts of all programs, the newest first."""
    drafts = filter(None, map(_read_draft, (session_folder() / FOLDER).glob("*.json")))
    return sorted(drafts, key=lambda draft: -draft.written_s)


def _read_draft(file: Path) -> Draft | None:
    try:
        fields = json.loads(read_regular(file, 2 * MAX_PROGRAM_BYTES))
        return Draft(str(fields["path"]), str(fields["text"]), float(fields["written_s"]))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        # Drafts are written atomically; a malformed file has nothing to restore.
        return None


def drop_draft(path: str) -> None:
    """Delete the draft of a program; if it cannot be deleted, it stays and will be offered again."""
    # The folder may be read-only by now; the text itself is safe.
    with suppress(OSError):
        find_program_data(FOLDER, _locate(path)).unlink(missing_ok=True)


def _locate(path: str) -> str:
    """Return the absolute path of a program; empty if `path` is empty, for a program without a file."""
    return path and os.path.abspath(path)
