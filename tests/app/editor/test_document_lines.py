"""Breakpoints and light of a program that is edited while it runs."""

from __future__ import annotations

import pytest

from tests.app.app_help import notices, open_lab, until

TURNS = """\
import time
n = 0
while True:
    n = n + 1
    time.sleep(0.05)
    m = n
"""


@pytest.mark.slow
async def test_editing_a_paused_program_keeps_breakpoints_and_current_line_in_place() -> None:
    async with open_lab(TURNS, speed=0.0) as (pilot, app):

        def at(line: int) -> bool:
            return app.debugger.view is not None and app.debugger.view.paused.line == line

        await pilot.press("n")
        await until(pilot, lambda: at(1))
        app.debugger.toggle_line(6)
        await pilot.press("d", "ctrl+home", "#", "enter", "escape")
        assert app.debugger.texts == ("7",)
        assert app.panel_area.code is not None
        area = app.panel_area.code._area
        await until(pilot, lambda: area._lit == 2)
        await pilot.press("space")
        await until(pilot, lambda: at(6) and area._lit == 7)
        # The cursor is on a line that the run does not have, then on one that it has elsewhere.
        area.move_cursor((0, 0))
        await pilot.press("L")
        assert "This line is not in the running text" in notices(app)
        area.move_cursor((4, 0))
        await pilot.press("L")
        await until(pilot, lambda: at(4) and area._lit == 5)
