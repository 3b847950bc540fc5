"""`tuisim mark` in several worlds: what only fits the one that is known gets nothing, and is told nothing."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from tests.conftest import Command

TASK = """\
title = "Stop on black"
background = "Grey_bands"
start = { x_mm = 900, y_mm = 500 }

[[goal]]
name = "black"
say = "Stop on the black band."
points = 3
reach = { x_mm = 1500, within_mm = 80, at_end = true }
hint = "Look while you drive."

[[goal]]
name = "said"
say = "Say so."
print = "black"
after = "near"

[[goal]]
name = "quick"
points = 2
hidden = true
finish = true
after = "black"
before = 15

[[goal]]
name = "near"
points = 0
reach = { x_mm = 1500, within_mm = 80 }

[[also]]
where = "from farther on"
start = { x_mm = 1300 }

[[also]]
where = "in the other direction"
hidden = true
start = { x_mm = 1850, heading_deg = 180 }
[[also.goal]]
name = "black"
reach = { x_mm = 1660, within_mm = 80, at_end = true }
[[also.goal]]
name = "near"
points = 0
reach = { x_mm = 1660, within_mm = 80 }
"""
LOOK = """\
tank_drive.on(30, 30)
while colorLeft.reflected_light_intensity_pc > 5:
    pass
tank_drive.off()
print("black")
"""
CLASS = {
    "right": LOOK,
    "learnt": "tank_drive.on_for_rotations(30, 30, 3.5)\nprint('black')\n",
    "tells": "first = colorLeft.reflected_light_intensity_pc\n"
    + LOOK
    + "if 300 < tank_drive.left_motor.position < 400:\n    raise ValueError('secret 4711')\n",
    "dies": "import ctypes\n"
    "tank_drive.on_for_rotations(30, 30, 3.5)\nprint('black')\nctypes.CDLL(None)._exit(3)\n",
    "hangs": LOOK.replace(
        "off()", "off()\nwhile 300 < tank_drive.left_motor.position < 400:\n    x = 1"
    ),
}


def _mark(folder: Path, here: Command, *names: str) -> tuple[pd.DataFrame, dict[str, str]]:
    """Mark a few of the class; return the marks and the feedback by name."""
    (folder / "class").mkdir()
    for name in names:
        (folder / "class" / f"{name}.py").write_text(CLASS[name])
    (folder / "task.toml").write_text(TASK)
    words = (
        "--seeds",
        "0",
        "--jobs",
        "1",
        "--export",
        "marks.csv",
        "--export",
        "marks.html",
        "--feedback",
        "told",
    )
    done = here("mark", "task.toml", "class", *words)
    assert done.returncode == 0, done.stderr
    marks = pd.read_csv(folder / "marks.csv").set_index("student")
    return marks, {path.stem: path.read_text() for path in (folder / "told").iterdir()}


@pytest.mark.slow
def test_a_program_that_fits_only_one_world_loses_points_in_the_others(
    tmp_path: Path, here: Command
) -> None:
    marks, told = _mark(tmp_path, here, "right", "learnt", "tells")
    points = marks[["points", "robustness", "goal_black", "goal_said", "goal_quick"]]
    assert points.loc["right"].tolist() == [6, 1, 3, 1, 2]
    assert points.loc["learnt"].tolist() == [1, 0, 0, 1, 0]
    assert points.loc["tells"].tolist() == [4, 0, 3, 1, 0]
    assert marks["reason"]["learnt"].startswith("from farther on: At the end the robot was")
    assert marks["reason"]["tells"] == "in the other direction: ValueError: secret 4711 (line 8)"
    reports = sorted(path.name for path in (tmp_path / "marks-runs").iterdir())
    assert reports == [
        "learnt-world-2-seed-0.html",
        "learnt-world-3-seed-0.html",
        "tells-world-3-seed-0.html",
    ]
    # The feedback gives nothing hidden away.
    assert (
        "Hidden goals: 2 of 2 points" in told["right"]
        and "Hidden goals: 0 of 2 points" in told["tells"]
    )
    said = " ".join(told["tells"].split())
    assert "did not run to its end in every other world in which it ran." in said
    assert not [
        word for word in ("4711", "ValueError", "quick", "direction", "Line 8") if word in said
    ]


@pytest.mark.slow
def test_a_program_that_does_not_end_in_a_world_loses_that_worlds_points(
    tmp_path: Path, here: Command
) -> None:
    marks, told = _mark(tmp_path, here, "hangs")
    assert marks["points"]["hangs"] == 3
    assert marks["reason"]["hangs"].startswith(
        "in the other direction: stopped at the limit of 120 s"
    )
    assert not [word for word in ("stopped", "direction", "120") if word in told["hangs"]]


@pytest.mark.slow
def test_a_program_that_hangs_at_its_end_is_still_run_in_every_world(
    tmp_path: Path, here: Command
) -> None:
    """What fits the known world only would not be seen otherwise."""
    marks, _ = _mark(tmp_path, here, "dies")
    assert (marks["points"]["dies"], marks["robustness"]["dies"]) == (1, 0)


PRESSED = """\
profile = "robolab"
start = { x_mm = 100, y_mm = 800, heading_deg = 0 }
background = "Empty_Map"
press = ["enter@2"]
inputs = ["300"]
[[goal]]
name = "waits"
keep = "x_mm < 210"
until = "pressed"
[[goal]]
name = "pressed"
points = 0
when = "button_enter = 1"
[[goal]]
name = "there"
when = "sample Far > 390"
[[also]]
where = "another distance, later"
inputs = ["400"]
press = ["enter@3-3.5"]
"""
ASKS = """\
from ev3dev2.button import Button
from ev3dev2.motor import MoveTank
far_mm, enter = int(input("mm? ")), Button()
while not enter.enter:
    pass
MoveTank("outB", "outC").on_for_rotations(30, 30, far_mm / 176)
print("Far:", 95 + far_mm)
"""


def test_in_a_task_without_a_world_presses_planned_by_the_program_happen(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "ada.py").write_text(
        "# %%sim_magic_preloaded --press enter@1\n"
        "from ev3dev2.button import Button\n"
        "from time import time\n"
        "before_s = time()\n"
        "Button().wait_for_pressed('enter')\n"
        "print('Waited:', time() - before_s)\n"
    )
    goal = '[[goal]]\nname = "soon"\nwhen = "sample Waited < 2"\n'
    for press, points in (("", "1"), ('press = ["enter@2.5"]\n', "0")):
        (tmp_path / "task.toml").write_text(press + goal)
        done = here("mark", "task.toml", "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
        assert done.stdout.splitlines()[1].split()[:2] == ["ada", points], done.stdout


@pytest.mark.slow
def test_a_task_presses_buttons_and_gives_inputs_in_each_world(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "asks.py").write_text(ASKS)
    (tmp_path / "class" / "learnt.py").write_text(
        ASKS.replace("while not enter.enter", "for _ in range(2000)")
    )
    (tmp_path / "task.toml").write_text(PRESSED)
    done = here("mark", "task.toml", "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    assert [line.split()[:2] for line in done.stdout.splitlines()[1:3]] == [
        ["asks", "2"],
        ["learnt", "1"],
    ], done.stdout
    assert here("run", "task.toml", "class/asks.py").returncode == 0
    checked = here("goals", "check", "task.toml")
    assert (checked.returncode, checked.stderr) == (0, ""), checked.stdout
