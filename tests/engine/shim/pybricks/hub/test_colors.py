"""Hue, saturation and value as the sensor of a hub measures them."""

from __future__ import annotations

import pytest

from tuisim.engine.shim.pybricks.hub.colors import measure_hsv


@pytest.mark.parametrize(
    ("channels", "hue"),
    [((128, 64, 832), 245), ((704, 768, 384), 70), ((0, 1024, 0), 120), ((0, 0, 0), 10)],
)
def test_the_hue_of_a_hubs_colour_sensor_is_a_rounded_down_whole_number(
    channels: tuple[int, int, int], hue: int
) -> None:
    assert measure_hsv(*channels)[0] == hue
