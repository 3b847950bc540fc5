"""Cells and what changed between frames."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cases import cases
from tuisim.terminal.cells import find_changed_cells, find_changed_runs
from tuisim.terminal.fitted_cells import Cells, fit_cells, list_cells
from tuisim.terminal.glyphs import GLYPHS, build_glyph_set, build_half_block
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import Pixels

INK = (255, 0, 0)
PAPER = (255, 255, 255)
FINE = (CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT, CellSet.BRAILLE)


def picture_of(cells: CellSet, pattern: int) -> Pixels:
    """One cell with ink on the points of a pattern."""
    glyphs = build_glyph_set(cells)
    points = glyphs.rows * glyphs.cols
    colors = [INK if pattern >> point & 1 else PAPER for point in range(points)]
    return np.array(colors, np.uint8).reshape(glyphs.rows, glyphs.cols, 3)


def glyph(cell: int) -> str:
    return GLYPHS[cell >> 48]


def test_a_half_block_cell_holds_the_upper_and_the_lower_colour() -> None:
    picture = np.array([[[1, 2, 3]], [[4, 5, 6]]], np.uint8)

    assert fit_cells(picture, build_glyph_set(CellSet.HALF), list_cells(1, 1)).tolist() == [
        0x010203_040506
    ]


@pytest.mark.parametrize("cells", FINE)
def test_a_cell_of_two_colours_is_drawn_exactly_for_every_pattern(cells: CellSet) -> None:
    glyphs = build_glyph_set(cells)
    for pattern in range(1, (1 << glyphs.rows * glyphs.cols) - 1):
        picture = picture_of(cells, pattern)

        cell = int(fit_cells(picture, glyphs, list_cells(1, 1))[0])

        covered = glyphs.covered[glyphs.numbers.tolist().index(cell >> 48)] > 0.5
        fore = cell >> 24 & 0xFFFFFF
        back = cell & 0xFFFFFF
        shown = [fore if point else back for point in covered]
        assert shown == [int.from_bytes(bytes(point)) for point in picture.reshape(-1, 3)], pattern


@pytest.mark.parametrize("cells", FINE)
def test_a_cell_of_nearly_one_colour_needs_no_glyph(cells: CellSet) -> None:
    glyphs = build_glyph_set(cells)
    picture = np.full((glyphs.rows, glyphs.cols, 3), 211, np.uint8)
    picture[0, 0] = 212

    cell = int(fit_cells(picture, glyphs, list_cells(1, 1))[0])

    assert cell >> 24 == cell & 0xFFFFFF


@pytest.mark.parametrize("cells", FINE)
def test_only_cells_that_changed_are_fitted_to_glyphs_again(cells: CellSet) -> None:
    glyphs = build_glyph_set(cells)
    old = np.zeros((3 * glyphs.rows, 5 * glyphs.cols, 3), np.uint8)
    new = old.copy()
    new[2 * glyphs.rows, 4 * glyphs.cols, 2] = new[glyphs.rows - 1, 2 * glyphs.cols - 1, 0] = 1

    rows, cols = find_changed_cells(old, new, glyphs)

    assert list(zip(rows.tolist(), cols.tolist(), strict=True)) == [(0, 1), (2, 4)]


@pytest.mark.parametrize("cells", [CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT])
def test_a_fine_picture_can_be_drawn_as_half_blocks(cells: CellSet) -> None:
    coarse = build_half_block(cells)
    picture = np.full((coarse.rows, coarse.cols, 3), 255, np.uint8)
    picture[: coarse.rows // 2] = 0

    cell: Cells = fit_cells(picture, coarse, list_cells(1, 1))

    assert cell.tolist() == [0x000000_FFFFFF]
    assert glyph(int(cell[0])) == "▀"


@cases(
    "changed, runs",
    {
        "nothing": ([], []),
        "one cell": ([4], [(0, 4, 1)]),
        "a gap of two is joined": ([2, 5], [(0, 2, 4)]),
        "a gap of three is not": ([2, 6], [(0, 2, 1), (0, 6, 1)]),
        "rows are apart": ([9, 10], [(0, 9, 1), (1, 0, 1)]),
    },
)
def test_changed_cells_of_a_row_are_joined_to_runs(
    changed: list[int], runs: list[tuple[int, int, int]]
) -> None:
    old = np.zeros((3, 10), np.int64)
    new = old.copy()
    new.flat[changed] = 1

    assert find_changed_runs(old, new) == runs


@given(st.lists(st.booleans(), min_size=60, max_size=60))
def test_runs_of_changed_cells_cover_every_change_and_do_not_touch(changed: list[bool]) -> None:
    old = np.zeros((3, 20), np.int64)
    new = np.array(changed, np.int64).reshape(3, 20)
    covered = np.zeros((3, 20), int)

    for row, first, length in find_changed_runs(old, new):
        covered[row, first : first + length] += 1

    assert covered.max() <= 1
    assert covered[new != old].all()
