"""A drag ends when a dialog takes the mouse: nothing follows it afterwards."""

from __future__ import annotations

import pytest
from textual.widget import Widget

from tests.app.app_help import LOGS, open_lab, until
from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.form import Slider
from tuisim.app.panels.brick import Brick
from tuisim.app.panels.chart import Chart
from tuisim.app.panels.world import WorldView


@pytest.mark.slow
async def test_no_drag_outlives_a_dialog() -> None:
    async with open_lab(LOGS, panels_on=frozenset({"noise", "brick"}), size=(120, 50)) as (
        pilot,
        app,
    ):
        view = app.query_one(WorldView)
        slider = app.query_one("#light", Slider)
        chart = app.query_one(Chart)
        brick = app.query_one(Brick)
        assert view._port is not None
        col, row = view._port.to_px(app.run_controller.pose.x_mm, app.run_controller.pose.y_mm)
        grips: list[tuple[Widget, tuple[int, int]]] = [
            (view, (int(col), int(row / 2))),
            (slider, (0, 0)),
        ]
        for widget, at in grips:
            await pilot.mouse_down(widget, offset=at)
            dialog: Dialog[None] = Dialog()
            await app.push_screen(dialog)
            await pilot.mouse_up()
            dialog.dismiss()
            await until(pilot, lambda: len(app.screen_stack) == 1)
        # As while the mouse presses a button, or drags the cursor.
        brick._clicked = "enter"
        chart._dragging = True
        app.capture_mouse(brick)
        app.capture_mouse(chart)
        app.capture_mouse(None)
        await pilot.pause()
        assert (view._grip, slider.dragging, brick.held, chart._dragging) == (
            None,
            False,
            frozenset(),
            False,
        )
