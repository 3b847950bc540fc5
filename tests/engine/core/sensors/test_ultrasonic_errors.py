"""Ultrasonic sensor of a brick: what is too close for it, and its bias."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tuisim.engine.core.drift import draw_echo_bias_mm
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import EV3, ROBOLAB, ProfileSpec
from tuisim.engine.core.sensors.ultrasonic import measure_noisy_mm
from tuisim.engine.core.spec import FIELD_WIDTH_MM, UltrasonicSpec, WorldSpec
from tuisim.engine.core.state import Instant

SENSOR = UltrasonicSpec(ray_angles_deg=(0.0,))
BIASED = DriftSpec(echo_bias_mm=14.0)


def read(
    distance_mm: float, profile: ProfileSpec, drift: DriftSpec = NO_DRIFT, seed: int = 0
) -> int:
    pose = Pose(FIELD_WIDTH_MM - SENSOR.y_mm - distance_mm, 500.0, 0.0)
    return measure_noisy_mm(
        SENSOR, Instant(0, pose, drift=drift, profile=profile, seed=seed), WorldSpec(drift=drift)
    )


@pytest.mark.parametrize(
    ("distance_mm", "profile", "shown"),
    [(29, EV3, 2550), (30, EV3, 30), (29, ROBOLAB, 29), (0, EV3, 2550), (1000, EV3, 1000)],
)
def test_an_object_too_close_to_the_ultrasonic_sensor_gives_no_echo(
    distance_mm: float, profile: ProfileSpec, shown: int
) -> None:
    assert read(distance_mm, profile) == shown


def test_a_bias_is_drawn_once_a_run_and_adds_to_each_echo() -> None:
    drawn = [draw_echo_bias_mm("in1", BIASED, seed) for seed in range(300)]
    assert (min(drawn), max(drawn)) == (-2, 14)
    for seed, bias_mm in enumerate(drawn[:20]):
        assert {read(way, EV3, BIASED, seed) - way for way in (30, 500, 2000)} == {bias_mm}
    assert draw_echo_bias_mm("in4", BIASED, 0) != drawn[0]


def test_without_an_echo_no_bias_is_added_to_the_distance() -> None:
    far = Instant(0, Pose(100.0, 500.0, 90.0), drift=BIASED, profile=EV3, seed=3)
    open_world = WorldSpec(walls=False, drift=BIASED)
    assert measure_noisy_mm(SENSOR, far, open_world) == 2550
    assert measure_noisy_mm(replace(SENSOR, noise_mm=5.0), far, open_world) > 2540
