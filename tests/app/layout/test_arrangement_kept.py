"""The arrangement that is kept for the next start."""

from __future__ import annotations

import pytest

from tests.app.app_help import LOGS, open_lab, ready, settings
from tuisim.app.app import LabApp
from tuisim.app.layout.arrangement import KeptLayout, Preset, load_layout, save_layout
from tuisim.app.panels import TerminalSize


@pytest.mark.slow
async def test_the_next_start_forgets_the_arrangement() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        standard = (await ready(pilot)).panel_area.arrangement.boxes
        await pilot.press("f7", "i")
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        assert (await ready(pilot)).panel_area.arrangement.boxes == standard


@pytest.mark.slow
async def test_the_next_start_finds_an_arrangement_that_was_kept_for_its_size() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("f7", "i", "shift+f9")
        kept = app.panel_area.arrangement.boxes
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        assert (await ready(pilot)).panel_area.arrangement.boxes == kept
    async with LabApp(settings(LOGS)).run_test(size=(80, 24)) as pilot:
        assert (await ready(pilot)).panel_area.preset == "standard"


def test_what_is_known_stays() -> None:
    save_layout(TerminalSize.SMALL, KeptLayout(Preset.DRIVE, {"chart": True}))
    assert load_layout(TerminalSize.SMALL) == KeptLayout(Preset.DRIVE, {"chart": True})
