"""The small picture of the mat."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.engine.core.spec import FIELD_HEIGHT_MM
from tuisim.pictures.scene.mat import MatPictures, shrink
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.glyphs import build_glyph_set
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import CellPoints, Pixels

OUTSIDE = (1, 2, 3)


def mat(ground: int = 255) -> Pixels:
    return np.full((1143, 2362, 3), ground, np.uint8)


def test_a_plain_mat_stays_plain_and_what_is_off_it_is_outside() -> None:
    picture = shrink(mat(211), Viewport.fit_field(76, 54), OUTSIDE)

    assert set(map(tuple, picture.reshape(-1, 3).tolist())) == {(211, 211, 211), OUTSIDE}
    assert tuple(picture[0, 0]) == OUTSIDE


@pytest.mark.parametrize("size", [(51, 12), (75, 20), (76, 27), (120, 33)], ids=str)
def test_a_mat_drawn_in_dots_or_signs_ends_at_a_cells_border(size: tuple[int, int]) -> None:
    cols, rows = size
    picture = shrink(
        mat(), Viewport.fit_field(2 * cols, 4 * rows, CellPoints(2, 4)), OUTSIDE, whole_cells=True
    )

    cells = picture.reshape(rows, 4, cols, 2, 3)
    assert (cells == cells[:, :1, :, :1]).all(), "a cell of two colours"
    inside = np.argwhere((cells[:, 0, :, 0] == 255).all(axis=2))
    assert np.ptp(inside[:, 1]) + 1 in (cols - 1, cols) or np.ptp(inside[:, 0]) + 1 in (
        rows - 1,
        rows,
    )


def test_light_lines_on_a_dark_mat_are_drawn_as_clearly_as_the_reverse() -> None:
    pixels = mat()
    for row, col, thick in ((100, 90, 6), (400, 700, 14), (801, 1501, 40)):
        pixels[row : row + thick] = 30
        pixels[:, col : col + thick] = 90
    light, dark = (
        shrink(one, Viewport.fit_field(96, 50), OUTSIDE) for one in (pixels, 255 - pixels)
    )
    on_mat = (light != OUTSIDE).any(axis=2)
    assert on_mat.mean() > 0.8
    assert np.abs(light[on_mat] + dark[on_mat].astype(int) - 255).max() <= 1


@pytest.mark.slow
@for_each(cells=list(CellSet), size=[(74, 20)], across_per_down=[0.0, 0.37, 1.0, 3.1])
def test_a_thin_line_of_a_mat_is_drawn_without_gaps(
    cells: CellSet, size: tuple[int, int], across_per_down: float
) -> None:
    """Each point of the line is seen in the picture at its place or beside it."""
    pixels = mat()
    down = np.arange(100, 1000)
    middle = (600 + across_per_down * (down - 100)).astype(int)
    rows = down[middle < 2300]
    thick = 10 * np.hypot(1, across_per_down)
    for row, col in zip(rows, middle, strict=False):
        pixels[row, round(col - thick / 2) : round(col + thick / 2)] = 0

    glyphs = build_glyph_set(cells)
    view = Viewport.fit_field(
        size[0] * glyphs.cols, size[1] * glyphs.rows, CellPoints(glyphs.cols, glyphs.rows)
    )
    picture = shrink(pixels, view, OUTSIDE)[..., 0].astype(int)

    around = np.pad(picture, 1, constant_values=255)
    near = np.min(
        [
            around[r : r + len(picture), c : c + picture.shape[1]]
            for r in range(3)
            for c in range(3)
        ],
        axis=0,
    )
    at = [
        view.to_px(float(col), float(FIELD_HEIGHT_MM - row))
        for row, col in zip(rows, middle, strict=False)
    ]
    seen = [255 - near[int(row), int(col)] for col, row in at]
    assert min(seen) > 60
    assert min(seen) > 0.5 * max(seen)


@pytest.mark.parametrize("size", [(156, 34), (152, 40), (304, 76)], ids=str)
def test_a_thin_black_line_is_black_wherever_it_lies(size: tuple[int, int]) -> None:
    view = Viewport.fit_field(*size, CellPoints(2, 2))
    for start_mm in range(500, 540, 7):
        for axis in (0, 1):
            pixels = mat()
            pixels.swapaxes(0, axis)[start_mm : start_mm + 10] = 0
            picture = shrink(pixels, view, OUTSIDE)
            lines = np.nonzero((picture == 0).all(axis=2).swapaxes(0, axis).any(axis=1))[0]
            assert len(lines) == 1 or (len(lines) == 2 and view.mm_per_px < 10)
            assert set(np.unique(picture)) <= {0, 255, *OUTSIDE}


def test_a_view_finer_than_the_mat_repeats_pixels() -> None:
    pixels = mat()
    pixels[600, 1000] = 0
    view = Viewport(8, 8, 0.5, 999.0, 1143 - 599.0)

    picture = shrink(pixels, view, OUTSIDE)

    assert (picture[..., 0] == 0).sum() == 4


def test_the_mats_picture_for_a_view_is_computed_once() -> None:
    pictures = MatPictures(mat(), OUTSIDE)
    view = Viewport.fit_field(40, 20)

    assert pictures.picture(view) is pictures.picture(view)
