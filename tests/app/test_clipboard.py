"""What ctrl+c copies of each panel, and what it tells."""

from __future__ import annotations

import pytest

from tests.app.app_help import LOGS, notices, open_lab, until, until_shown
from tuisim.app.app import LabApp
from tuisim.engine.protocol import End

TOLD = "sent to the terminal's clipboard"


def copied_text(app: LabApp) -> str:
    """What the app has sent to the clipboard."""
    return app.clipboard


@pytest.mark.slow
async def test_each_panel_copies_what_it_shows() -> None:
    async with open_lab(LOGS, autorun=True, speed=0.0) as (pilot, app):
        await until(pilot, lambda: app.run_controller.build_snapshot().end == End.FINISHED)
        await until(pilot, lambda: "finished" in app.panel_area.output.copy_text().text)  # type: ignore[union-attr]
        wanted = {
            "output": "Colour: 100.0\nColour: 100.0",
            "code": "sensor_val = colorLeft.reflected_light_intensity_pc\nprint(",
            "world": "Grey_bands, ",
        }
        for panel, text in wanted.items():
            app.panel_area.focus_opened(panel)
            await until(pilot, lambda panel=panel: app.panel_area.find_focused_panel() == panel)  # type: ignore[misc]
            await pilot.press("ctrl+c")
            await until(pilot, lambda text=text: text in copied_text(app), panel)  # type: ignore[misc]
        rows = copied_text(app).split("\n")
        assert any(char in "".join(rows) for char in "⣿⡇⢸") and rows[-3].startswith("L ")
        assert TOLD in notices(app)[-1] and "I writes a file" in notices(app)[-1]
        # A chart copies the values at its cursor.
        app.panel_area.focus_opened("chart")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "chart")
        await until_shown(pilot, "[x] Colour")
        await pilot.press("ctrl+c")
        await until(pilot, lambda: "[x] Colour" in copied_text(app))
        await pilot.press("left", "ctrl+c")
        await until(pilot, lambda: " s  Colour " in copied_text(app))
        assert "\n" not in copied_text(app)


@pytest.mark.slow
async def test_clicking_a_panel_without_focus_makes_it_the_one_that_is_copied() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await until_shown(pilot, "Ultrasonic")
        await pilot.click(app.panel_area.panels["instrumentation"])
        await pilot.press("ctrl+c")
        await until(pilot, lambda: copied_text(app).startswith("LeftMotor"))
        app.panel_area.focus_opened("chart")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "chart")
        app.panel_area.focus_world()
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "world")
        await pilot.press("ctrl+c")
        await until(pilot, lambda: copied_text(app).startswith("Grey_bands"))


async def test_an_error_is_copied_with_its_line() -> None:
    async with open_lab("import time\nprint(speeed)\n", autorun=True, speed=0.0) as (pilot, app):
        await until(pilot, lambda: app.run_controller.build_snapshot().end == End.RAISED)
        await until(pilot, lambda: app.panel_area.code is not None)
        app.panel_area.focus_opened("code")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "code")
        await pilot.press("ctrl+c")
        await until(pilot, lambda: copied_text(app).startswith("line 2: NameError"))
