"""The goals panel: the goals of a task, judged while the run goes on, at its end, and as of a past instant."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import ready, screen_text, settings, until, until_shown
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.render.goals import GoalsView, goal_lines
from tuisim.config.build import build_run_spec
from tuisim.config.options import settings_of
from tuisim.goals.files import load_goals
from tuisim.goals.judge import Change, GoalState, Judgement
from tuisim.goals.spec import AllOf, Finish, Goal, Use

GOALS = """\
title = "There and done"
background = "Empty_Map"

[start]
x_mm = 300
y_mm = 500
heading_deg = 0

[[goal]]
name = "there"
say = "Drive to x = 500."
points = 2
reach = { x_mm = 500 }

[[goal]]
name = "said"
points = 3
hint = "Print it at the end."
print = "done"
"""
DRIVES = "tank_drive.on_for_seconds(SpeedPercent(30), SpeedPercent(30), 2)\n"
SIZE = (120, 40)


@pytest.fixture
def task(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A goals file, in the folder to be in."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "task_goals.toml"
    path.write_text(GOALS)
    return path


def with_goals(path: Path, text: str | None = None, **more: Any) -> AppSettings:
    """What the command makes of `tuisim PROGRAM --goals FILE`."""
    goals = load_goals(path)
    chosen = {"panels_on": frozenset({"goals"}), "speed": 0.0, **more}
    made = settings(text, goals=goals, world_file=path, **chosen)
    return replace(made, spec=build_run_spec(settings_of(goals.settings)))


def shown(app: LabApp) -> list[str]:
    """The lines of the panel, without those that are cut off below."""
    panel = app.panel_area.goals
    return [] if panel is None else ["".join(text for text, _ in line).rstrip() for line in panel._text._lines]


async def until_ended(pilot: Pilot[Any], app: LabApp) -> None:
    await until(pilot, lambda: app.run_controller.run is not None and not app.run_controller.in_run)


MET = Judgement(
    Goal("there", Finish(), "Drive to it.", 2), (Change(100, 1.0, GoalState.MET, 299.6, 80.2),), line=7
)  # fmt: skip
MISSED = Judgement(
    Goal("closed", Finish(), points=1.5, hint="Turn by 90."),
    (Change(200, 2.0, GoalState.MISSED, 1.0, 2.0),),
    "It was 30 mm off.",
    9,
)
BY_TEXT = Judgement(Goal("part", Use(("f",)), points=0), (Change(0, 0.0, GoalState.MET, 1.0, 2.0),), line=3)
OPEN = Judgement(Goal("a name that is longer than a line", AllOf(("there",))), (), "5 mm to go.")
TEXTS = {
    "met": (MET, ["✓ met    there              2/2", "  Drive to it.", "  1.00 s, x 300, y 80 mm, line", "  7"]),
    "missed": (
        MISSED,
        [
            "✗ missed closed           0/1.5",
            "  2.00 s, x 1, y 2 mm",
            "  It was 30 mm off. (line 9)",
            "  Hint: Turn by 90.",
        ],
    ),
    "by the text, without points": (BY_TEXT, ["✓ met    part", "  by the program's text, line 3"]),
    "open, with a long name": (
        OPEN,
        ["· open   a name that is     0/1", "         longer than a line", "  not decided yet"],
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_goal_as_lines(name: str) -> None:
    judgement, expected = TEXTS[name]
    view = GoalsView("A task", (judgement.goal,), (judgement,))
    lines = ["".join(text for text, _ in line).rstrip() for line in goal_lines(view, view.states(None), 31)]
    assert lines[0] == "A task"
    assert lines[2:] == expected


async def test_without_goals_the_panel_says_what_to_do_next() -> None:
    async with LabApp(settings()).run_test(size=SIZE) as pilot:
        app = await ready(pilot)
        await pilot.press("J")
        await until_shown(pilot, "No goals: o opens a goals file")
        assert shown(app) == ["No goals: o opens a goals file such as", "square_goals.toml"]


async def test_a_run_is_judged_when_it_has_ended(task: Path) -> None:
    app = LabApp(with_goals(task, DRIVES))
    async with app.run_test(size=SIZE) as pilot:
        await ready(pilot)
        await until(pilot, lambda: "0 of 5 points" in shown(app))
        assert "R runs the program" in screen_text(app)
        await pilot.press("R")
        await until(pilot, lambda: "2 of 5 points" in shown(app) and any("missed said" in text for text in shown(app)))
        assert shown(app)[-1] == "  Hint: Print it at the end."
        assert "R runs the program" not in screen_text(app)


async def test_goals_are_judged_while_the_program_runs(task: Path) -> None:
    app = LabApp(with_goals(task, f"{DRIVES}input('more?')\nprint('done')\n"))
    async with app.run_test(size=SIZE) as pilot:
        await ready(pilot)
        await pilot.press("R")
        await until(pilot, lambda: any("✓ met    there" in text for text in shown(app)))
        assert app.run_controller.in_run
        assert any("· open   said" in text for text in shown(app))
        await pilot.press(*"yes", "enter")
        await until(pilot, lambda: "5 of 5 points" in shown(app))
