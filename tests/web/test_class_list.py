"""The list of a class: what it may hold, and what is told of a wrong line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.errors import ConfigError
from tuisim.web.class_list import MOST_STUDENTS, read_class

LISTS: dict[str, tuple[str, bytes, tuple[str, ...]]] = {
    "a name a line": ("class.txt", b"Ada\nBob\n", ("Ada", "Bob")),
    "blank lines and comments": (
        "class.txt",
        b"# group 1\n\n  Ada  \n   # more\nBob",
        ("Ada", "Bob"),
    ),
    "a comma in a text file": ("class.txt", b"Lovelace, Ada\n", ("Lovelace, Ada",)),
    "letters of any language": (
        "class",
        "\N{BYTE ORDER MARK}Ümit\r\n李雷\r\n".encode(),
        ("Ümit", "李雷"),
    ),
    "one form of a letter": ("class.txt", "U\N{COMBINING DIAERESIS}mit".encode(), ("Ümit",)),
    "CSV": ("class.CSV", b'Name,group\n"Lovelace, Ada",1\nBob,2\n', ("Lovelace, Ada", "Bob")),
    "CSV with semicolons and no heading": ("class.csv", b"Ada;1\nBob;2\n", ("Ada", "Bob")),
    "a heading is a name elsewhere": ("class.csv", b"Ada\nName\n", ("Ada", "Name")),
    "a text file has no heading": ("class.txt", b"Name\nAda\n", ("Name", "Ada")),
    "what a spreadsheet has been kept from": ("class.csv", b"'=Ada\n", ("=Ada",)),
}


@pytest.mark.parametrize(("file", "data", "names"), LISTS.values(), ids=LISTS)
def test_names_are_read(file: str, data: bytes, names: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / file).write_bytes(data)
    assert read_class(tmp_path / file) == names


WRONG: dict[str, tuple[str, bytes, str]] = {
    "nothing": ("class.txt", b"# nobody\n", ": has no names"),
    "a name twice": ("class.txt", b"Ada\n\nBob\nAda\n", ": line 4: 'Ada' is in line 1, too"),
    "capitals only": ("class.txt", b"Ada\nADA\n", ": line 2: 'ADA' is in line 1, too"),
    "no name in a row": ("class.csv", b"Ada,1\n,2\n", ": line 2: has no name"),
    "a folder": ("class.txt", b"Ada\na/b\n", ": line 2: no name of a folder: 'a/b'"),
    "the folder above": (
        "class.txt",
        b"..\n",
        ": line 1: a name does not begin or end like this: '..'",
    ),
    "a hidden folder": (
        "class.txt",
        b".links.json\n",
        ": line 1: a name does not begin or end like this",
    ),
    "an option": ("class.txt", b"-rf\n", ": line 1: a name does not begin or end like this: '-rf'"),
    "control characters": (
        "class.txt",
        b"Ada\nB\x1b[2Jb\n",
        r": line 2: no name of a folder: 'B\x1b[2Jb'",
    ),
    "a null": ("class.txt", b"A\x00\n", r": line 1: no name of a folder: 'A\x00'"),
    "a long name": ("class.txt", b"A" * 61, ": line 1: the name has more than 60 characters"),
    "too many": (
        "class.txt",
        b"".join(b"%d\n" % n for n in range(MOST_STUDENTS + 1)),
        ": line 501: has more than 500",
    ),
    "no UTF-8": ("class.txt", b"Ada\nB\xff\n", ": line 2: is not in UTF-8"),
    "no CSV": ("class.csv", b'Ada,1\n"B"b,2\n', ": line 2: is no CSV: "),
    "too large": ("class.txt", b"#" * (2 << 20), ": is larger than 1 MiB"),
}


@pytest.mark.parametrize(("file", "data", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_line_is_told_with_file_and_number(
    file: str, data: bytes, told: str, tmp_path: Path
) -> None:
    (tmp_path / file).write_bytes(data)
    with pytest.raises(ConfigError) as caught:
        read_class(tmp_path / file)
    assert caught.value.message.startswith(f"{tmp_path / file}{told}")


def test_a_missing_list_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there is no such file"):
        read_class(tmp_path / "class.txt")
