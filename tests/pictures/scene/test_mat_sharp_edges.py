"""Straight edges of areas in the small picture of a mat."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.pictures.scene.mat import shrink
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import CellPoints, Pixels

OUTSIDE = (1, 2, 3)
BLOCKS = CellPoints(2, 2)
SIZES = [(156, 40), (152, 60), (304, 110)]


def field() -> Pixels:
    return np.full((1143, 2362, 3), 255, np.uint8)


def drawn(mat: Pixels, size: tuple[int, int], *, exact: bool = False) -> Pixels:
    return shrink(mat, Viewport.fit_field(*size, BLOCKS), OUTSIDE, exact=exact)


def colors_of(picture: Pixels) -> set[tuple[int, ...]]:
    return set(map(tuple, picture.reshape(-1, 3).tolist())) - {OUTSIDE}


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("by_mm", [0, 3, 7, 11])
def test_a_drawn_band_of_a_mat_has_no_notches_and_no_mixed_edges(
    size: tuple[int, int], by_mm: int
) -> None:
    mat = field()
    mat[201 + by_mm : 901, 501 + by_mm : 607 + 2 * by_mm] = 128
    picture = drawn(mat, size)
    assert colors_of(picture) == {(128, 128, 128), (255, 255, 255)}
    rows, cols = np.nonzero((picture == 128).all(axis=2))
    assert len(rows) == (np.ptp(rows) + 1) * (np.ptp(cols) + 1)


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_bands_beside_each_other_have_no_spikes_where_three_colours_meet(
    size: tuple[int, int],
) -> None:
    mat = field()
    colors = {(255, 0, 0), (0, 255, 0), (0, 0, 255)}
    for at, color in enumerate(sorted(colors)):
        mat[207:901, 507 + 131 * at : 638 + 131 * at] = color
    assert colors_of(drawn(mat, size)) == {*colors, (255, 255, 255)}


def test_a_mats_edge_is_drawn_sharp_up_to_an_adjoining_area() -> None:
    mat = field()
    mat[204:601, 503:701] = 0
    mat[303:701, 703:901] = 128
    is_mixed = drawn(mat, SIZES[1], exact=True)[18:21, 45] < 250
    assert is_mixed.all()
    assert (drawn(mat, SIZES[1])[18:21, 45] == 255).all()


def test_a_mats_line_is_drawn_up_to_the_area_that_it_ends_at() -> None:
    mat = field()
    mat[203:907, 803:1205] = 0
    mat[550:562, 300:803] = 0
    picture = drawn(mat, SIZES[1])
    rows = np.nonzero((picture[:, 40] < 200).all(axis=1))[0]
    line = picture[rows[0] : rows[-1] + 1].min(axis=(0, 2))
    first = int(np.nonzero(line[40:] == 0)[0][0]) + 40
    assert (line[40:first] < 200).all()


@pytest.mark.parametrize("by_mm", range(0, 40, 5))
def test_a_dot_of_a_mat_has_no_spike_at_its_top_or_bottom(by_mm: int) -> None:
    mat = field()
    rows, cols = np.ogrid[:1143, :2362]
    mat[np.hypot(rows - 507 - by_mm, cols - 909 - by_mm) < 50] = (255, 0, 0)
    is_red = (drawn(mat, (124, 30)) == (255, 0, 0)).all(axis=2)
    share = 1 - drawn(mat, (124, 30), exact=True)[..., 1] / 255
    widths = is_red.sum(axis=1)
    assert widths.max() >= 4
    spikes = is_red & (widths == 1)[:, None]
    assert (share[spikes] >= 0.5).all(), "a point that is mostly white is red"
