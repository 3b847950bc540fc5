"""The goals panel: the goals of a task, judged while the run goes on, at its end, and as of a past instant."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import (
    notices,
    open_lab,
    program_of,
    screen_text,
    settings,
    until,
    until_shown,
    until_state,
)
from tests.app.render.test_goals import texts
from tests.conftest import Command
from tests.running import PATIENCE_S
from tuisim.app import goals as app_goals
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.snapshot import RunPhase
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks.goals.files import GoalsFile

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
    goals = GoalsFile.load(path)
    chosen = {"panels_on": frozenset({"goals"}), "speed": 0.0, **more}
    made = settings(text, goals=goals, world_file=path, **chosen)
    return replace(made, spec=build_run_spec(Settings.merge(goals.settings)))


def shown(app: LabApp) -> list[str]:
    """The lines of the panel, without those that are cut off below."""
    panel = app.panel_area.goals
    return [] if panel is None else texts(panel._picture.lines)


def state(app: LabApp, name: str) -> str:
    """Sign and state of a goal in the list."""
    return next((text[:9].rstrip() for text in shown(app) if text[9:].startswith(f"{name} ")), "")


@pytest.mark.slow
async def test_without_goals_the_panel_says_what_to_do_next() -> None:
    async with open_lab(size=SIZE) as (pilot, app):
        await pilot.press("J")
        await until_shown(pilot, "No goals: o opens a goals file")
        assert shown(app) == ["No goals: o opens a goals file such as", "square_goals.toml"]


async def test_the_title_of_the_task_is_in_the_frame_where_it_would_take_a_row_of_the_goals(
    task: Path,
) -> None:
    async with open_lab(with_goals(task), size=SIZE) as (pilot, app):
        await until_shown(pilot, "J Goals: There and done ─")
        assert shown(app)[0] == "0 of 5 points"
        await pilot.resize_terminal(120, 50)
        await until_shown(pilot, "J Goals ─")
        assert shown(app)[:2] == ["There and done", "0 of 5 points"]


@pytest.mark.slow
async def test_a_run_is_judged_when_it_has_ended(task: Path) -> None:
    async with open_lab(with_goals(task, DRIVES), size=SIZE) as (pilot, app):
        await until(pilot, lambda: "0 of 5 points" in shown(app))
        assert "R runs the program" in screen_text(app)
        await pilot.press("R")
        await until(
            pilot,
            lambda: (
                "2 of 5 points" in shown(app)
                and "✗ missed said                        0/3" in shown(app)
            ),
        )
        assert shown(app)[-1] == "Hint: Print it at the end."
        assert "R runs the program" not in screen_text(app)


@pytest.mark.slow
async def test_the_goals_panel_judges_goals_while_the_program_runs(task: Path) -> None:
    async with open_lab(
        with_goals(task, f"{DRIVES}input('more?')\nprint('done')\n"), size=SIZE
    ) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: state(app, "there") == "✓ met")
        assert app.run_controller.in_run
        assert state(app, "said") == "· open"
        await pilot.press(*"yes", "enter")
        await until(pilot, lambda: "5 of 5 points" in shown(app))


@pytest.mark.slow
async def test_at_a_past_instant_the_goals_panel_shows_the_states_of_then(task: Path) -> None:
    async with open_lab(with_goals(task, DRIVES), size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: state(app, "said") == "✗ missed")
        panel = app.panel_area.goals
        judgements = app.goals._judgements
        assert panel is not None
        tick = judgements[0].changes[0].tick
        for at, there, total in (
            (tick - 1, "· open", "0 of 5 points"),
            (tick, "✓ met", "2 of 5 points"),
        ):
            app.run_controller.timeline.go(at)
            app.draw(force=True)
            assert (state(app, "there"), state(app, "said")) == (there, "· open")
            assert total in shown(app)
            assert panel.border_subtitle == f"as of {at / 100:.2f} s"
        await pilot.press("end")
        await until(pilot, lambda: state(app, "said") == "✗ missed")
        assert panel.border_subtitle == ""


@pytest.mark.slow
async def test_a_stored_run_is_judged(task: Path) -> None:
    made = with_goals(task, DRIVES)
    assert made.program is not None
    run = start_run(made.program, made.spec, RunOptions())
    assert run.wait(PATIENCE_S)
    async with open_lab(replace(made, replay=run.stored()), size=SIZE) as (pilot, app):
        await until(
            pilot, lambda: (state(app, "there"), state(app, "said")) == ("✓ met", "✗ missed")
        )


@pytest.mark.slow
async def test_keys_and_mouse_choose_the_goal_that_is_shown_in_detail(task: Path) -> None:
    async with open_lab(with_goals(task, DRIVES), size=SIZE) as (pilot, app):
        panel = app.panel_area.goals
        assert panel is not None
        await until(pilot, lambda: any(text.startswith("── there") for text in shown(app)))
        panel.focus()
        await pilot.press("down")
        assert any(text.startswith("── said") for text in shown(app))
        await pilot.click(panel._text, offset=(5, panel._picture.rows.index(0)))
        await pilot.pause()
        assert app.focused is panel
        assert any(text.startswith("── there") for text in shown(app))
        # It stays the one that was chosen.
        await pilot.press("R")
        await until(pilot, lambda: state(app, "said") == "✗ missed")
        assert any(text.startswith("── there") for text in shown(app))
        assert "↑↓ goal" in screen_text(app)


async def open_path(pilot: Pilot[Any], app: LabApp, path: str) -> None:
    await pilot.press("o")
    entry = app.screen.query_one(Input)
    entry.focus()
    entry.value = path
    await pilot.press("enter")
    await until(pilot, lambda: len(app.screen_stack) == 1 and app.loader.mat_is_ready)


@pytest.mark.slow
async def test_goals_are_opened_with_their_world_and_closed_with_the_next(task: Path) -> None:
    (task.parent / "lab.toml").write_text('background = "Loop"\n')
    async with open_lab(DRIVES, speed=0.0, size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await open_path(pilot, app, task.name)
        await until(
            pilot, lambda: app.panel_area.is_shown("goals") and state(app, "said") == "· open"
        )
        assert app.run_controller.next_run.spec.world.start.x_mm == 300
        assert app.loader.world_file == Path(task.name)
        # The run before was for another task.
        app.goals.update()
        assert app.goals._recording is None
        await pilot.press("R")
        await until(pilot, lambda: state(app, "there") == "✓ met")
        # It is the same task.
        await open_path(pilot, app, task.name)
        await until(pilot, lambda: state(app, "there") == "✓ met")
        await open_path(pilot, app, "lab.toml")
        await until_shown(pilot, "No goals: o opens")


@pytest.mark.slow
async def test_examples_of_goals_are_offered_and_opened_by_name(task: Path) -> None:
    # In fewer rows, the frame of the panel has the beginning of the title.
    async with open_lab(size=(120, 42)) as (pilot, app):
        await pilot.press("o")
        await until(pilot, lambda: bool(app.screen.query(OptionList)))
        listed = app.screen.query_one(OptionList)
        await until(pilot, lambda: listed.option_count > 0)
        assert "task_goals.toml" in screen_text(app)
        # Those of tuisim come last.
        listed.highlighted = listed.option_count - 1
        await until_shown(pilot, "square_goals.toml")
        assert "A square, closed within 20 mm" in screen_text(app)
        await pilot.press("escape")
        await open_path(pilot, app, "square_goals.toml")
        await until_shown(pilot, "A square, closed within 20 mm")
        assert program_of(app).name == "square.py"


@pytest.mark.quick_cases("beside a world")
@pytest.mark.parametrize("is_world", [True, False], ids=["as the world", "beside a world"])
async def test_goals_that_change_on_disk_are_read_again(task: Path, is_world: bool) -> None:
    async with open_lab(
        replace(with_goals(task, DRIVES), world_file=task if is_world else None), size=SIZE
    ) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: state(app, "said") == "✗ missed")
        task.write_text(GOALS.replace("x_mm = 500 }", "x_mm = 2000 }"))
        app.check_files()
        await until(pilot, lambda: state(app, "there") == "✗ missed")
        assert notices(app).count("task_goals.toml changed on disk: reloaded") == 1

        task.write_text(GOALS.replace("x_mm = 500 }", "x_mm = 5000 }"))
        app.check_files()
        wrong = "task_goals.toml, line 13: goal[1].reach.x_mm: must be a number from 0 to 2362, got 5000"
        await until(pilot, lambda: sum(wrong in text for text in notices(app)) == 1)
        # The goals are the last good ones.
        assert state(app, "there") == "✗ missed"


@pytest.mark.slow
async def test_no_goal_is_judged_while_the_panel_of_goals_is_closed(
    task: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    judged = []
    judge = app_goals._judge_run

    def noted(*given: Any) -> Any:
        judged.append(given)
        return judge(*given)

    monkeypatch.setattr(app_goals, "_judge_run", noted)
    async with open_lab(with_goals(task, DRIVES, panels_on=frozenset()), size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        app.goals.update()
        assert not judged
        await pilot.press("J")
        await until(pilot, lambda: state(app, "said") == "✗ missed")
        app.goals.update()
        assert len(judged) == 1


@pytest.mark.slow
async def test_an_error_while_judging_goals_is_told_once(task: Path) -> None:
    async with open_lab(with_goals(task, DRIVES, panels_on=frozenset()), size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        assert app.run_controller.run is not None
        (app.run_controller.run.folder / "run.json").unlink()
        await pilot.press("J")
        await until(pilot, lambda: any("run.json" in text for text in notices(app)))
        app.goals.update()
        app.goals.update()
        assert not app.goals._is_judging
        assert sum("run.json" in text for text in notices(app)) == 1


STARTS = {
    "as the world": (["task_goals.toml"], (300.0, None, 2)),
    "as the world, of a program": (["task_goals.toml", "mine.py"], (300.0, "mine.py", 2)),
    "by option": (["--goals", "task_goals.toml", "mine.py"], (300.0, "mine.py", 2)),
    "by option, in another world": (
        ["--goals", "task_goals.toml", "lab.toml", "mine.py"],
        (700.0, "mine.py", 2),
    ),
    "an example by name": (["--goals", "square"], (300.0, "square.py", 5)),
    "an example by file": (["square_goals.toml"], (300.0, "square.py", 5)),
    "no goals": (["lab.toml"], (700.0, None, 0)),
}


@pytest.mark.parametrize("name", STARTS)
def test_open_loads_goals_world_and_program_of_the_command_line(
    name: str, task: Path, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    words, (x_mm, program, count) = STARTS[name]
    (task.parent / "mine.py").write_text(DRIVES)
    (task.parent / "lab.toml").write_text("start.x_mm = 700\n")
    opened: list[AppSettings] = []

    def run_app(settings: AppSettings) -> int:
        opened.append(settings)
        return 0

    monkeypatch.setattr("tuisim.app.app.run_app", run_app)
    monkeypatch.setattr("tuisim.commands.app.has_terminal", lambda: True)
    done = here("open", *words)
    assert (done.returncode, done.stderr) == (0, "")
    (made,) = opened
    assert made.spec.world.start.x_mm == x_mm
    assert (made.program.name if made.program else None) == program
    assert len(made.goals.goals if made.goals else ()) == count
    assert ("goals" in made.panels_on) is bool(count)


def test_open_refuses_faulty_goals_with_file_line_and_key(task: Path, here: Command) -> None:
    task.write_text(GOALS.replace("points = 2", "points = -2000"))
    done = here("open", "--goals", task.name)
    assert done.returncode == 2
    assert (
        "task_goals.toml, line 12: goal[1].points: must be a number from -1000 to 1000, got -2000"
        in done.stderr
    )
