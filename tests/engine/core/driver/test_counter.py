"""The speed that a driver reads off the counter: late, cut off, and lingering."""

from __future__ import annotations

import pytest

from tuisim.engine.core.driver.counter import LOOK, Counter


def turn(counter: Counter, begin_ms: int, end_ms: int, speed_dps: float) -> None:
    """Turn evenly, from a middle of a count."""
    angle_deg = counter.count / 2 + 0.25
    for now_ms in range(begin_ms, end_ms, 2):
        after_deg = angle_deg + speed_dps * 0.002
        counter.record(now_ms * LOOK, 2 * LOOK, angle_deg, after_deg, 0.5)
        angle_deg = after_deg


@pytest.mark.parametrize("speed_dps", [60.4, -60.4, 250.7, 1050.2, -1560.9])
def test_a_steady_speed_read_from_counts_is_rounded_towards_zero(speed_dps: float) -> None:
    counter = Counter()
    turn(counter, 0, 600, speed_dps)
    assert counter.measure_speed_dps() == int(speed_dps)


def test_the_read_speed_of_a_stopping_motor_falls_to_zero_with_a_delay() -> None:
    counter = Counter()
    turn(counter, 0, 200, 500.0)
    speeds = []
    for now_ms in range(200, 450, 10):
        counter.record_rest(now_ms * LOOK)
        speeds.append(counter.measure_speed_dps())
    assert speeds[:5] == [500] * 5 and speeds == sorted(speeds, reverse=True)
    assert speeds.index(0) * 10 == pytest.approx(204, abs=10)


def test_a_motor_that_turns_back_counts_the_same_positions_again() -> None:
    counter = Counter()
    counter.record(0, 2 * LOOK, 0.1, 3.1, 0.5)
    counter.record(2 * LOOK, 2 * LOOK, 3.1, -3.1, 0.5)
    assert counter.count == -7


@pytest.mark.parametrize("speed_dps", [90.5, -300.3, 1050.2])
def test_skipping_a_stretch_at_constant_speed_gives_the_speed_of_single_steps(
    speed_dps: float,
) -> None:
    stepped = Counter()
    skipped = Counter()
    turn(stepped, 0, 600, speed_dps)
    turn(skipped, 0, 300, speed_dps)
    skipped.add_evenly(600 * LOOK, 0.25 + 0.6 * speed_dps, speed_dps)
    for now_ms in range(600, 800, 2):
        for counter in stepped, skipped:
            turn(counter, now_ms, now_ms + 2, -0.7 * speed_dps)
        assert stepped.count == skipped.count
        assert stepped.measure_speed_dps() == pytest.approx(skipped.measure_speed_dps(), abs=1)


@pytest.mark.parametrize("speed_dps", [500.0, -500.0])
def test_what_an_obstacle_prevented_was_never_counted(speed_dps: float) -> None:
    counter = Counter()
    stopped = Counter()
    for each in counter, stopped:
        turn(each, 0, 200, speed_dps)
    turn(counter, 200, 210, speed_dps)
    counter.take_back(stopped.count / 2 + 0.25)
    assert counter.count == stopped.count
    for now_ms in range(210, 500, 10):
        counter.record_rest(now_ms * LOOK)
        stopped.record_rest(now_ms * LOOK)
        assert counter.measure_speed_dps() == stopped.measure_speed_dps()
