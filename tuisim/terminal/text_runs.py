"""Styled pieces of text, the output of drawing functions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from rich.color import Color
from rich.style import Style

if TYPE_CHECKING:
    from tuisim.terminal.pixels import Rgb

Run: TypeAlias = tuple[str, Style]
"""A piece of a line in one style."""

Line: TypeAlias = list[Run]


def escape_markup(text: str) -> str:
    """Return the markup that shows a text from a file or the user unchanged.

    `textual.markup.escape` does not escape some brackets that follow a backslash or are in quotes.
    """
    return text.replace("[", "\\[")


def convert_color(color: Color | None) -> Rgb | None:
    """Return red, green and blue of a colour; None for no colour, and for a number of the terminal's palette."""
    if color is None or color.triplet is None:
        return None
    red, green, blue = color.triplet
    return red, green, blue


def cut(text: str, width: int) -> str:
    """Return a text cut to a number of cells; one that was cut ends in an ellipsis."""
    return text if len(text) <= width else text[: max(0, width - 1)] + "…"[:width]


def cut_line(line: Sequence[Run], width: int) -> Sequence[Run]:
    """Return a line of styled text cut to a number of cells; it ends in an ellipsis unless only blanks were cut off."""
    if (
        sum(len(text) for text, _ in line) <= width
        or not "".join(text for text, _ in line)[width:].strip()
    ):
        return line
    runs: list[Run] = []
    left = width
    for text, style in line:
        runs.append((cut(text, left) if len(text) > left else text, style))
        left -= len(text)
        if left < 0:
            return runs
        if left == 0:
            # The next piece is cut off completely, so this one gets the ellipsis.
            runs[-1] = (text[:-1] + "…", style)
            return runs
    return runs


def find_first_row(chosen: int, count: int, room: int) -> int:
    """Return the index of the first visible row of a list that is scrolled so that the selected row is near the middle.

    Args:
        chosen: Index of the selected row.
        count: Number of rows of the list.
        room: Number of rows that are visible.
    """
    return min(max(chosen - room // 2, 0), max(count - room, 0))
