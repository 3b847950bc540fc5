"""The command palette: everything that a key does, by its title."""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path

import pytest
from textual.widgets import OptionList

from tests.app.app_help import open_lab, ready, screen_text, settings, until
from tuisim.analysis.source import LogRequest
from tuisim.app.action import fitting, most_entries
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.analyser.app import Analyser
from tuisim.app.app import LabApp
from tuisim.app.dialogs.palette import Palette


async def test_it_offers_every_key_those_that_work_now_first_and_finds_one_by_its_title() -> None:
    async with open_lab() as (pilot, app):
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(app.screen, Palette) and app.screen.is_ready)
        listed = app.screen.query_one(OptionList)
        works = [not ACTIONS[option.id or ""].why_not(app.situation()) for option in listed.options]
        assert len(works) == len(ACTIONS)
        assert works == sorted(works, reverse=True)
        lines = [str(option.prompt) for option in listed.options]
        assert all(
            line.endswith(f" {ACTIONS[one.id or ''].key_label}")
            for line, one in zip(lines, listed.options, strict=True)
        )
        await pilot.press(*"pen up", "enter")
        await until(pilot, lambda: app.run_controller.pen_down)


FITTED = {80: 9, 120: 11, 200: 15, 300: 20}


@pytest.mark.parametrize("columns, most", FITTED.items(), ids=map(str, FITTED))
def test_the_footer_has_few_entries_in_groups_with_the_palette_among_them(
    columns: int, most: int
) -> None:
    shown = fitting([*ACTIONS.values()], columns, most_entries(columns))
    assert len(shown) <= most
    assert {"palette", "help", "quit"} <= {one.id for one in shown}
    groups = [group for group, _ in groupby(shown, lambda one: one.group)]
    assert len(groups) == len(set(groups))


@pytest.mark.slow
async def test_above_the_analyser_it_offers_no_key_of_the_lab(tmp_path: Path) -> None:
    log = tmp_path / "log.txt"
    log.write_text("Colour: 1\nColour: 2\n")
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app, analyser = await ready(pilot), Analyser(LogRequest(file=str(log)))
        await app.push_screen(analyser)
        await until(pilot, lambda: analyser.is_open)
        await pilot.press("ctrl+p", *"quit")
        await until(pilot, lambda: re.search("No command has|Quit", screen_text(app)) is not None)
        assert "Quit" not in screen_text(app)
