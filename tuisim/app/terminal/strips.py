"""Strips of half-block cells."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

from rich.color import Color
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual.color import Color as TextualColor
from textual.filter import LineFilter
from textual.strip import Strip

from tuisim.app.render.colors import PALETTE_16, PALETTE_256, TRUECOLOR

UPPER_HALF = "▀"

_DEPTHS = {"standard": PALETTE_16, "windows": PALETTE_16, "256": PALETTE_256}
"""Number of colours by the name of Rich's colour system."""


def color_depth(console: Console) -> int:
    """Return the number of colours that a console supports; full colour if it does not say."""
    return _DEPTHS.get(console.color_system or "", TRUECOLOR)


@lru_cache(maxsize=8192)
def _segment(cell: int) -> Segment:
    top, bottom = Color.from_rgb(*_channels(cell >> 24)), Color.from_rgb(*_channels(cell & 0xFFFFFF))
    return Segment(UPPER_HALF if top != bottom else " ", Style(color=top, bgcolor=bottom))


def _channels(rgb: int) -> tuple[int, int, int]:
    return rgb >> 16, rgb >> 8 & 255, rgb & 255


class CellStrip(Strip):
    """A row of half-block cells, see `render.cells.Cells`. Segments are created only on demand.

    Args:
        cells: One number per cell.
    """

    __slots__ = ["_made", "cells"]

    def __init__(self, cells: Sequence[int]) -> None:
        # The base class's caches are omitted: every method that uses one is overridden here.
        self.cells = cells
        """One number per cell."""
        self._made: list[Segment] | None = None
        self._cell_length = self._cell_count = len(cells)
        self._link_ids = set()
        self._render_cache = None

    @property
    def _segments(self) -> list[Segment]:  # type: ignore[override]  # a slot of the base class
        if self._made is None:
            self._made = [_segment(cell) for cell in self.cells]
        return self._made

    def _plain(self) -> Strip:
        return Strip(self._segments, len(self.cells))

    def __bool__(self) -> bool:
        return bool(self.cells)

    def crop(self, start: int, end: int | None = None) -> Strip:
        """Return the cells from `start` up to `end`."""
        length = len(self.cells)
        start, end = max(0, start), length if end is None else min(length, end)
        return self if start == 0 and end == length else CellStrip(self.cells[start : max(start, end)])

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Return the strips between the cuts, the first one from column 0."""
        pieces, at = [], 0
        for cut in cuts:
            if cut <= len(self.cells):
                pieces.append(self.crop(at, cut))
                at = cut
        return pieces

    def adjust_cell_length(self, cell_length: int, style: Style | None = None) -> Strip:
        """Return the strip cropped or padded to a length."""
        return self if cell_length == len(self.cells) else self._plain().adjust_cell_length(cell_length, style)

    def crop_extend(self, start: int, end: int, style: Style | None) -> Strip:
        """Return the strip between two columns, padded where it is too short."""
        return self.crop(start, end) if end <= len(self.cells) else self._plain().crop_extend(start, end, style)

    def apply_filter(self, filter: LineFilter, background: TextualColor) -> Strip:  # noqa: A002  # the base class's name
        """Return the strip with a filter of Textual applied."""
        return self._plain().apply_filter(filter, background)

    def apply_style(self, style: Style) -> Strip:
        """Return the strip with a style laid over it."""
        return self._plain().apply_style(style)

    def apply_offsets(self, x: int, y: int) -> Strip:
        """Return the strip unchanged: half blocks cannot be selected as text."""
        return self
