"""One frame of a movie in character cells: the same panels as in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from rich.style import Style

from tuisim.charts.cell_image import PLAIN, Cell, Look, row_of_cells
from tuisim.charts.fitted_cells import all_cells, fit_cells
from tuisim.charts.glyphs import GLYPHS, glyph_set
from tuisim.charts.text_chart import ChartPainter, ChartState
from tuisim.charts.traces import Traces
from tuisim.charts.world_image import SQUARE, CellPoints, Pixels, field_view
from tuisim.config.options import CellSet
from tuisim.errors import ConfigError, printable
from tuisim.movies.clip import Moment, Panel, Recorded
from tuisim.movies.pictures import MovingWorld, SensorArrays

if TYPE_CHECKING:
    from PIL.Image import Image

Size = tuple[int, int]

WIDTH = 80
"""Default width in characters."""
LEAST, MOST = (20, 10), (400, 200)
"""Limits of a size."""

_STRIP_ROWS = 11
"""Default height of chart and arrays below the world."""
_STRIP_SHARE = 0.34
"""Their share of a given height."""
_CAPTION_ROWS = 1
_STRONG, _SOFT = Style(bold=True), Style(color="#a8a8a8")


def picture_cells(pixels: Pixels) -> list[list[Cell]]:
    """Return a picture with an even number of rows as half blocks: two square pixels in a cell."""
    upper, lower = pixels[0::2].tolist(), pixels[1::2].tolist()
    return [
        [
            (" ", Look(PLAIN.ink, tuple(below))) if above == below else ("▀", Look(tuple(above), tuple(below)))
            for above, below in zip(*rows, strict=True)
        ]
        for rows in zip(upper, lower, strict=True)
    ]


_FINE = CellPoints(4, 8)
"""Square pixels of a cell that is drawn with finer glyphs than half blocks."""


def fine_cells(picture: Image, columns: int, rows: int, cell_set: CellSet) -> list[list[Cell]]:
    """Return a picture as so many cells with the glyphs of a set."""
    from PIL import Image

    glyphs = glyph_set(cell_set)
    size = columns * glyphs.cols, rows * glyphs.rows
    points = np.asarray(picture.resize(size, Image.Resampling.BOX))
    cells = fit_cells(points, glyphs, all_cells(rows, columns)).reshape(rows, columns)
    return [[_cell(number) for number in row] for row in cells.tolist()]


@lru_cache(maxsize=8192)
def _cell(number: int) -> Cell:
    """Return a cell of `charts.fitted_cells.Cells`."""
    ink, ground = ((number >> at >> 16 & 255, number >> at >> 8 & 255, number >> at & 255) for at in (24, 0))
    return (" ", Look(PLAIN.ink, ground)) if ink == ground else (GLYPHS[number >> 48], Look(ink, ground))


class CellPainter:
    """Draws a recorded run as character cells at one instant after the other.

    Args:
        recorded: The run.
        panels: What is shown, at least one.
        span_s: Range of simulated time of the chart.
        size: Columns and rows; None for the size that fits the panels.
        cell_set: The glyphs of the world, a set of blocks.

    Raises:
        ConfigError: the panels do not fit the size.
        LogError: the mat no longer exists.
    """

    def __init__(
        self,
        recorded: Recorded,
        panels: Sequence[Panel],
        span_s: tuple[float, float],
        size: Size | None = None,
        cell_set: CellSet = CellSet.HALF,
    ) -> None:
        has_world, has_strip = Panel.WORLD in panels, Panel.CHART in panels or Panel.ARRAYS in panels
        if size is None:
            rows = _CAPTION_ROWS + _STRIP_ROWS * has_strip
            size = WIDTH, rows + -(-field_view(WIDTH, 2 * MOST[1]).height_px // 2) * has_world
        self.size, self._cell_set = size, cell_set
        self._recorded, self._panels = recorded, panels
        self._strip_rows = 0
        if has_strip:
            self._strip_rows = size[1] - _CAPTION_ROWS
            if has_world:
                self._strip_rows = min(self._strip_rows, max(_STRIP_ROWS, round(size[1] * _STRIP_SHARE)))
        self._world_rows = size[1] - _CAPTION_ROWS - self._strip_rows
        if (has_world and self._world_rows < 6) or (has_strip and self._strip_rows < 4):
            raise ConfigError(f"{size[0]}x{size[1]} is too small", "no room for all panels", key="--size")
        if has_world:
            cell = SQUARE if cell_set is CellSet.HALF else _FINE
            view = field_view(cell.cols * size[0], cell.rows * self._world_rows)
            self._world = MovingWorld(recorded, replace(view, cell=cell))
        if Panel.ARRAYS in panels:
            self._arrays = SensorArrays(recorded)
        self._traces, self._charted = Traces(), 0
        self._chart, self._state = ChartPainter(), ChartState(x_limits=span_s if span_s[1] > span_s[0] else None)

    def cells(self, moment: Moment) -> list[list[Cell]]:
        """Return the frame. The instants of successive calls must not decrease."""
        columns = self.size[0]
        grid = [self._caption(moment)]
        if Panel.WORLD in self._panels:
            grid += _centred(self._world_at(moment), columns, self._world_rows)
        if self._strip_rows:
            below = self._arrays_at(moment) if Panel.ARRAYS in self._panels else [[] for _ in range(self._strip_rows)]
            if Panel.CHART in self._panels:
                chart = self._chart_at(moment, columns - len(below[0]))
                below = [left + right for left, right in zip(below, chart, strict=True)]
            grid += below
        return grid

    def _world_at(self, moment: Moment) -> list[list[Cell]]:
        picture = self._world.at(moment)
        if self._cell_set is CellSet.HALF:
            return picture_cells(_even(picture))
        columns, rows = round(picture.width / _FINE.cols), round(picture.height / _FINE.rows)
        return fine_cells(picture, max(columns, 1), max(rows, 1), self._cell_set)

    def _caption(self, moment: Moment) -> list[Cell]:
        values = "  ".join(f"{name}: {value:.5g}" for name, value in moment.values)
        return row_of_cells([(f" {moment.time_s:.2f} s", _STRONG), (f"   {printable(values)}", None)], self.size[0])

    def _chart_at(self, moment: Moment, columns: int) -> list[list[Cell]]:
        samples = self._recorded.samples
        while self._charted < len(samples) and samples[self._charted].tick <= moment.tick:
            sample = samples[self._charted]
            self._traces.append(sample.name, [sample.time_s], [sample.value])
            self._charted += 1
        lines = self._chart.paint(self._traces, self._state, columns, self._strip_rows).lines
        rows = [row_of_cells(line, columns) for line in lines]
        return rows + [row_of_cells([], columns)] * (self._strip_rows - len(rows))

    def _arrays_at(self, moment: Moment) -> list[list[Cell]]:
        """Return the arrays side by side, each below its name."""
        from PIL import Image

        arrays = self._arrays.at(moment)
        most = self.size[0] * 2 // 5 if Panel.CHART in self._panels else self.size[0]
        side = max(min(2 * (self._strip_rows - 1), most // max(len(arrays), 1) - 2) // 2 * 2, 2)
        rows: list[list[Cell]] = [[] for _ in range(self._strip_rows)]
        for name, picture in arrays:
            pixels = np.asarray(picture.resize((side, side), Image.Resampling.BOX))
            block = [row_of_cells([(name[:side].center(side), _SOFT)], side), *picture_cells(pixels)]
            block += [row_of_cells([], side)] * (self._strip_rows - len(block))
            rows = [[*row, (" ", PLAIN), *cells, (" ", PLAIN)] for row, cells in zip(rows, block, strict=True)]
        if Panel.CHART not in self._panels:
            rows = _centred(rows, self.size[0], self._strip_rows)
        return rows


def _even(picture: Image) -> Pixels:
    """Return the pixels of a picture with an even number of rows; a missing one is black."""
    pixels = np.asarray(picture)
    return pixels if len(pixels) % 2 == 0 else np.concatenate([pixels, pixels[-1:]])


def _centred(cells: list[list[Cell]], columns: int, rows: int) -> list[list[Cell]]:
    blank: Cell = " ", PLAIN
    left, top = (columns - len(cells[0])) // 2, (rows - len(cells)) // 2
    wide = [[blank] * left + row + [blank] * (columns - left - len(row)) for row in cells]
    empty = [[blank] * columns]
    return empty * top + wide + empty * (rows - top - len(wide))
