"""The noise panel, at rest and during a run."""

from __future__ import annotations

import json

import pytest
from textual.widgets import Input, Static

from tests.app.app_help import (
    ENDLESS,
    LOGS,
    open_lab,
    until,
    until_shown,
    until_state,
)
from tuisim.app.app import LabApp
from tuisim.app.form import Slider
from tuisim.app.panels.noise import Noise
from tuisim.app.snapshot import RunPhase
from tuisim.core.spec import NoiseSpec
from tuisim.protocol import SetNoise
from tuisim.runs.side_files import read_actions

SHOWN = frozenset({"noise"})


def sliders(app: LabApp) -> list[int]:
    return [slider.value for slider in app.query(Slider)]


async def test_a_slider_acts_on_the_readings_at_once() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        assert app.run_controller.snapshot().colors["left"].green == 255
        app.query_one("#light", Slider).focus()
        await pilot.press("end")
        await until(pilot, lambda: app.run_controller.snapshot().colors["left"].green < 255)
        assert app.run_controller.next_run.spec.world.noise == NoiseSpec(128, 0)
        assert app.query_one("#light-number", Input).value == "128"
        # The arrows belong to the slider now, not to the robot.
        assert app.run_controller.pose.x_mm == 150


@pytest.mark.quick_cases("seed-*")
@pytest.mark.parametrize(
    "field, typed, said",
    [
        ("light-number", "129", "Light must be a whole number from 0 to 128, got '129'"),
        ("motor-number", "x", "Motor must be a whole number from 0 to 500, got 'x'"),
        ("seed", "-1", "Seed must be a whole number from 0 to 9223372036854775807, got '-1'"),
    ],
)
async def test_a_wrong_number_is_refused_beside_it(field: str, typed: str, said: str) -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        before = app.run_controller.next_run
        entry = app.query_one(f"#{field}", Input)
        entry.focus()
        entry.value = typed
        await pilot.press("enter")
        await pilot.pause()
        assert str(app.query_one("Noise #message", Static).render()) == said
        assert app.run_controller.next_run == before


@pytest.mark.slow
async def test_typed_numbers_and_the_seed_are_for_the_next_run_too() -> None:
    async with open_lab("print('A: 1')\n", panels_on=SHOWN, speed=0.0, size=(80, 24)) as (
        pilot,
        app,
    ):
        for field, typed in (("motor-number", "50"), ("seed", "7")):
            entry = app.query_one(f"#{field}", Input)
            entry.focus()
            entry.value = typed
            await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.next_run.spec.seed == 7)
        await pilot.press("escape", "R")
        await until_state(pilot, RunPhase.ENDED)
        assert app.run_controller.run is not None
        assert app.run_controller.run.spec.world.noise == NoiseSpec(0, 50)
        assert app.run_controller.run.spec.seed == 7


@pytest.mark.slow
async def test_noise_set_during_a_run_is_recorded_and_shown_from_its_tick_on() -> None:
    async with open_lab(ENDLESS, autorun=True, panels_on=SHOWN) as (pilot, app):
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING
                and app.run_controller.snapshot().instant.tick > 0
            ),
        )
        app.query_one("#light", Slider).focus()
        await pilot.press("pageup")
        await until(pilot, lambda: app.run_controller.snapshot().instant.noise.light == 10)
        run, recording = app.run_controller.run, app.run_controller.timeline.recording
        assert run is not None
        assert recording is not None
        actions, _ = read_actions(run.folder)
        assert [action.command for action in actions] == [SetNoise(10, 0)]
        assert recording.noise_at(run.telemetry.record(0)) == NoiseSpec(0, 0)
        await until_shown(pilot, "light ±10")
        # The run itself began without: what it was made of does not change.
        assert (
            json.loads((run.folder / "run.json").read_text())["spec"]["world"]["noise"]["light"]
            == 0
        )
        await pilot.press("escape", "S")
        await until_state(pilot, RunPhase.ENDED)
        assert app.run_controller.snapshot().instant.noise.light == 10
        assert sliders(app) == [10, 0]


async def test_the_panel_shows_what_a_mat_or_a_program_leaves() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        app.query_one("#motor", Slider).focus()
        await pilot.press("right")
        app.loader.change_mat("Loop")
        await until(pilot, lambda: app.loader.mat_is_ready)
        assert sliders(app) == [0, 1]
        assert app.query_one(Noise).display
