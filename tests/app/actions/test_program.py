"""A paused program is run again; a new one that has run is not left unsaved without a question."""

from __future__ import annotations

import pytest

from tests.app.app_help import ENDLESS, open_lab, until, until_state
from tuisim.app.app import AppSettings
from tuisim.app.dialogs.question import Question
from tuisim.app.snapshot import RunPhase
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings


@pytest.mark.slow
async def test_the_run_key_starts_a_paused_program_again() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        await pilot.press("space")
        await until_state(pilot, RunPhase.PAUSED)
        before = app.run_controller.run_id
        await pilot.press("R")
        await until_state(pilot, RunPhase.RUNNING)
        assert app.run_controller.run_id != before


async def test_quitting_asks_before_dropping_a_new_program_that_has_run() -> None:
    plain = AppSettings(spec=build_run_spec(Settings()), settings=Settings())
    async with open_lab(plain, size=(80, 24)) as (pilot, app):
        app.document.start_new("print(1)\n")
        await until(pilot, lambda: app.run_controller.program is not None)
        assert not app.document.dirty
        await pilot.press("escape", "R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("q")
        await until(pilot, lambda: isinstance(app.screen, Question))
