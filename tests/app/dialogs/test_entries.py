"""Lists of entries that are typed: tab completes the name of a column, else it goes on to the list."""

from __future__ import annotations

from typing import Any

import pytest
from textual.app import App
from textual.widgets import Input, OptionList

from tuisim.app.dialogs.entries import BreaksDialog, WatchesDialog
from tuisim.engine.breakpoints import Breakpoint
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


@pytest.mark.parametrize(
    ("dialog", "typed"),
    [
        (lambda keep: WatchesDialog(("1+1",), RUN, keep), "e+2"),
        (lambda keep: BreaksDialog((Breakpoint.parse("3", RUN),), RUN, keep), "time 2"),
    ],
    ids=["watch", "breakpoint"],
)
async def test_text_typed_while_a_list_of_breaks_or_watches_is_focused_adds_an_entry(
    dialog: Any, typed: str
) -> None:
    entries: list[Any] = []
    app: App[None] = App()
    async with app.run_test(size=(100, 40)) as pilot:
        app.push_screen(dialog(entries.extend))
        await pilot.pause()
        assert app.screen.query_one(OptionList).has_focus
        await pilot.press(*("space" if letter == " " else letter for letter in typed), "enter")
        assert len(entries) == 2 and typed in str(entries[1])
