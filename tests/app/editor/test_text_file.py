"""The pure parts of the editor: colours, lines, files, drafts, the check."""

from __future__ import annotations

import codecs
import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from tuisim.app.editor import text_lines
from tuisim.app.editor.syntax import Colouring, mistake_in, spans
from tuisim.app.editor.text_file import (
    FOLDER,
    Form,
    drop_draft,
    find_draft,
    is_protected,
    keep_draft,
    read_text,
    write_text,
)
from tuisim.config.program_file import programs
from tuisim.errors import ConfigError


@pytest.mark.parametrize(
    ("line", "before", "parts", "after"),
    [
        ("while x:  # go", "", [("while", "keyword"), ("# go", "comment")], ""),
        ("def run(a):", "", [("def", "keyword"), ("run", "name")], ""),
        ("print(x1, 0x1F, 2.5e-3)", "", [("print", "name"), ("0x1F", "number"), ("2.5e-3", "number")], ""),
        ("x = rb'a\\'b' + \"#\"", "", [("rb'a\\'b'", "string"), ('"#"', "string")], ""),
        ("x = '''a # b", "", [("'''a # b", "string")], "'''"),
        ("c''' + 1", "'''", [("c'''", "string"), ("1", "number")], ""),
        ('still """ in', "'''", [('still """ in', "string")], "'''"),
        ('"""a""" """b', "", [('"""a"""', "string"), ('"""b', "string")], '"""'),
        ("x = 'open", "", [("'open", "string")], ""),
        ("", '"""', [], '"""'),
    ],
    ids=["keyword", "def", "numbers", "strings", "opens", "closes", "other quotes", "twice", "unclosed", "empty"],
)
def test_parts_of_a_line_and_the_state_after_it(
    line: str, before: str, parts: list[tuple[str, str]], after: str
) -> None:
    found, state = spans(line, before)
    assert [(line[start:end], kind) for start, end, kind in found] == parts
    assert state == after


def test_an_edit_changes_the_colours_of_the_lines_below() -> None:
    lines = ["a = 1", "b = 2", "c = 3"]
    colouring = Colouring()
    assert colouring.of(lines, 2) == [(4, 5, "number")]
    lines[0] = "'''"
    colouring.forget(0)
    assert colouring.of(lines, 2) == [(0, 5, "string")]


@pytest.mark.parametrize("path", [pytest.param(each.path, id=each.name) for each in programs()])
def test_every_example_is_coloured_in_order_and_without_overlap(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").split("\n")
    colouring = Colouring()
    for at, line in enumerate(lines):
        ends = [0, *(edge for start, end, _ in colouring.of(lines, at) for edge in (start, end)), len(line)]
        assert ends == sorted(ends)


@pytest.mark.parametrize(
    ("line", "indent"),
    [
        ("while x:", "    "),
        ("    if x:  # why", "        "),
        ("x = '#:'", ""),
        ("    return 3", ""),
        ("        pass", "    "),
        ("f(", "    "),
        ("    x = 1", "    "),
        ("", ""),
    ],
)
def test_the_indentation_after_a_line(line: str, indent: str) -> None:
    assert text_lines.indent_after(line) == indent


@pytest.mark.parametrize(
    ("change", "before", "after"),
    [
        (text_lines.indented, ["a", "", "  b"], ["    a", "", "      b"]),
        (text_lines.outdented, ["    a", "  b", "      c", "\td", "e"], ["a", "b", "    c", "d", "e"]),
        (text_lines.comment_toggled, ["  a", "", "    b"], ["  # a", "", "  #   b"]),
        (text_lines.comment_toggled, ["  # a", "", "  #   b", "#c"], ["  a", "", "    b", "c"]),
        (text_lines.comment_toggled, ["# a", "b"], ["# # a", "# b"]),
        (text_lines.comment_toggled, ["", " "], ["", " "]),
    ],
    ids=["in", "out", "comment", "code", "mixed", "empty"],
)
def test_lines_are_changed(change: Callable[[list[str]], list[str]], before: list[str], after: list[str]) -> None:
    assert change(before) == after


@pytest.mark.parametrize(
    ("wanted", "found"),
    [("speed", [(0, 0), (1, 4)]), ("Speed", [(1, 4)]), ("(", [(1, 9)]), ("", []), ("nothing", [])],
)
def test_places_of_a_text(wanted: str, found: list[tuple[int, int]]) -> None:
    assert text_lines.places(["speed = 3", "x = Speed(1)"], wanted) == found


@pytest.mark.parametrize(
    ("one", "other", "count"),
    [("a\nb\nc", "a\nb\nc", 0), ("a\nb\nc", "a\nx\nc", 1), ("a", "a\nb\nc", 2), ("", "a", 1)],
    ids=["same", "changed", "added", "from nothing"],
)
def test_how_many_lines_differ(one: str, other: str, count: int) -> None:
    assert text_lines.differing_lines(one, other) == count


@pytest.mark.parametrize(
    ("data", "form"),
    [
        (b"x = 1\ny = 2\n", Form()),
        (b"x = 1\r\ny = 2\r\n", Form(newline="\r\n")),
        (b"x = 1\ry = 2", Form(newline="\r")),
        (codecs.BOM_UTF8 + "x = 'é'\n".encode(), Form(has_mark=True)),
        ("# -*- coding: iso-8859-1 -*-\nx = 'é'\n".encode("latin-1"), Form(encoding="iso-8859-1")),
        ("x = '\x0c\u2028'\n".encode(), Form()),
        (b"", Form()),
    ],
    ids=["plain", "windows", "mac", "mark", "latin", "odd breaks", "empty"],
)
def test_a_file_is_written_back_as_it_was(data: bytes, form: Form, tmp_path: Path) -> None:
    path = tmp_path / "p.py"
    path.write_bytes(data)
    path.chmod(0o640)
    text, found = read_text(path)
    assert found == form
    write_text(path, text, found)
    assert path.read_bytes() == data
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_what_the_encoding_lacks_leaves_the_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "p.py"
    path.write_bytes(b"# coding: latin-1\n")
    text, form = read_text(path)
    with pytest.raises(ConfigError, match="cannot be written"):
        write_text(path, text + "x = '→'\n", form)
    assert path.read_bytes() == b"# coding: latin-1\n"
    assert os.listdir(tmp_path) == ["p.py"]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    path, link = tmp_path / "p.py", tmp_path / "link.py"
    path.write_text("1\n")
    link.symlink_to(path)
    write_text(link, "2\n", Form())
    assert link.is_symlink()
    assert path.read_text() == "2\n"


def test_examples_are_protected_and_own_programs_are_not(tmp_path: Path) -> None:
    assert is_protected(programs()[0].path)
    assert not is_protected(tmp_path / "p.py")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("x = 1\n", None, ""),
        ("%%sim_magic_preloaded -b Grey_bands\nprint(colorLeft)\n", None, ""),
        ("x = 1\nif x\n    pass\n", 2, "line 2: expected ':'"),
        ("return 3\n", 1, "line 1: 'return' outside function"),
        ("# %%sim_magic -b\n", 0, "-b"),
        ("assert (1, 'x is \\d')\n", None, ""),
        ("x = " + "(" * 500 + ")" * 500, 1, "nested"),
    ],
    ids=["good", "magic", "syntax", "outside", "wrong magic", "warning", "deep"],
)
def test_what_is_wrong_with_a_program(text: str, line: int | None, words: str) -> None:
    found = mistake_in(text, "p.py")
    if line is None:
        assert found is None
    else:
        assert found is not None
        assert found.line == line
        assert words in found.message


def test_a_draft_is_found_until_it_is_dropped(home: Path) -> None:
    keep_draft("/a/p.py", "x = '\ud800é'\n")
    keep_draft("/a/q.py", "y")
    found = find_draft("/a/p.py")
    assert found is not None
    assert found.text == "x = '\ud800é'\n"
    drop_draft("/a/p.py")
    assert find_draft("/a/p.py") is None
    assert find_draft("/a/q.py") is not None


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"path": 3}', b"\xff"])
def test_what_is_no_draft_is_none(content: bytes, home: Path) -> None:
    keep_draft("/a/p.py", "x")
    (file,) = (home / FOLDER).iterdir()
    file.write_bytes(content)
    assert find_draft("/a/p.py") is None
