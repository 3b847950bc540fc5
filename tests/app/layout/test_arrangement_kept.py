"""The arrangement that is kept for the next start."""

from __future__ import annotations

import pytest

from tests.app.app_help import LOGS, open_lab, until
from tuisim.app.layout.arrangement import KeptLayout, Preset, load_layout, save_layout
from tuisim.app.panels import TerminalSize


@pytest.mark.slow
async def test_a_stored_arrangement_of_panels_is_used_only_at_the_size_it_was_stored_for() -> None:
    async with open_lab(LOGS) as (pilot, app):
        standard = app.panel_area.arrangement.boxes
        await pilot.press("f7", "i")
    async with open_lab(LOGS) as (pilot, app):
        assert app.panel_area.arrangement.boxes == standard
        await pilot.press("f7", "i", "shift+f9")
        kept = app.panel_area.arrangement.boxes
    async with open_lab(LOGS) as (_, app):
        assert app.panel_area.arrangement.boxes == kept
    async with open_lab(LOGS, size=(80, 24)) as (_, app):
        assert app.panel_area.preset == "standard"


def test_a_saved_layout_is_loaded_again() -> None:
    save_layout(TerminalSize.SMALL, KeptLayout(Preset.DRIVE, {"output": False}))
    assert load_layout(TerminalSize.SMALL) == KeptLayout(Preset.DRIVE, {"output": False})


@pytest.mark.slow
async def test_panels_are_kept_for_the_next_start_only_by_the_key_that_says_so() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press("X", "i", "i")
        await until(pilot, lambda: not app.panel_area.is_shown("instrumentation"))
    assert load_layout(TerminalSize.SMALL) == KeptLayout()
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        assert app.panel_area.is_shown("instrumentation")
        await pilot.press("X", "shift+f9")
    assert load_layout(TerminalSize.SMALL).asked == {"positioning": True}
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        assert app.panel_area.is_shown("positioning")
        await pilot.press("f6", "f6", "shift+f9")
    assert load_layout(TerminalSize.SMALL) == KeptLayout()
