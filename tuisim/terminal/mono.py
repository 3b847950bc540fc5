"""Pictures without colours: darkness as dots or as signs, so that greys which have to be told apart look different."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from tuisim.terminal.glyphs import BRAILLE_FROM, Covered, GlyphSet, nearest_signs, sign_number
from tuisim.terminal.picture_options import CellSet

if TYPE_CHECKING:
    from tuisim.terminal.fitted_cells import CellIndex, Cells
    from tuisim.terminal.pixels import Pixels

_LUMA = np.array([0.299, 0.587, 0.114], np.float32)
_GREYS, _DARKNESS = (0, 128, 211, 220, 255), (1.0, 0.5, 0.25, 0.125, 0.0)
"""Two, four and eight times the ink for the darker greys of the mats, which are hardly darker than each other."""
_THRESHOLDS = (np.array([0, 4, 6, 2, 1, 5, 7, 3], np.float32) + 0.5) / 8
"""The order in which the points of a cell get dots: each dot far from the last one."""
_RAMP = " .:-+xoO8@"
_EVEN = 0.13
"""Points whose darkness differs by less than this are shown by a sign for their mean."""
_INK_ON_PAPER = 0xFFFFFF << 24
"""Light dots on black where a picture needs colours after all, as in a screenshot."""


def darkness(points: npt.NDArray[np.uint8]) -> Covered:
    """Return how dark colours are, shape (…, 3), from 0 for white to 1 for black."""
    found: Covered = np.interp(points @ _LUMA, _GREYS, _DARKNESS).astype(np.float32)
    return found


def mono_cells(picture: Pixels, glyphs: GlyphSet, at: CellIndex, cell_set: CellSet) -> Cells:
    """Return some cells of a picture as dots or signs, shape (n,)."""
    rows, cols = len(picture) // glyphs.rows, picture.shape[1] // glyphs.cols
    points = picture.reshape(rows, glyphs.rows, cols, glyphs.cols, 3).transpose(0, 2, 1, 3, 4)[at]
    ink = darkness(points.reshape(len(points), glyphs.rows * glyphs.cols, 3))
    if cell_set is CellSet.BRAILLE:
        dots = ink > _THRESHOLDS
        patterns = (dots << np.arange(dots.shape[1])).sum(axis=1)
        numbers = np.where(patterns == 0, sign_number(" "), BRAILLE_FROM + patterns)
    else:
        ramp = np.array([sign_number(sign) for sign in _RAMP])
        even = np.ptp(ink, axis=1) < _EVEN
        steps = np.rint(ink.mean(axis=1) * (len(_RAMP) - 1)).astype(np.intp)
        numbers = np.where(even, ramp[steps], nearest_signs(ink))
    cells: Cells = numbers.astype(np.int64) << 48 | _INK_ON_PAPER
    return cells


def sign_cell(sign: str) -> int:
    """Return the cell that shows a sign."""
    return sign_number(sign) << 48 | _INK_ON_PAPER
