"""Where the end stops of motors are."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.cases import for_each
from tests.programs.robot.reading import PYBRICKS_HEAD, built

_HOME = "arm.run_until_stalled(200, Stop.COAST, 50)\n"
_BACK = "arm.run_until_stalled(-200, Stop.COAST, 50)\n"
RANGES: Mapping[str, tuple[str, tuple[float, float]]] = {
    "no target": (_HOME, (-225.0, 45.0)),
    "a target before the stop": (f"arm.run_target(500, 90)\n{_HOME}", (-225.0, 135.0)),
    "a target after it": (f"{_HOME}arm.run_target(500, 60)\n", (-225.0, 105.0)),
    "targets on the other side": (f"arm.run_target(500, -300)\n{_HOME}", (-345.0, 45.0)),
    "backwards": (f"arm.run_target(500, -90)\n{_BACK}", (-135.0, 225.0)),
    "counted from the stop": (
        f"{_HOME}arm.reset_angle(0)\narm.run_target(500, 90)\n",
        (-225.0, 45.0),
    ),
    "before it, then counted from it": (
        f"arm.run_target(500, 90)\n{_HOME}arm.reset_angle(0)\narm.run_target(500, -100)\n",
        (-225.0, 135.0),
    ),
    "turns before the stop": (
        f"arm.run_angle(500, 90)\narm.run_angle(500, 30)\n{_HOME}",
        (-225.0, 165.0),
    ),
    "a turn from a target": (
        f"arm.run_target(500, 90)\narm.run_angle(500, 60)\n{_HOME}arm.reset_angle(0)\n",
        (-225.0, 195.0),
    ),
    "a turn after the stop": (f"{_HOME}arm.run_angle(500, -300)\n", (-345.0, 45.0)),
    "a stop in a function that is called later": (
        "def home():\n"
        f"    {_HOME}    arm.reset_angle(0)\n"
        "arm.run_target(500, 90)\nhome()\narm.run_target(500, -100)\n",
        (-225.0, 135.0),
    ),
    "a turn in a method that is called first": (
        "class Lift:\n"
        "    def home(self):\n"
        f"        {_HOME}"
        "    def up(self):\n"
        "        arm.run_angle(500, 90)\n"
        "lift = Lift()\nlift.up()\nlift.home()\nlift.up()\n",
        (-225.0, 135.0),
    ),
    "a turn in a function that is called later": (
        f"def lift():\n    arm.run_angle(500, -90)\n{_HOME}lift()\n",
        (-225.0, 45.0),
    ),
    "an angle that is not known": (
        f"{_HOME}arm.reset_angle(arm.angle() - 20)\narm.run_target(500, 90)\n",
        (-225.0, 135.0),
    ),
}


@for_each(case=RANGES)
def test_an_arms_end_stop_lies_beyond_every_target_of_the_program(case: str) -> None:
    text, expected = RANGES[case]
    found = built(f"arm = Motor(Port.A)\n{text}", PYBRICKS_HEAD)
    assert found is not None
    (motor,) = found.choice.spec.extra_motors
    assert (motor.low_deg, motor.high_deg) == expected


@pytest.mark.parametrize(
    "mounted, expected",
    [("Direction.COUNTERCLOCKWISE", (-135.0, 225.0)), ("gears=[16, 8]", (-225.0, 90.0))],
    ids=["the other way round", "behind gears"],
)
def test_end_stops_follow_the_direction_and_gears_of_the_motor(
    mounted: str, expected: tuple[float, float]
) -> None:
    text = f"arm = Motor(Port.A, {mounted})\narm.run_target(500, 90)\n{_HOME}"
    found = built(text, PYBRICKS_HEAD)
    assert found is not None
    (motor,) = found.choice.spec.extra_motors
    assert (motor.low_deg, motor.high_deg) == expected


def test_an_unknown_position_in_the_program_raises_no_error_when_placing_stops() -> None:
    assert built("arm = MediumMotor(OUTPUT_A)\narm.position = x\narm.on_to_position(20, 90)")
