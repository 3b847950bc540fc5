"""What a paused program waits for, with the library that it uses."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.engine.runtime.debugging import Driver
from tests.running import Start
from tuisim.engine.protocol import BEFORE_NEXT_TICK

PYBRICKS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait
left, right = Motor(Port.B), Motor(Port.C)
"""
PYBRICKS_WAITS = {
    "one of two that move": (
        "left.run(100)\nright.run_angle(50, 500)",
        "waits for motor outC to reach 500°",
    ),
    "until it stalls": (
        "left.run(100)\nright.run_until_stalled(100)",
        "waits for motor outC to stop",
    ),
    "a drive base": (
        "DriveBase(left, right, 56, 114).turn(90)",
        "waits for motor outB to reach 183° and motor outC to reach -183°",
    ),
    "sleep": ("left.run(100)\nwait(3000)", "sleeps until 3.00 s"),
}


@pytest.mark.parametrize("case", PYBRICKS_WAITS)
def test_what_a_pybricks_program_waits_for_is_said(start: Start, case: str) -> None:
    text, note = PYBRICKS_WAITS[case]
    held = {"live": True, "speed": 0.0, "hold_at": (30, BEFORE_NEXT_TICK)}
    driver = Driver(start(PYBRICKS + text, profile="lego-micropython", prelude="none", **held))
    driver.paused()
    assert driver.look(thread="MainThread").waiting == note


READS = {
    "predefined": ("gyro.angle", "gyro.angle"),
    "own name": ("turned.angle", "turned.angle"),
    "within a call": ("gyro.angle_and_rate", "gyro.angle_and_rate"),
    "other sensor": ("ultrasonic.distance_centimeters", "ultrasonic.distance_centimeters"),
}


@cases("text, words", READS)
def test_a_paused_loop_names_the_sensor_it_reads_as_in_the_program(
    start: Start, text: str, words: str
) -> None:
    before = "gyro\nturned, gyro = gyro, None\n" if text.startswith("turned") else ""
    loop = f"{before}while True:\n    {text}\n"
    driver = Driver(start(loop, live=True, speed=0.0, hold_at=(30, BEFORE_NEXT_TICK)))
    driver.paused()
    assert driver.look(thread="MainThread").waiting.startswith(f"reads {words} until")
