"""Rows of the code, lit or cut."""

from __future__ import annotations

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip


def highlight_strip(strip: Strip, base: Style, lit: Style) -> Strip:
    """Return a row of text with the background of a highlight; a cursor or a selection keeps its own background."""
    background = Style(bgcolor=lit.bgcolor)
    pieces = ((piece.text, piece.style or base) for piece in strip)
    segments = [
        Segment(text, style + background if style.bgcolor == base.bgcolor else style)
        for text, style in pieces
    ]
    return Strip(segments, strip.cell_length)


def cut_strip(strip: Strip, width: int, style: Style) -> Strip:
    """Return a row of text cut to `width` cells, with an ellipsis in place of the rest."""
    return Strip.join([strip.crop(0, width - 1), Strip([Segment("…", style)], 1)])
