"""The electric motor: as measured, and exact in any steps."""

from __future__ import annotations

import pytest

from tuisim.engine.core.driver.plant import LARGE, MEDIUM, STEP_NS, Axle, build_circuit


def steady_dps(axle: Axle, duty: int) -> float:
    axle.power(duty)
    for _ in range(1000):
        axle.advance(STEP_NS)
    return axle.speed_dps


@pytest.mark.parametrize(
    "plant, battery_v, expected_dps",
    [(LARGE, 8.0, 930), (LARGE, 7.2, 834), (LARGE, 8.38, 976), (MEDIUM, 8.38, 1445)],
)
def test_the_battery_voltage_sets_an_axles_highest_speed(
    plant: object, battery_v: float, expected_dps: float
) -> None:
    assert steady_dps(Axle(plant, battery_v), 100) == pytest.approx(expected_dps, rel=0.01)  # type: ignore[arg-type]


def test_a_free_motor_has_the_measured_time_constant() -> None:
    assert build_circuit(LARGE, 8.0).time_constant_s == pytest.approx(0.071, abs=0.001)
    robot = LARGE.add_load(0.00038, 0.006)
    assert build_circuit(robot, 8.0).time_constant_s == pytest.approx(0.089, abs=0.001)


@pytest.mark.parametrize("duty, turns", [(6, False), (-6, False), (7, True), (-7, True)])
def test_a_motor_at_rest_needs_a_torque_to_start(duty: int, turns: bool) -> None:
    assert bool(steady_dps(Axle(LARGE, 8.0), duty)) is turns


def test_an_axle_turns_equally_far_whatever_the_time_steps() -> None:
    whole = Axle(LARGE, 8.0)
    parts = Axle(LARGE, 8.0)
    for duty in (70, -40, 0, None):
        whole.power(duty)
        parts.power(duty)
        left_ns: float = 300_000_000
        while left_ns:
            left_ns = whole.advance(left_ns)
        for _ in range(100):
            left_ns = 3_000_000
            while left_ns:
                left_ns = parts.advance(left_ns)
        assert parts.angle_deg == pytest.approx(whole.angle_deg)
        assert parts.speed_dps == pytest.approx(whole.speed_dps, abs=1e-6)


def test_a_blocked_axle_turns_only_away_from_the_obstacle() -> None:
    axle = Axle(LARGE, 8.0)
    axle.high_deg = 5.0
    assert steady_dps(axle, 100) == 0.0 and axle.angle_deg == 5.0
    assert steady_dps(axle, -100) < -900
