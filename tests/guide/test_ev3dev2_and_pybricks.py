"""The table with the calls of both libraries: each column is a program, and both run on one robot."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.conftest import Command
from tuisim.guide.catalogue import load_pages

IMPORTS = {
    "ev3dev2": """\
import time
from ev3dev2.button import Button
from ev3dev2.display import Display
from ev3dev2.led import Leds
from ev3dev2.motor import (
    OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D, LargeMotor, MediumMotor, MoveDifferential, SpeedDPS,
)
from ev3dev2.power import PowerSupply
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, TouchSensor, UltrasonicSensor
from ev3dev2.sound import Sound
from ev3dev2.wheel import EV3Tire
""",
    "pybricks": """\
from pybricks.ev3devices import ColorSensor, GyroSensor, Motor, TouchSensor, UltrasonicSensor
from pybricks.hubs import EV3Brick
from pybricks.parameters import Color, Port
from pybricks.robotics import DriveBase
from pybricks.tools import StopWatch, wait
""",
}


def rows() -> list[tuple[str, str]]:
    """The calls in each row of the table: of ev3dev2, of Pybricks."""
    table = load_pages()["ev3dev2-and-pybricks"].source.partition("## What differs")[0]
    found = [re.findall(r"`([^`]+)`", line) for line in table.splitlines() if line.startswith("| ")]
    return [(cells[0], cells[1]) for cells in found if len(cells) == 2]


@pytest.fixture
def programs(tmp_path: Path) -> None:
    for column, (library, imports) in enumerate(IMPORTS.items()):
        lines = "\n".join(row[column] for row in rows())
        (tmp_path / f"{library}_calls.py").write_text(f"{imports}{lines}\nprint('last')\n")


@pytest.mark.usefixtures("programs")
def test_ev3dev2_and_pybricks_calls_of_the_guides_table_run_without_an_error(here: Command) -> None:
    assert len(rows()) > 30
    assert here("robots", "--from", "ev3dev2_calls.py", "--out", "robot.toml").returncode == 0
    done = {
        name: here("run", f"{name}_calls.py", "-r", "robot.toml", "--timeout", 100)
        for name in IMPORTS
    }
    assert {name: (one.returncode, one.stdout) for name, one in done.items()} == dict.fromkeys(
        IMPORTS, (0, "last\n")
    )
