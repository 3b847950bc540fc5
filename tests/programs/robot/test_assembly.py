"""The robot of a program: what is told of another reading, and programs that cannot be read."""

from __future__ import annotations

import pytest

from tests.programs.robot.reading import built


@pytest.mark.parametrize(
    "text, doubt",
    [
        (
            "[LargeMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C)]",
            "those on outB and outC are taken for the wheels",
        ),
        (
            "MoveTank(OUTPUT_A, OUTPUT_D)\nMoveTank(OUTPUT_B, OUTPUT_C)",
            "MoveTank on outB and outC is not used",
        ),
        (
            "ColorSensor('in1')\nTouchSensor('in1')\nTouchSensor('in1')",
            "in1 is taken for that of the touch sensor, not of the colour sensor",
        ),
        ("GyroSensor('in1')\nGyroSensor('in2')", "a robot has one gyro"),
    ],
    ids=["wheels", "pairs", "kinds", "gyros"],
)
def test_a_doubtful_choice_of_the_wheels_motors_is_told(text: str, doubt: str) -> None:
    found = built(text)
    assert found is not None
    assert any(doubt in one for one in found.doubts)


@pytest.mark.parametrize(
    "text",
    [
        "def f(:",
        "x = " + "(" * 3000,
        "x = " + "-" * 5000 + "1",
        "a.b" + ".c" * 5000 + "()",
        "import ev3dev2\0",
    ],
    ids=["syntax", "brackets", "signs", "attributes", "null"],
)
def test_no_robot_is_built_for_a_program_that_cannot_be_read(text: str) -> None:
    assert built(text) is None


def test_parts_of_a_hubs_robot_are_listed_by_their_names_on_the_hub() -> None:
    robot = built(
        "from pybricks.hubs import PrimeHub\nfrom pybricks.pupdevices import ForceSensor, Motor\n"
        "from pybricks.parameters import Port\nbumper, arm = ForceSensor(Port.E), Motor(Port.C)",
        "",
    )
    assert robot is not None
    words = {part.what for part in robot.parts}
    assert words >= {"force sensor on E", "medium angular motor on C"}
