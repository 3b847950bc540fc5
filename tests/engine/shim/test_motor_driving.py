"""Driving is exact: squares close, turns are right, odometry agrees, lines are followed, threads repeat."""

from __future__ import annotations

import math

import pytest

from tests.engine.shim.conftest import START, RunOn
from tuisim.engine.core.tick_record import TICK_RECORD

EXERCISED = {
    "ev3dev2.motor:LineFollowErrorLostLine",
    "ev3dev2.motor:LineFollowErrorTooFast",
    "ev3dev2.motor:MoveTank.cs",
    "ev3dev2.motor:MoveTank.follow_line",
}
"""Items that only these tests exercise."""

DRIVE = """
from ev3dev2.motor import *
from ev3dev2.wheel import EV3EducationSetTire
drive = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, {spacing})
"""

SQUARES = """
for _ in range(40):
    drive.on_for_distance({speed}, 250)
    drive.turn_degrees({speed}, 90)
"""


@pytest.mark.quick_cases("90-square", "30-plain")
@pytest.mark.parametrize("robot", ["square", "plain"])
@pytest.mark.parametrize("speed", [30, 60, 90])
def test_ten_squares_end_where_they_began(run_on: RunOn, robot: str, speed: int) -> None:
    done = run_on(DRIVE.format(spacing=168) + SQUARES.format(speed=speed), robot)
    x_mm, y_mm, heading_deg = done.pose
    assert math.hypot(x_mm - START.x_mm, y_mm - START.y_mm) < 1.0
    # Clockwise: ten whole turns.
    assert heading_deg == pytest.approx(-3600.0, abs=0.1)


FOLLOW = """
from ev3dev2.motor import *
from ev3dev2.sensor.lego import ColorSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.cs = ColorSensor('in2')
try:
    tank.follow_line({gains}, target_light_intensity=45, white=77, off_line_count_max=20)
except ({errors}) as error:
    print(type(error).__name__, tank.left_motor.is_running)
"""
ERRORS = "LineFollowErrorLostLine, LineFollowErrorTooFast"


def test_the_librarys_own_follower_drives_the_lollipop(run_on: RunOn) -> None:
    text = FOLLOW.format(gains="kp=5, ki=0, kd=12.5, speed=SpeedPercent(15)", errors=ERRORS)
    done = run_on(text, "default", "lollipop")
    assert done.lines == ["LineFollowErrorLostLine False"]
    # Past the left end and the far side of the loop, then to where the stick ends.
    way = [(row[2], row[3]) for row in TICK_RECORD.iter_unpack(done.recording[0][64:])]
    assert min(x for x, _ in way) < 450 and max(y for _, y in way) > 740
    assert 1860 < max(x for x, _ in way) < 1980
    assert way[-1][0] > 1860


def test_follow_line_too_fast_raises_and_stops_the_robot(run_on: RunOn) -> None:
    text = FOLLOW.format(gains="kp=1000, ki=0, kd=0, speed=SpeedPercent(90)", errors=ERRORS)
    assert run_on(text, "default", "lollipop").lines == ["LineFollowErrorTooFast False"]
