"""`tuisim goals try`: what programs earn that do nothing of what a task asks for."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.tasks.goals.files import list_example_names


@pytest.mark.slow_cases("*")
@pytest.mark.parametrize("name", list_example_names())
def test_goals_try_finds_no_fault_in_the_examples_of_goals(name: str, here: Command) -> None:
    done = here("goals", "try", name, "--jobs", "1", "--seeds", "0")
    assert (done.returncode, done.stderr) == (0, ""), done.stdout
    assert done.stdout.endswith("_goals.toml: all is well\n")


TASK = """\
program = "model.py"
background = "Empty_Map"
start = { x_mm = 500, y_mm = 500 }
[[goal]]
name = "there"
reach = { x_mm = 700 }
points = 2
[[goal]]
name = "said"
print = "home"
[[goal]]
name = "free"
touch_nothing = true
[[goal]]
name = "end"
finish = true
"""
MODEL = "tank_drive.on_for_rotations(30, 30, 1.2)\nprint('home')\n"


def test_goals_try_names_points_that_a_useless_program_earns(tmp_path: Path, here: Command) -> None:
    (tmp_path / "task.toml").write_text(TASK)
    (tmp_path / "model.py").write_text(MODEL)
    (tmp_path / "wrong").mkdir()
    (tmp_path / "wrong" / "back.py").write_text(MODEL.replace("30, 30", "-30, -30"))
    (tmp_path / "wrong" / "same.py").write_text(MODEL)
    (tmp_path / "wrong" / "broken.py").write_text("print('home'\n")
    done = here("goals", "try", "task.toml", "wrong", "--jobs", "1", "--seeds", "0")
    assert (done.returncode, done.stderr) == (1, "")
    assert [line.split("  ")[0] for line in done.stdout.splitlines()[:8]] == [
        *("PROGRAM", "empty program", "stands still", "prints the answers", "model.py (model)"),
        *("back.py (wrong example)", "broken.py (wrong example)", "same.py (wrong example)"),
    ]
    assert [
        [part.strip() for part in line.split("  ")[-2:]] for line in done.stdout.splitlines()[1:8]
    ] == [
        *(["2 of 5", "free, end"],) * 2,
        ["3 of 5", "said, free, end"],
        ["5 of 5", "all"],
        ["3 of 5", "said, free, end"],
        ["0 of 5", "-"],
        ["5 of 5", "all"],
    ]
    said = " ".join(done.stdout.splitlines()[8:])
    assert (
        "printing the answers meets “said” (1 of 5 points): give it `after`, `x_mm` or `reading`"
        in said
    )
    assert (
        "an empty program and standing still and printing the answers meets “free” (1 of 5 points)"
        in said
    )
    assert "task.toml: the wrong example same.py gets all points" in said


def test_goals_try_reports_a_model_program_that_misses_points(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "task.toml").write_text(TASK.partition('[[goal]]\nname = "said"')[0])
    (tmp_path / "model.py").write_text("tank_drive.on_for_rotations(30, 30, 0.5)\n")
    done = here("goals", "try", "task.toml", "--jobs", "1", "--seeds", "0")
    assert done.returncode == 1
    assert "the model model.py does not get all points: line 1: At its nearest" in done.stdout


BAD = {
    "no such task": ("none.toml", "none.toml: there is no such file"),
    "no such wrong example": ("task.toml none.py", "none.py: there is no such file or folder"),
    "no such model": ("task.toml", "there is no such file or folder"),
}


@cases("words, message", BAD)
def test_goals_try_refuses_bad_input(
    tmp_path: Path, here: Command, words: str, message: str
) -> None:
    (tmp_path / "task.toml").write_text(TASK)
    if "model" not in message and words != "task.toml":
        (tmp_path / "model.py").write_text(MODEL)
    done = here("goals", "try", *words.split())
    assert (done.returncode, done.stdout, message in done.stderr) == (2, "", True), done.stderr
