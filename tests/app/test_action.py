"""The command palette: everything that a key does, by its title."""

from __future__ import annotations

from itertools import groupby

import pytest
from textual.widgets import OptionList

from tests.app.app_help import open_lab, until
from tuisim.app.action import find_max_entries, fit_actions
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.dialogs.palette import Palette
from tuisim.app.snapshot import RunPhase, Situation


@pytest.mark.slow
async def test_the_palette_offers_every_key_and_finds_one_by_its_title() -> None:
    async with open_lab() as (pilot, app):
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(app.screen, Palette) and app.screen.is_ready)
        listed = app.screen.query_one(OptionList)
        works = [
            not ACTIONS[option.id or ""].why_not(app.find_situation()) for option in listed.options
        ]
        assert len(works) == len(ACTIONS)
        assert works == sorted(works, reverse=True)
        lines = [str(option.prompt) for option in listed.options]
        assert all(
            line.endswith(f" {ACTIONS[one.id or ''].key_label}")
            for line, one in zip(lines, listed.options, strict=True)
        )
        await pilot.press(*"pen up", "enter")
        await until(pilot, lambda: app.run_controller.pen_down)


FITTED = {60: 9, 80: 9, 120: 11, 200: 15, 300: 20}


@pytest.mark.parametrize("columns, most", FITTED.items(), ids=map(str, FITTED))
@pytest.mark.parametrize("state", [RunPhase.IDLE, RunPhase.RUNNING, RunPhase.PAUSED])
def test_the_footer_has_few_entries_in_groups_that_fit_with_help_palette_and_quit_as_the_last(
    columns: int, most: int, state: RunPhase
) -> None:
    now = Situation(state, has_program=True, has_run=state != RunPhase.IDLE)
    works = [action for action in ACTIONS.values() if not action.why_not(now)]
    shown = fit_actions(works, columns, find_max_entries(columns))
    assert len(shown) <= most
    assert [one.id for one in shown[-3:]] == ["help", "palette", "quit"]
    groups = [group for group, _ in groupby(shown, lambda one: one.group)]
    assert len(groups) == len(set(groups))
    words = sum(len(f" {one.footer_key or one.key_label} {one.footer}") for one in shown)
    assert words + 2 * (len(groups) - 1) <= columns
