"""A program that misuses the library gets the library's own error, with its own line."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.shim.conftest import RunOn

SETUP = """\
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
from ev3dev2.sound import Sound
motor = LargeMotor(OUTPUT_B)
"""

MISUSES = {
    "too fast": ("SpeedPercent(150)", "ev3dev2.motor.SpeedInvalid: "),
    "plain number too fast": ("motor.on(101)", "ev3dev2.motor.SpeedInvalid: "),
    "steering": ("MoveSteering(OUTPUT_B, OUTPUT_C).on(101, 50)", "AssertionError: "),
    "empty port": (
        "LargeMotor(OUTPUT_A)",
        "ev3dev2.DeviceNotFound: LargeMotor(ev3-ports:outA) is not connected. ",
    ),
    "wrong kind of motor": (
        "MediumMotor(OUTPUT_B)",
        "ev3dev2.DeviceNotFound: MediumMotor(ev3-ports:outB) is not",
    ),
    "wrong kind of sensor": (
        "GyroSensor('in2')",
        "ev3dev2.DeviceNotFound: GyroSensor(in2) is not connected. This",
    ),
    "negative seconds": ("motor.on_for_seconds(10, -1)", "ValueError: "),
    "read-only": ("motor.count_per_rot = 1", "AttributeError: "),
    "read-only on a sensor": ("ColorSensor().num_values = 1", "AttributeError: "),
    "write-only": ("motor.command", "Exception: command is a write-only property!"),
    "set point": (
        "motor.speed_sp = 2000",
        "ValueError: The given speed value 2000 was out of range. Max speed: +/-1050",
    ),
    "set point below": (
        "motor.time_sp = -1",
        "ValueError: One or more arguments were out of range or invalid",
    ),
    "mode": (
        "ColorSensor().mode = 'DIM'",
        "ValueError: One or more arguments were out of range or invalid",
    ),
    "no such attribute": ("motor.run_forever(fast=1)", "AttributeError: "),
    "unknown sound file": (
        "Sound().play_file('nothing.wav')",
        "ValueError: nothing.wav does not exist",
    ),
    "unknown note": ("Sound().play_note('H9', 1)", "ValueError: invalid note (H9)"),
    "wrong kind of sound": (
        "Sound().tone(1, 2, 3)",
        "Exception: Unsupported number of parameters in Sound.tone()",
    ),
    "quote in speech": ('Sound().speak("It\'s")', "ValueError: No closing quotation"),
    "volume cannot be told": ("Sound().get_volume()", "TypeError: invalid cmd type"),
    "outside the grid": (
        "from ev3dev2.display import Display; Display().text_grid('x', x=22)",
        "AssertionError: grid columns must be between 0 and 21, 22 was requested",
    ),
    "unknown font": (
        "from ev3dev2.display import Display; Display().text_pixels('x', font='luBS15')",
        "AssertionError: luBS15 is an invalid font",
    ),
    "font not loaded": (
        "from ev3dev2 import fonts; fonts.load('x')",
        'Exception: Failed to load font "x". Check',
    ),
    "picture not there": (
        "from ev3dev2.display import Display; Display().image_filename('no.png')",
        "FileNotFoundError: ",
    ),
    "colour not there": (
        "from ev3dev2.display import Display; Display().line(line_color='greenish')",
        "ValueError: unknown color specifier: 'greenish'",
    ),
    "odometry not started": (
        "from ev3dev2.wheel import EV3Tire; MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 120).turn_to_angle(10, 90)",
        "ev3dev2.ThreadNotRunning: ",
    ),
    "no gyro told": (
        "MoveTank(OUTPUT_B, OUTPUT_C).turn_degrees(10, 90)",
        "ev3dev2.DeviceNotDefined: ",
    ),
    "white on black": (
        "c = ColorSensor(); c.red_max = 0; c.rgb",
        "ZeroDivisionError: ",
    ),
}


@pytest.mark.quick_cases(
    "steering",
    "volume cannot be told",
    "wrong kind of motor",
    "wrong kind of sensor",
    "negative seconds",
    "unknown font",
)
@cases("text, error", MISUSES)
def test_misuse(run_on: RunOn, text: str, error: str) -> None:
    done = run_on(SETUP + text, "default")
    assert (done.ended.end, done.ended.error_line) == ("raised", 5)
    assert done.errors[0] == "Traceback (most recent call last):"
    assert done.errors[-1].startswith(error)
    places = [line for line in done.errors if line.startswith("  File ")]
    assert places and not any("tuisim" in line or "site-packages" in line for line in places)
