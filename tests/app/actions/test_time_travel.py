"""What the user does to a run that is held, or looked back at: seen at once, done right before the next tick."""

from __future__ import annotations

from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from tests.app.app_help import (
    notices,
    open_lab,
    press_and_stand,
    ready,
    recording_of,
    settings,
    until,
    until_shown,
    until_state,
)
from tests.running import PATIENCE_S
from tuisim.app.action import KeyFooter
from tuisim.app.actions.time_travel import go_to_now, go_to_tick
from tuisim.app.app import LabApp
from tuisim.app.dialogs.question import BranchQuestion
from tuisim.app.form import Slider
from tuisim.app.panels.chart import Chart
from tuisim.app.run_controller import RunController
from tuisim.app.setup.next_run import change_obstacles
from tuisim.app.snapshot import RunPhase
from tuisim.commands.rerun import rerun, same
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec, Obstacle
from tuisim.engine.protocol import Answer, LineStep, Resume, SetNoise
from tuisim.engine.runs.store import RunStore
from tuisim.pictures.scene.painter import ScenePainter

STEPS = """\
import time
n = 0
while True:
    n = n + 1
    n = n + 1
    time.sleep(0.05)
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
"""

LINES = "".join(f"n{number} = {number}\n" for number in range(1, 10))


async def held(pilot: Pilot[Any]) -> LabApp:
    """Hold the program at a line, with ticks behind it."""
    app = await ready(pilot)
    await until(pilot, lambda: app.run_controller.timeline.newest > 20)
    await pilot.press("n")
    await until(pilot, lambda: app.debugger.view is not None)
    while app.debugger.view is None or app.debugger.view.paused.line != 4:
        await press_and_stand(pilot, "n")
    return app


@pytest.mark.slow
async def test_a_robot_moved_during_a_pause_at_a_line_stays_where_it_was_put() -> None:
    async with LabApp(settings(STEPS, autorun=True, speed=8.0)).run_test(size=(120, 40)) as pilot:
        app = await held(pilot)
        tick = app.run_controller.timeline.newest
        start = app.run_controller.pose
        app.run_controller.set_noise(NoiseSpec(20, 0))
        # The code is what one reads: the arrow keys move in it.
        await pilot.press("up", "right")
        assert app.run_controller.pose == start
        await pilot.press("escape")
        for key in ("up", "up", "right", "p", "p", "p"):
            await pilot.press(key)
        assert app.run_controller.pose == Pose(start.x_mm + 10, start.y_mm + 20, start.heading_deg)
        # As at the end of a drag.
        app.run_controller.place(app.run_controller.pose)
        now = app.run_controller.build_snapshot()
        assert (now.instant.noise, now.pen_down, now.gyro_deg) == (NoiseSpec(20, 0), True, 0)
        # Another line, and still the same tick: nothing has been done yet.
        await pilot.press("n")
        await until(
            pilot, lambda: app.debugger.view is not None and app.debugger.view.paused.line == 5
        )
        assert app.run_controller.timeline.newest == tick
        assert app.run_controller.pose.y_mm == start.y_mm + 20
        await pilot.press("full_stop")
        await until(pilot, lambda: app.run_controller.timeline.newest == tick + 1)
        recording = recording_of(app)
        kinds = ["set_noise", *["set_pose"] * 3, *["set_pen"] * 3]
        assert [(one.tick, one.command.kind) for one in recording.actions()] == [
            (tick, kind) for kind in kinds
        ]
        assert app.run_controller.pose == Pose(start.x_mm + 10, start.y_mm + 20, start.heading_deg)
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
        # It stands nowhere any more.
        assert app.debugger.view is None
        run = RunStore().load_run(app.run_controller.run_id)
        again = rerun(run, RunStore())
        again.wait(PATIENCE_S)
        assert same(run, RunStore().load_run(again.run_id)).same


async def noisy_past(pilot: Pilot[Any]) -> LabApp:
    """A run whose noise was set to 10 on its way, looked at before and after that by turns."""
    app = await ready(pilot)
    await until(pilot, lambda: app.run_controller.timeline.newest > 30)
    app.run_controller.set_noise(NoiseSpec(10, 0))
    await until(
        pilot,
        lambda: (
            app.run_controller.build_snapshot().instant.noise.light == 10
            and app.run_controller.timeline.newest > 60
        ),
    )
    go_to_tick(app.context, 10)
    await until(pilot, lambda: light(app) == 0)
    return app


def light(app: LabApp) -> int:
    return app.query_one("#light", Slider).value


def noises(app: LabApp) -> list[int]:
    """The light noise that the user has set in the run at hand."""
    recording = recording_of(app)
    return [one.command.light for one in recording.actions() if isinstance(one.command, SetNoise)]


@pytest.mark.slow
async def test_dragging_a_noise_slider_in_the_past_asks_once_and_sets_once() -> None:
    shown = frozenset({"noise"})
    async with LabApp(settings(STEPS, autorun=True, speed=8.0, panels_on=shown)).run_test(
        size=(120, 40)
    ) as pilot:
        app = await noisy_past(pilot)
        await pilot.mouse_down("#light", offset=(0, 0))
        await pilot.hover("#light", offset=(4, 0))
        await pilot.hover("#light", offset=(8, 0))
        assert light(app) > 20
        assert len(app.screen_stack) == 1
        await pilot.mouse_up("#light", offset=(8, 0))
        await until(pilot, lambda: isinstance(app.screen, BranchQuestion))
        assert len(app.screen_stack) == 2
        await pilot.press("n")
        await until(pilot, lambda: light(app) == 0)
        go_to_now(app.context)
        await until(pilot, lambda: light(app) == 10)
        assert noises(app) == [10]
        # A branch with other noise sets it once.
        go_to_tick(app.context, 10)
        await until(pilot, lambda: light(app) == 0)
        app.query_one("#light").focus()
        # As it was: nothing to ask.
        await pilot.press("enter")
        await pilot.pause()
        assert len(app.screen_stack) == 1
        await pilot.press("3", "0", "enter")
        await until(pilot, lambda: isinstance(app.screen, BranchQuestion))
        await pilot.press("y")
        await until(
            pilot,
            lambda: (
                len(app.screen_stack) == 1
                and app.run_controller.state in (RunPhase.RUNNING, RunPhase.PAUSED)
            ),
        )
        await until(pilot, lambda: noises(app) == [30])
        app.query_one("#seed").focus()
        await pilot.press("escape")
        await pilot.pause()
        assert (light(app), app.run_controller.next_run.spec.world.noise.light) == (30, 30)
        newest = app.run_controller.timeline.newest
        app.run_controller.send(Resume())
        await until(pilot, lambda: app.run_controller.timeline.newest > newest + 5)
        assert noises(app) == [30]


@pytest.mark.slow
async def test_a_run_paused_while_it_waits_for_input_can_be_resumed() -> None:
    asks = settings("name = input('Name? ')\nprint('A: 1')\nwhile True:\n    pass\n", autorun=True)
    async with open_lab(asks) as (pilot, app):
        await until_state(pilot, RunPhase.WAITING)
        await pilot.press("escape", "space")
        await until_state(pilot, RunPhase.PAUSED)
        await pilot.press("space")
        await until_state(pilot, RunPhase.WAITING)
        app.run_controller.send(Answer("Ann"))
        await until_state(pilot, RunPhase.RUNNING)


@pytest.mark.slow
async def test_quick_steps_back_add_up_and_the_end_key_returns_to_now() -> None:
    async with open_lab(LINES) as (pilot, app):
        for line in range(1, 5):
            await pilot.press("n")
            await until(pilot, partial(at_line, app, line))
            # The panels are there from the first line on.
            await until(
                pilot, lambda: app.panel_area.is_shown("code") and app.panel_area.is_shown("debug")
            )
        # Faster than the way back is worked out.
        for key in "NNnNnNNNnn":
            app.debugger.step_back() if key == "N" else app.debugger.step(LineStep.OVER)
        await until(pilot, lambda: at_line(app, 3) and not app.debugger.busy)
        await pilot.press("N", "N", "n")
        await until(pilot, lambda: at_line(app, 2) and not app.debugger.busy)
        await until_shown(pilot, "past 0.00 s")
        # As the end key does it: the run at work is not let on from a former line.
        await pilot.press("full_stop")
        await until(pilot, partial(at_line, app, 4))
        # While the way back is worked out, it can be given up.
        await pilot.press("N", "end")
        assert not app.debugger.busy
        await pilot.press("n")
        await until(pilot, partial(at_line, app, 5))
        assert not app.debugger.looks_back
        assert app.run_controller.timeline.newest == 0


def at_line(app: LabApp, line: int) -> bool:
    return app.debugger.view is not None and app.debugger.view.paused.line == line


async def test_a_change_for_the_next_run_is_shown_also_while_looking_at_the_past() -> None:
    async with LabApp(
        settings(LINES + "tank_drive.on_for_seconds(50, 50, 1)\n", speed=0.0)
    ).run_test() as pilot:
        app = await ready(pilot)
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        go_to_tick(app.context, 10)
        assert app.run_controller.in_past
        assert app.loader.try_change(
            lambda plan: change_obstacles(plan, (Obstacle(100, 100, 50, 50),))
        )
        assert app.run_controller.build_snapshot().spec.world.obstacles == (
            Obstacle(100, 100, 50, 50),
        )


@pytest.mark.slow
async def test_a_sample_clicked_in_the_chart_is_found_in_the_code() -> None:
    program = "import time\ntank_drive.on(50, 50)\nfor n in range(20):\n    time.sleep(0.1)\n    print('Colour: 100')\n"
    async with open_lab(program, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("c")
        await until_shown(pilot, "100 white")
        await pilot.mouse_down(app.query_one(Chart), offset=(20, 4))
        await until(pilot, lambda: app.run_controller.in_past)
        clicked = app.run_controller.build_snapshot()
        await pilot.press("comma")
        await until(
            pilot, lambda: app.run_controller.build_snapshot().instant.tick < clicked.instant.tick
        )

        assert clicked.line == 5
        assert app.run_controller.build_snapshot().line == 4


@pytest.mark.slow
async def test_a_line_of_a_module_beside_the_program_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("helper.py").write_text("def turn(by):\n    return by + 1\n")
    async with open_lab("from helper import turn\nturn(1)\n") as (pilot, app):
        for line in (1, 2):
            await pilot.press("n")
            await until(pilot, partial(at_line, app, line))
        await pilot.press("s")
        await until_shown(pilot, "line 2 of helper.py")
        await until_shown(pilot, "  return by + 1")


@pytest.mark.slow
async def test_go_to_is_empty_and_enter_alone_repeats_the_last_search() -> None:
    async with open_lab("tank_drive.on_for_seconds(20, 20, 1)\n", speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        timeline = app.run_controller.timeline
        await pilot.press("g", *"tick", "space", *"30", "enter")
        assert timeline.at == 30
        await pilot.press("end", "g")
        field = app.screen.query_one(Input)
        assert (field.value, field.placeholder) == ("", "Enter: tick 30")
        await pilot.press("enter")
        assert timeline.at == 30


async def test_the_arrow_is_on_the_line_that_go_to_names() -> None:
    text = "import time\nfor n in range(3):\n    print('A: 1')\n    time.sleep(0.1)\n"
    async with open_lab(text, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        for line in (3, 4):
            await pilot.press("g", *f"line {line}", "enter")
            await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
            assert app.debugger.view is not None
            assert (app.debugger.current_line, app.debugger.view.paused.line) == (line, line)
        # A line that does not run in a tick gets no arrow there.
        app.debugger.choose_line(5, 3)
        go_to_tick(app.context, 5)
        await until(pilot, lambda: app.debugger.current_line == 4)


async def test_a_tick_back_builds_the_state_and_paints_world_and_footer_only_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls: Counter[str] = Counter()

    def count(owner: type, name: str) -> None:
        do = getattr(owner, name)

        def do_counted(*words: Any, **options: Any) -> Any:
            calls[name] += 1
            return do(*words, **options)

        monkeypatch.setattr(owner, name, do_counted)

    text = "import time\ntank_drive.on(20, 20)\ntime.sleep(0.2)\n"
    async with open_lab(text, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("comma")
        for owner, name in ((RunController, "build_snapshot"), (ScenePainter, "paint")):
            count(owner, name)
        count(KeyFooter, "show")
        go_to_tick(app.context, 5)
        assert calls == {"build_snapshot": 1, "paint": 1, "show": 1}


async def test_go_to_a_line_of_the_newest_instant_names_the_instant_and_marks_the_line() -> None:
    async with open_lab("import time\ntime.sleep(0.1)\nprint('A: 1')\n", speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("D", "g", *"line 3", "enter")
        await until(pilot, lambda: any("line 3: the latest" in text for text in notices(app)))
        code = app.context.panels.code
        assert code is not None
        await until(pilot, lambda: code._area.cursor_location[0] == 2)


async def test_a_line_that_another_follows_in_its_tick_is_not_said_to_wait_for_it() -> None:
    text = "while colorLeft.reflected_light_intensity_pc > 9:\n    tank_drive.on_for_degrees(9, 9, 9)\n    break\n"
    async with open_lab(text, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("G")
        assert recording_of(app).telemetry.record(1).line == 1
        app.debugger.choose_line(1, 1)
        go_to_tick(app.context, 1)
        await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
        assert app.debugger.view is not None
        assert (app.debugger.view.paused.line, app.debugger.view.inspected.waiting) == (1, "")
        await pilot.press("comma", "full_stop")
        await until(pilot, lambda: app.debugger.current_line == 2)
        assert "outB" in app.debugger.view.inspected.waiting


async def test_keys_that_go_back_at_the_first_line_say_that_it_is_the_first() -> None:
    async with open_lab("import time\ntime.sleep(1)\n", speed=0.0) as (pilot, app):
        await pilot.press("n")
        await until_state(pilot, RunPhase.PAUSED)
        await pilot.press("home")
        assert "This is the start of the run" in notices(app)
        await pilot.press("N")
        await until(pilot, lambda: "This is the first line of the run" in notices(app))
