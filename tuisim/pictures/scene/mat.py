"""Pictures of the mat: the part of it in view, scaled down so that thin lines stay visible."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from tuisim.pictures.scene.sharp_edges import sharpen_edges
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

_REMEMBERED = 4
_STRONGER = 2.5
_CLEAR = 0.6
"""What covers less of a pixel than `_CLEAR` is drawn as if it covered `_STRONGER` times as much, up to that."""
_PLAIN = 0.15
"""A pixel of which less than this is of another colour is one of an area, and not of a thin line."""
_AREA_MM = 60
"""Anything narrower is a line."""
_FINE_COLS = 2
"""Pixels of so many across a cell, or of fewer, are so large that thin lines need it."""


def shrink(
    mat: Pixels,
    view: Viewport,
    outside_rgb: tuple[int, int, int],
    whole_cells: bool = False,
    exact: bool = False,
) -> Pixels:
    """Return what a viewport shows of a mat.

    Each picture pixel is the mean of the mat pixels under it. Where a pixel is as wide as a cell or half of it, it is
    moved toward the colour that is rarer around it, so that a line of 10 mm can still be seen when a pixel covers
    30 mm, and looks the same whether it lies in one row of pixels or between two. Such pictures also have sharp
    straight edges between areas.

    Args:
        mat: The mat, one pixel a mm, row 0 at the top of the field.
        view: The part to show.
        outside_rgb: Colour of what lies off the mat.
        whole_cells: End the mat where a cell ends, for glyphs that do not fill their cells: half of a cell in another
            colour would be a column of dots or brackets beside it.
        exact: Leave every mean as it is.

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
    """Move both ends of the mat in `lines` to the nearest ends of cells of `step` lines, in place.

    Args:
        inside: The lines that show the mat.
    """
    first, end = (step * math.floor(edge / step + 0.5) for edge in (inside.start, inside.stop))
    lines[first : inside.start] = lines[inside.start]
    lines[inside.start : first] = outside_rgb
    lines[inside.stop : end] = lines[inside.stop - 1]
    lines[end : inside.stop] = outside_rgb


def _find_edges(
    start_mm: float, mm_per_px: float, count: int, size_mm: int
) -> tuple[slice, npt.NDArray[np.intp]]:
    """Return which picture pixels have their middle on the mat, and the edges of these pixels on the mat, in mm."""
    middles = start_mm + (np.arange(count) + 0.5) * mm_per_px
    inside = np.flatnonzero((middles >= 0) & (middles < size_mm))
    if not len(inside):
        return slice(0, 0), np.empty(0, np.intp)
    first, last = int(inside[0]), int(inside[-1]) + 1
    edges = np.floor(start_mm + np.arange(first, last + 1) * mm_per_px + 0.5).astype(np.intp)
    edges = np.clip(edges, 0, size_mm)
    # Where a picture pixel is smaller than a mat pixel, it shows the one that begins there.
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
    low = np.minimum.reduceat(_reduce_rows(np.minimum, part, rows, np.uint8), cols, axis=1).astype(
        np.float32
    )
    high = np.maximum.reduceat(_reduce_rows(np.maximum, part, rows, np.uint8), cols, axis=1).astype(
        np.float32
    )
    picture = _keep_detail(mean, low, high)
    rows_mm, cols_mm = (max(int(np.median(np.diff(edges))), 1) for edges in (row_edges, col_edges))
    sharpen_edges(
        picture,
        mean,
        high - low,
        (max(-(-_AREA_MM // rows_mm), 2), max(-(-_AREA_MM // cols_mm), 2)),
    )
    return picture


def _reduce_rows(
    operation: np.ufunc, part: Pixels, starts: npt.NDArray[np.intp], dtype: npt.DTypeLike
) -> npt.NDArray[Any]:
    """Return `operation.reduceat(part, starts, axis=0, dtype=dtype)`, in a tenth of its time."""
    reduced = np.empty((len(starts), *part.shape[1:]), dtype)
    for row, (start, end) in enumerate(pairwise([*starts, len(part)])):
        operation.reduce(part[start : max(end, start + 1)], axis=0, dtype=dtype, out=reduced[row])
    return reduced


def _keep_detail(
    mean: npt.NDArray[np.float32], low: npt.NDArray[np.float32], high: npt.NDArray[np.float32]
) -> Pixels:
    """Move each mean toward its lowest or highest colour, whichever is further from the mean of the pixels around it.

    Plain areas and gradients are hardly changed: lowest and highest are nearly the same there. Nor are the edges of
    areas: a pixel beside an edge has nearly the colour of the area, unlike one beside a thin line.
    """
    around = np.pad(mean, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows, cols = mean.shape[:2]
    nine = [around[row : row + rows, col : col + cols] for row in range(3) for col in range(3)]
    near = sum(nine) / len(nine)
    is_dark = high - near < near - low
    line = np.where(is_dark, low, high)
    ground = np.where(is_dark, high, low)
    span = line - ground
    share = (mean - ground) / np.where(span == 0, 1, span)
    nearest = np.where(is_dark, np.minimum.reduce(nine), np.maximum.reduce(nine))
    is_edge = np.abs(line - nearest) < _PLAIN * np.abs(span)
    stronger = np.where(is_edge, share, np.minimum(_STRONGER * share, _CLEAR))
    picture: Pixels = np.rint(ground + span * np.maximum(share, stronger)).astype(np.uint8)
    return picture


class MatPictures:
    """Scaled pictures of one mat, cached by viewport.

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
