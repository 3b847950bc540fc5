"""Colour sensor on real mats and on small ones made for the purpose."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import compress
from typing import Any

import pytest

from tests.cases import cases, for_rows
from tuisim.engine import mat_cache, mats
from tuisim.engine.core.field import OUTSIDE_DISC_RGB, Field, build_disc_mask, count_disc_pixels
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors import color
from tuisim.engine.core.spec import ColorSensorSpec, NoiseSpec, RobotSpec
from tuisim.engine.core.state import Instant

LEFT, RIGHT = RobotSpec().color_sensors
OpenMat = Callable[[str], Field]


@pytest.fixture(scope="module")
def mat() -> OpenMat:
    """Opens a mat by name."""

    @cache
    def opened(name: str) -> Field:
        return mat_cache.FieldFiles.prepare(mats.background(name).image, {20}).open_field()

    return opened


def at(
    x_mm: float,
    y_mm: float,
    heading_deg: float = 0.0,
    *,
    light: int = 0,
    seed: int = 0,
    tick: int = 0,
) -> Instant:
    return Instant(tick, Pose(x_mm, y_mm, heading_deg), noise=NoiseSpec(light=light), seed=seed)


@pytest.mark.parametrize(
    "x_mm, rgb, code, name, red_percent, mean_percent",
    [
        (100, (255, 255, 255), 6, "White", 100, 100),
        (300, (255, 0, 0), 5, "Red", 100, 100 / 3),
        (500, (0, 255, 0), 3, "Green", 0, 100 / 3),
        (700, (0, 0, 255), 2, "Blue", 0, 100 / 3),
        (900, (0, 255, 255), 2, "Blue", 0, 200 / 3),
        (1100, (255, 0, 255), 5, "Red", 100, 200 / 3),
        (1300, (255, 255, 0), 4, "Yellow", 100, 200 / 3),
        (1500, (0, 0, 0), 1, "Black", 0, 0),
    ],
)
def test_the_sensor_reads_each_band_of_the_rainbow(
    x_mm: int,
    rgb: tuple[int, int, int],
    code: int,
    name: str,
    red_percent: float,
    mean_percent: float,
    mat: OpenMat,
) -> None:
    seen = color.measure_color(LEFT, at(x_mm, 500), mat("Rainbow_bands"))
    assert (seen.rgb, seen.code, seen.name) == (rgb, code, name)
    assert (seen.red_percent, seen.mean_percent) == pytest.approx((red_percent, mean_percent))


@pytest.mark.slow_cases("far off, other side")
@cases(
    "name, x_mm, red",
    {
        "before the band": ("Grey_bands", 210.999, 255),
        "one column in": ("Grey_bands", 211, 253.967),
        "two columns in": ("Grey_bands", 212, 252.705),
        "box within the field": ("Empty_Map", 2317, 255),
        "a little off": ("Empty_Map", 2326, 213.2),
        "half off": ("Empty_Map", 2334.6, 87.8),
        "wholly off": ("Empty_Map", 2343, 0),
        "far off": ("Empty_Map", 1e6, 0),
        "far off, other side": ("Empty_Map", -1e6, 0),
    },
)
def test_the_sensor_mixes_both_sides_of_an_edge(
    name: str, x_mm: float, red: float, mat: OpenMat
) -> None:
    seen = color.measure_color(LEFT, at(x_mm, 500), mat(name))
    digits = len(str(float(red)).partition(".")[2])
    assert seen.red == pytest.approx(red, abs=0.5 * 10**-digits)


@pytest.mark.parametrize("diameter, pixels", [(10, 69), (20, 305), (30, 697)])
def test_disc_has_the_known_number_of_pixels(diameter: int, pixels: int) -> None:
    assert count_disc_pixels(diameter) == pixels


@cases(
    "pose, corner",
    {
        "facing right": (Pose(500, 500, 0), (520, 613)),
        "facing up": (Pose(500, 500, 90), (470, 603)),
        "facing left": (Pose(500, 500, 180), (460, 653)),
        "facing down": (Pose(500, 500, -90), (510, 663)),
        "half a pixel off is cut toward zero": (Pose(-20.5, 500, 0), (0, 613)),
        "one and a half off": (Pose(-21.5, 500, 0), (-1, 613)),
        "fractions are cut": (Pose(500.9, 500, 0), (520, 613)),
    },
)
def test_the_pixels_under_a_sensor_are_rounded_as_in_the_old_simulator(
    pose: Pose, corner: tuple[int, int]
) -> None:
    nudged = Pose(pose.x_mm + 1e-9, pose.y_mm - 1e-9, pose.heading_deg)
    assert color.find_box_corner(nudged, LEFT) == corner


@for_rows(
    "rgb, code",
    {
        "black": ((0, 0, 0), 1),
        "grey of value 29": ((76, 76, 76), 1),
        "grey of value 30": ((77, 77, 77), 6),
        "white": ((255, 255, 255), 6),
        "saturation 19 counts as grey": ((100, 81, 81), 6),
        "saturation 20 has a colour": ((100, 80, 80), 5),
        "dark, no colour": ((60, 59, 59), 1),
        "black with noise": ((4, 4, 5), 2),
        "hue 29": ((240, 119, 0), 5),
        "hue 30": ((240, 120, 0), 4),
        "hue 89": ((121, 240, 0), 4),
        "hue 90": ((120, 240, 0), 3),
        "hue 162": ((0, 240, 168), 3),
        "hue 163": ((0, 240, 172), 2),
        "hue 282": ((168, 0, 240), 2),
        "hue 283": ((172, 0, 240), 5),
        "hue 359": ((255, 0, 1), 5),
    },
)
def test_find_color_code_gives_the_lego_code_of_each_colour(
    rgb: tuple[int, int, int], code: int
) -> None:
    assert color.find_color_code(*rgb) == code


@pytest.mark.parametrize("light", [0, 20], ids=["clear", "noisy"])
def test_the_mean_of_a_sensors_pixel_array_is_its_reading(light: int, mat: OpenMat) -> None:
    instant = at(1010, 500, 33, light=light)
    field = mat("Rainbow_bands")
    array = color.read_pixel_array(LEFT, instant, field)
    pixels = [tuple(array[at : at + 3]) for at in range(0, len(array), 3)]
    inside = [is_inside for row in build_disc_mask(LEFT.diameter_mm) for is_inside in row]
    assert len(pixels) == LEFT.diameter_mm**2
    assert {pixel for pixel, is_inside in zip(pixels, inside, strict=True) if not is_inside} == {
        OUTSIDE_DISC_RGB
    }
    reds = [pixel[0] for pixel, is_inside in zip(pixels, inside, strict=True) if is_inside]
    assert color.measure_color(LEFT, instant, field).red == sum(reds) / len(reds)


def noisy(
    mat: OpenMat, *, light: int = 20, seed: int = 1, tick: int = 7, sensor: ColorSensorSpec = LEFT
) -> bytes:
    """The pixels of the disc on the mid grey band."""
    return color.read_pixel_array(
        sensor, at(1125, 500, light=light, seed=seed, tick=tick), mat("Grey_bands")
    )


@cases(
    "other",
    {
        "seed": {"seed": 2},
        "tick": {"tick": 8},
        "sensor": {"sensor": RIGHT},
        "level": {"light": 21},
    },
)
def test_noise_differs_by_seed_tick_and_sensor(other: dict[str, Any], mat: OpenMat) -> None:
    assert noisy(mat) != noisy(mat, **other)


@pytest.mark.parametrize("light", [1, 20, 127, 128])
def test_noise_stays_within_its_level_and_reaches_it(light: int, mat: OpenMat) -> None:
    inside = [is_inside for row in build_disc_mask(20) for is_inside in row for _ in range(3)]
    seen = [
        byte for tick in range(20) for byte in compress(noisy(mat, light=light, tick=tick), inside)
    ]
    assert (min(seen), max(seen)) == (max(0, 128 - light), min(255, 128 + light))
    assert sum(seen) / len(seen) == pytest.approx(128, abs=0.05 * light)
