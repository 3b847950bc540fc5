"""Cells are fitted to the picture alone; those of one colour need no glyph."""

from __future__ import annotations

import numpy as np
import pytest

from tests.terminal.test_cells import picture_of
from tuisim.terminal.fitted_cells import all_cells, fit_cells, is_flat
from tuisim.terminal.glyphs import glyph_set
from tuisim.terminal.picture_options import CellSet


def test_cells_of_one_color_are_flat() -> None:
    glyphs = glyph_set(CellSet.OCTANT)
    picture = np.concatenate(
        [picture_of(CellSet.OCTANT, pattern) for pattern in (0x00, 0x0F, 0xFF)], axis=1
    )
    assert is_flat(picture, glyphs, all_cells(1, 3)).tolist() == [True, False, True]


@pytest.mark.parametrize("cells", [CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT])
def test_flat_cells_are_those_without_two_colors(cells: CellSet) -> None:
    glyphs = glyph_set(cells)
    picture = np.concatenate([picture_of(cells, 1), picture_of(cells, 0)], axis=1)
    fitted = fit_cells(picture, glyphs, all_cells(1, 2))
    has_two = (fitted >> 24 & 0xFFFFFF) != (fitted & 0xFFFFFF)
    assert is_flat(picture, glyphs, all_cells(1, 2)).tolist() == (~has_two).tolist()
