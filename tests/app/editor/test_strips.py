"""Rows of the code, lit or cut."""

from __future__ import annotations

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from tuisim.app.editor.strips import cut_strip, highlight_strip


def test_a_code_row_that_is_cut_ends_with_an_ellipsis() -> None:
    cut = cut_strip(Strip([Segment("speed = 30")]), 6, Style())
    assert (cut.text, cut.cell_length) == ("speed…", 6)


def test_highlighting_the_running_row_keeps_the_background_of_a_selection() -> None:
    base = Style(bgcolor="black")
    lit = Style(bgcolor="yellow")
    selected = Style(bgcolor="blue")
    row = highlight_strip(Strip([Segment("a", base), Segment("b", selected)]), base, lit)
    assert [piece.style.bgcolor.name for piece in row if piece.style and piece.style.bgcolor] == [
        "yellow",
        "blue",
    ]
