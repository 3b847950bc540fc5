"""Cells: a glyph in two colours fitted to the points of a picture."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from tuisim.terminal.glyphs import GlyphSet
from tuisim.terminal.pixels import Pixels, pack_rgb

Cells = npt.NDArray[np.int64]
"""Shape (rows, columns): the glyph's number in `GLYPHS` in bits 48 to 62, the colour of the points that it covers in
bits 24 to 47, that of the others in bits 0 to 23, each 0xRRGGBB."""

_FLAT = 3
"""A cell whose points differ by no more than this in each channel, of 255, is drawn in one colour."""
_OTHER = 1e9
"""Added to the distance of a point of the other group; more than any distance."""
_DARKER = 0.01
"""Factor of the lightness of a point, which is added to its distance to decide between points equally far away."""
_AT_ONCE = 1024
"""Cells that are fitted in one step, to limit memory."""


CellIndex = tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]
"""The rows and columns of some cells."""


def list_cells(rows: int, cols: int) -> CellIndex:
    """Return the row and the column of every cell of a picture with this number of rows and columns of cells."""
    at_rows, at_cols = np.indices((rows, cols)).reshape(2, -1)
    return at_rows, at_cols


def fit_cells(picture: Pixels, glyphs: GlyphSet, places: CellIndex) -> Cells:
    """Return the glyphs and colours that show some cells of a picture best.

    Args:
        picture: The picture, a whole number of cells wide and high. Each of its cells has as many points as a glyph.
        glyphs: The glyphs to choose from.
        places: Rows and columns of the cells.

    Returns:
        One number for each cell, shape (n,).
    """
    cells: Cells = np.empty(len(places[0]), np.int64)
    for first in range(0, len(cells), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        chosen = _read_points(picture, glyphs, (places[0][some], places[1][some]))
        cells[some] = _fit_points(chosen, glyphs)
    return cells


def is_flat(picture: Pixels, glyphs: GlyphSet, places: CellIndex) -> npt.NDArray[np.bool_]:
    """Return for some cells whether all points of a cell have one colour, so that any glyph shows it as well.

    Args:
        picture, glyphs, places: As for `fit_cells`.

    Returns:
        Shape (n,).
    """
    return _is_one_color(_read_points(picture, glyphs, places))


def _read_points(picture: Pixels, glyphs: GlyphSet, places: CellIndex) -> npt.NDArray[np.uint8]:
    """Return the points of some cells of a picture, shape (3, points of a cell, n)."""
    rows = len(picture) // glyphs.rows
    cols = picture.shape[1] // glyphs.cols
    points = picture.reshape(rows, glyphs.rows, cols, glyphs.cols, 3).transpose(4, 1, 3, 0, 2)
    return points[..., places[0], places[1]].reshape(3, glyphs.rows * glyphs.cols, -1)


def _is_one_color(points: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    is_one: npt.NDArray[np.bool_] = (points.max(axis=1) - points.min(axis=1)).max(axis=0) <= _FLAT
    return is_one


def _fit_points(points: npt.NDArray[np.uint8], glyphs: GlyphSet) -> Cells:
    """Return the cells that show points best; the points have shape (3, points of a cell, n)."""
    packed = pack_rgb(points.astype(np.int64))
    if len(packed) == 2:
        # A cell of two points needs no search: the points are its two colours.
        halves: Cells = packed[0] << 24 | packed[1]
        return halves
    if len(glyphs.numbers) == 1:
        return _draw_half_blocks(points, glyphs)
    cells: Cells = packed[0] << 24 | packed[0]
    uneven = np.flatnonzero(~_is_one_color(points))
    lab = _convert_lab(points[..., uneven])
    chosen = _find_best_glyphs(lab, glyphs)
    fore, back = _find_typical(lab, glyphs.covered[chosen].T)
    cells[uneven] = glyphs.numbers[chosen] << 48 | packed[fore, uneven] << 24 | packed[back, uneven]
    return cells


def _draw_half_blocks(points: npt.NDArray[np.uint8], glyphs: GlyphSet) -> Cells:
    """Return cells with half blocks; each half has the colour of one row of points, the mean of the row.

    The mean is taken because a thin line covers only one of the two points of a row: with the colour of one point
    alone, either the line or the background would disappear.
    """
    of_rows = np.rint(points.reshape(3, glyphs.rows, glyphs.cols, -1).mean(axis=2)).astype(np.uint8)
    covered = np.repeat(glyphs.covered[0, :: glyphs.cols, None], of_rows.shape[2], axis=1)
    fore, back = _find_typical(_convert_lab(of_rows), covered)
    packed = pack_rgb(of_rows.astype(np.int64))
    numbers = np.arange(of_rows.shape[2])
    cells: Cells = glyphs.numbers[0] << 48 | packed[fore, numbers] << 24 | packed[back, numbers]
    return cells


def _find_typical(
    lab: npt.NDArray[np.float32], covered: npt.NDArray[np.float32]
) -> list[npt.NDArray[np.intp]]:
    """Return the index of a typical point in each cell: one array for its covered points, one for its other points.

    The typical point of a group is the point whose colour is nearest to the mean of the group. The mean itself often is
    no colour of the picture, and looks blurred. If two points are equally near, the darker one is taken: the lighter
    one would look like a notch in the edge of a dark band.
    """
    points: list[npt.NDArray[np.intp]] = []
    for share in (covered, 1 - covered):
        mean = (lab * share).sum(axis=1, keepdims=True) / share.sum(axis=0)
        distance = np.square(lab - mean).sum(axis=0) + _DARKER * lab[0]
        points.append((distance + _OTHER * (share < 0.5)).argmin(axis=0))
    return points


def _find_best_glyphs(lab: npt.NDArray[np.float32], glyphs: GlyphSet) -> npt.NDArray[np.intp]:
    """Return for each cell the index of the glyph that splits the cell's points into the two most even groups.

    This is the glyph whose split explains most of the variance of the points. To find it, the mean of all points is
    subtracted from them: the variance that a glyph explains then follows from the sum of the points that it covers.
    """
    size = lab.shape[1]
    # One product for each channel is so small that the library does not start threads for it.
    sums = np.matmul(glyphs.covered, lab - lab.mean(axis=1, keepdims=True))
    count = glyphs.covered.sum(axis=1)[:, None]
    explained = np.square(sums, out=sums).sum(axis=0) * (1 / count + 1 / (size - count))
    best: npt.NDArray[np.intp] = explained.argmax(axis=0)
    return best


@lru_cache(maxsize=1)
def _build_linear() -> npt.NDArray[np.float32]:
    """Return the linear light, 0 to 1, of each of the 256 sRGB values."""
    value = np.arange(256) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4).astype(
        np.float32
    )


_XYZ = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]], np.float32
) / np.array([[0.9505], [1.0], [1.089]], np.float32)
"""Matrix from linear sRGB to XYZ, relative to white (D65)."""
_FROM_ROOTS = np.array([[0, 116, 0], [500, -500, 0], [0, 200, -200]], np.float32)
"""Matrix from the cube roots of XYZ to L*a*b*, but for the 16 that is subtracted from every L*."""


def _convert_lab(points: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """Return colours of shape (3, …) in CIE L*a*b*, in which distances are as large as differences look."""
    xyz = _XYZ @ _build_linear()[points].reshape(3, -1)
    root = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    lab: npt.NDArray[np.float32] = (_FROM_ROOTS @ root).reshape(points.shape)
    return lab
