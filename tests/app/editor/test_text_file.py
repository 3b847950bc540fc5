"""A file of a program: its form, links, drafts."""

from __future__ import annotations

import codecs
import os
import stat
from pathlib import Path

import pytest

from tuisim.app.editor.text_file import (
    FOLDER,
    TextFormat,
    drop_draft,
    find_draft,
    is_protected,
    keep_draft,
    read_text,
    write_text,
)
from tuisim.base.errors import ConfigError
from tuisim.programs.program_file import list_programs


@pytest.mark.parametrize(
    "data, form",
    [
        (b"x = 1\ny = 2\n", TextFormat()),
        (b"x = 1\r\ny = 2\r\n", TextFormat(newline="\r\n")),
        (b"x = 1\ry = 2", TextFormat(newline="\r")),
        (codecs.BOM_UTF8 + "x = 'é'\n".encode(), TextFormat(has_mark=True)),
        (
            "# -*- coding: iso-8859-1 -*-\nx = 'é'\n".encode("latin-1"),
            TextFormat(encoding="iso-8859-1"),
        ),
        ("x = '\x0c\u2028'\n".encode(), TextFormat()),
        (b"", TextFormat()),
    ],
    ids=["plain", "windows", "mac", "mark", "latin", "odd breaks", "empty"],
)
def test_saving_a_program_keeps_its_encoding_line_ends_and_permissions(
    data: bytes, form: TextFormat, tmp_path: Path
) -> None:
    path = tmp_path / "p.py"
    path.write_bytes(data)
    path.chmod(0o640)
    text, found = read_text(path)
    assert found == form
    write_text(path, text, found)
    assert path.read_bytes() == data
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_text_that_the_files_encoding_lacks_leaves_the_file_unchanged(tmp_path: Path) -> None:
    path = tmp_path / "p.py"
    path.write_bytes(b"# coding: latin-1\n")
    text, form = read_text(path)
    with pytest.raises(ConfigError, match="cannot be written"):
        write_text(path, text + "x = '→'\n", form)
    assert path.read_bytes() == b"# coding: latin-1\n"
    assert os.listdir(tmp_path) == ["p.py"]


def test_saving_a_program_through_a_link_keeps_the_link(tmp_path: Path) -> None:
    path = tmp_path / "p.py"
    link = tmp_path / "link.py"
    path.write_text("1\n")
    link.symlink_to(path)
    write_text(link, "2\n", TextFormat())
    assert link.is_symlink()
    assert path.read_text() == "2\n"


def test_examples_are_protected_and_own_programs_are_not(tmp_path: Path) -> None:
    assert is_protected(list_programs()[0].path)
    assert not is_protected(tmp_path / "p.py")


def test_a_stored_draft_is_found_until_it_is_deleted(home: Path) -> None:
    keep_draft("/a/p.py", "x = '\ud800é'\n")
    keep_draft("/a/q.py", "y")
    found = find_draft("/a/p.py")
    assert found is not None
    assert found.text == "x = '\ud800é'\n"
    drop_draft("/a/p.py")
    assert find_draft("/a/p.py") is None
    assert find_draft("/a/q.py") is not None


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"path": 3}', b"\xff"])
def test_a_damaged_draft_is_ignored(content: bytes, home: Path) -> None:
    keep_draft("/a/p.py", "x")
    (file,) = (home / FOLDER).iterdir()
    file.write_bytes(content)
    assert find_draft("/a/p.py") is None


def test_unsaved_text_is_not_offered_for_a_program_of_that_name_in_another_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    keep_draft("mine.py", "x = 1\n")
    (tmp_path / "other").mkdir()
    monkeypatch.chdir(tmp_path / "other")
    assert find_draft("mine.py") is None
    draft = find_draft("../mine.py")
    assert draft is not None
    assert draft.path == str(tmp_path / "mine.py")
