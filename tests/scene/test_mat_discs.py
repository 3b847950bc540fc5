"""Sensor discs."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.core.field import disc_pixels
from tuisim.scene.discs import draw_discs, lay_out

GROUND, CORNER = (1, 1, 1), (2, 2, 2)


def box(diameter: int, value: int) -> bytes:
    return bytes([value]) * (3 * diameter**2)


@pytest.mark.parametrize(
    ("count", "width", "height", "side", "beside"),
    [
        pytest.param(2, 40, 20, 20, True, id="beside without a gap"),
        pytest.param(2, 26, 40, 20, False, id="stacked"),
        pytest.param(2, 18, 12, 9, True, id="small"),
        pytest.param(2, 120, 80, 20, True, id="much room"),
        pytest.param(3, 60, 20, 20, True, id="three sensors"),
        pytest.param(1, 2, 2, 2, True, id="hardly any room"),
        pytest.param(0, 40, 20, 20, True, id="no sensor"),
    ],
)
def test_layout(count: int, width: int, height: int, side: int, beside: bool) -> None:
    layout = lay_out(count, width, height)

    assert (layout.side_px, layout.beside) == (side, beside)
    for col, row in layout.corners:
        assert 0 <= col <= width - side
        assert 0 <= row <= height - side
        assert row % 2 == 0


@pytest.mark.parametrize("diameter", [10, 20, 30])
def test_discs_show_their_pixels(diameter: int) -> None:
    layout = lay_out(2, 60, 30)

    picture = draw_discs(layout, [box(diameter, 100), box(diameter, 200)], GROUND, CORNER)

    if diameter <= layout.side_px:
        assert (picture == 100).all(axis=2).sum() == disc_pixels(diameter)
    assert (picture == 200).all(axis=2).any()
    assert (picture == CORNER).all(axis=2).any()
    assert tuple(picture[-1, 0]) == GROUND


def test_a_disc_made_smaller_keeps_its_halves() -> None:
    pixels = np.zeros((20, 20, 3), np.uint8)
    pixels[:, 10:] = 250

    picture = draw_discs(lay_out(1, 10, 10), [pixels.tobytes()], GROUND, CORNER)

    assert picture[5, 2, 0] == 0
    assert picture[5, 8, 0] == 250
