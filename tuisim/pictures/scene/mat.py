"""Pictures of the mat: the part of it in view, scaled down so that thin lines stay visible."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from itertools import pairwise, product
from typing import Any

import numpy as np
import numpy.typing as npt

from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

_REMEMBERED = 4
_MIN_CONTRAST = 24
"""Pixels over colours that differ less show their mean, as of a gradient."""
_PLAIN = 0.15
"""Share of the range of a pixel's colours: a colour that is so near to one of its ends is one of two, and not of
many."""
_MIN_SHARE = 0.2
"""Share of a pixel and the one beside it that a line must cover to be drawn in its own colour."""
_FINE_COLS = 2
"""Number of pixels across a cell up to which they are so large that thin lines need their own colour."""

_PAD = ((2, 2), (2, 2), (0, 0))

_Numbers = npt.NDArray[np.float32]
_Flags = npt.NDArray[np.bool_]


def shrink(
    mat: Pixels,
    view: Viewport,
    outside_rgb: tuple[int, int, int],
    whole_cells: bool = False,
    exact: bool = False,
) -> Pixels:
    """Return the picture of a mat in a viewport.

    Each picture pixel is the mean of the mat pixels under it. Only a pixel that is as wide as a cell, or half of a
    cell, is drawn otherwise, so that edges are sharp and thin lines stay visible: it has the colour of the area that
    covers most of it, or of a thin line in it. So a black line of 10 mm is black even where a pixel covers 30 mm, and
    looks the same whether it lies in one row of pixels or between two.

    Args:
        mat: The mat, one pixel a mm, row 0 at the top of the field.
        view: The part to show.
        outside_rgb: Colour of what lies off the mat.
        whole_cells: End the mat where a cell ends, for glyphs that do not fill their cells: half of a cell in another
            colour would be a column of dots or brackets beside it.
        exact: Draw every pixel as the mean, however wide it is.

    Returns:
        Shape (view.height_px, view.width_px, 3).
    """
    picture = np.empty((view.height_px, view.width_px, 3), np.uint8)
    picture[:] = outside_rgb
    height_mm, width_mm = mat.shape[:2]
    cols, col_edges = _find_edges(view.left_mm, view.mm_per_px, view.width_px, width_mm)
    rows, row_edges = _find_edges(
        height_mm - view.top_mm, view.mm_per_row, view.height_px, height_mm
    )
    if len(col_edges) < 2 or len(row_edges) < 2:
        return picture
    picture[rows, cols] = _reduce_mat(
        mat, row_edges, col_edges, keep_detail=view.cell.cols <= _FINE_COLS and not exact
    )
    if whole_cells:
        _end_at_cells(picture, rows, view.cell.rows, outside_rgb)
        _end_at_cells(picture.swapaxes(0, 1), cols, view.cell.cols, outside_rgb)
    return picture


def _end_at_cells(
    lines: Pixels, inside: slice, step: int, outside_rgb: tuple[int, int, int]
) -> None:
    """Move both ends of the mat in a picture to the nearest ends of cells: extend the mat, or cut it.

    Args:
        lines: The rows, or the columns, of the picture; changed in place.
        inside: The lines that show the mat.
        step: Number of lines in a cell.
        outside_rgb: Colour of what lies off the mat.
    """
    first, end = (step * math.floor(edge / step + 0.5) for edge in (inside.start, inside.stop))
    lines[first : inside.start] = lines[inside.start]
    lines[inside.start : first] = outside_rgb
    lines[inside.stop : end] = lines[inside.stop - 1]
    lines[end : inside.stop] = outside_rgb


def _find_edges(
    start_mm: float, mm_per_px: float, count: int, size_mm: int
) -> tuple[slice, npt.NDArray[np.intp]]:
    """Return the pixels whose middle is on the mat, along one axis of a picture, and the edges of these pixels.

    Args:
        start_mm: Where the picture begins on the mat.
        mm_per_px: Size of a pixel.
        count: Number of pixels.
        size_mm: Size of the mat.

    Returns:
        A slice of the pixels, and the edges in whole mm on the mat, one more than pixels.
    """
    middles = start_mm + (np.arange(count) + 0.5) * mm_per_px
    inside = np.flatnonzero((middles >= 0) & (middles < size_mm))
    if not len(inside):
        return slice(0, 0), np.empty(0, np.intp)
    first, last = int(inside[0]), int(inside[-1]) + 1
    edges = np.floor(start_mm + np.arange(first, last + 1) * mm_per_px + 0.5).astype(np.intp)
    edges = np.clip(edges, 0, size_mm)
    # A picture pixel may be smaller than a mat pixel: it then shows the mat pixel that begins at its edge.
    edges[:-1] = np.minimum(edges[:-1], size_mm - 1)
    edges[-1] = max(edges[-1], edges[-2] + 1)
    return slice(first, last), edges


def _reduce_mat(
    mat: Pixels, row_edges: npt.NDArray[np.intp], col_edges: npt.NDArray[np.intp], keep_detail: bool
) -> Pixels:
    part = mat[row_edges[0] : row_edges[-1], col_edges[0] : col_edges[-1]]
    rows = row_edges[:-1] - row_edges[0]
    cols = col_edges[:-1] - col_edges[0]
    # The sum over the rows of a pixel stays below 2^16 as long as it covers at most 257 mm.
    narrow = np.uint16 if int(np.diff(row_edges).max()) <= 257 else np.uint32
    sums = np.add.reduceat(_reduce_rows(np.add, part, rows, narrow), cols, axis=1, dtype=np.uint32)
    areas = (
        np.maximum(np.diff(row_edges), 1)[:, None, None]
        * np.maximum(np.diff(col_edges), 1)[None, :, None]
    )
    mean = (sums / areas).astype(np.float32)
    if not keep_detail:
        plain: Pixels = np.rint(mean).astype(np.uint8)
        return plain
    low, high = (
        operation.reduceat(_reduce_rows(operation, part, rows, np.uint8), cols, axis=1).astype(
            np.float32
        )
        for operation in (np.minimum, np.maximum)
    )
    middle = part[(row_edges[:-1] + row_edges[1:]) // 2 - row_edges[0]][
        :, (col_edges[:-1] + col_edges[1:]) // 2 - col_edges[0]
    ]
    return _keep_detail(mean, low, high, middle.astype(np.float32))


def _reduce_rows(
    operation: np.ufunc, part: Pixels, starts: npt.NDArray[np.intp], dtype: npt.DTypeLike
) -> npt.NDArray[Any]:
    """Return `operation.reduceat(part, starts, axis=0, dtype=dtype)`, computed in a tenth of its time."""
    reduced = np.empty((len(starts), *part.shape[1:]), dtype)
    for row, (start, end) in enumerate(pairwise([*starts, len(part)])):
        operation.reduce(part[start : max(end, start + 1)], axis=0, dtype=dtype, out=reduced[row])
    return reduced


def _keep_detail(mean: _Numbers, low: _Numbers, high: _Numbers, middle: _Numbers) -> Pixels:
    """Return the colour of each pixel: that of the area that covers most of the pixel, or that of a thin line in it.

    A thin line is drawn in those pixels of which it covers more than of the pixels beside them.

    Args:
        mean, low, high: Mean, lowest and highest of each channel below each pixel, shape (rows, columns, 3).
        middle: The colour of the mat below the middle of each pixel, of the same shape. Beside a straight edge, this
            colour covers most of the pixel.
    """
    span = high - low
    has_contrast = span.max(axis=2) > _MIN_CONTRAST
    is_pure = (np.minimum(middle - low, high - middle) <= _PLAIN * span).all(axis=2)
    picture = np.where((has_contrast & is_pure)[..., None], middle, mean)
    around = np.pad(mean, _PAD, mode="edge")
    near = sum(_shift(around, *offset) for offset in product((-1, 0, 1), repeat=2)) / 9
    # Of the two colours, that of the line is the rarer one around the pixel.
    line = np.where(high - near < near - low, low, high)
    ground = low + high - line
    way = (line - ground) / np.maximum(np.square(span).sum(axis=2, keepdims=True), 1)
    along = ((middle - ground) * way).sum(axis=2, keepdims=True)
    off_way = np.abs(ground + along * (line - ground) - middle).max(axis=2)
    has_third = off_way > _PLAIN * span.max(axis=2)
    is_line = _find_lines(mean, ground, way) & has_contrast & ~has_third
    detailed: Pixels = np.rint(np.where(is_line[..., None], line, picture)).astype(np.uint8)
    return detailed


def _find_lines(mean: _Numbers, ground: _Numbers, way: _Numbers) -> _Flags:
    """Return which pixels show a thin line best: the line covers more of them than of the pixels on both sides of it.

    Args:
        mean: Mean colours, shape (rows, columns, 3).
        ground: The colour beside the line, of the same shape.
        way: The vector from `ground` to the line's colour, divided by the square of its length, of the same shape. The
            product of this and a colour's distance from `ground` is the share of the line in the colour.
    """
    is_line = np.zeros(mean.shape[:2], bool)
    # Off the mat, there is no part of a line.
    padded = np.pad(mean, _PAD, constant_values=np.nan)

    # Both directions, and the search for tips, compare with the same neighbours.
    @cache
    def measure(down: int, right: int) -> _Numbers:
        share: _Numbers = ((_shift(padded, down, right) - ground) * way).sum(axis=2)
        return np.nan_to_num(share)

    for down, right in ((1, 0), (0, 1)):
        last, before, share, after, next_after = (
            measure(step * down, step * right) for step in (-2, -1, 0, 1, 2)
        )
        is_best = (share > before) & (share >= after)
        covers = share + np.maximum(before, after) >= _MIN_SHARE
        # A line between two rows of pixels covers both rows; at the end of an edge, all pixels on one side are covered.
        beside = np.maximum(np.minimum(last, before), np.minimum(after, next_after))
        is_line |= (
            is_best & covers & (share - beside >= _MIN_SHARE / 2) & ~_is_tip(measure, down, right)
        )
    return is_line


def _is_tip(measure: Callable[[int, int], _Numbers], down: int, right: int) -> _Flags:
    """Return which pixels are only the tip of an area, such as of a disc, and not a part of a line.

    Along the line, the area is wider on one side of its tip, and has almost ended on the other side.

    Args:
        measure: Returns how much of each pixel's neighbour has the colour of the line; the neighbour is given by how
            many pixels it is below and to the right.
        down, right: The step across the line, in pixels: (1, 0) or (0, 1).
    """
    share = measure(0, 0)
    is_tip = np.zeros(share.shape, bool)
    for side in (-1, 1):
        row, col = side * right, side * down
        corners = np.minimum(measure(row + down, col + right), measure(row - down, col - right))
        is_tip |= (corners > share) & (measure(-row, -col) < share / 2)
    return is_tip


def _shift(padded: _Numbers, down: int, right: int) -> _Numbers:
    """Return for each pixel of a picture the values of the pixel some rows below and some columns to the right.

    Args:
        padded: The picture with `_PAD` around it.
        down: Number of rows; negative is above.
        right: Number of columns; negative is to the left.
    """
    first_row, first_col = 2 + down, 2 + right
    rows, cols = padded.shape[0] - 4, padded.shape[1] - 4
    return padded[first_row : first_row + rows, first_col : first_col + cols]


class MatPictures:
    """Makes scaled pictures of one mat, and stores one for each viewport.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat.
        whole_cells, exact: As for `shrink`.
    """

    def __init__(
        self,
        mat: Pixels,
        outside_rgb: tuple[int, int, int],
        whole_cells: bool = False,
        exact: bool = False,
    ) -> None:
        @lru_cache(maxsize=_REMEMBERED)
        def draw_picture(view: Viewport) -> Pixels:
            shrunk = shrink(mat, view, outside_rgb, whole_cells, exact)
            shrunk.flags.writeable = False
            return shrunk

        self.picture: Callable[[Viewport], Pixels] = draw_picture
        """Returns the picture for a viewport. It is shared: do not write into it."""
