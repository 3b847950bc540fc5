"""A program that misuses the library gets the library's own error, with its own line."""

from __future__ import annotations

from tests.cases import cases
from tests.engine.shim.conftest import RunOn

SETUP = """\
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
from ev3dev2.sound import Sound
motor = LargeMotor(OUTPUT_B)
"""

MISUSES = {
    "steering": ("MoveSteering(OUTPUT_B, OUTPUT_C).on(101, 50)", "AssertionError: "),
    "wrong kind of motor": (
        "MediumMotor(OUTPUT_B)",
        "ev3dev2.DeviceNotFound: MediumMotor(ev3-ports:outB) is not",
    ),
    "wrong kind of sensor": (
        "GyroSensor('in2')",
        "ev3dev2.DeviceNotFound: GyroSensor(in2) is not connected. This",
    ),
    "negative seconds": ("motor.on_for_seconds(10, -1)", "ValueError: "),
    "volume cannot be told": ("Sound().get_volume()", "TypeError: invalid cmd type"),
    "unknown font": (
        "from ev3dev2.display import Display; Display().text_pixels('x', font='luBS15')",
        "AssertionError: luBS15 is an invalid font",
    ),
}


@cases("text, error", MISUSES)
def test_a_misused_call_raises_the_librarys_own_error(run_on: RunOn, text: str, error: str) -> None:
    done = run_on(SETUP + text, "default")
    assert (done.ended.end, done.ended.error_line) == ("raised", 5)
    assert done.errors[0] == "Traceback (most recent call last):"
    assert done.errors[-1].startswith(error)
    places = [line for line in done.errors if line.startswith("  File ")]
    assert places and not any("tuisim" in line or "site-packages" in line for line in places)
