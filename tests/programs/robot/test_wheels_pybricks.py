"""The wheels of programs for Pybricks: which motors drive them, and what a drive base says about them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cases import for_each
from tests.programs.robot.reading import PYBRICKS_HEAD, USUAL, built
from tuisim.base.source import Program
from tuisim.engine.core.spec import NO_PORT, RobotSpec
from tuisim.programs.program_settings import read_source_facts

# A program; the ports of the left and the right wheel, their diameter and their distance.
DRIVE_BASES: Mapping[str, tuple[str, tuple[str, str, float, float]]] = {
    "names": (
        "left = Motor(Port.A)\nright = Motor(Port.D)\nrobot = DriveBase(left, right, 56, 114)",
        ("outA", "outD", 56, 114),
    ),
    "ports that others have the other way round": (
        "l = Motor(Port.C)\nr = Motor(Port.B)\nDriveBase(l, r, wheel_diameter=55.5, axle_track=104)",
        ("outC", "outB", 55.5, 104),
    ),
    "attributes": (
        "class Robot:\n    def __init__(self):\n        self.l, self.r = Motor(Port.A), Motor(Port.D)\n"
        "        self.base = DriveBase(self.l, self.r, 68.8, 150)\nRobot()",
        ("outA", "outD", 68.8, 150),
    ),
    "a function for each": (
        "def one():\n    return Motor(Port.D)\ndef other():\n    return Motor(Port.A)\n"
        "DriveBase(one(), other(), 56, 100)",
        ("outD", "outA", 56, 100),
    ),
    "a function for both": (
        "def motor(port):\n    return Motor(port)\na = motor(Port.D)\nb = motor(Port.A)\nDriveBase(a, b, 56, 100)",
        ("outD", "outA", 56, 100),
    ),
    "keywords": (
        "DriveBase(right_motor=Motor(port=Port.A), left_motor=Motor(Port.D), axle_track=120, wheel_diameter=43.2)",
        ("outD", "outA", 43.2, 120),
    ),
    "constants": (
        "WHEEL_MM = 62.4\nTRACK_CM = 12\nL, R = Port.B, Port.C\nDriveBase(Motor(L), Motor(R), WHEEL_MM, "
        "TRACK_CM * 10)",
        ("outB", "outC", 62.4, 120),
    ),
    "a list": (
        "motors = [Motor(port) for port in (Port.A, Port.D)]\nDriveBase(motors[0], motors[1], 56, 100)",
        ("outA", "outD", 56, 100),
    ),
    "a tuple": (
        "a, b = (Motor(port) for port in (Port.A, Port.D))\nDriveBase(a, b, 56, 100)",
        ("outA", "outD", 56, 100),
    ),
    "a dictionary": (
        "m = {'a': Motor(Port.A), 'd': Motor(Port.D)}\nDriveBase(m['d'], m['a'], 56, 100)",
        ("outD", "outA", 56, 100),
    ),
    "ports that only data tells": (
        "ports = {'B': Port.B, 'C': Port.C}\nd = {}\n"
        "DriveBase(Motor(ports[d['left']]), Motor(ports[d['right']]), 56, 100)",
        ("outB", "outC", 56, 100),
    ),
    "objects that hold a motor": (
        "class Side:\n    def __init__(self, port):\n        self.motor = Motor(port)\n"
        "one, other = Side(Port.D), Side(Port.A)\nDriveBase(one.motor, other.motor, 56, 100)",
        ("outD", "outA", 56, 100),
    ),
    "a class of its own": (
        "class Robot(DriveBase):\n    def __init__(self):\n"
        "        super().__init__(Motor(Port.A), Motor(Port.D), 56, 99)\nRobot()",
        ("outA", "outD", 56, 99),
    ),
    "parameters": (
        "class Robot:\n    def __init__(self, a, b, wheel=56, track=100):\n        DriveBase(a, b, wheel, track)\n"
        "Robot(Motor(Port.A), Motor(Port.D), track=130)",
        ("outA", "outD", 56, 130),
    ),
    "version 1.0": (
        "from pybricks import ev3brick as brick\nbrick.sound.beep()\nrobot = DriveBase(Motor(Port.B), Motor(Port.C), "
        "56, 114)\nrobot.drive_time(100, 0, 1000)",
        ("outB", "outC", 56, 114),
    ),
    "sizes that a constant contradicts": (
        "WHEEL_DIAMETER = 43.2\nAXLE_TRACK = 120\nDriveBase(Motor(Port.B), Motor(Port.C), 56, 180)",
        ("outB", "outC", 56, 180),
    ),
    "an arm with the name of a side": (
        "left = Motor(Port.A)\nright = Motor(Port.D)\nDriveBase(Motor(Port.B), Motor(Port.C), 56, 100)",
        ("outB", "outC", 56, 100),
    ),
    "no drive base": (
        "left_motor = Motor(Port.D)\nright_motor = Motor(Port.A)\nleft_motor.run(300)",
        ("outD", "outA", 56, 180),
    ),
    "sizes that are impossible": (
        "DriveBase(Motor(Port.A), Motor(Port.D), 0, 100)",
        ("outB", "outC", 56, 180),
    ),
}


def robot_of(text: str) -> RobotSpec:
    found = built(text, PYBRICKS_HEAD)
    return found.choice.spec if found else USUAL


@for_each(case=DRIVE_BASES)
def test_a_drive_base_gives_motors_and_sizes_of_the_wheels(case: str) -> None:
    text, expected = DRIVE_BASES[case]
    robot = robot_of(text)
    assert (
        robot.left_port,
        robot.right_port,
        robot.wheel_diameter_mm,
        robot.wheel_spacing_mm,
    ) == expected


def test_a_drive_base_in_an_imported_module_gives_the_robots_wheels(tmp_path: Path) -> None:
    (tmp_path / "hardware.py").write_text(
        PYBRICKS_HEAD
        + "left = Motor(Port.A)\nright = Motor(Port.D)\nrobot = DriveBase(left, right, 43.2, 110)\n"
    )
    path = str(tmp_path / "main.py")
    found = read_source_facts(
        Program("main.py", "from hardware import robot\nrobot.straight(100)\n", path=path)
    ).robot
    assert found is not None
    robot = found.choice.spec
    assert (robot.left_port, robot.right_port, robot.wheel_diameter_mm) == ("outA", "outD", 43.2)
    assert (
        str(next(part.where for part in found.parts if part.path == "left_port"))
        == "hardware.py, line 10"
    )


GEARS: Mapping[str, tuple[str, float]] = {
    "none": ("Motor(Port.B)\nb = Motor(Port.C)", 1),
    "one train": (
        "Motor(Port.B, Direction.CLOCKWISE, [12, 36])\nb = Motor(Port.C, gears=[12, 36])",
        3,
    ),
    "trains": ("Motor(Port.B, gears=G)\nb = Motor(Port.C, gears=G)", 6),
    "on one side": ("Motor(Port.B, gears=[12, 36])\nb = Motor(Port.C)", 1),
}


@pytest.mark.parametrize("case", GEARS)
def test_gears_of_both_wheels_are_those_of_the_robot(case: str) -> None:
    motors, ratio = GEARS[case]
    assert (
        robot_of(f"G = [[12, 36], (20, 16, 40)]\na = {motors}\nDriveBase(a, b, 56, 114)").gear_ratio
        == ratio
    )


def test_different_gears_of_the_two_wheels_are_told() -> None:
    found = built("DriveBase(Motor(Port.A, gears=[1, 2]), Motor(Port.D), 56, 100)", PYBRICKS_HEAD)
    assert found is not None
    assert found.doubts == ("the gears of the two wheels differ: none are built",)


def test_move_tank_with_only_one_motor_gives_no_wheels() -> None:
    assert built("MoveTank(OUTPUT_A)") is None


def test_motors_that_run_until_they_stall_are_not_taken_for_wheels() -> None:
    found = built(
        "feed, belt = Motor(Port.A), Motor(Port.D)\nfeed.run_until_stalled(120)\nbelt.run(50)\n",
        PYBRICKS_HEAD,
    )
    assert found is not None
    robot = found.choice.spec
    assert (robot.left_port, robot.right_port) == ("outB", "outC")
    assert [motor.port for motor in robot.extra_motors] == ["outA", "outD"]


def test_on_a_hub_a_port_used_by_a_sensor_is_not_taken_for_a_wheel() -> None:
    text = (
        "from pybricks.hubs import EssentialHub\nfrom pybricks.pupdevices import ColorSensor, Motor\n"
        "from pybricks.parameters import Port\narm, eye = Motor(Port.A), ColorSensor(Port.B)"
    )
    robot = built(text, "")
    assert robot is not None
    assert robot.choice.spec.left_port == NO_PORT
    assert [motor.port for motor in robot.choice.spec.extra_motors] == ["A"]
    assert [sensor.port for sensor in robot.choice.spec.color_sensors] == ["B"]


@pytest.mark.parametrize(
    ("parts", "wheels"),
    [
        ("gate = Motor(Port.B)", ("A", "B")),
        ("arm = Motor(Port.B)", ("A", "C")),
        ("train = DCMotor(Port.A)\nlamp = Light(Port.B)", ("A", "C")),
    ],
    ids=["a motor without a telling name", "an arm", "a light"],
)
def test_the_port_of_an_arm_or_a_light_on_a_hub_is_none_of_a_wheel(
    parts: str, wheels: tuple[str, str]
) -> None:
    head = "from pybricks.hubs import PrimeHub\nfrom pybricks.pupdevices import DCMotor, Light, Motor\n"
    facts = read_source_facts(
        Program("prog.py", f"{head}from pybricks.parameters import Port\n{parts}\n")
    )
    assert facts.robot is not None
    robot = facts.robot.choice.spec
    assert (robot.left_port, robot.right_port) == wheels
