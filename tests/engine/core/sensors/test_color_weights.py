"""The three strategies of a colour sensor: how it weighs the pixels of its disc."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tuisim.engine import mat_cache, mats
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.color import measure_color
from tuisim.engine.core.spec import STRATEGIES, NoiseSpec, RobotSpec
from tuisim.engine.core.state import Instant

LEFT = RobotSpec().color_sensors[0]

# The left edge of the black band of Grey_bands is at x = 1450; the sensor is 30 mm before the axle.
EDGE = {
    1409: (255.0, 255.0, 255.0),
    1412: (238.28, 247.20, 243.49),
    1415: (198.98, 216.31, 216.43),
    1418: (151.33, 160.66, 159.45),
    1421: (103.67, 94.34, 95.55),
    1424: (56.02, 38.69, 38.57),
    1427: (16.72, 7.80, 11.51),
    1430: (0.0, 0.0, 0.0),
}
"""By robot x in mm: red of mean, gaussian and centre."""


@pytest.fixture(scope="module")
def grey_bands() -> Field:
    return mat_cache.FieldFiles.prepare(mats.background("Grey_bands").image, {20}).open_field()


def seen(field: Field, x_mm: float, strategy: str, light: int = 0) -> float:
    instant = Instant(3, Pose(x_mm, 500.0, 0.0), noise=NoiseSpec(light, 0), seed=1)
    return measure_color(replace(LEFT, strategy=strategy), instant, field).red


@pytest.mark.parametrize("x_mm, reds", EDGE.items())
def test_readings_across_an_edge_follow_the_weights_of_the_disc(
    grey_bands: Field, x_mm: int, reds: tuple[float, ...]
) -> None:
    found = tuple(seen(grey_bands, float(x_mm), strategy) for strategy in STRATEGIES)
    assert found == pytest.approx(reds, abs=0.005)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_noise_is_added_to_pixels_before_they_are_weighted(
    grey_bands: Field, strategy: str
) -> None:
    clear = seen(grey_bands, 1125, strategy)
    noisy = seen(grey_bands, 1125, strategy, light=20)
    assert clear == pytest.approx(128.0)
    assert noisy != clear
    assert noisy == pytest.approx(128.0, abs=4.0)
