"""What of a program can run."""

from __future__ import annotations

from tests.programs.robot.reading import changed

_LIFT = """\
class LiftMotor(Motor):
    def __init__(self):
        Motor.__init__(self, OUTPUT_A)
class Lift:
    motor = LiftMotor()
    def up(self):
        MediumMotor(OUTPUT_D)
"""


def test_parts_created_in_a_class_body_are_on_the_robot() -> None:
    assert changed(_LIFT) == "A large motor"
    assert changed(f"{_LIFT}Lift().up()") == "A large motor, D medium motor"


def test_parts_created_in_methods_of_an_unused_class_are_not_on_the_robot() -> None:
    unused = "class Arm:\n    def __init__(self):\n        self.motor = MediumMotor(OUTPUT_A)\n"
    assert changed(unused) == ""
    assert changed(f"{unused}Arm()") == "A medium motor"
