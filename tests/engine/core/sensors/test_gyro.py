"""Gyro: what its angle misses of fast turns, and of clockwise ones."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.engine.core.memory_sink import MemorySink
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec

SMALL = RobotSpec(wheel_spacing_mm=60.0)
"""At full speed it turns faster than a gyro senses."""


def spin(sign: int, profile: str, drift: DriftSpec, step: int, robot: RobotSpec) -> Simulation:
    """Return a robot that has turned for 3 s, clockwise for 1, in calls of some ticks."""
    world = WorldSpec(drift=drift)
    sim = Simulation(RunSpec(robot, world, PROFILES[profile]), MemorySink())
    for motor, speed in ((sim.left, sign * 8000), (sim.right, -sign * 8000)):
        assert isinstance(motor, ServoMotor)
        motor.run_freely(0, speed)
    done = 0
    while done < 300:
        done += sim.advance(min(step, 300 - done))
    return sim


@pytest.mark.parametrize("sign", [1, -1])
def test_a_turn_faster_than_the_gyro_senses_is_counted_at_its_limit(sign: int) -> None:
    sim = spin(sign, "lego-micropython", NO_DRIFT, 300, SMALL)
    instant = sim.build_instant()
    assert abs(instant.turn_rate_dps) > 600
    assert instant.gyro_rate_dps == sign * 440
    last_s = sim.build_instant().gyro_zero_deg - sim.build_instant().pose.heading_deg
    sim.advance(100)
    now = sim.build_instant().gyro_zero_deg - sim.build_instant().pose.heading_deg
    assert now - last_s == pytest.approx(sign * 440, abs=0.01)
    # In a standing start it senses the beginning in full.
    assert 0 < 3 * 440 - abs(last_s) < 440 / 4


@pytest.mark.parametrize("robot", [SMALL, RobotSpec()])
@pytest.mark.parametrize("drift", [NO_DRIFT, DriftSpec(gyro_scale_pc=2.0)])
def test_a_limited_gyro_reads_the_same_however_ticks_are_grouped(
    drift: DriftSpec, robot: RobotSpec
) -> None:
    ends = {
        (sim.pose, sim.drive.gyro_zero_deg)
        for sim in (spin(1, "pybricks4", drift, step, robot) for step in (1, 7, 300))
    }
    assert len(ends) == 1


@pytest.mark.parametrize(("sign", "share"), [(1, 0.98), (-1, 1.0)])
def test_a_drifting_gyro_counts_too_little_of_a_clockwise_turn(sign: int, share: float) -> None:
    sim = spin(sign, "lego-micropython", DriftSpec(gyro_scale_pc=2.0), 300, RobotSpec())
    instant = sim.build_instant()
    turned_deg = -instant.pose.heading_deg
    assert sign * turned_deg > 600
    assert instant.gyro_deg == pytest.approx(share * turned_deg, abs=0.51)
    assert instant.gyro_rate_dps == pytest.approx(-share * instant.turn_rate_dps / share, abs=0.51)


def test_a_profile_without_a_gyro_limit_reads_any_rate() -> None:
    instant = spin(1, "lego-micropython", NO_DRIFT, 300, SMALL).build_instant()
    free = replace(instant, profile=PROFILES["robolab"])
    assert free.gyro_rate_dps == round(-instant.turn_rate_dps) > 440
