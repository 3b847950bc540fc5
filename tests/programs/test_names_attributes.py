"""What a program wants of an object that does not have it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.app.editor.completion import find_members
from tuisim.programs.names import AttributeCheck


@pytest.mark.parametrize(
    "text, messages",
    [
        ("tank_drive.onn(1)", ["`tank_drive` has no `onn`: did you mean `on`?"]),
        ("é = tank_drive.offf", ["`tank_drive` has no `offf`: did you mean `off`?"]),
        ("import time\ntime.slep(1)", ["`time` has no `slep`: did you mean `sleep`?"]),
        ("colorLeft.reflected_light_intensity_pc\ngyro.angle", []),
        (
            "from ev3dev2.sensor.lego import ColorSensor\nc = ColorSensor()\nc.reflected_light_intensity_pc",
            [],
        ),
        ("tank_drive.mine = 1\nprint(tank_drive.mine)", []),
        ("tank_drive = 1\ntank_drive = gyro\ntank_drive.onn", []),
        ("def f(gyro):\n    gyro.onn", []),
        ("class A:\n    pass\n\na = A()\na.onn", []),
        ("if hasattr(gyro, 'onn'):\n    gyro.onn()", []),
        ("from pybricks.hubs import EV3Brick\nev3 = EV3Brick()\nev3.onn", []),
        ("tank_drive.onn(", []),
    ],
    ids=[
        "prelude",
        "not ASCII",
        "module",
        "known",
        "of the course",
        "own attribute",
        "several objects",
        "parameter",
        "own class",
        "asks first",
        "Pybricks",
        "unfinished line",
    ],
)
def test_attributes_that_an_object_lacks_are_found_in_a_program(
    home: Path, text: str, messages: list[str]
) -> None:
    found = AttributeCheck(find_members).find_unknown_attributes(text, "prog.py")
    assert [one.message for one in found] == messages
    lines = text.split("\n")
    assert all(lines[one.row][one.start : one.end] == one.name for one in found)


def test_an_objects_attributes_are_looked_up_once() -> None:
    asked: list[tuple[int, int]] = []

    def known(text: str, path: str, row: int, column: int) -> frozenset[str]:
        asked.append((row, column))
        return frozenset({"on"})

    check = AttributeCheck(known)
    assert not check.find_unknown_attributes("tank_drive.on()\ntank_drive.on()", "prog.py")
    assert [one.row for one in check.find_unknown_attributes("\ntank_drive.onn()", "prog.py")] == [
        1
    ]
    assert asked == [(0, 10)]
