"""Runs in the app, with a real child process."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.app.app_help import (
    ENDLESS,
    lab,
    notices,
    open_lab,
    ready,
    recording_of,
    screen_text,
    settings,
    until,
    until_shown,
    until_state,
)
from tuisim.app import run_controller
from tuisim.app.app import LabApp
from tuisim.app.panels.code import Code
from tuisim.app.panels.output import Answer
from tuisim.app.panels.world import WorldView
from tuisim.app.snapshot import RunPhase
from tuisim.base.errors import BackgroundError
from tuisim.engine import mat_cache
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.terminal.picture_mode import PictureMode
from tuisim.terminal.picture_options import CellSet

PUSHES = "from time import sleep\ntank_drive.on(50, 50)\nsleep(2)\ntank_drive.off()\n"


async def test_after_a_run_the_app_shows_the_motor_speeds_of_the_last_tick() -> None:
    turning = "from time import sleep\ntank_drive.on(50, 20)\nsleep(0.3)\n"
    async with open_lab(turning, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        snapshot = app.run_controller.build_snapshot()
        last = recording_of(app).telemetry.last()
        assert last is not None and last.left_speed_dps > last.right_speed_dps > 0
        assert snapshot.list_turns()[:2] == [
            (last.left_position_deg, last.left_speed_dps),
            (last.right_position_deg, last.right_speed_dps),
        ]
        at_the_end = last.build_instant(snapshot.spec, snapshot.spec.world.noise)
        assert snapshot.gyro_rate_dps == at_the_end.gyro_rate_dps != 0


async def test_a_printed_line_that_is_nearly_a_sample_is_told_once() -> None:
    printing = "for number in range(3):\n    print('Angle L:', number)\n"
    async with open_lab(printing, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: "is no sample" in screen_text(app))
        assert screen_text(app).count("is no sample") == 1


@pytest.mark.slow
async def test_the_end_says_that_the_robot_stood_at_a_wall() -> None:
    setup = settings(PUSHES, autorun=True, speed=0.0)
    world = replace(setup.spec.world, solid=True, start=Pose(2200.0, 571.5, 0.0))
    setup = replace(setup, spec=replace(setup.spec, world=world))
    async with open_lab(setup) as (pilot, app):
        stood = "stood at the wall from 0.77 s on, its wheels pushed for 1.2 s"
        # The output panel breaks the line.
        await until(
            pilot,
            lambda: (
                "— finished at 2.00 s" in screen_text(app)
                and "stood at the wall" in screen_text(app)
            ),
        )
        assert f"finished, {stood}" not in notices(app)


@pytest.mark.slow
async def test_keys_pause_a_run_step_one_tick_resume_and_stop_it() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING
                and app.run_controller.build_snapshot().instant.tick > 5
            ),
        )
        await pilot.press("space")
        await until_state(pilot, RunPhase.PAUSED)
        tick = app.run_controller.build_snapshot().instant.tick
        await pilot.press("full_stop")
        await until(pilot, lambda: app.run_controller.build_snapshot().instant.tick == tick + 1)
        await pilot.press("space")
        await until(pilot, lambda: app.run_controller.build_snapshot().instant.tick > tick + 5)
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
        assert app.run_controller.build_snapshot().end == "stopped"


@pytest.mark.slow
async def test_the_robot_can_be_placed_during_a_run() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until(pilot, lambda: app.run_controller.in_run)
        app.run_controller.place(Pose(1000, 700, 90))
        await until(pilot, lambda: app.run_controller.pose.y_mm >= 700)
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("R")
        await until_state(pilot, RunPhase.RUNNING)
        # A run begins where the last one began, unless the robot was placed at rest.
        assert app.run_controller.pose.y_mm == 500


@pytest.mark.slow
async def test_an_error_is_shown_with_its_line() -> None:
    async with open_lab("print('A: 1')\nprint(nothing)\n", autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: all(words in screen_text(app) for words in ("NameError", "✗ 2")))
        output = app.panel_area.output
        assert output is not None and output.copy_text().text.count("Traceback") == 1
        await until(
            pilot,
            lambda: "name 'nothing' is not defined" in str(app.query_one(Code).border_subtitle),
        )
        assert not any("NameError" in notice for notice in notices(app))


async def test_an_error_opens_the_code_at_its_line() -> None:
    text = "\n" * 40 + "print(nothing)\n"
    async with open_lab(text, autorun=True, size=(80, 24)) as (pilot, app):
        await until_shown(pilot, "✗41 print(nothing)")
        assert app.panel_area.is_shown("output")


@pytest.mark.slow
async def test_an_error_is_readable_in_a_small_terminal_until_the_next_run() -> None:
    # The output is narrow there: the line goes on in the next row.
    parts = "NameError: name 'nothing' is ", "not defined"
    async with open_lab("print('A: 1')\nprint(nothing)\n", size=(80, 24)) as (pilot, app):
        await pilot.press("O", "O")
        assert not app.panel_area.is_shown("output")
        await pilot.press("R")
        await until(pilot, lambda: all(part in screen_text(app) for part in parts))
        await until_state(pilot, RunPhase.ENDED)
        app.clear_notifications()
        await pilot.press("right", "comma", "end")
        await until(pilot, lambda: all(part in screen_text(app) for part in parts))


@pytest.mark.quick_cases("text")
@pytest.mark.parametrize(
    "keys, printed",
    [(["a", "n", "n", "enter"], "got ann"), (["ctrl+d"], "nothing more")],
    ids=["text", "end of file"],
)
async def test_input_is_answered_from_the_app(keys: list[str], printed: str) -> None:
    asks = "try:\n    print('got', input('Name? '))\nexcept EOFError:\n    print('nothing more')\n"
    async with open_lab(asks, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.WAITING)
        await until(pilot, lambda: isinstance(app.focused, Answer))
        await until_shown(pilot, "Name?")
        await pilot.press(*keys)
        await until_shown(pilot, printed)
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: not app.query(Answer))


@pytest.mark.slow
async def test_a_flood_of_prints_leaves_the_app_usable() -> None:
    flood = "for n in range(200_000):\n    print('line', n)\n"
    async with open_lab(flood, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        await pilot.press("D", "D")
        assert not app.panel_area.is_shown("code")
        await until_shown(pilot, "line 199999")


@pytest.mark.slow
async def test_quit_during_a_run_asks_and_leaves_no_child() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        run = app.run_controller.run
        assert run is not None
        await pilot.press("q", "n")
        assert len(app.screen_stack) == 1
        await pilot.press("q", "y")
    assert run.ended is not None


async def test_a_mat_whose_preparation_failed_is_prepared_again_for_a_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    open_field = mat_cache.FieldFiles.open_field
    tries = []

    def opened(files: mat_cache.FieldFiles, **choices: bool) -> Field:
        tries.append(files)
        if len(tries) == 1:
            raise BackgroundError("the prepared mat cannot be opened")
        return open_field(files, **choices)

    monkeypatch.setattr(mat_cache.FieldFiles, "open_field", opened)
    async with LabApp(settings("print(1)\n")).run_test(size=(80, 24)) as pilot:
        app = lab(pilot)
        await until(pilot, lambda: any("cannot be opened" in notice for notice in notices(app)))
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)


@pytest.mark.slow
async def test_the_state_says_stopped_only_when_the_drawn_robot_has_stopped() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING and app.run_controller.pose.x_mm > 160
            ),
        )
        # The terminal still shows the last frame: no further one is due.
        app.pacer.ready = lambda: False  # type: ignore[method-assign]
        for key, word in (("space", "paused"), ("S", "stopped")):
            await pilot.press(key)
            await until(pilot, lambda word=word: app.key_footer._status.startswith(word))  # type: ignore[misc]
            scene = app.query_one(WorldView)._scene
            assert scene is not None and scene.pose == app.run_controller.pose


@pytest.mark.slow
async def test_on_a_slow_link_a_paused_or_stopped_world_is_drawn_finely_at_once() -> None:
    setup = settings(ENDLESS, autorun=True)
    mode = PictureMode(CellSet.QUADRANT, CellSet.QUADRANT, is_slow=lambda: True)
    async with LabApp(setup, picture_mode=mode).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        world = app.query_one(WorldView)
        mode.is_slow = lambda: True
        await until(pilot, lambda: world.is_coarse and app.run_controller.pose.x_mm > 160)
        for key, word in (("space", "paused"), ("S", "stopped")):
            await pilot.press(key)
            await until(pilot, lambda word=word: app.key_footer._status.startswith(word))  # type: ignore[misc]
            assert not world.is_coarse


async def test_a_run_in_the_app_ends_at_a_limit_and_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert run_controller.TIME_LIMIT_S == 3600
    monkeypatch.setattr(run_controller, "TIME_LIMIT_S", 1.0)
    async with open_lab(ENDLESS, autorun=True, speed=0.0) as (pilot, _):
        await until_state(pilot, RunPhase.ENDED)
        await until_shown(pilot, "stopped at the limit of 1 s simulated time")
