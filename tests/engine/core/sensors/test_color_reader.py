"""The quick way to a colour reading agrees with the plain one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tuisim.engine.core.field import Field, count_disc_pixels
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import EV3, ROBOLAB, ProfileSpec
from tuisim.engine.core.sensors.color import build_rgb_reader, measure_color
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, RobotSpec
from tuisim.engine.core.state import Instant

WIDTH_PX = 40
DIAMETER = 20
LEFT, RIGHT = RobotSpec().color_sensors


def random_field() -> Field:
    """A narrow mat whose disc sums are any that a disc can have."""
    most = 255 * count_disc_pixels(DIAMETER)
    size = (FIELD_HEIGHT_MM + DIAMETER) * (WIDTH_PX + DIAMETER) * 3
    sums = np.random.default_rng(1).integers(0, most, size, np.uint32, endpoint=True)
    pixels = memoryview(bytes(range(256)) * (WIDTH_PX * FIELD_HEIGHT_MM * 3 // 256 + 1))
    return Field(WIDTH_PX, FIELD_HEIGHT_MM, pixels, {DIAMETER: sums.data})


FIELD = random_field()
ON_FLOOR = replace(FIELD, floor_rgb=(250, 240, 131))


SENSORS = (LEFT, RIGHT, replace(LEFT, white_percent=61.0, black_percent=7.5))


@given(
    st.floats(-80, 120),
    st.floats(-80, 1200),
    st.floats(-720, 720),
    st.sampled_from((ROBOLAB, EV3)),
    st.sampled_from((FIELD, ON_FLOOR)),
)
def test_the_quick_colour_reader_gives_the_channels_of_a_full_reading(
    x_mm: float, y_mm: float, heading_deg: float, profile: ProfileSpec, field: Field
) -> None:
    instant = Instant(0, Pose(x_mm, y_mm, heading_deg), profile=profile)
    for sensor in SENSORS:
        seen = measure_color(sensor, instant, field)
        assert build_rgb_reader(sensor, profile, field)(x_mm, y_mm, heading_deg) == seen.rgb


@pytest.mark.parametrize("profile", [ROBOLAB, EV3])
@pytest.mark.parametrize("strategy", ["gaussian", "centre"])
def test_the_quick_colour_reader_reads_weighted_discs_too(
    strategy: str, profile: ProfileSpec
) -> None:
    sensor = replace(LEFT, strategy=strategy)
    seen = measure_color(sensor, Instant(0, Pose(20.0, 500.0, 30.0), profile=profile), FIELD)
    assert build_rgb_reader(sensor, profile, FIELD)(20.0, 500.0, 30.0) == seen.rgb
    assert any(seen.rgb)


def test_integer_division_gives_the_same_channels_for_every_sum() -> None:
    count = count_disc_pixels(DIAMETER)
    assert all(int(total / count) == total // count for total in range(255 * count + 1))
