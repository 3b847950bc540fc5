"""Lines of a text: changes, places, and the same lines in an edited text."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.cases import for_rows
from tuisim.app.editor import text_lines
from tuisim.app.editor.text_lines import MAX_COMPARED, LineMap


@for_rows(
    "run, shown, to_shown",
    [
        ("abc", "abc", [1, 2, 3]),
        ("abc", "xabc", [2, 3, 4]),
        ("abc", "axc", [1, 0, 3]),
        ("abcd", "xbyd", [0, 2, 0, 4]),
        ("abcdef", "acxdef", [1, 0, 2, 4, 5, 6]),
        ("aaa", "aaaa", [1, 2, 3]),
        ("abc", "", [0, 0, 0]),
        ("", "abc", []),
    ],
)
def test_each_line_of_the_running_text_is_found_in_the_edited_text(
    run: str, shown: str, to_shown: list[int]
) -> None:
    lines = LineMap(run, shown)
    assert [lines.find_shown_line(line) for line in range(1, len(run) + 1)] == to_shown
    assert all(
        lines.find_run_line(there) == line for line, there in enumerate(to_shown, 1) if there
    )
    assert (
        lines.find_shown_line(0)
        == lines.find_run_line(0)
        == lines.find_shown_line(len(run) + 1)
        == 0
    )


def test_lines_of_a_long_rewritten_text_are_matched_only_at_its_ends() -> None:
    many = [str(number) for number in range(MAX_COMPARED + 1)]
    lines = LineMap(["first", *many, "last"], ["first", "new", *many[::-1], "last"])
    assert (lines.find_shown_line(1), lines.find_shown_line(len(many) + 2)) == (1, len(many) + 3)
    assert lines.find_shown_line(5) == 0


@for_rows(
    "line, indent",
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
def test_a_new_line_is_indented_by_what_the_line_before_it_needs(line: str, indent: str) -> None:
    assert text_lines.compute_indent(line) == indent


@pytest.mark.parametrize(
    "change, before, after",
    [
        (text_lines.indent_lines, ["a", "", "  b"], ["    a", "", "      b"]),
        (
            text_lines.outdent_lines,
            ["    a", "  b", "      c", "\td", "e"],
            ["a", "b", "    c", "d", "e"],
        ),
        (text_lines.toggle_comments, ["  a", "", "    b"], ["  # a", "", "  #   b"]),
        (text_lines.toggle_comments, ["  # a", "", "  #   b", "#c"], ["  a", "", "    b", "c"]),
        (text_lines.toggle_comments, ["# a", "b"], ["# # a", "# b"]),
        (text_lines.toggle_comments, ["", " "], ["", " "]),
    ],
    ids=["in", "out", "comment", "code", "mixed", "empty"],
)
def test_lines_are_indented_outdented_and_commented(
    change: Callable[[list[str]], list[str]], before: list[str], after: list[str]
) -> None:
    assert change(before) == after


@pytest.mark.parametrize(
    "wanted, found",
    [("speed", [(0, 0), (1, 4)]), ("Speed", [(1, 4)]), ("(", [(1, 9)]), ("", []), ("nothing", [])],
)
def test_find_matches_gives_each_place_of_the_searched_text(
    wanted: str, found: list[tuple[int, int]]
) -> None:
    assert text_lines.find_matches(["speed = 3", "x = Speed(1)"], wanted) == found


@pytest.mark.parametrize(
    "one, other, count",
    [("a\nb\nc", "a\nb\nc", 0), ("a\nb\nc", "a\nx\nc", 1), ("a", "a\nb\nc", 2), ("", "a", 1)],
    ids=["same", "changed", "added", "from nothing"],
)
def test_count_differing_lines_counts_changed_and_added_lines(
    one: str, other: str, count: int
) -> None:
    assert text_lines.count_differing_lines(one, other) == count
