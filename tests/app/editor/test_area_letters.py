"""After a click into the text, a letter starts typing."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot

from tests.app.app_help import ENDLESS, open_lab, screen_text, until, until_state
from tuisim.app.app import LabApp
from tuisim.app.editor.area import CodeArea
from tuisim.app.snapshot import RunPhase

TEXT = "x = 1\n"


async def click_into_text(pilot: Pilot[None], app: LabApp) -> CodeArea:
    """Click behind the first line."""
    await until(pilot, lambda: bool(app.query(CodeArea)) and "x = 1" in screen_text(app))
    area = app.query_one(CodeArea)
    await pilot.click(area, offset=(area.gutter_width + 5, 0))
    await until(pilot, lambda: app.focused is area)
    return area


@pytest.mark.slow
async def test_after_a_click_into_the_text_letters_are_typed_into_it() -> None:
    async with open_lab(TEXT) as (pilot, app):
        area = await click_into_text(pilot, app)
        await until(pilot, lambda: "letters edit" in screen_text(app).splitlines()[-1])
        await pilot.press(*"R2", "space", "m")
        await until(pilot, lambda: area.program_text == "x = 1R2 m\n")
        assert area.typing and app.run_controller.timeline.recording is None


async def test_after_escape_letters_are_keys_of_the_app_again() -> None:
    async with open_lab(TEXT) as (pilot, app):
        area = await click_into_text(pilot, app)
        await pilot.press("escape")
        await until(pilot, lambda: "R run" in screen_text(app).splitlines()[-1])
        await pilot.press("p")
        await until(pilot, lambda: app.run_controller.pen_down)
        assert area.program_text == TEXT


@pytest.mark.slow
async def test_during_a_run_a_click_leaves_letters_to_the_app() -> None:
    async with open_lab("x = 1\n" + ENDLESS, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        area = await click_into_text(pilot, app)
        assert not area.awaits_letters
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
