"""Lines of text with charts, whose canvases have pixels where the terminal can draw them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from rich.segment import Segment
from textual.geometry import Region
from textual.strip import Strip

from tuisim.pictures.charts.bands import SHADES
from tuisim.pictures.charts.canvas import AXIS
from tuisim.pictures.charts.plot_image import Plot, PlotInks
from tuisim.pictures.charts.text_chart import ChartPicture
from tuisim.terminal.cell_view import JoinedStrip, LinesView, PictureStrip
from tuisim.terminal.picture import Graphics, TilePicture
from tuisim.terminal.picture_mode import Sharpness, find_picture_mode
from tuisim.terminal.text_runs import Run, convert_color

if TYPE_CHECKING:
    from tuisim.engine.core.css_colors import Rgb
    from tuisim.terminal.pixels import Pixels

Lines = Sequence[Sequence[Run]]
Paint = Callable[[bool], tuple[Lines, Sequence[tuple[int, ChartPicture]]]]

_CURSOR: Rgb = 255, 255, 255
_STILL_S = 1.0
"""A chart that has not changed for this long stands still; while data arrive, it is drawn a few times a second."""


class PlotStrip(JoinedStrip):
    """A row of text and parts of a chart's picture.

    Args:
        parts: Text and parts of one picture, from left to right.
        spare: Returns the row with characters only, for use where pixels cannot be shown.
    """

    __slots__ = ["_spare"]

    def __init__(self, parts: Sequence[Strip], spare: Callable[[], Strip]) -> None:
        super().__init__(parts)
        self._spare = spare

    def make(self) -> list[Segment]:
        """Return the row as Textual segments, with characters only."""
        return list(self._spare())

    def _part(self, start: int, end: int) -> PlotStrip:
        return PlotStrip(self._cut(start, end), lambda: self._spare().crop(start, end))


class PlotView(LinesView):
    """A widget with lines of text and charts; a chart has pixels if the terminal can show them, else characters.

    Args:
        redraw: Draws all lines again, with pixels if `graphics` is not None, else with characters.
    """

    def __init__(self, redraw: Callable[[], None]) -> None:
        super().__init__()
        self._draw_again = redraw
        self._sharpness = Sharpness(self, self._refine, _STILL_S)
        self._tiles: TilePicture | None = None
        """The picture of the canvases, as large as the widget, while they are drawn with pixels; else None."""
        self._spans: dict[int, tuple[int, int]] = {}
        """First column of the image in each of its rows, and the column behind it."""
        self._spare_lines: Callable[[], Lines] = tuple
        self._spare: Lines | None = None

    @property
    def graphics(self) -> Graphics | None:
        """How pixels are drawn now; None if characters are drawn instead.

        Characters are drawn if there are no colours, and on a slow link while the chart changes.
        """
        picture_mode = find_picture_mode(self.app)
        is_coarse = self.app.no_color or (picture_mode.is_slow() and not self._sharpness.is_still)
        return None if is_coarse else picture_mode.graphics

    def draw(self, paint: Paint) -> None:
        """Show lines of text with charts.

        Args:
            paint: Draws the lines, and returns all of them, and each chart in them with the number of its first row. It
                is called with True if pixels will cover the canvases of the charts, which it must then leave blank.
        """
        graphics = self.graphics
        lines, pictures = paint(graphics is not None)
        if graphics is not None:
            self._spare_lines = lambda: paint(False)[0]
            self._spare = None
            self._show(lines, pictures, graphics)
        else:
            self.set_lines(lines)
            self._sharpness.record_change(
                is_coarse=find_picture_mode(self.app).graphics is not None and not self.app.no_color
            )

    def _show(
        self, lines: Lines, pictures: Sequence[tuple[int, ChartPicture]], graphics: Graphics
    ) -> None:
        plots = [
            (first + picture.top, picture.left - 1, picture.plot)
            for first, picture in pictures
            if picture.plot
        ]
        spans = {
            top + row: (left, left + plot.size[1])
            for top, left, plot in plots
            for row in range(plot.size[0])
        }
        if self._tiles is None or self._tiles.graphics != graphics:
            self._tiles = TilePicture(graphics)
            self._spans = {}
        runs = self._tiles.put(self._draw_image(plots, graphics.cell_points))
        super().set_lines(lines)
        if spans != self._spans:
            self._spans = spans
            super().redraw()
        for row, _, _ in runs:
            if row < len(self._text_strips):
                self._text_strips[row] = None
        if runs:
            self.refresh(*[Region(col, row, length, 1) for row, col, length in runs])
        self._sharpness.record_change()

    def _draw_image(self, plots: Sequence[tuple[int, int, Plot]], cell: tuple[int, int]) -> Pixels:
        (width, height), size = cell, self.size
        image: Pixels = np.zeros((size.height * height, size.width * width, 3), np.uint8)
        theme = find_picture_mode(self.app).theme
        shades = tuple(
            theme.rgb(rgb) if theme else rgb
            for shade in SHADES
            if (rgb := convert_color(shade.bgcolor))
        )
        inks = PlotInks(
            self.ground_rgb,
            self._find_ink(convert_color(AXIS.color)),
            self._find_ink(_CURSOR),
            shades,
        )
        for top, left, plot in plots:
            rows, cols = plot.size
            curves = tuple(replace(curve, rgb=self._find_ink(curve.rgb)) for curve in plot.curves)
            part = replace(plot, curves=curves).draw(cell, inks)
            image[top * height : (top + rows) * height, left * width : (left + cols) * width] = part
        return image

    def _find_ink(self, own: Rgb | None) -> Rgb:
        theme = find_picture_mode(self.app).theme
        rgb = own or _CURSOR
        return theme.choose_text_rgb(rgb) if theme else rgb

    def set_lines(self, lines: Lines) -> None:
        """Show lines of characters, without pixels."""
        if self._tiles is not None:
            self._tiles = None
            self._spans = {}
            super().redraw()
        super().set_lines(lines)
        self._sharpness.record_change()

    def _refine(self) -> bool:
        self._draw_again()
        return False

    def redraw(self) -> None:
        """Draw all lines again, because the app's glyphs or colours have changed."""
        super().redraw()
        self._draw_again()

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the plot."""
        strip = super().render_line(y)
        if self._tiles is None or y not in self._spans or isinstance(strip, PlotStrip):
            return strip
        left, right = self._spans[y]
        parts = strip.crop(0, left), PictureStrip(self._tiles.row(y)[left:right]), strip.crop(right)
        made = PlotStrip(parts, partial(self._render_spare_line, y))
        self._text_strips[y] = made
        return made

    def _render_spare_line(self, y: int) -> Strip:
        if self._spare is None:
            self._spare = self._spare_lines()
        return self.draw_strip(self._spare[y] if y < len(self._spare) else [])
