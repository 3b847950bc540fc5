"""What a change of mode of a sensor costs on a brick, and what it does to the values."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn

COLOR = """
import time
from ev3dev2.sensor.lego import ColorSensor
eye = ColorSensor('in2')
eye.value(0)
before = time.time()
eye.mode = 'RGB-RAW'
print(round(time.time() - before, 4))
shown = []
while time.time() - before < 0.05:
    value = eye.value(0)
    shown.append((value, time.time() - before < 0.02))
print(sorted({value for value, is_early in shown if is_early}), {value for value, is_early in shown if not is_early})
before = time.time()
eye.mode = 'RGB-RAW'
print(time.time() - before < 0.005)
"""


def test_changing_a_sensors_mode_takes_time_and_first_readings_are_old(run_on: RunOn) -> None:
    took, shown, is_quick = run_on(COLOR, "default", "red").lines
    assert 0.015 <= float(took) <= 0.0165
    # The reflected light of before, then red; a slow program reads nothing so early.
    assert shown in ("[55] {166}", "[] {166}")
    assert is_quick == "True"


def test_changing_a_sensors_mode_takes_no_time_in_the_course_profile(run_on: RunOn) -> None:
    took, shown, _ = run_on(COLOR, "default", "red", "robolab").lines
    assert (float(took), shown) == (0, "[189] {189}")


GYRO = """
import time
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import GyroSensor
gyro = GyroSensor()
MoveTank(OUTPUT_B, OUTPUT_C).on_for_degrees(20, -20, 180)
time.sleep(1)
first = gyro.angle
gyro.rate
gyro.mode = 'GYRO-ANG'
time.sleep(0.03)
print(first > 50, gyro.angle == first, gyro.angle)
"""


@pytest.mark.parametrize(
    ("robot", "profile", "is_reset"),
    [("default", "ev3", True), ("newer gyro", "ev3", False), ("default", "robolab", False)],
)
def test_an_older_gyro_restarts(run_on: RunOn, robot: str, profile: str, is_reset: bool) -> None:
    (line,) = run_on(GYRO, robot, profile=profile).lines
    assert line.startswith("True False 0" if is_reset else "True True")


PYBRICKS = """
from pybricks.ev3devices import GyroSensor, Motor
from pybricks.parameters import Port
gyro, left, right = GyroSensor(Port.S4), Motor(Port.B), Motor(Port.C)
left.run_angle(200, 180, wait=False)
right.run_angle(200, -180)
first = gyro.angle()
gyro.speed()
print(first > 50, gyro.angle() == first)
gyro.reset_angle(10)
print(gyro.angle())
"""


@pytest.mark.parametrize(("robot", "keeps"), [("default", False), ("newer gyro", True)])
def test_pybricks_also_restarts_an_older_gyro(run_on: RunOn, robot: str, keeps: bool) -> None:
    assert run_on(PYBRICKS, robot, profile="lego-micropython").lines == [f"True {keeps}", "10"]


INFRARED = """
import time
from ev3dev2.sensor.lego import InfraredSensor
eye, before = InfraredSensor(), time.time()
eye.proximity
half = time.time()
eye.heading(1)
print(half - before < 0.05, 1.1 <= time.time() - half < 1.15)
"""


def test_an_infrared_sensors_first_reading_takes_more_than_a_second(run_on: RunOn) -> None:
    assert run_on(INFRARED, "eyes", "furnished").lines == ["True True"]


NOTHING = """
from ev3dev2.sensor.lego import ColorSensor
eye = ColorSensor('in2')
eye.mode = 'REF-RAW'
eye.mode = 'COL-COLOR'
print(eye.value(0))
"""


def test_an_old_value_that_is_no_color_reads_0(run_on: RunOn) -> None:
    (code,) = run_on(NOTHING, "default", "red").lines
    # 5 where readings are slow.
    assert code in ("0", "5")
