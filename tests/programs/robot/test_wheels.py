"""Which motors of a program drive the wheels."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.cases import for_each
from tests.programs.robot.reading import USUAL, built, changed

WHEELS: Mapping[str, tuple[str, str]] = {
    "steering": ("MoveSteering(OUTPUT_A, OUTPUT_B)", "A left wheel, B right wheel, C -"),
    "differential before tank": (
        "MoveTank(OUTPUT_A, OUTPUT_D)\nMoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 180)",
        "A large motor, D large motor",
    ),
    "a tank of arms": (
        "arms = MoveTank(OUTPUT_A, OUTPUT_D)\ndrive = MoveTank(OUTPUT_B, OUTPUT_C)",
        "A large motor, D large motor",
    ),
    "names": (
        "lift = LargeMotor(OUTPUT_C)\nrightMotor = LargeMotor(OUTPUT_A)\nleftMotor = LargeMotor(OUTPUT_B)",
        "A right wheel, C large motor",
    ),
    "German names": (
        "motor_links = LargeMotor(OUTPUT_D)\nmotor_rechts = LargeMotor(OUTPUT_A)",
        "A right wheel, B -, C -, D left wheel",
    ),
    "Chinese names": (
        "左电机 = LargeMotor(OUTPUT_D)\n右电机 = LargeMotor(OUTPUT_A)",
        "A right wheel, B -, C -, D left wheel",
    ),
    "Russian names": (
        "мотор_левый = LargeMotor(OUTPUT_D)\nмоторПравый = LargeMotor(OUTPUT_A)",
        "A right wheel, B -, C -, D left wheel",
    ),
    "short names": (
        "mL = LargeMotor(OUTPUT_D)\nmR = LargeMotor(OUTPUT_A)",
        "A right wheel, B -, C -, D left wheel",
    ),
    "names of constants": (
        "L = OUTPUT_D\nR = OUTPUT_A\nm1 = LargeMotor(L)\nm2 = LargeMotor(R)",
        "A right wheel, B -, C -, D left wheel",
    ),
    "a class that holds two": (
        "arm = LargeMotor(OUTPUT_B)\nclass Car:\n    def __init__(self):\n        self.a = LargeMotor(OUTPUT_A)\n"
        "        self.d = LargeMotor(OUTPUT_D)\nCar()",
        "A left wheel, B large motor, C -, D right wheel",
    ),
    "three without names": (
        "[LargeMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C)]",
        "A large motor",
    ),
    "a single large motor": ("LargeMotor(OUTPUT_A)", "A large motor"),
    "a medium motor on the left wheel's port": (
        "MediumMotor(OUTPUT_B)",
        "A left wheel, B medium motor",
    ),
    "medium motors left and right": (
        "left = MediumMotor(OUTPUT_A)\nright = MediumMotor(OUTPUT_D)",
        "A left wheel (medium motor), B -, C -, D right wheel (medium motor)",
    ),
    "the same port twice": ("MoveTank(OUTPUT_B, OUTPUT_B)", ""),
    "medium motors on all ports": (
        "[MediumMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D)]",
        "A medium motor, B left wheel (medium motor), C right wheel (medium motor), D medium motor",
    ),
    "as usual": ("tank = MoveTank(OUTPUT_B, OUTPUT_C)\nleft = LargeMotor(OUTPUT_B)", ""),
}


@for_each(case=WHEELS)
def test_the_motors_of_the_wheels_are_found(case: str) -> None:
    text, expected = WHEELS[case]
    assert changed(text) == expected


SIZES: Mapping[str, tuple[str, tuple[float, float, float]]] = {
    "rim": ("MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Rim, 100)", (30, 20, 100)),
    "by keyword": (
        "MoveDifferential(OUTPUT_B, OUTPUT_C, wheel_class=EV3Tire, wheel_distance_mm=9.5 * 10)",
        (43.2, 21, 95),
    ),
    "of a subclass": (
        "class W(EV3Tire): pass\nMoveDifferential(OUTPUT_B, OUTPUT_C, W, 180)",
        (43.2, 21, 180),
    ),
    "with super": (
        "class W(Wheel):\n    def __init__(self):\n        super().__init__(diameter_mm=62.4, width_mm=20)\n"
        "MoveDifferential(OUTPUT_B, OUTPUT_C, W, 150)",
        (62.4, 20, 150),
    ),
    "impossible": ("MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 0)", (56, 20, 180)),
}


@pytest.mark.parametrize("case", SIZES)
def test_wheel_sizes_given_to_a_differential_drive_are_those_of_the_robot(case: str) -> None:
    text, expected = SIZES[case]
    found = built(text)
    robot = found.choice.spec if found else USUAL
    assert (robot.wheel_diameter_mm, robot.wheel_width_mm, robot.wheel_spacing_mm) == expected


def test_motors_of_an_arm_are_not_taken_for_wheels() -> None:
    arm = (
        "class Joint:\n    def __init__(self, motor):\n        self.motor = motor\n"
        "elbow, base = Joint(LargeMotor(OUTPUT_B)), Joint(LargeMotor(OUTPUT_C))\ngrip = MediumMotor(OUTPUT_A)\n"
        "limit = TouchSensor(INPUT_1)\nm = elbow.motor\nm.on_for_degrees(5, 40)\n"
        "m = base.motor\nm.on(-5)\nlimit.wait_for_pressed()"
    )
    found = built(arm)
    assert found is not None
    robot = found.choice.spec
    assert not robot.has_wheels
    assert [(touch.pressed_by, touch.pressed_at) for touch in robot.touch_sensors] == [
        ("outC", "low")
    ]


DOUBTS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "a car": (
        "drive = LargeMotor(OUTPUT_A)\nsteering = MediumMotor(OUTPUT_B)",
        ("a car that steers is not simulated: this robot stands, because two motors drive it",),
    ),
    "a head": (
        "kopf = MediumMotor(OUTPUT_A)\nsonic = UltrasonicSensor()\nMoveTank(OUTPUT_B, OUTPUT_C)",
        ("no motor turns a sensor here: each keeps its direction",),
    ),
    "a head without a sensor": ("head = MediumMotor(OUTPUT_A)", ()),
    "an arm beside a sensor": ("arm = MediumMotor(OUTPUT_A)\nsonic = UltrasonicSensor()", ()),
}


@pytest.mark.parametrize("case", DOUBTS)
def test_motors_that_the_robot_cannot_have_as_wheels_are_named(case: str) -> None:
    text, doubts = DOUBTS[case]
    found = built(text)
    assert found is not None
    assert found.doubts == doubts
