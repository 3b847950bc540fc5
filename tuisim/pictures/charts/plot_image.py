"""The canvas of a chart with its axes as an image: grid, curves, marks and cursors."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.bands import find_columns, place_names
from tuisim.pictures.charts.canvas import BRAILLE, Curve, choose_owners
from tuisim.pictures.charts.traces import clip_line, reduce_points

if TYPE_CHECKING:
    import numpy.typing as npt
    from PIL.ImageFont import FreeTypeFont

    from tuisim.engine.core.css_colors import Rgb
    from tuisim.engine.runs.arrays import FloatArray
    from tuisim.pictures.charts.axes import Limits
    from tuisim.pictures.charts.layout import Span
    from tuisim.terminal.pixels import Pixels

    _Points = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Plot:
    """The canvas of a chart to be drawn as an image: its curves, spans, cursors and limits."""

    curves: tuple[Curve, ...]
    """The curves, the topmost last."""
    columns: int
    """Size of the canvas in cells. A cell more on the left is for the axis there."""
    rows: int
    x_limits: Limits
    y_limits: Limits
    x_ticks: tuple[float, ...]
    y_ticks: tuple[float, ...]
    has_time_line: bool
    """Whether a row of cells below the canvas is for the axis of time."""
    cursors: tuple[float, ...]
    """Times of the cursors."""
    spans: tuple[Span, ...] = ()
    """Ranges of time that are shaded and named."""

    @property
    def size(self) -> tuple[int, int]:
        """The number of rows and columns of the image in cells, with the axes."""
        return self.rows + self.has_time_line, 1 + self.columns

    def measure_across(self, times_s: FloatArray, width: int) -> _Points:
        """Return for each time its distance from the left edge of the image, in points of the image.

        Args:
            times_s: The times in s, shape (n,).
            width: Width of a cell in points.
        """
        # Place times as `axes.find_column` does, so that a label is below its tick.
        low, high = self.x_limits
        return (times_s - low) / (high - low) * (self.columns - 0.5) * width + 1

    def down(self, values: FloatArray, height: int) -> _Points:
        """Return for each value its distance from the top of the canvas, in points of the image.

        Args:
            values: The values, shape (n,).
            height: Height of a cell in points.
        """
        return axes.measure_row(values, self.y_limits, self.rows) * height

    def draw(self, cell: tuple[int, int], inks: PlotInks) -> Pixels:
        """Return the canvas as an image of the size of its cells.

        Args:
            cell: Width and height of a cell in points.
            inks: The colours that are not those of curves.
        """
        width, height = cell
        rows, cols = self.size
        image: Pixels = np.full((rows * height, cols * width, 3), inks.ground, np.uint8)
        inside = image[: self.rows * height, width : (1 + self.columns) * width]
        for number, span in enumerate(self.spans):
            start, stop = _find_cells(span, self, width)
            inside[:, start:stop] = inks.shades[number % len(inks.shades)]
        _draw_axes(image, inside, self, cell, inks)
        covered = [_measure_coverage(self, curve, cell) for curve in self.curves]
        _draw_names(inside, covered, self, cell, inks)
        seen = choose_owners(np.array(covered, np.bool_), _TURN * width) if covered else ()
        for curve, coverage, is_seen in zip(self.curves, covered, seen, strict=True):
            _lay(inside, coverage * is_seen, curve.rgb)
        for column in _clip_places(
            self.measure_across(np.array(self.cursors), width), inside.shape[1]
        ):
            inside[:, column] = inks.cursor
        return image


@dataclass(frozen=True, slots=True)
class PlotInks:
    """The colours in a chart's image besides those of its curves: of the background, axes, cursors and spans."""

    ground: Rgb
    axis: Rgb
    cursor: Rgb
    shades: tuple[Rgb, ...] = ()
    """Colours of the spans, used in turn."""


_GRID_SHARE = 0.2
"""Share of the colour of the axes in the colour of the grid."""
_FINE = 3
"""Factor by which curves are drawn finer, and then reduced, for smooth edges."""
_LETTER = 0.602
"""Width of a letter of the font, of its size."""
_LEVELS = 4
"""Shades of a smooth edge: each shade more is another colour to be sent."""
_TURN = 4
"""Cells across that a curve has at a time where it lies on others."""
_LINE_SHARE, _MARK_SHARE = 1 / 9, 1 / 5
"""Width of a line and radius of a mark, of the height of a cell."""


def _find_cells(span: Span, plot: Plot, width: int) -> tuple[int, int]:
    """Return the first column of image points that a span of the x axis covers, and the column after the last one.

    Args:
        span: The span.
        plot: The chart.
        width: Width of a cell in points.
    """
    start, stop = np.clip(
        plot.measure_across(np.array([span.start, span.stop]), width), 0, plot.columns * width
    ).astype(int)
    return int(start), int(stop) + 1


def _draw_names(
    inside: Pixels,
    covered: list[npt.NDArray[np.uint8]],
    plot: Plot,
    cell: tuple[int, int],
    inks: PlotInks,
) -> None:
    """Write the names of spans into an image, in place; each is in the lowest row of cells without a curve."""
    # This is imported on demand, since few terminals need it.
    from PIL import Image, ImageDraw

    width, height = cell
    places = [find_columns(span, plot.x_limits, plot.columns) for span in plot.spans]

    def is_free(row: int, first: int, stop: int) -> bool:
        return not any(
            cover[row * height : (row + 1) * height, first * width : stop * width].any()
            for cover in covered
        )

    cursors = [axes.find_column(x, plot.x_limits, plot.columns) for x in plot.cursors]
    for row, first, text in place_names(
        plot.spans, places, plot.rows, plot.columns, is_free, cursors
    ):
        mask = Image.new("L", (len(text) * width, height))
        ImageDraw.Draw(mask).text((0, height // 2), text, 255, _load_font(width), anchor="lm")
        place = inside[
            row * height : (row + 1) * height, first * width : (first + len(text)) * width
        ]
        _lay(place, np.asarray(mask) // (256 // (_LEVELS + 1)), inks.axis)


@cache
def _load_font(width: int) -> FreeTypeFont:
    """Return the font whose letters have a given width in points."""
    from PIL import ImageFont

    content = files("tuisim.pictures.charts").joinpath("fonts", "DejaVuSansMono.ttf").read_bytes()
    return ImageFont.truetype(BytesIO(content), width / _LETTER)


def _draw_axes(
    image: Pixels, inside: Pixels, plot: Plot, cell: tuple[int, int], inks: PlotInks
) -> None:
    width, height = cell
    grid = _mix_colors(inks.ground, inks.axis, _GRID_SHARE)
    across = _clip_places(plot.measure_across(np.array(plot.x_ticks), width), inside.shape[1])
    down = _clip_places(plot.down(np.array(plot.y_ticks), height), len(inside))
    inside[:, across] = grid
    inside[down] = grid
    bottom = len(inside)
    image[:bottom, width - 1] = inks.axis
    image[down, width - 1 - width // 3 : width] = inks.axis
    if plot.has_time_line:
        image[bottom, width - 1 :] = inks.axis
        image[bottom : bottom + 1 + height // 4, width + across] = inks.axis


def _clip_places(points: _Points, length: int) -> npt.NDArray[np.intp]:
    """Return positions, in points of an image, as whole indices; those outside the `length` points are left out."""
    places = np.floor(points).astype(np.intp)
    return places[(places >= 0) & (places < length)]


def _mix_colors(ground: Rgb, rgb: Rgb, share: float) -> Rgb:
    red, green, blue = (
        round(below + (above - below) * share) for below, above in zip(ground, rgb, strict=True)
    )
    return red, green, blue


def _measure_coverage(plot: Plot, curve: Curve, cell: tuple[int, int]) -> npt.NDArray[np.uint8]:
    """Return how much of each point of the canvas a curve covers, from 0 to `_LEVELS`, shape (rows, columns) of points.

    Args:
        plot: The chart.
        curve: The curve.
        cell: Width and height of a cell in points.
    """
    # This is imported on demand, since few terminals need it.
    from PIL import Image, ImageDraw

    width, height = cell
    size = plot.columns * width, plot.rows * height
    mask = Image.new("L", (size[0] * _FINE, size[1] * _FINE))
    draw = ImageDraw.Draw(mask)
    times_s, values = clip_line(
        *reduce_points(curve.times_s, curve.values, plot.x_limits, size[0]), plot.x_limits
    )
    points = (
        np.stack((plot.measure_across(times_s, width), plot.down(values, height)), axis=1) * _FINE
    )
    if curve.marker != BRAILLE or len(points) == 1:
        radius = max(height * _MARK_SHARE, 1.5) * _FINE
        for x, y in points.tolist():
            draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=255)
    else:
        draw.line(
            points.ravel().tolist(), fill=255, width=max(round(height * _LINE_SHARE * _FINE), _FINE)
        )
    covered: npt.NDArray[np.uint8] = (
        np.asarray(mask.reduce(_FINE)) // (256 // (_LEVELS + 1))
    ).clip(max=_LEVELS)
    return covered


def _lay(image: Pixels, covered: npt.NDArray[np.uint8], rgb: Rgb) -> None:
    cells = np.nonzero(covered)
    below = image[cells].astype(np.float32)
    share = covered[cells][:, np.newaxis] / _LEVELS
    image[cells] = np.rint(below + (np.array(rgb) - below) * share).astype(np.uint8)
