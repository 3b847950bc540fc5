"""What was plugged in, in words: at the end of a run, and when it happens."""

from __future__ import annotations

import pytest

from tuisim.engine.core.plugged import LATE, LEFT, RIGHT, PluggedPart
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.programs.plugged_words import describe_newest, list_parts

TOUCH = PluggedPart("in1", "TouchSensor", 53, 9)
WHEELS = (
    PluggedPart("outA", "LargeMotor", 60, 12, LEFT),
    PluggedPart("outD", "LargeMotor", 60, 12, RIGHT),
)
ARM = PluggedPart("outB", "MediumMotor", 70, 0)
TOO_LATE = PluggedPart("outD", "LargeMotor", 70, 14, LATE)
RUN = RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"])
MOTORS = tuple(PluggedPart(one.port, "LargeMotor", 50, 3) for one in WHEELS)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((), ""),
        ((TOUCH,), "touch sensor on in1 (line 9)"),
        (
            (TOUCH, *WHEELS),
            "touch sensor on in1 (line 9), wheels on outA (left) and outD (line 12)",
        ),
        ((*MOTORS, *WHEELS), "wheels on outA (left) and outD (line 12)"),
        ((ARM,), "medium motor on outB"),
        ((PluggedPart("C", "MediumAngularMotor", 5, 7),), "medium angular motor on C (line 7)"),
        ((TOO_LATE,), "large motor on outD, no wheel's since the robot had driven (line 14)"),
    ],
)
def test_plugged_in_parts_are_listed_in_words(parts: tuple[PluggedPart, ...], words: str) -> None:
    assert list_parts(parts) == words


def test_the_newest_part_is_told_when_it_is_whole() -> None:
    begin = "— plugged in, because the program opened it: "
    assert describe_newest([TOUCH], RUN) == f"{begin}touch sensor on in1 (line 9)"
    assert describe_newest([TOUCH, WHEELS[0]], RUN) == ""
    assert describe_newest([TOUCH, *WHEELS], RUN) == (
        f"{begin}wheels on outA (left) and outD (line 12)"
    )
