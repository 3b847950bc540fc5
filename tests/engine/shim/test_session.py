"""What a program reads is recorded, whichever library it reads with."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn
from tests.running import Done
from tuisim.engine.runs.readings import READING_MODES, READING_PORTS, read_readings

LINES = {
    "ev3dev2": """\
from ev3dev2.motor import LargeMotor, MediumMotor
from ev3dev2.sensor.lego import *
from ev3dev2.button import Button
touch, infrared, gyro, sonar = TouchSensor(), InfraredSensor(), GyroSensor(), UltrasonicSensor()
motor, arm, button = LargeMotor('outB'), MediumMotor('outA'), Button()
motor.position  # outB position
arm.degrees  # outA position
motor.speed  # outB speed
motor.is_running  # outB state
touch.is_pressed  # in2 TOUCH
infrared.proximity  # in3 IR-PROX
infrared.heading()  # in3 IR-SEEK
infrared.top_left()  # in3 IR-REMOTE
gyro.angle  # in4 GYRO-ANG
gyro.rate  # in4 GYRO-RATE
sonar.distance_centimeters  # in1 US-DIST-CM
button.any()  # buttons pressed
motor.on_for_degrees(50, 90)
motor.polarity
sonar.mode
""",
    "files": """\
from glob import glob
def named(kind, port):
    return next(one for one in glob(f'/sys/class/{kind}/*') if port in open(one + '/address').read())
motor, touch = named('tacho-motor', 'outC'), named('lego-sensor', 'in2')
open(motor + '/position').read()  # outC position
open(touch + '/value0').read()  # in2 TOUCH
open(motor + '/max_speed').read()
""",
    "ev3dev": """\
from ev3dev.ev3 import *
motor, touch, sonar, button = LargeMotor('outB'), TouchSensor(), UltrasonicSensor(), Button()
motor.position  # outB position
motor.state  # outB state
touch.is_pressed  # in2 TOUCH
sonar.distance_centimeters  # in1 US-DIST-CM
button.enter  # buttons pressed
""",
    "pybricks": """\
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import *
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
brick, left, right = EV3Brick(), Motor(Port.B), Motor(Port.C)
touch, infrared, sonar = TouchSensor(Port.S2), InfraredSensor(Port.S3), UltrasonicSensor(Port.S1)
base = DriveBase(left, right, 56, 120)
left.angle()  # outB position
right.speed()  # outC speed
base.distance()  # outB position, outC position
base.state()  # outB position, outC position
left.control.stalled()  # outB state
touch.pressed()  # in2 TOUCH
infrared.distance()  # in3 IR-PROX
infrared.keypad()  # in3 IR-REM-A
sonar.distance()  # in1 US-DIST-CM
brick.buttons.pressed()  # buttons pressed
base.straight(20)
brick.battery.voltage()
""",
}
"""Behind each line what it reads."""


def _read(done: Done) -> list[tuple[int, str]]:
    rows = read_readings(done.run.folder).rows
    return [
        (line, f"{READING_PORTS[port]} {READING_MODES[mode]}")
        for line, port, mode in rows[["line", "port", "mode"]].tolist()
    ]


def _expected(text: str) -> list[tuple[int, str]]:
    return [
        (number, reading)
        for number, line in enumerate(text.splitlines(), start=1)
        if "  # " in line
        for reading in line.partition("  # ")[2].split(", ")
    ]


@pytest.mark.parametrize("library", LINES)
def test_each_reading_is_recorded_with_its_line(run_on: RunOn, library: str) -> None:
    profile = "lego-micropython" if library == "pybricks" else "ev3"
    done = run_on(LINES[library], "eyes", profile=profile)
    assert done.errors == []
    assert _read(done) == _expected(LINES[library])


def test_a_recorded_reading_has_the_time_at_which_its_value_was_measured(run_on: RunOn) -> None:
    done = run_on(
        """\
import time
from ev3dev2.motor import LargeMotor
from ev3dev2.sensor.lego import ColorSensor
color, motor = ColorSensor('in2'), LargeMotor('outB')
for _ in range(3):
    color.reflected_light_intensity
    print(time.monotonic_ns())
    motor.position
    print(time.monotonic_ns())
""",
        "default",
    )
    clock_ns = done.run.spec.profile.clock_read_ns
    printed = [int(line) - clock_ns for line in done.lines]
    assert read_readings(done.run.folder).rows["time_ns"].tolist() == printed


def test_a_loop_that_takes_no_time_records_a_reading_once_an_instant(run_on: RunOn) -> None:
    done = run_on(
        """\
from ev3dev2.motor import LargeMotor
left, right = LargeMotor('outB'), LargeMotor('outC')
for _ in range(3000):
    left.position, right.position
""",
        "default",
        profile="nbev3devsim",
    )
    rows = read_readings(done.run.folder).rows
    instants = len(set(rows["time_ns"].tolist()))
    assert 1 < instants < 100
    assert len(rows) == 2 * instants


def test_readings_in_threads_and_functions_are_recorded_with_their_lines(run_on: RunOn) -> None:
    done = run_on(
        """\
import threading
from ev3dev2.motor import LargeMotor
from ev3dev2.button import Button
motor, button = LargeMotor('outB'), Button()
def read():
    return motor.position
def watch():
    for _ in range(2):
        button.any()
thread = threading.Thread(target=watch)
thread.start()
read(), read()
thread.join()
button.wait_for_pressed(['enter'], timeout_ms=25)
""",
        "default",
    )
    assert sorted(set(_read(done))) == [
        (6, "outB position"),
        (9, "buttons pressed"),
        (14, "buttons pressed"),
    ]


@pytest.mark.parametrize(
    "wait",
    [
        "for event in evdev.InputDevice('/dev/input/event0').read_loop(): break",
        "open('/dev/input/event0', 'rb').read(24)",
    ],
)
def test_waiting_for_a_button_is_reading_it(run_on: RunOn, wait: str) -> None:
    done = run_on(f"import evdev\n{wait}\n", "default", presses=("enter@0.2",))
    assert done.errors == []
    assert set(_read(done)) == {(2, "buttons pressed")}
    assert len(_read(done)) >= 20
