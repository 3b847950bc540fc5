"""Widgets that repaint only the cells that changed, one for images, one for text; strips of half-block cells."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.app import ComposeResult
from textual.color import Color as TextualColor
from textual.events import MouseEvent
from textual.filter import LineFilter
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from tuisim.terminal.cells import (
    MONO,
    CellRun,
    ColorMode,
    draw_mono_cells,
    find_changed_cells,
    find_changed_runs,
    reduce_cells,
    reduce_pixels,
)
from tuisim.terminal.fitted_cells import CellIndex, Cells, fit_cells, is_flat, list_cells
from tuisim.terminal.glyphs import GLYPHS, GlyphSet, build_glyph_set, build_half_block
from tuisim.terminal.picture import Graphics, PictureCell, TilePicture
from tuisim.terminal.picture_mode import (
    PictureMode,
    Sharpness,
    find_color_depth,
    find_picture_mode,
)
from tuisim.terminal.picture_options import BLOCKS, CellSet
from tuisim.terminal.pixels import CellPoints, Pixels, unpack_rgb
from tuisim.terminal.text_runs import Run, cut_line
from tuisim.terminal.textual_internals import MadeOnDemand

_TEXT_GAP = 8
"""Fewer unchanged characters than this cost less than a new cursor position and style."""


class RowsView(Widget):
    """Base of widgets that store the rows that they show, and repaint only parts of them."""

    ALLOW_SELECT = False

    @cached_property
    def picture_mode(self) -> PictureMode:
        """How the app draws pictures."""
        return find_picture_mode(self.app)

    @property
    def ground_rgb(self) -> tuple[int, int, int]:
        """Background colour of the widget as red, green and blue."""
        own = self.background_colors[1].rgb
        theme = self.picture_mode.theme
        return theme.rgb(own) if theme else own

    def redraw(self) -> None:
        """Draw the content again, because the app's glyphs or colours have changed."""
        self.refresh()

    def render_lines(self, crop: Region) -> list[Strip]:
        """Return the rows of a region of the widget, without Textual's cache, which would rebuild whole rows."""
        return _cut(
            [self.render_line(y) for y in crop.line_range], crop, self.size.width, self.rich_style
        )


REFINED_CELLS = 100
"""Cells that become fine in one step on a slow link."""
QUICKLY_REFINED_CELLS = 400
"""Cells that become fine in one step on a link that is not known to be slow."""


class PixelView(RowsView):
    """A widget that shows an image, with pixels of the terminal, or as cells with a glyph in two colours."""

    def __init__(self) -> None:
        super().__init__()
        self._raw: Pixels | None = None
        self._shown: Pixels = np.empty((0, 0, 3), np.uint8)
        self._cells: Cells = np.empty((0, 0), np.int64)
        self._coarse: npt.NDArray[np.bool_] = np.empty((0, 0), bool)
        """The cells that are drawn as half blocks, to be refined."""
        self._glyphs = build_glyph_set(CellSet.HALF)
        self._tiles: TilePicture | None = None
        """The image while it is drawn with pixels; else None."""
        self._sharpness = Sharpness(self, self._refine_cells)
        self._strips: list[Strip | None] = []
        self._signs: Mapping[tuple[int, int], int] = {}
        """Cells that are shown in place of those of the image, by row and column."""

    @property
    def color_mode(self) -> ColorMode:
        """The colours that the terminal supports."""
        return ColorMode(find_color_depth(self.app), bool(self.app.no_color))

    @property
    def cell_set(self) -> CellSet:
        """The set of glyphs with which the app draws images."""
        return self.picture_mode.cells

    @property
    def graphics(self) -> Graphics | None:
        """How the image is drawn with pixels; None for glyphs."""
        return self.picture_mode.graphics

    def choose_cell(self, graphics: Graphics | None) -> CellPoints:
        """Return how many points of an image are in a cell when the image is drawn in a given way.

        Args:
            graphics: How pixels are drawn; None for the app's glyphs.
        """
        if graphics is not None:
            width_px, height_px = graphics.cell_px
            return CellPoints(*graphics.cell_points, height_px / width_px)
        glyphs = build_glyph_set(self.cell_set)
        return CellPoints(glyphs.cols, glyphs.rows)

    def set_fine_picture(
        self, picture: Pixels, graphics: Graphics | None = None, *, stands: bool = False
    ) -> None:
        """Show an image with as many points in a cell as `choose_cell(graphics)`; only changed cells are repainted.

        Args:
            picture: The image.
            graphics: How its pixels are drawn; None for the app's glyphs.
            stands: Whether the image will not change soon, so that its glyphs are drawn finely also on a slow link.
        """
        if graphics is not None:
            self._show_pixels(picture, graphics)
        else:
            self._show(picture, self.cell_set, stands)

    @property
    def is_coarse(self) -> bool:
        """Whether some cells are drawn as half blocks until there is time for finer glyphs."""
        return bool(self._coarse.any())

    def _show_pixels(self, picture: Pixels, graphics: Graphics) -> None:
        if self._tiles is None or self._tiles.graphics != graphics:
            self._tiles = TilePicture(graphics)
            self._forget_cells()
        runs = self._tiles.put(picture, self.picture_mode.is_slow())
        rows, _ = self._tiles.size
        self._sharpness.record_change(is_coarse=self._tiles.is_coarse)
        if len(self._strips) != rows:
            self._strips = [None] * rows
            self.refresh()
        else:
            self._refresh_runs(runs)

    def _refresh_runs(self, runs: Iterable[CellRun]) -> None:
        """Repaint some runs of cells."""
        regions = []
        for row, col, length in runs:
            self._strips[row] = None
            regions.append(Region(col, row, length, 1))
        if regions:
            self.refresh(*regions)

    def _forget_cells(self) -> None:
        self._cells = np.empty((0, 0), np.int64)
        self._strips = []
        self._coarse = np.empty((0, 0), bool)

    def _show(self, picture: Pixels, cell_set: CellSet, stands: bool = False) -> None:
        if self._tiles is not None:
            self._tiles = None
            self._forget_cells()
        old = self._shown
        was = self._cells
        fine = build_glyph_set(cell_set)
        mode = self.color_mode
        self._reduce(picture, mode)
        shape = len(picture) // fine.rows, picture.shape[1] // fine.cols
        as_before = was.shape == shape and old.shape == picture.shape and fine is self._glyphs
        places = find_changed_cells(old, self._shown, fine) if as_before else list_cells(*shape)
        if as_before and stands and self.is_coarse:
            changed = self._coarse.copy()
            changed[places] = True
            rows, cols = np.nonzero(changed)
            places = rows, cols
        self._glyphs = fine
        has_finer = cell_set in BLOCKS and cell_set != CellSet.HALF
        is_coarse = has_finer and not stands and self.picture_mode.is_slow()
        if not as_before:
            self._coarse = np.zeros(shape, bool)
        self._coarse[places] = is_coarse and ~is_flat(self._shown, fine, places)
        cells = was.copy() if as_before else np.empty(shape, np.int64)
        glyphs = build_half_block(cell_set) if is_coarse else fine
        cells[places] = self._fit_places(glyphs, mode, places)
        self._put(cells)
        self._sharpness.record_change(is_coarse=self.is_coarse)

    def _fit_places(self, glyphs: GlyphSet, mode: ColorMode, places: CellIndex) -> Cells:
        if mode.depth == MONO:
            return draw_mono_cells(self._shown, glyphs, places, self.cell_set)
        return reduce_cells(fit_cells(self._shown, glyphs, places), mode)

    def _put(self, cells: Cells) -> None:
        if cells.shape != self._cells.shape:
            self._cells, self._strips = cells, [None] * len(cells)
            self.refresh()
            return
        runs = find_changed_runs(self._cells, cells)
        self._cells = cells
        self._refresh_runs(runs)

    def _refine_cells(self) -> bool:
        """Draw some of the half blocks with pixels or finer glyphs; return whether half blocks remain."""
        count = REFINED_CELLS if self.picture_mode.is_slow() else QUICKLY_REFINED_CELLS
        if self._tiles is not None:
            self._refresh_runs(self._tiles.refine(count))
            return self._tiles.is_coarse
        self._refine_glyphs(count)
        return self.is_coarse

    def _refine_glyphs(self, count: int) -> None:
        rows, cols = np.nonzero(self._coarse)
        places = rows[:count], cols[:count]
        self._coarse[places] = False
        cells = self._cells.copy()
        cells[places] = self._fit_places(self._glyphs, self.color_mode, places)
        self._put(cells)

    def redraw(self) -> None:
        """Draw the image again, because the app's glyphs or colours have changed."""
        self._raw = None
        self.draw_picture()

    def on_resize(self) -> None:
        """Draw the image again for the new size."""
        self.draw_picture()

    def draw_picture(self) -> None:
        """Draw the image for the present size, glyphs and colours; subclasses that make their image override this."""

    def clear_picture(self) -> None:
        """Remove the image, so that the widget is blank."""
        if self._strips:
            self._raw = self._tiles = None
            self._forget_cells()
            self.refresh()

    def _reduce(self, picture: Pixels, mode: ColorMode) -> None:
        """Store an image in the colours of the terminal: if these are few, dither the points that have changed."""
        if not mode.dithers:
            self._raw = self._shown = picture
            return
        if self._raw is None or self._raw.shape != picture.shape:
            reduced = np.empty_like(picture)
            rows, cols = np.indices(picture.shape[:2]).reshape(2, -1)
        else:
            reduced = self._shown.copy()
            rows, cols = np.nonzero((self._raw != picture).any(axis=2))
        reduced[rows, cols] = reduce_pixels(picture[rows, cols], rows, cols, mode)
        self._shown = reduced
        self._raw = picture

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the picture."""
        if y >= len(self._strips):
            return self._draw_blank()
        strip = self._strips[y]
        if strip is None:
            strip = (
                CellStrip(self._read_row(y))
                if self._tiles is None
                else PictureStrip(self._tiles.row(y))
            )
            self._strips[y] = strip
        return strip

    def _read_row(self, y: int) -> list[int]:
        cells: list[int] = self._cells[y].tolist()
        for (row, col), cell in self._signs.items():
            if row == y and 0 <= col < len(cells):
                cells[col] = cell
        return cells

    def set_signs(self, signs: Mapping[tuple[int, int], int]) -> None:
        """Show signs in place of some cells of the image; an image that is drawn with pixels is not changed.

        Args:
            signs: The number of each sign's cell, see `cells.sign_cell`, by row and column.
        """
        rows, cols = self._cells.shape
        changed = {place for place, _ in self._signs.items() ^ signs.items()}
        self._signs = signs
        self._refresh_runs(
            (row, col, 1) for row, col in changed if 0 <= row < rows and 0 <= col < cols
        )

    def _draw_blank(self) -> Strip:
        # A strip without a style would break Textual's filter for terminals without colours.
        strip = Strip.blank(self.size.width, self.rich_style)
        for line_filter in self.app.get_line_filters():
            strip = strip.apply_filter(line_filter, self.background_colors[1])
        return strip


class LinesView(RowsView):
    """A widget that shows lines of styled text; only characters that differ are repainted."""

    def __init__(self) -> None:
        super().__init__()
        self._lines: list[Sequence[Run]] = []
        self._text_strips: list[Strip | None] = []

    def set_lines(self, lines: Sequence[Sequence[Run]]) -> None:
        """Show lines from the top of the widget; a line that is too long ends in an ellipsis."""
        width = self.size.width
        old = self._lines
        self._lines = [cut_line(line, width) if width else line for line in lines]
        if len(old) != len(self._lines):
            self._text_strips = [None] * len(self._lines)
            self.refresh()
            return
        regions = []
        for y, (before, now) in enumerate(zip(old, self._lines, strict=True)):
            if before != now:
                self._text_strips[y] = None
                regions += [Region(x, y, length, 1) for x, length in _find_changes(before, now)]
        if regions:
            self.refresh(*regions)

    def notify_style_update(self) -> None:
        """Drop the stored rows, because their colours may have changed."""
        super().notify_style_update()
        self._text_strips = [None] * len(self._lines)

    def redraw(self) -> None:
        """Draw the lines again, because the app's colours have changed."""
        self._text_strips = [None] * len(self._lines)
        self.refresh()

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the lines."""
        if y >= len(self._text_strips):
            return self.draw_strip([])
        strip = self._text_strips[y]
        if strip is None or strip.cell_length != self.size.width:
            strip = self._text_strips[y] = self.draw_strip(self._lines[y])
        return strip

    def draw_strip(self, line: Sequence[Run]) -> Strip:
        """Return a line of styled text as a strip, cut or padded to the width of the widget."""
        base = self.rich_style
        whole = Strip([Segment(text, base + style) for text, style in line if text])
        segments = list(whole.adjust_cell_length(self.size.width, base))
        # These rows bypass Textual's style cache, which would apply the filters.
        for line_filter in self.app.get_line_filters():
            segments = line_filter.apply(segments, self.background_colors[1])
        return Strip(segments, self.size.width)


class LinesPanel(Widget):
    """Base of panels that show lines of text; a panel makes its lines again when its size changes."""

    DEFAULT_CSS = "LinesPanel > LinesView { width: 1fr; height: 1fr; }"

    def __init__(self) -> None:
        super().__init__()
        self._text = LinesView()

    def compose(self) -> ComposeResult:
        yield self._text

    def on_resize(self) -> None:
        self.call_after_refresh(self._redraw)

    def _redraw(self) -> None:
        """Make and draw the lines for the current size of the panel."""

    def find_cell(self, event: MouseEvent) -> tuple[int, int]:
        """Return the column and the row of the text at which the mouse is."""
        origin = self._text.region
        return int(event.screen_x) - origin.x, int(event.screen_y) - origin.y


def _cut(strips: list[Strip], crop: Region, width: int, style: Style) -> list[Strip]:
    first, last = crop.column_span
    if first == 0 and last == width:
        return [
            strip if strip.cell_length == width else strip.adjust_cell_length(width, style)
            for strip in strips
        ]
    return [strip.crop_extend(first, last, style) for strip in strips]


def _spread(line: Sequence[Run]) -> list[tuple[str, Style]]:
    return [(char, style) for text, style in line for char in text]


def _find_changes(before: Sequence[Run], now: Sequence[Run]) -> list[tuple[int, int]]:
    """Return the ranges of columns in which two lines differ, as (first column, length)."""
    old, new = _spread(before), _spread(now)
    blank = (" ", Style.null())
    width = max(len(old), len(new))
    old += [blank] * (width - len(old))
    new += [blank] * (width - len(new))
    runs: list[tuple[int, int]] = []
    for x in range(width):
        if old[x] == new[x]:
            continue
        if runs and x - sum(runs[-1]) < _TEXT_GAP:
            runs[-1] = (runs[-1][0], x + 1 - runs[-1][0])
        else:
            runs.append((x, 1))
    return runs


@lru_cache(maxsize=8192)
def _build_segment(cell: int) -> Segment:
    fore = Color.from_rgb(*unpack_rgb(cell >> 24))
    back = Color.from_rgb(*unpack_rgb(cell))
    return Segment(GLYPHS[cell >> 48] if fore != back else " ", Style(color=fore, bgcolor=back))


class LazyStrip(MadeOnDemand):
    """A strip whose segments are made only if Textual reads them; a part can be cut from it without making them."""

    __slots__ = []

    def _render_plain(self) -> Strip:
        return Strip(self, self.cell_length)

    def __bool__(self) -> bool:
        return bool(self.cell_length)

    def crop(self, start: int, end: int | None = None) -> Strip:
        """Return the columns from `start` up to `end` as a strip."""
        length = self.cell_length
        start, end = max(0, start), length if end is None else min(length, end)
        return self if start == 0 and end == length else self._part(start, max(start, end))

    @abstractmethod
    def _part(self, start: int, end: int) -> LazyStrip:
        """Return the columns from `start` up to `end`, both inside the strip, as a strip."""

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Return the strip cut at some columns: the parts up to each cut."""
        pieces = []
        start = 0
        for cut in cuts:
            if cut <= self.cell_length:
                pieces.append(self.crop(start, cut))
                start = cut
        return pieces

    def adjust_cell_length(self, cell_length: int, style: Style | None = None) -> Strip:
        """Return the strip cut or padded to a number of cells."""
        return (
            self
            if cell_length == self.cell_length
            else self._render_plain().adjust_cell_length(cell_length, style)
        )

    def crop_extend(self, start: int, end: int, style: Style | None) -> Strip:
        """Return the columns from `start` up to `end` as a strip, padded in a style if the strip ends before."""
        return (
            self.crop(start, end)
            if end <= self.cell_length
            else self._render_plain().crop_extend(start, end, style)
        )

    def apply_filter(self, filter: LineFilter, background: TextualColor) -> Strip:  # noqa: A002  # the base class's name
        """Return the strip after a filter of Textual has changed its segments."""
        return self._render_plain().apply_filter(filter, background)

    def apply_style(self, style: Style) -> Strip:
        """Return the strip with a style applied over its own styles."""
        return self._render_plain().apply_style(style)

    def apply_offsets(self, x: int, y: int) -> Strip:
        """Return the strip unchanged, because a picture cannot be selected as text."""
        return self


class JoinedStrip(LazyStrip):
    """A strip that consists of other strips, from left to right; each of these stays an object of its own class.

    Args:
        parts: The strips, from left to right.
    """

    __slots__ = ["parts"]

    def __init__(self, parts: Sequence[Strip]) -> None:
        self.parts = [part for part in parts if part.cell_length]
        self.begin(sum(part.cell_length for part in self.parts))

    def make(self) -> list[Segment]:
        """Return the segments of all parts."""
        return [segment for part in self.parts for segment in part]

    def _part(self, start: int, end: int) -> JoinedStrip:
        return JoinedStrip(self._cut(start, end))

    def _cut(self, start: int, end: int) -> list[Strip]:
        """Return the columns from `start` up to `end`, as one strip for each part; some may be empty."""
        cut = []
        offset = 0
        for part in self.parts:
            cut.append(
                part.crop(max(start - offset, 0), max(min(end - offset, part.cell_length), 0))
            )
            offset += part.cell_length
        return cut


class CellStrip(LazyStrip):
    """A strip of half-block cells, each a number as in `terminal.fitted_cells.Cells`.

    Args:
        cells: One number per cell.
    """

    __slots__ = ["cells"]

    def __init__(self, cells: Sequence[int]) -> None:
        self.cells = cells
        """The cells, one number each."""
        self.begin(len(cells))

    def make(self) -> list[Segment]:
        """Return the segments of the cells."""
        return [_build_segment(cell) for cell in self.cells]

    def _part(self, start: int, end: int) -> CellStrip:
        return CellStrip(self.cells[start:end])


class PictureStrip(CellStrip):
    """A strip of cells that are parts of a picture of pixels.

    Args:
        parts: The parts, of one row of one picture.
    """

    __slots__ = ["parts"]

    def __init__(self, parts: Sequence[PictureCell]) -> None:
        self.parts = parts
        self.begin(len(parts))

    @property
    def cells(self) -> Sequence[int]:  # type: ignore[override]  # a slot of the base class
        """The cells of the strip as half blocks, which are drawn where pixels cannot be shown."""
        if not self.parts:
            return ()
        first = self.parts[0]
        return first.picture.draw_half_blocks(first.row)[first.col : first.col + len(self.parts)]

    def _part(self, start: int, end: int) -> PictureStrip:
        return PictureStrip(self.parts[start:end])
