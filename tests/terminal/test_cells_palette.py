"""Fewer colours: what has to stay apart stays apart."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import cases, for_each
from tuisim.pictures.scene.robot import COLORED, GREY
from tuisim.terminal.cells import (
    PALETTE_8,
    PALETTE_16,
    PALETTE_256,
    ColorMode,
    find_sgr_index,
    reduce_pixels,
)
from tuisim.terminal.pixels import Pixels

MODES = [
    ColorMode(),
    ColorMode(PALETTE_256),
    ColorMode(PALETTE_16),
    ColorMode(PALETTE_8),
    ColorMode(grey=True),
    ColorMode(PALETTE_256, grey=True),
]


def area(rgb: tuple[int, int, int], mode: ColorMode) -> Pixels:
    """A plain area of 8 × 8 pixels as the terminal shows it."""
    rows, cols = np.indices((8, 8)).reshape(2, -1)
    return reduce_pixels(np.full((64, 3), rgb, np.uint8), rows, cols, mode)


@for_each(mode=MODES, band=[220, 211, 128, 0])
def test_in_few_colours_grey_bands_stand_out_on_white(mode: ColorMode, band: int) -> None:
    white = area((255, 255, 255), mode)
    grey = area((band,) * 3, mode)

    assert len(np.unique(white)) == 1
    assert grey.mean() < white.mean() - 5


def test_in_8_colours_the_ground_of_a_panel_is_one_colour() -> None:
    assert len(np.unique(area((16, 20, 27), ColorMode(PALETTE_8)))) == 1


@for_each(mode=MODES, ground=[0, 128, 211, 255])
def test_in_few_colours_the_robot_stands_out_on_every_ground(mode: ColorMode, ground: int) -> None:
    colors = GREY if mode.grey else COLORED
    below = area((ground,) * 3, mode).astype(int)

    contrast = [
        abs(area(part, mode).astype(int) - below).mean() for part in (colors.body, colors.marker)
    ]

    assert max(contrast) > 50


def test_in_grey_the_robots_marker_differs_from_its_body() -> None:
    mode = ColorMode(grey=True)

    assert area(GREY.marker, mode).mean() - area(GREY.body, mode).mean() > 100


@cases(
    "rgb, depth, index",
    {
        "black": (0x000000, PALETTE_256, 16),
        "white": (0xFFFFFF, PALETTE_256, 231),
        "a grey of the ramp": (0xD0D0D0, PALETTE_256, 252),
        "a colour of the cube": (0x005FD7, PALETTE_256, 26),
        "red of 16": (0xFF0000, PALETTE_16, 1),
        "white of 16": (0xFFFFFF, PALETTE_16, 15),
    },
)
def test_a_colour_is_reduced_to_the_nearest_of_the_palette(
    rgb: int, depth: int, index: int
) -> None:
    assert find_sgr_index(rgb, depth) == index


@pytest.mark.parametrize("depth", [PALETTE_256, PALETTE_16])
def test_reducing_a_reduced_colour_changes_nothing(depth: int) -> None:
    """Reducing what is already reduced changes nothing, so the code sent is the colour compared."""
    rng = np.random.default_rng(1)
    pixels = rng.integers(0, 256, (200, 3), np.uint8)
    zero = np.full(200, 2)

    once = reduce_pixels(pixels, zero, zero, ColorMode(depth))
    codes = [find_sgr_index(int(r) << 16 | int(g) << 8 | int(b), depth) for r, g, b in once]

    assert len(set(codes)) == len(np.unique(once, axis=0))
