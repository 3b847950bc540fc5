"""How the motors of programs for Pybricks are mounted: turned round, with end stops, pressing a sensor."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.cases import for_each
from tests.programs.robot.reading import PYBRICKS_HEAD, USUAL, built
from tuisim.engine.core.spec import RobotSpec

CCW = "Direction.COUNTERCLOCKWISE"


def robot_of(text: str) -> RobotSpec:
    found = built(text, PYBRICKS_HEAD)
    return found.choice.spec if found else USUAL


REVERSED: Mapping[str, tuple[str, tuple[bool, bool]]] = {
    "both": (
        f"DriveBase(Motor(Port.B, {CCW}), Motor(Port.C, positive_direction={CCW}), 56, 100)",
        (True, True),
    ),
    "one": (
        f"DriveBase(Motor(Port.B, Direction.CLOCKWISE), Motor(Port.C, {CCW}), 56, 100)",
        (False, True),
    ),
    "a constant": (f"WAY = {CCW}\nleft, right = Motor(Port.B, WAY), Motor(Port.C)", (True, False)),
    "an arm": (
        f"arm = Motor(Port.A, {CCW})\nDriveBase(Motor(Port.B), Motor(Port.C), 56, 100)",
        (False, False),
    ),
    "driven backwards to go forwards": (
        "robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 100)\ndef forward():\n    robot.straight(-200)\n"
        "    robot.turn(90)\nforward()",
        (True, True),
    ),
    "turned while it goes forwards": (
        "robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 100)\ndef forward():\n    robot.turn(-90)\nforward()",
        (False, False),
    ),
}


@pytest.mark.parametrize("case", REVERSED)
def test_a_wheel_with_the_other_direction_is_mounted_the_other_way_round(case: str) -> None:
    text, expected = REVERSED[case]
    robot = robot_of(text)
    assert (robot.left_reversed, robot.right_reversed) == expected


STOPS: Mapping[str, tuple[str, tuple[float | None, float | None]]] = {
    "until it stalls": ("m = Motor(Port.A)\nm.run_until_stalled(-100, Stop.COAST, 40)", (-45, 225)),
    "then far away": (
        "m = Motor(Port.A)\nm.run_until_stalled(speed=100)\nm.run_angle(200, -700)",
        (-745, 45),
    ),
    "in both directions": (
        "m = Motor(Port.A)\nm.run_until_stalled(-100)\nm.run_until_stalled(100)\nm.run_angle(90, x)",
        (-45, 225),
    ),
    "the speed is a parameter": (
        "m = Motor(Port.A)\ndef home(speed):\n    m.run_until_stalled(speed)\nhome(-100)\nhome(100)\nm.run_angle(9, x)",
        (-45, 225),
    ),
    "then to places counted from there": (
        "m = Motor(Port.A)\nm.run_until_stalled(-100)\nm.reset_angle(-300)\nm.run_target(200, target_angle=270)",
        (-45, 615),
    ),
    "then several times the same way": (
        "m = Motor(Port.A)\nm.run_until_stalled(-100)\nm.run_angle(90, 200)\nm.run_angle(90, 200)",
        (-45, 445),
    ),
    "with the other direction": (
        f"m = Motor(Port.A, {CCW})\nm.run_until_stalled(-100)",
        (-225, 45),
    ),
    "with gears": (
        "m = Motor(Port.A, gears=[8, 40])\nm.run_until_stalled(-100)\nm.track_target(90)",
        (-45, 495),
    ),
    "its control tells": (
        "m = Motor(Port.A)\nm.run(-100)\nwhile not m.control.stalled():\n    wait(10)",
        (-45, 225),
    ),
    "until it is slow": (
        "m = Motor(Port.A)\nm.dc(-50)\nwhile abs(m.speed()) > 20:\n    pass",
        (-45, 225),
    ),
    "it is only printed": (
        "m = Motor(Port.A)\nm.run(300)\nprint(m.stalled(), f'{m.control.stalled()}')\nm.run_angle(90, 360)",
        (None, None),
    ),
    "what a homing returns is printed": (
        "m = Motor(Port.A)\nprint(m.run_until_stalled(-100))",
        (-45, 225),
    ),
    "no homing": ("m = Motor(Port.A)\nm.run_time(200, 500)\nm.run(100)", (None, None)),
}


@for_each(case=STOPS)
def test_a_motor_that_is_driven_until_it_stalls_has_an_end_stop(case: str) -> None:
    text, expected = STOPS[case]
    (motor,) = robot_of(text).extra_motors
    assert (motor.low_deg, motor.high_deg) == expected


def test_a_motor_that_runs_until_a_touch_sensor_is_pressed_presses_it() -> None:
    robot = robot_of(
        f"base = Motor(Port.A, {CCW}, [12, 36])\nswitch = TouchSensor(Port.S1)\nbase.run(-60)\n"
        "while not switch.pressed():\n    wait(10)\nbase.reset_angle(0)\nbase.run_target(60, 160)"
    )
    assert (robot.touch_sensors[0].pressed_by, robot.touch_sensors[0].pressed_at) == (
        "outA",
        "high",
    )
    assert (robot.extra_motors[0].low_deg, robot.extra_motors[0].high_deg) == (-525, 45)
