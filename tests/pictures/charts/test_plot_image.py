"""The canvas of a chart as an image."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.cases import for_rows
from tuisim.engine.core.css_colors import Rgb
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.canvas import Curve
from tuisim.pictures.charts.plot_image import Plot, PlotInks

CELL = WIDTH, HEIGHT = 8, 16
COLUMNS = 30
ROWS = 10
GROUND = (10, 20, 30)
AXIS = (200, 200, 200)
CURSOR = (255, 255, 255)
CURVE = (240, 0, 0)
EMPTY = Plot((), COLUMNS, ROWS, (0.0, 10.0), (0.0, 100.0), (), (), True, ())


def cells_with(plot: Plot, rgb: Rgb) -> set[tuple[int, int]]:
    """Row and column on the canvas, whose axis is column -1, of the cells that show a colour."""
    at = (plot.draw(CELL, PlotInks(GROUND, AXIS, CURSOR)) == rgb).all(axis=2)
    rows, cols = plot.size
    assert at.shape == (rows * HEIGHT, cols * WIDTH)
    found = at.reshape(rows, HEIGHT, cols, WIDTH).any(axis=(1, 3))
    return {(row, col - 1) for row, col in np.argwhere(found).tolist()}


def curve(*points: tuple[float, float], marker: str = "braille") -> Plot:
    times_s, values = np.array(points, float).T
    return replace(EMPTY, curves=(Curve(times_s, values, CURVE, marker),))


CORNERS = {(0, 0), (0, 29), (9, 0), (9, 29)}
DRAWN = {
    "a line at the top": (curve((0, 100), (10, 100)), CURVE, {(0, col) for col in range(30)}),
    "a line at the bottom": (curve((0, 0), (10, 0)), CURVE, {(9, col) for col in range(30)}),
    "beyond the edges": (curve((-1e9, 100), (1e9, 100)), CURVE, {(0, col) for col in range(30)}),
    "a single point": (curve((0, 0)), CURVE, {(9, 0)}),
    "marks": (curve((0, 0), (0, 100), (10, 0), (10, 100), marker="o"), CURVE, CORNERS),
    "a cursor": (replace(EMPTY, cursors=(0.0,)), CURSOR, {(row, 0) for row in range(ROWS)}),
    "a cursor that is not in view": (replace(EMPTY, cursors=(11.0,)), CURSOR, set()),
    "axes": (
        EMPTY,
        AXIS,
        {(row, -1) for row in range(ROWS + 1)} | {(ROWS, col) for col in range(COLUMNS)},
    ),
    "no time line": (replace(EMPTY, has_time_line=False), AXIS, {(row, -1) for row in range(ROWS)}),
}


@for_rows("plot, rgb, expected", DRAWN)
def test_each_part_of_a_pixel_chart_is_in_its_cells(
    plot: Plot, rgb: Rgb, expected: set[tuple[int, int]]
) -> None:
    assert cells_with(plot, rgb) == expected


def test_grid_lines_of_a_pixel_chart_are_at_the_labels() -> None:
    limits = 0.0, 100.0
    grid = 48, 56, 64
    plot = replace(
        EMPTY,
        y_ticks=tuple(axes.find_row_ticks(limits, ROWS)),
        x_ticks=tuple(axes.time_ticks((0.0, 10.0), 30)),
    )
    found = cells_with(plot, grid)
    rows = {row for row in range(ROWS) if all((row, col) in found for col in range(COLUMNS))}
    cols = {col for col in range(COLUMNS) if all((row, col) in found for row in range(ROWS))}
    assert rows == set(axes.label_rows(limits, ROWS))
    line, _ = axes.draw_time_axis((0.0, 10.0), COLUMNS)
    assert cols == {col for col, char in enumerate(line) if char == "┬"}
