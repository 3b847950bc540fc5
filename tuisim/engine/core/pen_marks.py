"""The marks that the pen has drawn on the mat, for worlds in which sensors see them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field as dataclass_field
from itertools import islice
from math import floor

from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import parse_css_rgb
from tuisim.engine.core.field import Field, disc_weights, in_disc
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, RunSpec
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN

_BLOCK_PX = 32
"""Side of the square blocks of pixels; each block that has any mark is remembered."""

Marks = dict[tuple[int, int], tuple[int, int, int]]
"""Colour of each drawn pixel, by image column and row."""


@dataclass(frozen=True, slots=True)
class MarkedField(Field):
    """A mat with pen marks on it; sensors read it like any other.

    `marks` and `blocks` are filled by `PenMarks`; nothing else changes them.
    """

    marks: Marks = dataclass_field(default_factory=dict)
    blocks: set[tuple[int, int]] = dataclass_field(default_factory=set)

    @classmethod
    def on(cls, field: Field, marks: Marks) -> MarkedField:
        """Return the mat of `field` with exactly the pen marks `marks`, even if `field` has other marks."""
        blocks = {(col // _BLOCK_PX, row // _BLOCK_PX) for col, row in marks}
        mat = field.width_px, field.height_px, field.pixels, field.sums, field.floor_rgb
        return cls(*mat, marks, blocks)

    def _has_marks(self, diameter: int, col: int, row: int) -> bool:
        rows = range(row // _BLOCK_PX, (row + diameter) // _BLOCK_PX + 1)
        cols = range(col // _BLOCK_PX, (col + diameter) // _BLOCK_PX + 1)
        return any(
            (block_col, block_row) in self.blocks for block_row in rows for block_col in cols
        )

    def sum_disc(self, diameter: int, col: int, row: int) -> tuple[int, int, int]:
        """Return the sums of red, green and blue over a disc of the mat, including pen marks.

        Args:
            diameter: The disc's diameter in pixels, a key of `sums`.
            col, row: The upper left corner of the disc's box, which may be off the mat.
        """
        # Not `super()`: `slots=True` makes a new class, which `super()` without arguments does not find.
        red, green, blue = Field.sum_disc(self, diameter, col, row)
        if not self._has_marks(diameter, col, row):
            return red, green, blue
        for number, inside in enumerate(disc_weights(diameter, "mean")):
            place = (col + number % diameter, row + number // diameter)
            drawn = self.marks.get(place) if inside else None
            if drawn is not None:
                below = self.pixel(*place)
                red += drawn[0] - below[0]
                green += drawn[1] - below[1]
                blue += drawn[2] - below[2]
        return red, green, blue

    def read_disc(self, diameter: int, col: int, row: int) -> bytes:
        """Return the pixels of a disc, including pen marks, row by row, three bytes per pixel.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the disc's box, which may be off the mat.
        """
        if self._has_marks(diameter, col, row):
            return in_disc(self.read_box(diameter, col, row), diameter)
        return Field.read_disc(self, diameter, col, row)

    def read_box(self, diameter: int, col: int, row: int) -> bytes:
        """Return the pixels of the square box around a disc, including pen marks, row by row, three bytes per pixel.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the box, which may be off the mat.
        """
        pixels = Field.read_box(self, diameter, col, row)
        if not self._has_marks(diameter, col, row):
            return pixels
        drawn_on = bytearray(pixels)
        for down in range(diameter):
            for right in range(diameter):
                drawn = self.marks.get((col + right, row + down))
                if drawn is not None:
                    offset = 3 * (down * diameter + right)
                    drawn_on[offset : offset + 3] = bytes(drawn)
        return bytes(drawn_on)


_Point = tuple[float, float]
"""A point of the field: x and y in mm."""


class PenMarks:
    """The trace that the pen has drawn on a mat. It grows with each tick record that `add_records` gets."""

    def __init__(self, field: Field, spec: RunSpec) -> None:
        self._pen = spec.robot.pen
        self._rgb = parse_css_rgb(self._pen.color) or (0, 0, 0)
        self.field = MarkedField.on(field, {})
        """The mat with everything drawn up to now."""
        self.records = 0
        """Number of tick records processed."""
        self._last: _Point | None = None
        self._last_actions = 0

    def field_of_first(self, count: int) -> MarkedField:
        """Return the mat with only the first `count` marked pixels, as it was before the others were marked."""
        return MarkedField.on(self.field, dict(islice(self.field.marks.items(), count)))

    def add_records(self, records: Iterable[tuple[float, ...]]) -> None:
        """Continue the trace with the next tick records, which have the fields of `TICK_RECORD`."""
        for _, _, x_mm, y_mm, heading_deg, *_, flags, actions in records:
            self.records += 1
            if not int(flags) & FLAG_PEN_DOWN:
                self._last = None
                continue
            point = world_point(Pose(x_mm, y_mm, heading_deg), self._pen.x_mm, self._pen.y_mm)
            # A robot that was moved by hand draws no line.
            last = self._last if self._last is not None and self._last_actions == actions else point
            if last is point or last != point:
                self._draw_stroke(last, point)
            self._last, self._last_actions = point, int(actions)

    def _list_pixels(self, start: float, end: float) -> range:
        """Return the columns or rows of the pixels that a stroke between two x or y coordinates, in mm, may reach."""
        radius = self._pen.width_mm / 2
        return range(floor(min(start, end) - radius), int(max(start, end) + radius) + 1)

    def _draw_stroke(self, start: _Point, end: _Point) -> None:
        radius = self._pen.width_mm / 2
        x0 = start[0]
        y0 = FIELD_HEIGHT_MM - start[1]
        x1 = end[0]
        y1 = FIELD_HEIGHT_MM - end[1]
        dx, dy = x1 - x0, y1 - y0
        squared = dx * dx + dy * dy
        field = self.field
        cols = self._list_pixels(x0, x1)
        rows = self._list_pixels(y0, y1)
        if field.floor_rgb is None:
            cols = range(max(0, cols.start), min(field.width_px, cols.stop))
            rows = range(max(0, rows.start), min(field.height_px, rows.stop))
        for row in rows:
            for col in cols:
                # A pixel is drawn if its centre is no farther from the line than half the pen's width.
                px = col + 0.5 - x0
                py = row + 0.5 - y0
                along = max(0.0, min(1.0, (px * dx + py * dy) / squared)) if squared else 0.0
                if (px - along * dx) ** 2 + (py - along * dy) ** 2 <= radius * radius:
                    field.marks[col, row] = self._rgb
                    field.blocks.add((col // _BLOCK_PX, row // _BLOCK_PX))
