"""Lists of entries that are typed: tab completes the name of a column, else it goes on to the list."""

from __future__ import annotations

import pytest
from textual.app import App
from textual.widgets import Input, OptionList

from tuisim.app.dialogs.entries import BreaksDialog, WatchesDialog
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec

RUN = RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"])


@pytest.mark.parametrize("kind", [BreaksDialog, WatchesDialog])
async def test_tab_completes_the_name_of_a_column(
    kind: type[BreaksDialog] | type[WatchesDialog],
) -> None:
    app: App[None] = App()
    async with app.run_test(size=(100, 40)) as pilot:
        app.push_screen(kind((), RUN, lambda _: None))
        await pilot.pause()
        await pilot.press(*"left_red_p")
        await pilot.pause()
        await pilot.press("tab")
        assert app.screen.query_one(Input).value == "left_red_pc"
        assert app.screen.query_one(Input).has_focus
        await pilot.press("tab")
        assert app.screen.query_one(OptionList).has_focus
