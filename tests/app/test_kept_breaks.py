"""Breakpoints and watches follow their lines, and come back with their program."""

from __future__ import annotations

import pytest

from tuisim.app.kept_breaks import StoredBreaks, follow_edit, keep, load_kept
from tuisim.engine.breakpoints import parse_breakpoints


@pytest.mark.parametrize(
    "before, now, expected",
    [
        ("a\nb\nc", "a\nb\nc", ["2", "3 if x"]),
        ("a\nb\nc", "new\na\nb\nc", ["3", "4 if x"]),
        ("a\nb\nc", "a\nb\nnew\nc", ["2", "4 if x"]),
        ("a\nb\nc", "a\nc", ["2 if x"]),
    ],
    ids=["same", "line before", "line between", "line gone"],
)
def test_breaks_follow_their_lines(before: str, now: str, expected: list[str]) -> None:
    breaks = parse_breakpoints(("2", "3 if x", "time 3"))
    assert [one.text for one in follow_edit(breaks, before, now)] == [*expected, "time 3"]


def test_stored_breakpoints_are_loaded_for_their_program_only(home: object) -> None:
    kept = StoredBreaks(parse_breakpoints(("12 if x > 3", "# time 3.5")), ("len(x)",))
    keep("/some/where.py", kept)
    assert load_kept("/some/where.py") == kept
    assert load_kept("/else/where.py") == StoredBreaks()
