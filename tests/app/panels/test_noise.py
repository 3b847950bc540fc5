"""The noise panel, at rest and during a run."""

from __future__ import annotations

import pytest
from textual.widgets import Input, Static

from tests.app.app_help import (
    LOGS,
    open_lab,
    until,
)
from tuisim.app.app import LabApp
from tuisim.app.form import Slider
from tuisim.app.panels.noise import Noise
from tuisim.engine.core.spec import NoiseSpec

SHOWN = frozenset({"noise"})


def sliders(app: LabApp) -> list[int]:
    return [slider.value for slider in app.query(Slider)]


async def test_moving_a_noise_slider_changes_the_readings_at_once() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        assert app.run_controller.build_snapshot().colors["left"].green == 255
        app.query_one("#light", Slider).focus()
        await pilot.press("end")
        await until(pilot, lambda: app.run_controller.build_snapshot().colors["left"].green < 255)
        assert app.run_controller.next_run.spec.world.noise == NoiseSpec(128, 0)
        assert str(app.query_one("#light-number", Static).render()) == "128"
        # The arrows belong to the slider now, not to the robot.
        assert app.run_controller.pose.x_mm == 150


@pytest.mark.slow
async def test_a_seed_is_for_the_next_run_and_a_wrong_one_is_refused_beside_it() -> None:
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
        entry.value = "7"
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.next_run.spec.seed == 7)


@pytest.mark.slow
async def test_typed_digits_set_the_number_of_a_noise_slider() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        app.panel_area.focus_opened("noise")
        await until(pilot, lambda: app.focused is app.query_one("#light"))
        for keys, number in (("74", 74), ("e1290", 90), ("e0", 0), ("12e8", 8)):
            await pilot.press(*["enter" if key == "e" else key for key in keys])
            assert app.run_controller.next_run.spec.world.noise.light == number
            assert str(app.query_one("#light-number", Static).render()) == str(number)


@pytest.mark.slow
async def test_the_noise_sliders_keep_their_values_when_the_mat_changes() -> None:
    async with open_lab(LOGS, panels_on=SHOWN, size=(80, 24)) as (pilot, app):
        app.query_one("#motor", Slider).focus()
        await pilot.press("right")
        app.loader.change_mat("Loop")
        await until(pilot, lambda: app.loader.mat_is_ready)
        assert sliders(app) == [0, 1]
        assert app.query_one(Noise).display
