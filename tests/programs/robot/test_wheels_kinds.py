"""The kinds of motors in programs of Pybricks, which has one class for all."""

from __future__ import annotations

from collections.abc import Mapping

from tests.cases import for_each
from tests.programs.robot.reading import PYBRICKS_HEAD, changed

KINDS: Mapping[str, tuple[str, str]] = {
    "the motors of a drive base": (
        "DriveBase(Motor(Port.A), Motor(Port.D), 56, 100)",
        "A left wheel, B -, C -, D right wheel",
    ),
    "a pair with sides": (
        "left = Motor(Port.A)\nright = Motor(Port.B)",
        "A left wheel, B right wheel, C -",
    ),
    "a pair of arms beside wheels": (
        "DriveBase(Motor(Port.B), Motor(Port.C), 56, 100)\nfront = Motor(Port.A)\nback = Motor(Port.D)",
        "A medium motor, D medium motor",
    ),
    "a single one": ("m = Motor(Port.A)", "A medium motor"),
    "a single one on a wheel's port": ("test_motor = Motor(Port.B)", ""),
    "a tool on a wheel's port": ("claw = Motor(Port.B)", "A left wheel, B medium motor"),
    "a large one": ("large_motor = Motor(Port.A)", "A large motor"),
    "three tools": (
        "gripper = Motor(Port.A)\nelbow = Motor(Port.B)\nbase = Motor(Port.C)",
        "A large motor, B large motor, C large motor",
    ),
    "two tools on the ports of wheels": (
        "belt_motor = Motor(Port.D)\nfeed_motor = Motor(Port.A)",
        "A medium motor, D medium motor",
    ),
    "a motor without control": (
        "from pybricks.iodevices import DCMotor\nDCMotor(Port.A)",
        "A medium motor",
    ),
}


@for_each(case=KINDS)
def test_the_kind_of_each_pybricks_motor_is_found(case: str) -> None:
    text, expected = KINDS[case]
    assert changed(text, PYBRICKS_HEAD) == expected


def test_a_motor_of_any_kind_in_the_other_library_is_large() -> None:
    assert changed("Motor(OUTPUT_A)") == "A large motor"
