"""The devices that a program makes: where, how they are called, and which of them can be made at all."""

from __future__ import annotations

from tuisim.config.program_robot.library import DeviceKind
from tuisim.config.program_robot.mentions import Mentions, mentions_in
from tuisim.config.program_robot.source import data_files, read_modules
from tuisim.source import Program


def mentions(text: str) -> Mentions:
    program = Program(
        "p.py", f"from ev3dev2.motor import *\nfrom ev3dev2.sensor.lego import *\n{text}"
    )
    return mentions_in(read_modules(program), data_files(program))


def test_a_device_has_its_line_and_its_names() -> None:
    (found,) = mentions("arm = claw = MediumMotor(OUTPUT_A)").devices
    assert (found.kind, found.port, str(found.where)) == (DeviceKind.MEDIUM, "outA", "p.py, line 3")
    assert set(found.names) >= {"arm", "claw"}


def test_what_nothing_refers_to_makes_no_device() -> None:
    assert mentions("def unused():\n    MediumMotor(OUTPUT_A)").devices == ()
    assert [
        one.port for one in mentions("def used():\n    MediumMotor(OUTPUT_A)\nused()").devices
    ] == ["outA"]


def test_each_call_of_a_function_makes_its_own_device() -> None:
    found = mentions(
        "def motor(port):\n    return LargeMotor(port)\na, b = motor(OUTPUT_A), motor(OUTPUT_D)"
    ).devices
    assert sorted(one.port for one in found) == ["outA", "outD"]


def test_a_device_of_a_class_knows_its_owner() -> None:
    (found,) = mentions(
        "class Arm:\n    def __init__(self):\n        self.m = LargeMotor(OUTPUT_A)\nArm()"
    ).devices
    assert found.owner is not None
    assert getattr(found.owner.node, "name", "") == "Arm"


def test_a_pair_says_what_it_knows_of_the_wheels() -> None:
    (pair,) = mentions(
        "from ev3dev2.wheel import EV3Tire\ndrive = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 150)"
    ).pairs
    assert (pair.left, pair.right, pair.class_name) == ("outB", "outC", "MoveDifferential")
    assert (pair.wheel_mm, pair.spacing_mm) == ((43.2, 21.0), 150.0)


def test_a_sensor_without_a_port_is_any_of_its_kind() -> None:
    (found,) = mentions("TouchSensor()").devices
    assert (found.kind, found.port, found.is_any) == (DeviceKind.TOUCH, "", True)
