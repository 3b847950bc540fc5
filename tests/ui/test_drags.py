"""A drag ends when a dialog takes the mouse: nothing follows it afterwards."""

from __future__ import annotations

import pytest

from tests.ui.app_help import ENDLESS, ready, settings, until
from tuisim.core.geometry import Pose
from tuisim.ui.app import Lab
from tuisim.ui.panels.world import WorldView
from tuisim.ui.slider import Slider
from tuisim.ui.snapshot import RUNNING

pytestmark = pytest.mark.usefixtures("home")


async def test_no_drag_outlives_a_dialog() -> None:
    shown = frozenset({"noise", "brick"})
    async with Lab(settings(ENDLESS, panels_on=shown)).run_test(size=(120, 50)) as pilot:
        app = await ready(pilot)
        view, slider, brick = app.query_one(WorldView), app.query_one("#light", Slider), app.desk.brick
        assert view._port is not None and brick is not None
        await pilot.press("R")
        await until(pilot, lambda: app.bridge.state == RUNNING and bool(brick._picture.buttons))
        await pilot.press("space")
        app.bridge.place(Pose(1000, 500, 0))
        await until(pilot, lambda: view._snapshot is not None and view._snapshot.instant.pose.x_mm == 1000)
        col, row = view._port.to_px(1000, 500)
        button = brick._picture.buttons[0]
        for widget, x, y in (
            (view, int(col), int(row / 2)), (slider, 0, 0), (brick._view, button.first, button.row)
        ):  # fmt: skip
            await pilot.mouse_down(widget, offset=(x, y))
            await pilot.press("question_mark")
            await until(pilot, lambda: len(app.screen_stack) == 2)
            await pilot.mouse_up()
            await pilot.press("escape")
            await until(pilot, lambda: len(app.screen_stack) == 1)
        assert view._grip is None
        assert not slider.dragging
        assert app.bridge.pressed == frozenset()
