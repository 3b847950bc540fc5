"""Keys that arrive in one burst, as over a slow line, do what the same keys do one by one."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from tests.app.app_help import LOGS, open_lab, until
from tuisim.app.dialogs.cells import CellsCard
from tuisim.app.terminal_app import TerminalApp
from tuisim.terminal.queries import AnswerParser


def send(pilot: Pilot[Any], data: str) -> None:
    """Let the driver read what a terminal has sent."""
    driver = pilot.app._driver
    parser = AnswerParser()
    assert driver is not None
    for message in (*parser.feed(data), *parser.feed("")):
        driver.process_message(message)


async def settle(pilot: Pilot[Any]) -> None:
    """Wait until all that was pressed has been handled, and all that it has begun."""
    app = pilot.app
    assert isinstance(app, TerminalApp)
    await pilot.pause()
    await until(
        pilot,
        lambda: app._exit or (app._input.is_idle and all(one.is_finished for one in app.workers)),
    )
    await pilot.pause()


@pytest.mark.slow
async def test_backspace_is_not_overtaken_by_what_is_typed_after_it() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, _):
        send(pilot, "onew.csv\x7f\x7f\x7fparquet")
        await settle(pilot)
        assert pilot.app.screen.query_one(Input).value == "new.parquet"


async def test_enter_typed_with_the_words_waits_until_the_palette_has_searched() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        send(pilot, "\x10Glyphs of the world\r")
        await until(pilot, lambda: isinstance(app.screen, CellsCard))
