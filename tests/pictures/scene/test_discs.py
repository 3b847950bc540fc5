"""What colour sensors see, as pictures and in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.cases import cases, for_each
from tuisim.app.render.brick import shrink_pixels
from tuisim.engine.core.sensors.color import ColorReading, LightRead
from tuisim.pictures.scene.discs import RIM_RGB, RINGS, DiscFace, draw_disc
from tuisim.programs.robot.thresholds import AIM, ProgramThreshold

GROUND = (1, 2, 3)
FACE = DiscFace(
    "left", bytes([128]) * 1200, ColorReading(211.0, 211.0, 211.0), LightRead.PERCENT, 255
)


@cases(
    "width, height, tall",
    {
        "square": (20, 20, 1.0),
        "half blocks at 80x24": (13, 12, 1.0),
        "sextants": (26, 18, 4 / 3),
        "wide pixels": (26, 48, 0.5),
        "pixels": (200, 300, 1.0),
    },
)
@pytest.mark.parametrize("grey", [255, 128, 0])
def test_a_disc_is_whole_and_round_at_every_size(
    width: int, height: int, tall: float, grey: int
) -> None:
    picture = draw_disc(bytes([grey]) * 1200, width, height, GROUND, RIM_RGB, tall)

    is_disc = (picture == grey).all(axis=2)
    rows = np.flatnonzero(is_disc.any(axis=1))
    cols = np.flatnonzero(is_disc.any(axis=0))
    assert picture.shape == (height, width, 3)
    assert abs(rows[0] + rows[-1] + 1 - height) <= 1 and abs(cols[0] + cols[-1] + 1 - width) <= 1
    across = len(cols)
    down = len(rows) * tall
    assert abs(across - down) <= 2 * max(1.0, tall)
    assert across >= 0.6 * min(width, height * tall)


@pytest.mark.parametrize("diameter", [10, 20, 40])
def test_the_rim_of_a_drawn_sensor_disc_reaches_the_pictures_edges(diameter: int) -> None:
    picture = draw_disc(bytes([128]) * 3 * diameter**2, 200, 200, GROUND, RIM_RGB)
    is_seen = (picture != GROUND).any(axis=2)
    assert all(1 <= edge.sum() < 60 for edge in (is_seen[1], is_seen[-2], *is_seen.T[[1, -2]]))


def test_a_disc_of_one_pixel_is_drawn() -> None:
    assert draw_disc(bytes([255]) * 1200, 1, 1, GROUND, RIM_RGB).shape == (1, 1, 3)


@for_each(paper=[(255, 255, 255), (16, 21, 28)], grey=[255, 220, 211, 128, 16, 0])
def test_the_outline_of_a_disc_is_seen_whatever_its_colour(
    paper: tuple[int, int, int], grey: int
) -> None:
    picture = draw_disc(bytes([grey]) * 1200, 120, 120, paper, RIM_RGB).astype(int)

    column = picture[:60, 60]
    disc = column[-1]
    ground = column[0]
    apart = [min(abs(pixel - disc).max(), abs(pixel - ground).max()) for pixel in column]
    assert abs(disc - ground).max() > 40 or max(apart) > 25


def test_a_sensor_disc_drawn_smaller_keeps_its_two_halves() -> None:
    pixels = np.zeros((20, 20, 3), np.uint8)
    pixels[:, 10:] = 250

    picture = draw_disc(pixels.tobytes(), 10, 10, GROUND, RIM_RGB)

    assert picture[5, 2, 0] == 0
    assert picture[5, 7, 0] == 250


def test_rings_are_means_from_the_inside() -> None:
    pixels = np.zeros((20, 20, 3), np.uint8)
    pixels[8:12, 8:12] = 255

    face = replace(FACE, box=pixels.tobytes())

    assert face.rings[0] > 30 and face.rings[1:] == (0, 0)
    assert len(face.ring_words) == len(RINGS)


@pytest.mark.parametrize(
    "read, is_hubs, words",
    [
        (LightRead.PERCENT, False, "100 100 100"),
        (LightRead.REFLECTED, False, "255 255 255"),
        (LightRead.REFLECTION, False, "100 100 100"),
        (LightRead.REFLECTION, True, "33 33 33"),
        (LightRead.MEAN, False, "33 33 33"),
    ],
)
def test_rings_of_an_evenly_red_disc_show_the_value_that_the_program_gets(
    read: LightRead, is_hubs: bool, words: str
) -> None:
    seen = ColorReading(255.0, 0.0, 0.0, is_hubs=is_hubs)
    face = replace(FACE, box=bytes([255, 0, 0]) * 400, seen=seen, read=read)
    assert " ".join(face.ring_words) == words
    assert face.value_words.removeprefix("mean ").startswith(words.split()[0])


@pytest.mark.parametrize(
    "read, most, words",
    [
        (LightRead.PERCENT, 255, "82.7 %"),
        (LightRead.REFLECTED, 255, "211 of 255"),
        (LightRead.REFLECTED, 100, "82 of 100"),
        (LightRead.REFLECTION, 100, "82 %"),
        (LightRead.MEAN, 255, "mean 82.7 %"),
    ],
)
def test_the_value_beside_a_disc_is_what_the_program_gets(
    read: LightRead, most: int, words: str
) -> None:
    assert replace(FACE, read=read, reflected_max=most).value_words == words


def test_thresholds_beside_a_disc_say_whether_they_hold_now() -> None:
    thresholds = (
        ProgramThreshold(LightRead.PERCENT, ">", 90, 15),
        ProgramThreshold(LightRead.COLOR, "==", 6, 16),
        ProgramThreshold(LightRead.PERCENT, AIM, 50, 17),
        ProgramThreshold(LightRead.REFLECTED, "<", 300, 18),
    )

    face = replace(FACE, thresholds=thresholds)

    assert face.limit_words(99) == (
        "code line 15 > 90: no; code line 16 == White: yes; code line 17 aim 50; code line 18 < 300: yes"
    )
    assert face.limit_words(80) == "> 90: no; == White: yes; aim 50; < 300: yes"
    assert face.limit_words(21) == "code line 15 > 90: no"
    assert face.limit_words(13) == "> 90: no"
    assert face.limit_shares == (0.9, 0.5)


def test_a_disc_shrunk_to_cells_has_the_mean_of_each_cell() -> None:
    pixels = np.arange(24, dtype=np.uint8).reshape(4, 6)
    assert shrink_pixels(pixels, 2, 3).tolist() == [[3.5, 5.5, 7.5], [15.5, 17.5, 19.5]]
    assert shrink_pixels(pixels, 4, 1).tolist() == [[2.5], [8.5], [14.5], [20.5]]
