"""Lists of mats, robots, obstacles, programs and profiles."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.conftest import Command
from tuisim.engine.core.profile import PROFILES


@pytest.mark.parametrize(
    "command, name",
    [
        ("backgrounds", "Grey_bands"),
        ("robots", "Small_Robot"),
        ("obstacles", "Square_posts"),
        ("programs", "log_greys.py"),
        ("profiles", "robolab"),
    ],
)
def test_each_list_names_its_entries_as_text_and_json(
    command: str, name: str, here: Command
) -> None:
    assert name in here(command).stdout
    assert name in [entry["name"] for entry in json.loads(here(command, "--json").stdout)]


def test_a_list_of_profiles_is_one_line_for_each(here: Command) -> None:
    lines = here("profiles").stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["PROFILE", *PROFILES, "`tuisim"]


def test_profiles_of_a_brick_tell_each_figure_of_its_motors(here: Command) -> None:
    shown = here("profiles", "ev3").stdout
    assert "inertia_kg_m2     0.00150274   0.0003  large: nxt-unroller" in shown
    assert "inertia_kg_m2" not in here("profiles", "robolab", "lego-micropython").stdout


def test_list_of_robots_tells_their_ports(here: Command) -> None:
    assert "in1 bumper, in2 left, in3 infrared" in here("robots").stdout


def test_no_default_robot_is_written_for_parts_that_are_not_found(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "libs").mkdir()
    (tmp_path / "libs" / "my_robot.py").write_text("from ev3dev2.motor import LargeMotor\n")
    program = tmp_path / "prog" / "main.py"
    program.parent.mkdir()
    program.write_text("from my_robot import Robot\n")
    done = here("robots", "--from", program, "--out", tmp_path / "robot.toml")
    assert done.returncode == 2
    assert "it imports my_robot, which is in ../libs: PYTHONPATH=../libs finds it" in done.stderr
    assert not (tmp_path / "robot.toml").exists()
