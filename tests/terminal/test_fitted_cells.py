"""Cells are fitted to the picture alone; those of one colour need no glyph."""

from __future__ import annotations

import numpy as np
import pytest

from tests.terminal.test_cells import picture_of
from tuisim.terminal.fitted_cells import fit_cells, is_flat, list_cells
from tuisim.terminal.glyphs import build_glyph_set
from tuisim.terminal.picture_options import CellSet


def test_cells_of_one_colour_need_no_glyph() -> None:
    glyphs = build_glyph_set(CellSet.OCTANT)
    picture = np.concatenate(
        [picture_of(CellSet.OCTANT, pattern) for pattern in (0x00, 0x0F, 0xFF)], axis=1
    )
    assert is_flat(picture, glyphs, list_cells(1, 3)).tolist() == [True, False, True]


@pytest.mark.parametrize("cells", [CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT])
def test_is_flat_marks_exactly_the_cells_fitted_with_one_colour(cells: CellSet) -> None:
    glyphs = build_glyph_set(cells)
    picture = np.concatenate([picture_of(cells, 1), picture_of(cells, 0)], axis=1)
    fitted = fit_cells(picture, glyphs, list_cells(1, 2))
    has_two = (fitted >> 24 & 0xFFFFFF) != (fitted & 0xFFFFFF)
    assert is_flat(picture, glyphs, list_cells(1, 2)).tolist() == (~has_two).tolist()


@pytest.mark.parametrize("ground_first", [True, False], ids=["left edge", "right edge"])
@pytest.mark.parametrize("band", [(211, 211, 211), (128, 128, 128)])
def test_a_robots_corner_makes_no_notch_of_the_ground_in_a_band(
    band: tuple[int, int, int], ground_first: bool
) -> None:
    ground = (255, 255, 255)
    robot = (0, 95, 215)
    above = [ground, band] if ground_first else [band, ground]
    picture = np.array([above, [robot, robot]], np.uint8)
    (cell,) = fit_cells(picture, build_glyph_set(CellSet.QUADRANT), list_cells(1, 1)).tolist()
    shown = {cell >> 24 & 0xFFFFFF, cell & 0xFFFFFF}
    red, green, blue = band
    assert 0xFFFFFF not in shown
    assert red << 16 | green << 8 | blue in shown
