"""A controller that is commanded while it moves: its reference goes on without a jump."""

from __future__ import annotations

import random

import pytest

from tests.cases import for_each
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.servo.control import Controller
from tuisim.engine.core.servo.settings import compute_motor_settings
from tuisim.engine.core.servo.trajectory import Segment

MS_US = 1000
BEGIN_US, END_US = 5 * MS_US, 2000 * MS_US
RAMP_US = range(12 * MS_US, 300 * MS_US, 7 * MS_US)
AFTERWARDS_US = range(300 * MS_US, END_US, 10 * MS_US)
ACCELERATION = 1999
FAR_MILLI = -10_000_000
HELD_US = 50 * MS_US


def rest(now_us: int) -> Segment:
    return Segment(now_us, 0, 0, 0)


def build_controller(*, slips: bool = False) -> Controller:
    return Controller(compute_motor_settings(MotorLaw.PYBRICKS, "large"), slips=slips)


@pytest.mark.parametrize("end_us", [None, END_US])
@pytest.mark.parametrize("rate", [777, -777])
def test_giving_a_motor_the_same_command_again_changes_nothing(
    rate: int, end_us: int | None
) -> None:
    milli = []
    for times_us in ((BEGIN_US,), (BEGIN_US, *RAMP_US)):
        control = build_controller()
        for now_us in times_us:
            left_us = None if end_us is None else end_us - now_us
            control.run(now_us, rest, rate, ACCELERATION, left_us)
        milli.append([control.milli(now_us) for now_us in AFTERWARDS_US])
    assert milli[0] == milli[1]


@for_each(seed=range(10))
def test_another_command_starts_from_the_present_position_and_speed(seed: int) -> None:
    control = build_controller()
    chance = random.Random(seed)
    now_us = 0
    control.run(0, rest, 500, ACCELERATION)
    for _ in range(40):
        now_us += chance.randrange(1, 400) * MS_US
        if chance.random() < 0.3:
            control.note_lag(now_us, HELD_US, FAR_MILLI, 0)
        milli = control.milli(now_us)
        rate = control.rate(now_us)
        time_us = chance.choice((None, chance.randrange(1000, 2000) * MS_US))
        control.run(now_us, rest, chance.randrange(-900, 900), ACCELERATION, time_us)
        assert control.milli(now_us) == pytest.approx(milli, abs=10)
        assert control.rate(now_us) == pytest.approx(rate, abs=2)


def test_after_being_held_back_a_new_command_starts_at_the_wheels_position() -> None:
    control = build_controller(slips=True)
    control.run(0, rest, 500, ACCELERATION)
    control.note_lag(200 * MS_US, HELD_US, FAR_MILLI, 0)
    control.run(200 * MS_US, rest, 500, ACCELERATION)
    assert control.milli(200 * MS_US) == 0


def test_a_held_back_move_goes_on_as_a_free_one_delayed_by_the_hold() -> None:
    held = build_controller()
    free = build_controller()
    for control in (held, free):
        control.move_to_position(0, rest, 900, 700, ACCELERATION)
    held.note_lag(100 * MS_US, HELD_US, FAR_MILLI, 0)
    for rate in (None, 300):
        if rate is not None:
            held.run(150 * MS_US, rest, rate, ACCELERATION, 900 * MS_US)
            free.run(150 * MS_US - HELD_US, rest, rate, ACCELERATION, 900 * MS_US)
        assert held.end_us == (free.end_us or 0) + HELD_US
        for now_us in range(150 * MS_US, END_US, 10 * MS_US):
            before_us = now_us - HELD_US
            assert held.milli(now_us) == free.milli(before_us)
            assert held.rate(now_us) == free.rate(before_us)
            end_us = free.find_segment_end_us(before_us)
            assert held.find_segment_end_us(now_us) == (
                None if end_us is None else end_us + HELD_US
            )


def test_a_motion_held_back_is_stalled_after_the_stall_time() -> None:
    control = build_controller()
    stall_us = control.settings.stall_time_ms * MS_US
    control.run(0, rest, 500, ACCELERATION)
    for passed_us, is_stalled in ((stall_us - MS_US, False), (MS_US, True)):
        control.note_lag(2 * stall_us, passed_us, FAR_MILLI, 0)
        assert control.stalled is is_stalled
