"""The command palette: everything that a key does, by its title."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from textual.command import DiscoveryHit, Hit

from tests.app.app_help import ready, screen_text, settings, until
from tuisim.analysis.source import LogRequest
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.analyser.app import Analyser
from tuisim.app.app import LabApp
from tuisim.app.terminal_app import ActionProvider


async def test_it_offers_every_key_and_finds_it_by_its_title() -> None:
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        provider = ActionProvider(app.screen)
        offered = [hit async for hit in provider.discover() if isinstance(hit, DiscoveryHit)]
        assert [hit.help for hit in offered] == [f"{one.group} · key {one.key_label}" for one in ACTIONS.values()]
        found = [hit async for hit in provider.search("pen up") if isinstance(hit, Hit)]
        assert [str(hit.match_display) for hit in found] == [ACTIONS["pen"].title]
        found[0].command()
        assert app.run_controller.pen_down


@pytest.mark.slow
async def test_above_the_analyser_it_offers_no_key_of_the_lab(tmp_path: Path) -> None:
    log = tmp_path / "log.txt"
    log.write_text("Colour: 1\nColour: 2\n")
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app, analyser = await ready(pilot), Analyser(LogRequest(file=str(log)))
        await app.push_screen(analyser)
        await until(pilot, lambda: analyser.is_open)
        await pilot.press("ctrl+p", *"quit")
        await until(pilot, lambda: re.search("No matches|Quit", screen_text(app)) is not None)
        assert "Quit" not in screen_text(app)
