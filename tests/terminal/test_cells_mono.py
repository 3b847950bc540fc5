"""Pictures without colours."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.terminal.cells import draw_mono_cells
from tuisim.terminal.fitted_cells import list_cells
from tuisim.terminal.glyphs import GLYPHS, build_glyph_set
from tuisim.terminal.picture_options import CellSet


@pytest.mark.parametrize("cells", [CellSet.BRAILLE, CellSet.ASCII])
def test_without_colours_the_greys_of_the_mats_are_drawn_in_different_glyphs(
    cells: CellSet,
) -> None:
    glyphs = build_glyph_set(cells)

    def area(grey: int) -> str:
        picture = np.full((glyphs.rows, glyphs.cols, 3), grey, np.uint8)
        return GLYPHS[int(draw_mono_cells(picture, glyphs, list_cells(1, 1), cells)[0]) >> 48]

    shown = [area(grey) for grey in (255, 220, 211, 128, 0)]

    assert len(set(shown)) == 5
    assert shown[0] == " "
