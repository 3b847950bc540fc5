"""Reads program files, and writes them back in their original encoding and line ends."""

from __future__ import annotations

import codecs
import io
import os
import re
import stat
import tokenize
from dataclasses import dataclass
from pathlib import Path

from tuisim.errors import ConfigError
from tuisim.source import decode_source


@dataclass(frozen=True, slots=True)
class Form:
    """The format of a file besides its text."""

    encoding: str = "utf-8"
    """Python's name of the encoding; `utf-8` also for a file with a byte order mark."""
    has_mark: bool = False
    """Whether it begins with a byte order mark."""
    newline: str = "\n"
    """The line end of most lines."""


def read_text(path: Path) -> tuple[str, Form]:
    """Return a program's text with `\n` as line ends, and its format.

    Raises:
        ConfigError: the file cannot be read, or is not Python text.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(path)) from None
    text, encoding = decode_source(data, str(path))
    ends = {end: len(re.findall(pattern, text)) for end, pattern in _ENDS.items()}
    form = Form(encoding.removesuffix("-sig"), data.startswith(codecs.BOM_UTF8), max(ends, key=lambda end: ends[end]))
    return text.replace("\r\n", "\n").replace("\r", "\n"), form


_ENDS = {"\n": r"(?<!\r)\n", "\r\n": r"\r\n", "\r": r"\r(?!\n)"}


def write_text(path: Path, text: str, form: Form) -> None:
    """Write a program atomically; an existing file keeps its permissions, and a link stays a link.

    Raises:
        ConfigError: the file cannot be written, or not in its encoding.
    """
    from tuisim.atomic import replacing

    data = (codecs.BOM_UTF8 if form.has_mark else b"") + _encoded(text, form, path)
    try:
        mode = stat.S_IMODE(path.stat().st_mode) if path.exists() else None
        with replacing(path) as file:
            if mode is not None:
                os.fchmod(file.fileno(), mode)
            file.write(data)
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None


def _encoded(text: str, form: Form, path: Path) -> bytes:
    try:
        # The first two lines may name another encoding by now.
        encoding, _ = tokenize.detect_encoding(io.BytesIO(text.encode("utf-8", "surrogateescape")).readline)
        wanted = form.encoding if encoding == "utf-8" and _is_named(form.encoding, text) else encoding
        return text.replace("\n", form.newline).encode(wanted)
    except (SyntaxError, UnicodeError, LookupError) as error:
        raise ConfigError(f"cannot be written: {error}", "change that or the coding line", file=str(path)) from None


def _is_named(encoding: str, text: str) -> bool:
    """Return whether Python would read a text in this encoding: the default one, or the one named in the first two
    lines."""
    return encoding == "utf-8" or encoding in "\n".join(text.split("\n", 2)[:2])


def is_protected(path: Path) -> bool:
    """Return whether a program must not be overwritten: it is an example, or read-only."""
    from tuisim.config.folders import programs_folder

    examples = programs_folder().resolve()
    return path.resolve().parent == examples or (path.exists() and not os.access(path, os.W_OK))
