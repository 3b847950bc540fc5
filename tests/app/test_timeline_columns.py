"""The names of the chart's traces in the app: each is a breakpoint, a watch and an instant to go to."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import ready, settings, until, until_state
from tuisim.app.app import LabApp
from tuisim.app.dialogs.entries import WatchesDialog
from tuisim.app.snapshot import RunPhase

PROGRAM = "tank_drive.on_for_rotations(30, 30, 1)\nx = 1\n"


async def entered(pilot: Pilot[Any], text: str) -> None:
    """Type a text into the field of a dialog, and enter it."""
    pilot.app.screen.query_one(Input).value = text
    pilot.app.screen.query_one(Input).focus()
    await pilot.press("enter")


@pytest.mark.slow
async def test_every_trace_of_the_chart_can_be_typed() -> None:
    app = LabApp(
        settings(PROGRAM, autorun=True, speed=0.0, background="Grey_bands", panels_on=("chart",))
    )
    async with app.run_test(size=(120, 40)) as pilot:
        await ready(pilot)
        await until_state(pilot, RunPhase.ENDED)
        chart = app.panel_area.chart
        assert chart is not None
        await until(pilot, lambda: len(chart._traces) == 4)
        names = [trace.name for trace in chart._traces]
        timeline = app.run_controller.timeline
        for name in names:
            await pilot.press("g")
            await entered(pilot, f"{name} > -1 first")
            await until(pilot, lambda: timeline.at == 0)
            await pilot.press("end")
            await until(pilot, lambda: timeline.at is None)
        await pilot.press("T")
        for name in names:
            await entered(pilot, f"{name} > -1")
        await pilot.press("escape")
        assert [one.text for one in app.debugger.breaks] == [f"{name} > -1" for name in names]
        app.push_screen(WatchesDialog((), app.run_controller.spec, app.debugger.set_watches))
        await until(pilot, lambda: bool(app.screen.query(OptionList)))
        for name in names:
            await entered(pilot, name)
        await pilot.press("escape")
        await pilot.press("R")
        await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
        assert app.debugger.view is not None
        shown = {watch.text: watch.value for watch in app.debugger.view.inspected.watches}
        assert set(names) <= set(shown)
        assert all(float(shown[name]) > -1 for name in names)
