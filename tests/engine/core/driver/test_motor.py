"""Motors do what the driver's own code did: in every recording, to a degree and a few milliseconds."""

from __future__ import annotations

import random
from collections.abc import Iterator
from math import inf, isfinite
from typing import Any
from unittest.mock import patch

import pytest

from tests.cases import for_each
from tests.engine.core.driver.lab import MS, Bench, give, load_recordings, renumber
from tuisim.engine.core.driver.jiffies import Jiffies
from tuisim.engine.core.driver.motor import Command, DriverMotor
from tuisim.engine.core.driver.regulator import MODELS, StopAction
from tuisim.engine.core.motor_columns import RAMPING

RECORDINGS = load_recordings()
MAX_TENTHS_DEG = 10
QUICK = (
    "abs_during_timed",
    "abs_position_written",
    "abs_speed_zero",
    "direct_8",
    "forever_500_coast",
    "lib_blocked_degrees",
    "lib_degrees_500_90",
    "lib_seconds_three",
    "lib_to_position",
    "medium_rel_45_200",
    "medium_timed_300",
    "pid_p_only",
    "polarity_after_setpoints",
    "polarity_direct",
    "polarity_rel",
    "position_write_refused",
    "ramp_661",
    "ramp_cancelled_by_plain",
    "ramp_rel_300_300_-360_800",
    "ramp_timed_100_100_300_500",
    "rel_-45_1050",
    "rel_zero",
    "reset_during_run",
    "reverse_500_-500",
    "setpoints_do_not_apply_until_command",
    "stall_released",
    "stall_stop_hold_keeps_pushing",
    "stop_during_rel",
    "tank_degrees_500_0_180",
    "timed_220_1000",
)
EXACT = 152
"""In so many recordings every number is the same."""


def test_there_are_161_recordings_of_motors_of_which_30_are_quick() -> None:
    assert len(RECORDINGS) == 161 and len(set(QUICK)) == 30 and set(QUICK) < set(RECORDINGS)


@pytest.mark.quick_cases(*QUICK)
@pytest.mark.parametrize("name", RECORDINGS)
def test_simulated_motors_reproduce_recorded_positions_and_states(name: str) -> None:
    bench = Bench(RECORDINGS[name]).run()
    assert bench.states == RECORDINGS[name].states
    for samples, recorded in zip(bench.samples, RECORDINGS[name].samples, strict=True):
        for values, expected, most in (
            (samples.position, recorded.position, 1),
            (samples.tenths_deg, recorded.tenths_deg, MAX_TENTHS_DEG),
        ):
            errors = [abs(a - b) for a, b in zip(values, expected, strict=True)]
            assert max(errors) <= most, errors.index(max(errors)) * 10


@pytest.mark.slow
def test_nearly_all_recorded_motor_runs_are_reproduced_to_the_last_digit() -> None:
    same = [name for name, one in RECORDINGS.items() if Bench(one).run().samples == one.samples]
    assert len(same) >= EXACT


def build_motor(kind: str = "large", jiffies: Jiffies = Jiffies()) -> DriverMotor:  # noqa: B008 - frozen
    return DriverMotor(MODELS[kind], MODELS[kind].plant, 8.0, jiffies)


def random_setpoints(chance: random.Random) -> dict[str, Any]:
    ramps = (0, 0, 0, chance.randrange(2000))
    return {
        "speed_dps": chance.randrange(-1050, 1051),
        "position": chance.randrange(-400, 401),
        "duty": chance.randrange(-100, 101),
        "time_ms": chance.randrange(2000),
        "ramp_up_ms": chance.choice(ramps),
        "ramp_down_ms": chance.choice(ramps),
        "stop_action": chance.choice([*StopAction]),
    }


def play(motor: DriverMotor, seed: int, looks: random.Random | None) -> Iterator[object]:
    """Do anything with a motor for two seconds, and yield what it shows at each command."""
    chance = random.Random(seed)
    now_ns = 0
    while now_ns < 2000 * MS:
        end_ns = now_ns + chance.randrange(300 * MS)
        while looks is not None and now_ns < end_ns:
            now_ns = min(end_ns, now_ns + looks.randrange(20 * MS))
            motor.run_until(now_ns)
        now_ns = end_ns
        give(motor, now_ns, chance.choice([*Command]), **random_setpoints(chance))
        if chance.random() < 0.2:
            renumber(motor, now_ns, chance.randrange(-100, 100))
        if chance.random() < 0.3:
            angle_deg = motor.axle.angle_deg
            motor.axle.low_deg, motor.axle.high_deg = chance.choice(
                ((-inf, inf), (angle_deg, inf), (-inf, angle_deg), (angle_deg - 30, angle_deg + 30))
            )
        yield motor.position, motor.speed_dps, motor.duty, motor.axle.angle_deg, motor.state_bits


@for_each(seed=range(30))
def test_reading_a_motor_more_often_does_not_change_how_it_moves(seed: int) -> None:
    jiffies = Jiffies(seed, 137 * seed)
    motors = build_motor(jiffies=jiffies), build_motor(jiffies=jiffies)
    shown = [*play(motors[0], seed, None)]
    assert [*play(motors[1], seed, random.Random(seed))] == shown
    assert all(isfinite(motors[0].axle.angle_deg) for _ in shown)


@for_each(seed=range(30))
def test_skipping_steps_of_the_speed_control_changes_nothing(seed: int) -> None:
    shown = [*play(build_motor(), seed, None)]
    with patch.object(DriverMotor, "_can_regulate", lambda *_: False):
        assert [*play(build_motor(), seed, None)] == shown


def test_a_move_is_stepped_finely_only_near_its_target() -> None:
    motor = build_motor()
    positions = []
    give(motor, 0, Command.RUN_TO_REL_POS, speed_dps=500, position=1500)
    motor.run_until(100 * MS)
    control = DriverMotor.control
    regulate = DriverMotor._run_speed_control

    def note_control(self: DriverMotor, time_ns: int) -> None:
        positions.append(self.position)
        control(self, time_ns)

    def note_regulate(self: DriverMotor, step_ns: int, end_ns: int) -> int:
        positions.append(self.position)
        return regulate(self, step_ns, end_ns)

    with patch.multiple(DriverMotor, control=note_control, _run_speed_control=note_regulate):
        motor.run_until(4000 * MS)
    assert motor.position >= 1500
    assert len([position for position in positions if position < 1490]) < 100


def test_a_ramp_that_turns_back_goes_through_0() -> None:
    motor = build_motor()
    give(motor, 0, Command.RUN_FOREVER, speed_dps=400, ramp_up_ms=500, ramp_down_ms=500)
    motor.run_until(1000 * MS)
    give(motor, 1000 * MS, Command.RUN_FOREVER, speed_dps=-400)
    speeds = []
    for now_ms in range(1000, 2500, 50):
        motor.run_until(now_ms * MS)
        speeds.append(motor.speed_control.setpoint)
    assert speeds == sorted(speeds, reverse=True)
    assert 0 in speeds and speeds[-1] == -400 and not motor.state_bits & RAMPING


def test_a_relative_move_after_another_begins_where_that_was_to_end() -> None:
    motor = build_motor()
    for number in range(4):
        time_ns = number * 1000 * MS
        give(motor, time_ns, Command.RUN_TO_REL_POS, speed_dps=900, position=90)
    assert motor.target == 360
    renumber(motor, 4900 * MS, 0)
    give(motor, 5000 * MS, Command.RUN_TO_REL_POS)
    assert motor.target == 90
