"""Strips that can be sent in part: half-block cells, and text.

Textual cuts what it repaints on the right only: to change one cell it sends the row from
the widget's left edge up to that cell. For the strips of this module, and for no others,
`use_exact_crops` makes it send just the cells that changed. That replaces one method of
Textual's compositor; where the names it needs are missing, Textual keeps its own way,
which shows the same picture with more bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import Any

from rich.color import Color
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual.color import Color as TextualColor
from textual.filter import LineFilter
from textual.strip import Strip

from tuisim.ui.render.palette import PALETTE_16, PALETTE_256, TRUECOLOR, sgr_index

UPPER_HALF = "▀"

_DEPTHS = {"standard": PALETTE_16, "windows": PALETTE_16, "256": PALETTE_256}
"""Number of colours by the name of Rich's colour system."""


def color_depth(console: Console) -> int:
    """Return how many colours a console writes; full colour if it does not say."""
    return _DEPTHS.get(console.color_system or "", TRUECOLOR)


@lru_cache(maxsize=8192)
def _codes(rgb: int, depth: int) -> tuple[str, str]:
    """Return the codes that make a colour the foreground and the background."""
    if depth >= TRUECOLOR:
        channels = f"{rgb >> 16};{rgb >> 8 & 255};{rgb & 255}"
        return f"38;2;{channels}", f"48;2;{channels}"
    number = sgr_index(rgb, depth)
    if depth >= PALETTE_256:
        return f"38;5;{number}", f"48;5;{number}"
    shade = number if number < 8 else number + 52
    return str(30 + shade), str(40 + shade)


@lru_cache(maxsize=8192)
def _segment(cell: int) -> Segment:
    top, bottom = Color.from_rgb(*_channels(cell >> 24)), Color.from_rgb(*_channels(cell & 0xFFFFFF))
    return Segment(UPPER_HALF if top != bottom else " ", Style(color=top, bgcolor=bottom))


def _channels(rgb: int) -> tuple[int, int, int]:
    return rgb >> 16, rgb >> 8 & 255, rgb & 255


class CellStrip(Strip):
    """A row of half-block cells, see `render.cells.Cells`. Segments are made only if someone asks.

    Args:
        cells: One number a cell.
    """

    __slots__ = ["_cells", "_made"]

    def __init__(self, cells: Sequence[int]) -> None:
        # The caches of the base class are left out: every method that uses one is replaced here.
        self._cells = cells
        self._made: list[Segment] | None = None
        self._cell_length = self._cell_count = len(cells)
        self._link_ids = set()
        self._render_cache = None

    @property
    def _segments(self) -> list[Segment]:  # type: ignore[override]  # a slot of the base class
        if self._made is None:
            self._made = [_segment(cell) for cell in self._cells]
        return self._made

    def _plain(self) -> Strip:
        return Strip(self._segments, len(self._cells))

    def __bool__(self) -> bool:
        return bool(self._cells)

    def crop(self, start: int, end: int | None = None) -> Strip:
        """Return the cells from `start` up to `end`."""
        length = len(self._cells)
        start, end = max(0, start), length if end is None else min(length, end)
        return self if start == 0 and end == length else CellStrip(self._cells[start : max(start, end)])

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Return the strips between the cuts, the first from 0."""
        pieces, at = [], 0
        for cut in cuts:
            if cut <= len(self._cells):
                pieces.append(self.crop(at, cut))
                at = cut
        return pieces

    def render(self, console: Console) -> str:
        """Return the row as terminal codes, a colour only where it changes."""
        depth = color_depth(console)
        parts: list[str] = []
        foreground = background = ""
        for cell in self._cells:
            top, lower = cell >> 24, _codes(cell & 0xFFFFFF, depth)
            upper = _codes(top, depth)
            if upper == lower:
                if background != lower[1]:
                    parts.append(f"\x1b[{lower[1]}m")
                parts.append(" ")
            elif foreground == upper[0] and background == lower[1]:
                parts.append(UPPER_HALF)
            else:
                changed = [code for code, was in ((upper[0], foreground), (lower[1], background)) if code != was]
                parts.append(f"\x1b[{';'.join(changed)}m{UPPER_HALF}")
                foreground = upper[0]
            background = lower[1]
        return "".join([*parts, "\x1b[0m"]) if parts else ""

    def adjust_cell_length(self, cell_length: int, style: Style | None = None) -> Strip:
        """Return the strip cut or filled up to a length."""
        return self if cell_length == len(self._cells) else self._plain().adjust_cell_length(cell_length, style)

    def crop_extend(self, start: int, end: int, style: Style | None) -> Strip:
        """Return the strip between two columns, filled up where it is too short."""
        return self.crop(start, end) if end <= len(self._cells) else self._plain().crop_extend(start, end, style)

    def apply_filter(self, filter: LineFilter, background: TextualColor) -> Strip:  # noqa: A002  # the base class's name
        """Return the strip with a filter of Textual applied."""
        return self._plain().apply_filter(filter, background)

    def apply_style(self, style: Style) -> Strip:
        """Return the strip with a style laid over it."""
        return self._plain().apply_style(style)

    def apply_offsets(self, x: int, y: int) -> Strip:
        """Return the strip unchanged: half blocks cannot be selected as text."""
        return self


class TextStrip(Strip):
    """A row of text of which a part can be sent."""

    __slots__: list[str] = []

    def crop(self, start: int, end: int | None = None) -> Strip:
        """Return the cells from `start` up to `end`."""
        cut = super().crop(start, end)
        return self if cut is self else TextStrip(cut._segments, cut.cell_length)

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Return the strips between the cuts, the first from 0."""
        return [
            piece if isinstance(piece, TextStrip) else TextStrip(piece._segments, piece.cell_length)
            for piece in super().divide(cuts)
        ]


_original: Callable[..., str] | None = None


def use_exact_crops(on: bool = True) -> bool:
    """Make Textual send only the changed part of our strips, or go back to its own way.

    Returns:
        Whether the exact way is in use now; False where this Textual does not have what it needs.
    """
    global _original
    try:
        from textual._compositor import ChopsUpdate

        own = ChopsUpdate.render_segments
    except (ImportError, AttributeError):
        return False
    if not set(ChopsUpdate.__init__.__code__.co_varnames) >= {"chops", "spans", "chop_ends"}:
        return False
    if on and _original is None:
        _original = own
        ChopsUpdate.render_segments = _render_segments  # type: ignore[assignment, method-assign]
    elif not on and _original is not None:
        ChopsUpdate.render_segments = _original  # type: ignore[method-assign]
        _original = None
    return on


def _render_segments(update: Any, console: Console) -> str:
    """Return the terminal codes of a partial update: Textual's own, but our strips cut on both sides."""
    parts: list[str] = []
    last_y = update.spans[-1][0]
    for y, first, last in update.spans:
        for end, (x, strip) in zip(update.chop_ends[y], update.chops[y].items(), strict=False):
            if strip is None or x > last or end <= first:
                continue
            left = x
            if isinstance(strip, (CellStrip, TextStrip)):
                left, right = max(x, first), min(end, last)
                if right <= left:
                    continue
                strip = strip.crop(left - x, right - x)
            elif not (last > x >= first and end <= last):
                strip = strip.crop(0, min(end, last) - x)
            parts.append(f"\x1b[{y + 1};{left + 1}H{strip.render(console)}")
        if y != last_y:
            parts.append("\n")
    return "".join(parts)
