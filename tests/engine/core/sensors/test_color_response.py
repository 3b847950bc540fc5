"""Colour sensor of a brick: what it makes of white and black, of greys and of brown."""

from __future__ import annotations

from array import array
from dataclasses import replace
from statistics import fmean, pstdev

import pytest

from tuisim.engine.core.drift import draw_light_gain
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.field import Field, count_disc_pixels
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import EV3, PROFILES, ROBOLAB, ProfileSpec
from tuisim.engine.core.sensors.color import (
    EVEN,
    ColorReading,
    LightRead,
    build_noisy_rgb_reader,
    find_brick_color_code,
    find_response,
    measure_color,
    read_pixel_array,
)
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, ColorSensorSpec, NoiseSpec, RobotSpec
from tuisim.engine.core.state import Instant

LEFT, RIGHT = RobotSpec().color_sensors
WIDTH_PX = 100
DIAMETER = 20
POSE = Pose(20.0, 500.0, 0.0)


def paint(grey: int) -> Field:
    """Return a narrow mat of one grey, with the sums of the discs that are wholly on it."""
    size = (FIELD_HEIGHT_MM + DIAMETER) * (WIDTH_PX + DIAMETER) * 3
    sums = memoryview(array("I", [count_disc_pixels(DIAMETER) * grey]) * size)
    pixels = memoryview(bytes([grey]) * (WIDTH_PX * FIELD_HEIGHT_MM * 3))
    return Field(WIDTH_PX, FIELD_HEIGHT_MM, pixels, {DIAMETER: sums})


def read(
    grey: int,
    profile: ProfileSpec = EV3,
    sensor: ColorSensorSpec = LEFT,
    drift: DriftSpec = NO_DRIFT,
    seed: int = 0,
) -> ColorReading:
    return measure_color(
        sensor, Instant(0, POSE, profile=profile, drift=drift, seed=seed), paint(grey)
    )


@pytest.mark.parametrize(("grey", "percent"), [(255, 85), (0, 5), (128, 45)])
def test_reflected_light_of_white_and_black_is_as_on_a_brick(grey: int, percent: int) -> None:
    seen = read(grey)
    assert LightRead.REFLECTED.compute_value(seen, 100) == percent
    assert LightRead.REFLECTION.compute_value(seen, 100) == percent
    assert len(set(seen.rgb)) == 1


def test_a_hubs_reflection_is_the_mean_of_all_colours_not_red_alone() -> None:
    on_hub = read(128, sensor=replace(LEFT, port="C"))
    assert (read(128).is_hubs, on_hub.is_hubs) == (False, True)
    for seen, percent in (
        (ColorReading(255.0, 0.0, 0.0), 100),
        (ColorReading(255.0, 0.0, 0.0, is_hubs=True), 33),
        (ColorReading(0.0, 255.0, 255.0, is_hubs=True), 66),
        # A fifth of each channel's range is no whole number there.
        (ColorReading(51.0, 51.0, 51.0, is_hubs=True), 19),
    ):
        assert LightRead.REFLECTION.compute_value(seen, 100) == percent


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_only_the_course_profiles_read_the_mats_colours_unchanged(profile: ProfileSpec) -> None:
    assert (find_response(LEFT, profile) == EVEN) == (profile.name in ("robolab", "nbev3devsim"))


@pytest.mark.parametrize("profile", [ROBOLAB, EV3])
def test_a_sensors_own_white_and_black_percents_set_its_reading(profile: ProfileSpec) -> None:
    sensor = replace(LEFT, white_percent=62.0, black_percent=7.0)
    shown = [
        LightRead.REFLECTION.compute_value(read(grey, profile, sensor), 100) for grey in (255, 0)
    ]
    assert shown == [62, 7]


def test_beyond_the_mats_edge_a_sensor_reads_black_and_no_colour() -> None:
    off = Instant(0, Pose(-500.0, 500.0, 0.0), profile=EV3, noise=NoiseSpec())
    assert measure_color(LEFT, off, paint(255)).rgb == (0, 0, 0)
    assert measure_color(LEFT, off, paint(255)).name == "NoColor"
    assert read(0).name == "Black"


@pytest.mark.parametrize("grey", [0, 100, 255])
def test_the_quick_colour_reader_with_noise_equals_the_slow_one(grey: int) -> None:
    field = paint(grey)
    place = (POSE.x_mm, POSE.y_mm, POSE.heading_deg)
    noisy = build_noisy_rgb_reader(LEFT, EV3, field)
    for tick in range(30):
        instant = Instant(tick, POSE, profile=EV3, noise=NoiseSpec(light=20), seed=1)
        assert noisy(*place, 20, 1, tick) == measure_color(LEFT, instant, field).rgb


def test_the_middle_of_a_sensors_pixel_array_equals_its_reading() -> None:
    instant = Instant(0, POSE, profile=EV3)
    box = read_pixel_array(LEFT, instant, paint(255))
    middle = 3 * (DIAMETER * DIAMETER // 2 + DIAMETER // 2)
    assert tuple(box[middle : middle + 3]) == measure_color(LEFT, instant, paint(255)).rgb


def test_sensors_differ_by_drift() -> None:
    drift = DriftSpec(light_gain_pc=5.0)
    gains = [draw_light_gain("in2", drift, seed) for seed in range(1000)]
    assert fmean(gains) == pytest.approx(1, abs=0.01)
    assert pstdev(gains) == pytest.approx(0.05, rel=0.1)
    for seed in range(5):
        left, right = (read(128, EV3, sensor, drift, seed).red for sensor in (LEFT, RIGHT))
        assert left == pytest.approx(read(128).red * gains[seed])
        assert left != right
    assert max(read(255, ROBOLAB, LEFT, drift, seed).red for seed in range(9)) == 255


@pytest.mark.parametrize(
    ("rgb", "code"),
    [
        pytest.param((0, 0, 0), 0, id="nothing"),
        pytest.param((13, 13, 13), 1, id="black"),
        pytest.param((110, 110, 110), 0, id="grey"),
        pytest.param((217, 217, 217), 6, id="white"),
        pytest.param((200, 165, 120), 4, id="pale orange"),
        pytest.param((128, 128, 128), 6, id="least white"),
        pytest.param((83, 46, 27), 7, id="brown"),
        pytest.param((217, 145, 13), 4, id="orange"),
        pytest.param((217, 13, 13), 5, id="red"),
        pytest.param((100, 13, 13), 5, id="dark red"),
        pytest.param((13, 60, 13), 3, id="dark green"),
    ],
)
def test_find_brick_color_code_gives_the_code_that_a_brick_reads(
    rgb: tuple[int, int, int], code: int
) -> None:
    assert find_brick_color_code(*rgb) == code
