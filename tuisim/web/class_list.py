"""The list of a class: a text file with a name a line, or CSV with the names in its first column."""

from __future__ import annotations

import csv
import unicodedata
from collections.abc import Iterator
from pathlib import Path

from tuisim.config.files import read_bytes
from tuisim.errors import ConfigError
from tuisim.logs.csv_cells import restored
from tuisim.source import source_lines

MOST_STUDENTS = 500
_MOST_BYTES = 1 << 20
_LONGEST_NAME = 60
_CSV = ".csv"
_HEADINGS = frozenset({"name", "names", "student", "students", "submission", "username"})
"""What the first line of a CSV file may call its first column."""
_COMMENT = "#"
_HINT = "a file with a name a line"


def read_class(path: Path) -> tuple[str, ...]:
    """Return the names of a class in the order of the file; blank lines and those that begin with # are left out.

    A name is also that of a folder, so that it may hold no slash, and no two may differ by capitals only.

    Raises:
        ConfigError: it cannot be read, or a line has no name, an odd one, or one that is there already.
    """
    shown = str(path)
    names: dict[str, tuple[str, int]] = {}
    for number, text in _cells(path):
        name = unicodedata.normalize("NFC", text)
        line = f"line {number}"
        if problem := _problem(name):
            raise ConfigError(
                problem,
                "letters, digits, blanks and signs, such as Ada Lovelace",
                file=shown,
                key=line,
            )
        _, before = names.setdefault(name.casefold(), (name, number))
        if before != number:
            raise ConfigError(
                f"{name!r} is in line {before}, too", "each name once", file=shown, key=line
            )
        if len(names) > MOST_STUDENTS:
            raise ConfigError(f"has more than {MOST_STUDENTS} names", file=shown, key=line)
    if not names:
        raise ConfigError("has no names", _HINT, file=shown)
    return tuple(name for name, _ in names.values())


def _cells(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the number of each line that has a name, and the name as it is written."""
    data = read_bytes(path, _MOST_BYTES, ConfigError, hint=_HINT)
    if len(data) > _MOST_BYTES:
        raise ConfigError(f"is larger than {_MOST_BYTES >> 20} MiB", _HINT, file=str(path))
    try:
        lines = source_lines(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        number = 1 + data.count(b"\n", 0, error.start)
        raise ConfigError(
            "is not in UTF-8", "save it as UTF-8", file=str(path), key=f"line {number}"
        ) from None
    is_csv = path.suffix.lower() == _CSV
    written = [
        (number, line.strip())
        for number, line in enumerate(lines, 1)
        if line.strip()[:1] not in ("", _COMMENT)
    ]
    separator = max(",;\t", key=written[0][1].count) if is_csv and written else ","
    for number, line in written:
        name = _first_cell(line, separator, path, number) if is_csv else line
        if not (is_csv and number == written[0][0] and name.casefold() in _HEADINGS):
            yield number, name


def _first_cell(line: str, separator: str, path: Path, number: int) -> str:
    try:
        (cells,) = csv.reader([line], delimiter=separator, strict=True)
    except csv.Error as error:
        raise ConfigError(f"is no CSV: {error}", file=str(path), key=f"line {number}") from None
    return restored(cells[0]).strip()


def _problem(name: str) -> str:
    """Return why a name cannot be that of a folder and a part of a link; empty if it can."""
    if not name:
        return "has no name"
    if len(name) > _LONGEST_NAME:
        return f"the name has more than {_LONGEST_NAME} characters"
    if not name.isprintable() or set(name) & set('/\\:*?"<>|'):
        return f"no name of a folder: {name!r}"
    if name[0] in ".-~" or name[-1] == ".":
        return f"a name does not begin or end like this: {name!r}"
    return ""
