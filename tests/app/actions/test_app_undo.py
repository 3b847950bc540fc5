"""One key takes back what a letter has changed at once."""

from __future__ import annotations

import pytest

from tests.app.app_help import (
    LOGS,
    notices,
    open_lab,
    screen_text,
    until,
    until_shown,
    until_typing,
)
from tuisim.engine.protocol import End


@pytest.mark.slow
async def test_backspace_undoes_a_move_of_the_robot() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("right")
        await until(pilot, lambda: app.run_controller.pose.x_mm == 160)
        for key in ("m", "j"):
            await pilot.press(key)
            await until(pilot, lambda: app.run_controller.pose.x_mm != 160, key)
            await until_shown(pilot, "backspace undo")
            await pilot.press("backspace")
            await until(pilot, lambda: app.run_controller.pose.x_mm == 160, key)
            await until(pilot, lambda: "backspace undo" not in screen_text(app), key)


async def test_a_cleared_log_and_a_cleared_trace_come_back() -> None:
    drive = "tank_drive.on_for_seconds(20, 20, 0.5)\nprint('Colour: 7')\n"
    async with open_lab(drive, autorun=True, speed=0.0) as (pilot, app):
        await until(pilot, lambda: app.run_controller.build_snapshot().end == End.FINISHED)
        output = app.panel_area.output
        world = app.panel_area.world
        assert output is not None and world is not None
        await until(pilot, lambda: "Colour: 7" in output.copy_text().text)
        await pilot.press("x")
        await until(pilot, lambda: "Colour" not in output.copy_text().text)
        await pilot.press("backspace")
        await until(pilot, lambda: "Colour: 7" in output.copy_text().text)
        await until_shown(pilot, "[x] Colour")
        pieces = len(world._view.trace)
        await pilot.press("C")
        await until(pilot, lambda: len(world._view.trace) == 0)
        await pilot.press("backspace")
        await until(pilot, lambda: len(world._view.trace) == pieces)


@pytest.mark.slow
async def test_undo_without_a_change_says_that_there_is_nothing_to_undo() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("backspace")
        await until(pilot, lambda: "Nothing to undo" in notices(app))


async def test_undo_works_while_the_code_has_the_focus() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("d")
        await until_typing(pilot)
        await pilot.press("escape", "backspace")
        await until(pilot, lambda: "Nothing to undo" in notices(app))
