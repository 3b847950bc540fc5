"""The robot that is read from a program, in the shell: what is said, printed, written, run, varied and marked."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest

import tuisim
from tests.conftest import Command
from tuisim.engine.runs.store import RunStore

CLAW = """\
from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_D
from ev3dev2.sensor.lego import TouchSensor

tank = MoveTank(OUTPUT_A, OUTPUT_D)
claw = MediumMotor(OUTPUT_B)
touch = TouchSensor('in1')
claw.on_for_degrees(20, 45)
tank.on_for_rotations(30, 30, 1)
print("Claw:", claw.position)
"""
GOALS = """\
title = "Drive"
[[goal]]
name = "drive"
points = 1
finish = true
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "claw.py").write_text(CLAW)
    return tmp_path


def test_a_run_says_in_one_line_what_was_built(folder: Path, here: Command) -> None:
    done = here("run", "claw.py", "claw.py")
    assert done.stdout == "Claw: 45\n" * 2
    notes = [line for line in done.stderr.splitlines() if line.startswith("note: ")]
    assert notes == [
        "note: claw.py runs on a robot built from it: wheels on outA (left) and outD, medium motor on outB, touch "
        "sensor on in1, no ultrasonic sensor; as on a brick (profile ev3). -r or --profile to change it; "
        "`tuisim robots --from claw.py` shows the robot"
    ]


def test_robots_from_prints_the_lines_of_a_program_that_ask_for_each_part(
    folder: Path, here: Command
) -> None:
    done = here("robots", "--from", "claw.py")
    table = tomllib.loads(done.stdout)
    assert table["base"] == "Default_Robot"
    assert (table["left_port"], table["right_port"], table["motors"]) == (
        "outA",
        "outD",
        {"outB": "medium"},
    )
    assert "ultrasonic" in table and table["ultrasonic"] is False
    for line, what in (
        (4, "wheels on outA"),
        (5, "medium motor on outB"),
        (6, "touch sensor on in1"),
    ):
        assert f"claw.py, line {line}: {what}" in done.stdout


def test_robots_from_a_program_with_usual_parts_gives_the_default_robot(
    folder: Path, here: Command
) -> None:
    (folder / "usual.py").write_text(
        "from ev3dev2.motor import LargeMotor\nLargeMotor('outB').on(5)\n"
    )
    assert here("robots", "--from", "usual.py", "--out", "usual.toml").returncode == 0
    assert tomllib.loads((folder / "usual.toml").read_text()) == {
        "base": "Default_Robot",
        "name": "Default_Robot",
    }
    assert (
        json.loads(here("robots", "--from", "usual.py", "--json").stdout)[0]["name"]
        == "Default_Robot"
    )


@pytest.mark.parametrize(
    "words, message",
    [
        (["--from", "none.py"], "none.py: there is no such program"),
        (["--from", "claw.py", "Explorer"], "--from: cannot be combined with Explorer"),
        (["--out", "x.toml"], "--out: needs a program"),
        (["--from", "claw.py", "--out", "x.txt"], "x.txt: must end in .toml"),
        (["--from", "claw.py", "--out", "none/x.toml"], "none/x.toml: cannot be written"),
    ],
    ids=["no program", "a robot, too", "only a file", "a text file", "no folder"],
)
def test_wrong_words_for_robots_are_refused(
    words: list[str], message: str, folder: Path, here: Command
) -> None:
    done = here("robots", *words)
    assert (done.returncode, message in done.stderr) == (2, True), done.stderr


def test_comments_in_a_robot_file_stay_when_it_is_written_again(
    folder: Path, here: Command
) -> None:
    here("robots", "--from", "claw.py", "--out", "claw.toml")
    file = folder / "claw.toml"
    file.write_text("# My own robot.\n" + file.read_text().replace('"outD"', '"outC"'))
    assert here("robots", "--from", "claw.py", "--out", "claw.toml").returncode == 0
    assert file.read_text().startswith("# My own robot.\n")
    assert tomllib.loads(file.read_text())["right_port"] == "outD"


def test_a_stored_run_has_its_robot_and_runs_again_to_the_bit(folder: Path, here: Command) -> None:
    here("run", "claw.py")
    run = RunStore().load_run("last")
    assert (run.spec.robot.left_port, run.spec.profile.name) == ("outA", "ev3")
    (folder / "claw.py").write_text("print('another program')\n")
    assert here("runs", "rerun", run.number).returncode == 0


def test_a_missing_part_says_what_to_do(folder: Path, here: Command) -> None:
    done = here("run", "claw.py", "-r", "Default_Robot")
    assert done.returncode == 1
    assert (
        "LargeMotor(ev3-ports:outA) is not connected. This robot has: outB lego-ev3-l-motor"
        in done.stderr
    )
    assert (
        "Another robot: -r ROBOT; `tuisim robots --from PROGRAM --out FILE` writes" in done.stderr
    )


def test_a_batch_can_vary_the_robot_built_for_its_program(folder: Path, here: Command) -> None:
    done = here("batch", "claw.py", "--set", "robot.wheel_diameter_mm=56,28", "--json", "--jobs", 1)
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert [row["end"] for row in rows] == ["finished"] * 2
    assert [round(row["x_mm"]) for row in rows] == [1358, 1269]


@pytest.mark.slow
def test_marking_uses_the_tasks_robot_or_else_that_built_for_the_program(
    folder: Path, here: Command
) -> None:
    (folder / "class").mkdir()
    (folder / "class" / "ann.py").write_text(CLAW)
    for world, points in (("seed = 3\n", 1.0), ("robot = 'Default_Robot'\n", 0.0)):
        (folder / "goals.toml").write_text(world + GOALS)
        done = here(
            "mark", "goals.toml", "class", "--seeds", "1", "--jobs", 1, "--export", "marks.csv"
        )
        assert done.returncode == 0, done.stderr
        assert (folder / "marks.csv").read_text().splitlines()[1].split(",")[2] == f"{points}", (
            world
        )


def test_running_a_goal_file_as_a_world_uses_its_robot(folder: Path, here: Command) -> None:
    (folder / "goals.toml").write_text("robot = 'Default_Robot'\n" + GOALS)
    (folder / "world.toml").write_text("seed = 3\n")
    assert here("run", "goals.toml", "claw.py").returncode == 1
    assert here("run", "world.toml", "claw.py").returncode == 0


def test_the_api_builds_the_robot_and_says_so(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    run = tuisim.simulate("claw.py")
    assert (run.state, run.output) == ("finished", "Claw: 45\n")
    assert run.note.startswith("claw.py runs on a robot built from it: wheels on outA")
    assert tuisim.simulate("print(1)\nprint(2)\n").note == ""


LEGO = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
Motor(Port.A, gears=[12, 36]).run_angle(300, 90)
"""


@pytest.mark.parametrize("command", ["run", "batch"])
def test_a_task_with_a_profile_for_another_library_is_refused(
    folder: Path, here: Command, command: str
) -> None:
    (folder / "lego.py").write_text(LEGO)
    (folder / "goals.toml").write_text("profile = 'ev3'\n" + GOALS)
    done = here(command, "goals.toml", "lego.py")
    told = "tuisim: profile: lego.py uses pybricks, and the profile ev3 is for ev3dev2 (choose lego-micropython"
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(told)
