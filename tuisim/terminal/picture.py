"""A picture in the cells of a terminal, of which only cells that have changed are sent."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from itertools import count, groupby
from typing import NamedTuple

import numpy as np

from tuisim.terminal import kitty, sixel
from tuisim.terminal.cells import TRUECOLOR, CellRun, build_color_codes, find_runs
from tuisim.terminal.picture_options import Protocol
from tuisim.terminal.pixels import Pixels, pack_rgb

MAX_POINTS = 12
MAX_PAGE_POINTS = 32
"""Most points of a picture across a cell: in a terminal, and in a page, which shows each pixel of a fine screen."""


@dataclass(frozen=True, slots=True)
class Graphics:
    """The protocol and the sizes with which pixels are drawn in a terminal."""

    protocol: Protocol
    cell_px: tuple[int, int]
    """Width and height of a cell in pixels."""
    in_tmux: bool = False
    """Whether tmux has to pass codes on."""
    most_points: int = MAX_POINTS
    """The most points of a picture across a cell; larger cells get larger points."""

    @property
    def scale(self) -> int:
        """The width and height of a point of a picture, in pixels of the terminal.

        Smaller points would take too long to draw.
        """
        return max(1, -(-self.cell_px[0] // self.most_points))

    @property
    def cell_points(self) -> tuple[int, int]:
        """How many points of a picture are in a cell: across, and from top to bottom."""
        width_px, height_px = self.cell_px
        if self.protocol is Protocol.SIXEL and (width_px % self.scale or height_px % self.scale):
            # Terminals do not scale sixel pictures, so a point must be one of the terminal's pixels here.
            return width_px, height_px
        return max(width_px // self.scale, 1), max(height_px // self.scale, 1)


class PictureCell(NamedTuple):
    """A part of a picture of the size of a cell. Two parts are equal if they look the same."""

    picture: TilePicture
    row: int
    col: int
    version: int
    """Number of the last change of the part."""
    half_block: int | None = None
    """The half block that is drawn in place of the pixels, see `fitted_cells.Cells`: on a slow link it has far
    fewer bytes."""


class Rectangle(NamedTuple):
    """A rectangle of cells of a picture; `bottom` and `right` are one more than the last row and column."""

    top: int
    left: int
    bottom: int
    right: int

    @property
    def area(self) -> int:
        """The number of cells in the rectangle."""
        return (self.bottom - self.top) * (self.right - self.left)

    def join(self, other: Rectangle) -> Rectangle:
        """Return the smallest rectangle that contains this one and another one."""
        return Rectangle(
            min(self.top, other.top),
            min(self.left, other.left),
            max(self.bottom, other.bottom),
            max(self.right, other.right),
        )


class TilePicture:
    """A picture of pixels whose content changes; it is sent to the terminal in tiles of some cells.

    Args:
        graphics: How it is drawn.
    """

    def __init__(self, graphics: Graphics) -> None:
        self.graphics = graphics
        self._points: Pixels = np.empty((0, 0, 3), np.uint8)
        self._versions = np.empty((0, 0), np.int64)
        self._coarse: Mask = np.zeros((0, 0), bool)
        self._changes = 0
        self._first_image = 1 + next(_COUNT) % _MAX_PICTURES * _MAX_IMAGES
        self._tiles: dict[tuple[int, int], tuple[int, int]] = {}
        """The version and the image of each tile that the terminal has, by row and column of its first cell."""

    @property
    def size(self) -> tuple[int, int]:
        """The number of rows and columns of cells of the picture."""
        rows, cols = self._versions.shape
        return rows, cols

    @property
    def is_coarse(self) -> bool:
        """Whether some cells are drawn as half blocks until `refine` is called."""
        return bool(self._coarse.any())

    def put(self, points: Pixels, coarse: bool = False) -> list[CellRun]:
        """Replace the content of the picture.

        Args:
            points: The new picture, with as many points in each cell as `Graphics.cell_points` says.
            coarse: Whether to draw the cells that change as half blocks.

        Returns:
            Runs of changed cells: row, first column, number of cells. All rows if the size has changed.
        """
        width, height = self.graphics.cell_points
        rows = len(points) // height
        cols = points.shape[1] // width
        self._changes += 1
        if points.shape != self._points.shape:
            self._versions = np.full((rows, cols), self._changes)
            self._coarse = np.full((rows, cols), coarse)
            self._points = points
            return [(row, 0, cols) for row in range(rows)]
        differs = (points != self._points).reshape(rows, height, cols, width * 3).any(axis=(1, 3))
        if self.graphics.protocol is Protocol.KITTY and differs.any():
            differs = _fill_tiles(differs)
        self._versions[differs] = self._changes
        self._coarse[differs] = coarse
        self._points = points
        return find_runs(differs)

    def refine(self, cells: int) -> list[CellRun]:
        """Draw with pixels about `cells` of the cells that are half blocks now.

        Returns:
            Runs of changed cells: row, first column, number of cells.
        """
        rows, cols = np.nonzero(self._coarse)
        some: Mask = np.zeros(self._coarse.shape, bool)
        some[rows[:cells], cols[:cells]] = True
        if self.graphics.protocol is Protocol.KITTY:
            some = _fill_tiles(some)
        self._coarse[some] = False
        return find_runs(some)

    def draw_half_blocks(self, row: int) -> list[int]:
        """Return a row of the picture as half blocks, see `fitted_cells.Cells`, for places without pixels."""
        width, height = self.graphics.cell_points
        points = self._points[row * height : (row + 1) * height].astype(np.float32)
        upper, lower = (
            half.reshape(len(half), -1, width, 3).mean(axis=(0, 2))
            for half in np.array_split(points, 2)
        )
        packed = [pack_rgb(np.rint(half).astype(np.int64).T) for half in (upper, lower)]
        cells: list[int] = (packed[0] << 24 | packed[1]).tolist()
        return cells

    def forget(self) -> None:
        """Assume that the terminal shows no tile of the picture any more, though it may still store their images."""
        for tile, (_, image) in self._tiles.items():
            self._tiles[tile] = _NEVER, image

    def build_deletion(self) -> Callable[[], str]:
        """Return a function that returns the codes to delete all tiles in the terminal, even without this object."""
        return partial(_delete_tiles, self.graphics, self._tiles)

    def row(self, row: int) -> list[PictureCell]:
        """Return the cells of one row of the picture."""
        versions = self._versions[row].tolist()
        coarse = self._coarse[row]
        blocks = self.draw_half_blocks(row) if coarse.any() else []
        return [
            PictureCell(self, row, col, version, blocks[col] if is_coarse else None)
            for col, (version, is_coarse) in enumerate(zip(versions, coarse.tolist(), strict=True))
        ]

    def draw(
        self, places: Sequence[tuple[int, int, PictureCell]], is_shown: Callable[[int, int], bool]
    ) -> str:
        """Return the codes that draw some cells of the picture on the screen.

        Args:
            places: Row and column of the screen, and the cell.
            is_shown: Returns whether a cell of the screen, by row and column, shows its part of this picture.
        """
        by_offset = groupby(
            sorted(places, key=lambda at: (at[0] - at[2].row, at[1] - at[2].col)),
            key=lambda at: (at[0] - at[2].row, at[1] - at[2].col),
        )
        return "".join(
            self._draw_tiles(down, right, [cell for _, _, cell in some], is_shown)
            for (down, right), some in by_offset
        )

    def _draw_tiles(
        self,
        down: int,
        right: int,
        cells: Sequence[PictureCell],
        is_shown: Callable[[int, int], bool],
    ) -> str:
        if self.graphics.protocol is Protocol.KITTY:
            return self._draw_placeholders(down, right, cells)
        changed = np.zeros(self._versions.shape, bool)
        for cell in cells:
            if cell.row < len(changed) and cell.col < changed.shape[1]:
                changed[cell.row, cell.col] = True

        def may_draw(some: Rectangle) -> bool:
            return all(
                is_shown(row + down, col + right)
                for row in range(some.top, some.bottom)
                for col in range(some.left, some.right)
            )

        return "".join(
            f"\x1b[{rectangle.top + down + 1};{rectangle.left + right + 1}H{self._encode_part(rectangle)}"
            for rectangle in find_rectangles(changed, may_draw)
        )

    def _cut_part(self, some: Rectangle) -> Pixels:
        width, height = self.graphics.cell_points
        return self._points[
            some.top * height : some.bottom * height, some.left * width : some.right * width
        ]

    def _encode_part(self, some: Rectangle) -> str:
        points = self._cut_part(some)
        if self.graphics.protocol is Protocol.ITERM:
            return _encode_inline(points, some.right - some.left, some.bottom - some.top)
        scale = self.graphics.cell_px[0] // self.graphics.cell_points[0]
        return sixel.encode(
            points.repeat(scale, axis=0).repeat(scale, axis=1) if scale > 1 else points
        )

    # Kitty

    def _draw_placeholders(self, down: int, right: int, cells: Sequence[PictureCell]) -> str:
        """Return the codes that send the changed tiles of some cells, and write the placeholders of these tiles.

        Args:
            down: The row of the screen with the picture's first row.
            right: The column of the screen with the picture's first column.
            cells: The cells.
        """
        tiles = {
            (cell.row // _TILE_ROWS * _TILE_ROWS, cell.col // _TILE_COLS * _TILE_COLS)
            for cell in cells
        }
        parts = []
        stale = []
        for tile in sorted(tiles):
            codes, old = self._send(tile)
            parts.append(codes)
            stale += old
        cursor = (-1, -1)
        pen = 0
        for cell in sorted(cells, key=lambda one: (one.row, one.col)):
            top = cell.row // _TILE_ROWS * _TILE_ROWS
            left = cell.col // _TILE_COLS * _TILE_COLS
            _, image = self._tiles[top, left]
            if (cell.row, cell.col) != cursor:
                parts.append(f"\x1b[{cell.row + down + 1};{cell.col + right + 1}H")
            if image != pen:
                parts.append(f"\x1b[{build_color_codes(image, TRUECOLOR)[0]}m")
            parts.append(kitty.build_placeholder(cell.col - left, cell.row - top))
            cursor = (cell.row, cell.col + 1)
            pen = image
        parts.append("\x1b[0m")
        parts += [self._wrap_codes(kitty.delete(image)) for image in stale]
        return "".join(parts) + self._drop_tiles()

    def _send(self, tile: tuple[int, int]) -> tuple[str, list[int]]:
        """Return the codes that send a tile, and the numbers of the images to delete.

        Both are empty for an unchanged tile.

        Args:
            tile: The row and column of its upper left cell.
        """
        top, left = tile
        some = Rectangle(
            top, left, min(top + _TILE_ROWS, self.size[0]), min(left + _TILE_COLS, self.size[1])
        )
        version = int(self._versions[some.top : some.bottom, some.left : some.right].max())
        had = self._tiles.get(tile)
        if had is not None and had[0] == version:
            return "", []
        # A tile has two image numbers in turn, so that the old image stays until its placeholders have been replaced.
        number = self._first_image + 2 * (top // _TILE_ROWS * _MAX_TILES + left // _TILE_COLS)
        image = number + 1 if had is not None and had[1] == number else number
        self._tiles[tile] = version, image
        cols = some.right - some.left
        rows = some.bottom - some.top
        # Answers that come back through tmux would be taken for keys.
        codes = kitty.encode(
            self._cut_part(some), image, cols, rows, answers_errors=not self.graphics.in_tmux
        )
        return self._wrap_codes(codes), [had[1]] if had is not None else []

    def _drop_tiles(self) -> str:
        """Return the codes that delete the tiles outside the picture's present size, and remove them from `_tiles`."""
        rows, cols = self.size
        beyond = {
            tile: image for tile, image in self._tiles.items() if tile[0] >= rows or tile[1] >= cols
        }
        for tile in beyond:
            del self._tiles[tile]
        return _delete_tiles(self.graphics, beyond)

    def _wrap_codes(self, codes: str) -> str:
        return _wrap_codes(self.graphics, codes)


def _wrap_codes(graphics: Graphics, codes: str) -> str:
    return kitty.wrap_tmux(codes) if graphics.in_tmux else codes


def _delete_tiles(graphics: Graphics, tiles: Mapping[tuple[int, int], tuple[int, int]]) -> str:
    return "".join(_wrap_codes(graphics, kitty.delete(image)) for _, image in tiles.values())


_COMPRESSION = 1
"""Level of compression of PNG: a tenth of the time of the default, for a few per cent more bytes."""


def _encode_inline(picture: Pixels, cols: int, rows: int) -> str:
    """Return the codes that draw a picture at the cursor in iTerm2 and WezTerm, scaled to some columns and rows.

    Reference: https://iterm2.com/documentation-images.html
    """
    # This is imported on demand, since few terminals need it.
    from PIL import Image

    file = BytesIO()
    Image.fromarray(picture).save(file, "PNG", compress_level=_COMPRESSION)
    data = file.getvalue()
    keys = f"inline=1;size={len(data)};width={cols};height={rows};preserveAspectRatio=0;doNotMoveCursor=1"
    return f"\x1b]1337;File={keys}:{b64encode(data).decode()}\x07"


Mask = np.ndarray[tuple[int, int], np.dtype[np.bool_]]
"""Some cells of a picture, shape (rows, columns)."""

_TILE_ROWS, _TILE_COLS = 4, 8
_NEVER = -1
"""The version of a tile that the terminal does not have."""
_COUNT = count()
_MAX_PICTURES, _MAX_IMAGES = 255, 1 << 16
"""Pictures that have image numbers of their own, and numbers for each: the number of an image has 24 bits."""
_MAX_TILES = 256
"""The most tiles in a row of a picture, for which each row has image numbers."""
_JOIN_CELLS = 6
"""Two rectangles of changed cells are drawn as one if that adds at most this many cells: each rectangle costs codes."""


def _fill_tiles(changed: Mask) -> Mask:
    """Return which cells are in a tile that has at least one changed cell, shape (rows, columns).

    A changed tile is sent as a new image, so that all its cells change.
    """
    rows, cols = changed.shape
    filled = np.pad(changed, ((0, -rows % _TILE_ROWS), (0, -cols % _TILE_COLS)))
    tiles = filled.reshape(filled.shape[0] // _TILE_ROWS, _TILE_ROWS, -1, _TILE_COLS).any(
        axis=(1, 3)
    )
    whole: Mask = tiles.repeat(_TILE_ROWS, axis=0).repeat(_TILE_COLS, axis=1)[:rows, :cols]
    return whole


def find_rectangles(changed: Mask, may_draw: Callable[[Rectangle], bool]) -> list[Rectangle]:
    """Return rectangles that together contain all changed cells, from top to bottom.

    Args:
        changed: Shape (rows, columns).
        may_draw: Returns whether all cells of a rectangle may be drawn, also those that have not changed.
    """
    boxes: list[Rectangle] = []
    for row, col, length in find_runs(changed):
        run = Rectangle(row, col, row + 1, col + length)
        for number, other in enumerate(boxes):
            both = run.join(other)
            if (
                other.bottom >= run.top
                and both.area <= run.area + other.area + _JOIN_CELLS
                and may_draw(both)
            ):
                boxes[number] = both
                break
        else:
            boxes.append(run)
    return boxes
