"""Goals of a simulation that a script moves on."""

from __future__ import annotations

from pathlib import Path

import pytest

import tuisim
from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.engine.runs.stepped_run import SteppedRun
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.judgement import compute_points
from tuisim.tasks.goals.live import LiveGoals

WALL = """\
[[goal]]
name = "wall"
reach = { x_mm = 400, within_mm = 20, at_end = true }
[[goal]]
name = "still"
points = 2
outside = { x_mm = 600, y_mm = 0, width_mm = 100, height_mm = 1143 }
[start]
x_mm = 300
heading_deg = 0
"""


def test_a_labs_live_goals_give_the_points_of_a_run_with_the_same_commands() -> None:
    goals = GoalsFile.load("square_goals.toml").goals
    run = tuisim.simulate("square", world="square_goals.toml").stored
    stepped = SteppedRun(run.first_spec, run.open_mat(), is_recorded=True)
    live = LiveGoals(goals, stepped, run.open_mat())
    assert live.judge() == (0, False)
    stepped.advance(len(run.telemetry.array()) - 1, tuisim.load_run(run.folder).commands)
    assert live.judge() == (compute_points(judge(goals, run)), True)


def test_points_come_and_go_until_a_goal_is_missed_for_good(tmp_path: Path) -> None:
    (tmp_path / "goals.toml").write_text(WALL)
    lab = tuisim.Lab(goals=tmp_path / "goals.toml", columns=["x_mm"])
    seen = {lab.judge(): lab.read()["x_mm"]}
    while lab.read()["x_mm"] < 720:
        lab.step(400, 400, period_s=0.05)
        seen[lab.judge()] = lab.read()["x_mm"]
    # At the place the task is done; later it could still be done, but without the points of what was entered.
    assert [*seen] == [(2, False), (3, True), (0, False)]
    assert seen[3, True] == pytest.approx(420, abs=15)
    lab.reset()
    assert lab.judge() == (2, False)


@cases(
    "condition",
    {
        "lines": 'print = "done"',
        "samples": 'count = { of = "sample Colour", at_least = 1 }',
        "text": 'structure = "loops >= 1"',
        "brick": 'when = "sound matches ."',
        "calls": 'use = "time.sleep"',
    },
)
def test_a_lab_refuses_goals_about_a_program(condition: str, tmp_path: Path) -> None:
    file = tmp_path / "goals.toml"
    file.write_text(f'[[goal]]\nname = "first"\n{condition}\n')
    with pytest.raises(ConfigError, match="'first' is about a program"):
        tuisim.Lab(goals=file)
