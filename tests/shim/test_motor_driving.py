"""Driving is exact: squares close, turns are right, odometry agrees, lines are followed, threads repeat."""

from __future__ import annotations

import math

import pytest

from tests.shim.conftest import START, RunOn
from tuisim.core.geometry import Pose
from tuisim.core.tick_record import TICK_RECORD

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


@pytest.mark.quick_cases("5-square", "30-default")
@pytest.mark.parametrize("robot", ["square", "default"])
@pytest.mark.parametrize("speed", [5, 30, 60, 90, 100])
def test_a_quarter_turn_is_right_at_any_speed(run_on: RunOn, robot: str, speed: int) -> None:
    spacing = 168 if robot == "square" else 180
    done = run_on(DRIVE.format(spacing=spacing) + f"drive.turn_degrees({speed}, 90)", robot)
    assert done.pose[2] == pytest.approx(-90.0, abs=0.1)


ODOMETRY = """
import time
from math import degrees
time.sleep(0.1)
drive.odometry_start(theta_degrees_start=0, x_pos_start=500, y_pos_start=571.5)
for _ in range(10):
    for angle in (90, 90, 90, 90):
        drive.on_for_distance(40, 250)
        drive.turn_degrees(40, angle)
time.sleep(0.1)
print(drive.x_pos_mm, drive.y_pos_mm, degrees(drive.theta))
drive.odometry_stop()
"""


@pytest.mark.slow
def test_odometry_agrees_after_ten_metres(run_on: RunOn) -> None:
    done = run_on(DRIVE.format(spacing=168) + ODOMETRY, "square")
    x_mm, y_mm, heading_deg = map(float, done.lines[0].split())
    true_x_mm, true_y_mm, true_deg = done.pose
    assert math.hypot(x_mm - true_x_mm, y_mm - true_y_mm) < 1.0
    assert (heading_deg - true_deg + 180) % 360 - 180 == pytest.approx(0.0, abs=0.1)


ARC = """
import time
from math import degrees
time.sleep(0.1)
drive.odometry_start(theta_degrees_start=0, x_pos_start=500, y_pos_start=571.5)
drive.on_arc_right(30, 250, 10_000)
time.sleep(0.1)
print(drive.x_pos_mm, drive.y_pos_mm, degrees(drive.theta))
drive.odometry_stop()
"""


@pytest.mark.slow
def test_odometry_agrees_after_ten_metres_on_an_arc(run_on: RunOn) -> None:
    done = run_on(DRIVE.format(spacing=168) + ARC, "square")
    x_mm, y_mm, _ = map(float, done.lines[0].split())
    assert math.hypot(x_mm - done.pose[0], y_mm - done.pose[1]) < 1.0


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


def test_following_too_fast_stops(run_on: RunOn) -> None:
    text = FOLLOW.format(gains="kp=1000, ki=0, kd=0, speed=SpeedPercent(90)", errors=ERRORS)
    assert run_on(text, "default", "lollipop").lines == ["LineFollowErrorTooFast False"]


THREADS = """
import random, threading, time
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
tank, eye, far = MoveTank(OUTPUT_B, OUTPUT_C), ColorSensor('in2'), UltrasonicSensor()
over = False

def look():
    while not over:
        print('light:', eye.reflected_light_intensity)
        time.sleep(random.random() / 20)

def press():
    while not over:
        print('far:', far.distance_centimeters, tank.left_motor.position)
        time.sleep(0.03)

threads = [threading.Thread(target=f) for f in (look, press)]
for thread in threads:
    thread.start()
for side in range(4):
    tank.on_for_rotations(30, 30, 0.5)
    tank.on_for_degrees(20, -20, 135)
over = True
for thread in threads:
    thread.join()
"""


@pytest.mark.slow
def test_three_threads_give_the_same_log_twenty_times(run_on: RunOn) -> None:
    logs = {
        run_on(THREADS, "default", "lollipop", live=bool(time % 2)).recording for time in range(20)
    }
    assert len(logs) == 1
    ((telemetry, output, _),) = logs
    assert len(telemetry) > 64 * 100 and output.count(b"light:") > 50 and output.count(b"far:") > 50


def test_the_start_may_be_anywhere(run_on: RunOn) -> None:
    done = run_on("print(1)", start=Pose(100.0, 100.0, 30.0))
    assert done.pose == (100.0, 100.0, 30.0)
