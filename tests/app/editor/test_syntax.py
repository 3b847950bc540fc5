"""Colours of a program."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import for_rows
from tuisim.app.editor.syntax import Colouring, find_spans
from tuisim.programs.program_file import list_programs


@for_rows(
    "line, before, parts, after",
    [
        ("while x:  # go", "", [("while", "keyword"), ("# go", "comment")], ""),
        ("def run(a):", "", [("def", "keyword"), ("run", "name")], ""),
        (
            "print(x1, 0x1F, 2.5e-3)",
            "",
            [("print", "name"), ("0x1F", "number"), ("2.5e-3", "number")],
            "",
        ),
        ("x = rb'a\\'b' + \"#\"", "", [("rb'a\\'b'", "string"), ('"#"', "string")], ""),
        ("x = '''a # b", "", [("'''a # b", "string")], "'''"),
        ("c''' + 1", "'''", [("c'''", "string"), ("1", "number")], ""),
        ('still """ in', "'''", [('still """ in', "string")], "'''"),
        ('"""a""" """b', "", [('"""a"""', "string"), ('"""b', "string")], '"""'),
        ("x = 'open", "", [("'open", "string")], ""),
        ("", '"""', [], '"""'),
    ],
)
def test_each_part_of_a_line_has_its_kind_and_open_strings_go_on(
    line: str, before: str, parts: list[tuple[str, str]], after: str
) -> None:
    found, state = find_spans(line, before)
    assert [(line[start:end], kind) for start, end, kind in found] == parts
    assert state == after


def test_an_edit_changes_the_colours_of_the_lines_below() -> None:
    lines = ["a = 1", "b = 2", "c = 3"]
    colouring = Colouring()
    assert colouring.color_line(lines, 2) == [(4, 5, "number")]
    lines[0] = "'''"
    colouring.forget_line(0)
    assert colouring.color_line(lines, 2) == [(0, 5, "string")]


@pytest.mark.parametrize(
    "path", [pytest.param(each.path, id=each.name) for each in list_programs()]
)
def test_every_example_is_coloured_in_order_and_without_overlap(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").split("\n")
    colouring = Colouring()
    for at, line in enumerate(lines):
        ends = [
            0,
            *(edge for start, end, _ in colouring.color_line(lines, at) for edge in (start, end)),
            len(line),
        ]
        assert ends == sorted(ends)
