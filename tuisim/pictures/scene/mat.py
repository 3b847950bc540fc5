"""Pictures of the mat: the part of it in view, scaled down so that thin lines stay visible."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

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


# A cell has two colours only. With mixed pixels along both edges of a corner it would need three, and show a notch.

_EVEN = 4
"""Colours whose channels differ by no more than this are one."""
_STRAIGHT = 0.04
_RUN = 3
"""Along a straight edge the shares of so many pixels differ by no more than this."""
_LIGHT = np.array([0.30, 0.59, 0.11], np.float32)
"""How bright each channel looks."""
_ENDS = 2
"""So many pixels at each end of an edge go with it, where that is round."""
_CORNER = 0.06
"""How exactly the share of a corner is the product of those of its edges."""

_Numbers = npt.NDArray[np.float32]
_Flags = npt.NDArray[np.bool_]
_Places = tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]
"""The rows and columns of some pixels."""


def sharpen_edges(picture: Pixels, mean: _Numbers, span: _Numbers, area: tuple[int, int]) -> None:
    """Give each pixel on a straight edge between two areas, upright or level, the colour of one of them.

    Args:
        picture: Modified in place, shape (rows, columns, 3).
        mean: Means of the mat below each pixel, of the same shape.
        span: Ranges of the colours of the mat below each pixel, of the same shape.
        area: Rows and columns of one colour from which on they are an area, and not a line.
    """
    is_area = _find_areas(mean, span, area)
    light = _list_neighbors(np.where(is_area, mean @ _LIGHT, np.nan))
    edge_places = np.nonzero((span > _EVEN).any(axis=2) & ~np.isnan(np.array(light)).all(axis=0))
    near = np.array([channel_values[edge_places] for channel_values in light])
    around = np.array(
        [
            [channel_values[edge_places] for channel_values in _list_neighbors(channel)]
            for channel in np.moveaxis(mean, 2, 0)
        ]
    )
    here = np.arange(len(edge_places[0]))
    dark, bright = (around[:, find(near, axis=0), here].T for find in (np.nanargmin, np.nanargmax))
    way = bright - dark
    share = ((mean[edge_places] - dark) * way).sum(axis=1) / np.maximum(
        np.square(way).sum(axis=1), 1
    )
    is_mixed = (np.abs(dark + share[:, None] * way - mean[edge_places]) <= _EVEN).all(axis=1) & (
        np.abs(way) > _EVEN
    ).any(axis=1)
    shares = np.full(is_area.shape, np.nan, np.float32)
    shares[edge_places] = np.where(is_mixed, share, np.nan)
    is_bright, is_dark = _split_sides(shares)
    for is_so, color in ((is_bright[edge_places], bright), (is_dark[edge_places], dark)):
        picture[edge_places[0][is_so], edge_places[1][is_so]] = np.rint(color[is_so]).astype(
            np.uint8
        )
    # Pixels where three areas meet get the nearest of their colours.
    colors = np.where(np.isnan(near)[..., None], np.nan, around.transpose(1, 2, 0))
    others = [np.abs(colors - color).max(axis=2) > _EVEN for color in (dark, bright)]
    third = np.logical_and(*others).any(axis=0) & ~(is_bright | is_dark)[edge_places]
    _close_gaps(
        picture, mean, is_area | is_bright | is_dark, (edge_places[0][third], edge_places[1][third])
    )


def _close_gaps(picture: Pixels, mean: _Numbers, is_sharp: _Flags, edge_places: _Places) -> None:
    """Give pixels where three areas meet a colour of an edge that goes on at both sides of them, the nearer colour."""
    for axis in (0, 1):
        inside = (edge_places[axis] > 0) & (edge_places[axis] < picture.shape[axis] - 1)
        here = edge_places[0][inside], edge_places[1][inside]
        sides = [(here[0] + by * (axis == 0), here[1] + by * (axis == 1)) for by in (-1, 1)]
        goes_on = is_sharp[sides[0]] & is_sharp[sides[1]]
        neighbors = np.array([picture[side][goes_on] for side in sides])
        place = here[0][goes_on], here[1][goes_on]
        nearer = np.square(neighbors - mean[place]).sum(axis=2).argmin(axis=0)
        picture[place] = neighbors[nearer, np.arange(len(nearer))]


def _find_areas(mean: _Numbers, span: _Numbers, area: tuple[int, int]) -> _Flags:
    """Return which pixels belong to a rectangle of one colour that is at least as large as an area."""
    rows, cols = area
    if any(size > length for size, length in zip(area, mean.shape, strict=False)):
        return np.zeros(mean.shape[:2], bool)
    is_even = span.max(axis=2) <= _EVEN
    as_below, as_beside = (np.abs(np.diff(mean, axis=axis)).max(axis=2) <= _EVEN for axis in (0, 1))
    upright = _reduce_along(np.logical_and, is_even, 0, rows) & _reduce_along(
        np.logical_and, as_below, 0, rows - 1
    )
    beside = _reduce_along(np.logical_and, as_beside, 0, rows)
    inside: _Flags = _reduce_along(np.logical_and, upright, 1, cols) & _reduce_along(
        np.logical_and, beside, 1, cols - 1
    )
    for axis, size in enumerate(area):
        inside = _spread(inside, axis, size)
    return inside


def _split_sides(shares: _Numbers) -> tuple[_Flags, _Flags]:
    """Return which pixels belong to the brighter side of an edge, and which to the darker side.

    Args:
        shares: How much of each pixel the brighter side covers; NaN where there is no edge.
    """
    upright, level = (np.where(_find_runs(shares, axis), shares, np.nan) for axis in (0, 1))
    is_bright = (upright >= 0.5) | (level >= 0.5)
    is_dark = (upright < 0.5) | (level < 0.5)
    (_, up, _, _, _, _, _, down, _), (_, _, _, left, _, right, _, _, _) = (
        _list_neighbors(upright),
        _list_neighbors(level),
    )
    for first in (up, down):
        for second in (left, right):
            both = (first >= 0.5) & (second >= 0.5)
            none = (first < 0.5) & (second < 0.5)
            of_bright = np.abs(shares - first * second) < _CORNER
            of_dark = np.abs((1 - shares) - (1 - first) * (1 - second)) < _CORNER
            is_bright |= (of_bright & both) | (of_dark & ~none)
            is_dark |= (of_bright & ~both) | (of_dark & none)
    is_dark &= ~is_bright
    for _ in range(_ENDS):
        is_bright, is_dark = (
            so | (mixed & (np.any(_list_neighbors(so)[1::2], axis=0)))
            for so, mixed in (
                (is_bright, (shares >= 0.5) & ~is_dark),
                (is_dark, (shares < 0.5) & ~is_bright),
            )
        )
    return is_bright & ~np.isnan(shares), is_dark & ~np.isnan(shares)


def _find_runs(shares: _Numbers, axis: int) -> _Flags:
    """Return which pixels belong to a run of nearly equal shares along an axis."""
    if shares.shape[axis] < _RUN:
        return np.zeros(shares.shape, bool)
    span = _reduce_along(np.maximum, shares, axis, _RUN) - _reduce_along(
        np.minimum, shares, axis, _RUN
    )
    return _spread(span <= _STRAIGHT, axis, _RUN)


def _reduce_along(
    operation: np.ufunc, values: npt.NDArray[Any], axis: int, size: int
) -> npt.NDArray[Any]:
    """Return the result of an operation on `size` successive values along an axis, for each position."""
    lines = values.swapaxes(0, axis)
    count = len(lines) - size + 1
    reduced: npt.NDArray[Any] = operation.reduce(
        [lines[first : first + count] for first in range(size)]
    )
    return reduced.swapaxes(0, axis)


def _spread(flags: _Flags, axis: int, size: int) -> _Flags:
    """Return for each value whether it belongs to a window of `size` values that `_reduce_along` has found."""
    beyond = [(size - 1, size - 1) if each == axis else (0, 0) for each in range(2)]
    return _reduce_along(np.logical_or, np.pad(flags, beyond), axis, size)


def _list_neighbors(values: npt.NDArray[Any]) -> list[npt.NDArray[Any]]:
    """Return the values of all pixels, and for each direction those of their neighbours."""
    rows, cols = values.shape
    around = np.pad(values, 1, mode="edge")
    return [around[row : row + rows, col : col + cols] for row in range(3) for col in range(3)]
