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
        assert str(app.query_one("#light-number", Static).render()) == "128"
        # The arrows belong to the slider now, not to the robot.
        assert app.run_controller.pose.x_mm == 150


async def test_a_wrong_seed_is_refused_beside_it() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        before = app.run_controller.next_run
        entry = app.query_one("#seed", Input)
        entry.focus()
        entry.value = "-1"
        await pilot.press("enter")
        await pilot.pause()
        said = "Seed must be a whole number from 0 to 9223372036854775807, got '-1'"
        assert str(app.query_one("Noise #message", Static).render()) == said
        assert app.run_controller.next_run == before


@pytest.mark.parametrize(
    "keys, light",
    [("74", 74), ("1290", 90), ("0", 0), ("12 enter 8", 8)],
    ids=["two digits", "beyond the largest", "none", "anew"],
)
async def test_digits_set_the_number_of_a_slider(keys: str, light: int) -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        app.panel_area.attend("noise")
        await until(pilot, lambda: app.focused is app.query_one("#light"))
        for part in keys.split():
            await pilot.press(*([part] if part.isalpha() else part))
        await until(pilot, lambda: app.run_controller.next_run.spec.world.noise.light == light)
        assert str(app.query_one("#light-number", Static).render()) == str(light)


async def test_tab_goes_from_slider_to_slider_to_seed() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        app.panel_area.attend("noise")
        for name in ("light", "motor", "seed"):
            await until(pilot, lambda name=name: app.focused is app.query_one(f"#{name}"))  # type: ignore[misc]
            await pilot.press("tab")


@pytest.mark.slow
async def test_typed_numbers_and_the_seed_are_for_the_next_run_too() -> None:
    async with open_lab("print('A: 1')\n", panels_on=SHOWN, speed=0.0, size=(80, 24)) as (
        pilot,
        app,
    ):
        app.query_one("#motor", Slider).focus()
        await pilot.press("5", "0", "enter")
        entry = app.query_one("#seed", Input)
        entry.focus()
        entry.value = "7"
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
