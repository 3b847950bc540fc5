"""Rows of the screen that are not segments of text, and rows that are joined from such."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence

from rich.segment import Segment
from rich.style import Style
from textual.color import Color as TextualColor
from textual.filter import LineFilter
from textual.strip import Strip


class LazyStrip(Strip):
    """A row whose segments are created only on demand."""

    __slots__ = ["_made"]

    # The base class's caches are omitted: every method that uses one is overridden here.
    def _begin(self, count: int) -> None:
        self._made: list[Segment] | None = None
        self._cell_length = self._cell_count = count
        self._link_ids = set()
        self._render_cache = None

    @property
    def _segments(self) -> list[Segment]:  # type: ignore[override]  # a slot of the base class
        if self._made is None:
            self._made = self._make()
        return self._made

    @abstractmethod
    def _make(self) -> list[Segment]:
        """Return its segments."""

    def _plain(self) -> Strip:
        return Strip(self._segments, self.cell_length)

    def __bool__(self) -> bool:
        return bool(self._cell_length)

    def crop(self, start: int, end: int | None = None) -> Strip:
        """Return the part from `start` up to `end`."""
        length = self.cell_length
        start, end = max(0, start), length if end is None else min(length, end)
        return self if start == 0 and end == length else self._part(start, max(start, end))

    @abstractmethod
    def _part(self, start: int, end: int) -> LazyStrip:
        """Return the part from `start` up to `end`, both inside it."""

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Return the strips between the cuts, the first one from column 0."""
        pieces, at = [], 0
        for cut in cuts:
            if cut <= self.cell_length:
                pieces.append(self.crop(at, cut))
                at = cut
        return pieces

    def adjust_cell_length(self, cell_length: int, style: Style | None = None) -> Strip:
        """Return the strip cropped or padded to a length."""
        return self if cell_length == self.cell_length else self._plain().adjust_cell_length(cell_length, style)

    def crop_extend(self, start: int, end: int, style: Style | None) -> Strip:
        """Return the strip between two columns, padded where it is too short."""
        return self.crop(start, end) if end <= self.cell_length else self._plain().crop_extend(start, end, style)

    def apply_filter(self, filter: LineFilter, background: TextualColor) -> Strip:  # noqa: A002  # the base class's name
        """Return the strip with a filter of Textual applied."""
        return self._plain().apply_filter(filter, background)

    def apply_style(self, style: Style) -> Strip:
        """Return the strip with a style laid over it."""
        return self._plain().apply_style(style)

    def apply_offsets(self, x: int, y: int) -> Strip:
        """Return the strip unchanged: a picture cannot be selected as text."""
        return self


class JoinedStrip(LazyStrip):
    """A row of several strips, each of which stays what it is.

    Args:
        parts: From left to right.
    """

    __slots__ = ["parts"]

    def __init__(self, parts: Sequence[Strip]) -> None:
        self.parts = [part for part in parts if part.cell_length]
        self._begin(sum(part.cell_length for part in self.parts))

    def _make(self) -> list[Segment]:
        return [segment for part in self.parts for segment in part]

    def _part(self, start: int, end: int) -> JoinedStrip:
        return JoinedStrip(self._cut(start, end))

    def _cut(self, start: int, end: int) -> list[Strip]:
        """Return the parts between two columns."""
        cut, at = [], 0
        for part in self.parts:
            cut.append(part.crop(max(start - at, 0), max(min(end - at, part.cell_length), 0)))
            at += part.cell_length
        return cut
