"""Questions with a field: the word that is typed is ended."""

from __future__ import annotations

from tuisim.app.dialogs.question import completed


def test_the_word_that_is_typed_is_ended() -> None:
    words = ("Colour", "Left", "slope(", "`a b`")
    lines = {"slope(Co": "slope(Colour", "2 * sl": "2 * slope(", "`a": "`a b`", "2 + 3": None, "Colour": None}
    assert {line: completed(line, words) for line in lines} == lines
