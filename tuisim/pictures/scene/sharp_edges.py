"""Straight edges of areas in a small picture of a mat: each pixel across one is of the area that covers more of it.

A cell has two colours only. With mixed pixels along both edges of a corner it would need three, and show a notch.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tuisim.terminal.pixels import Pixels

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
