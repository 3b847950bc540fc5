"""The footer names keys that work where the focus is."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from tests.ui.app_help import LOGS, ready, screen_text, settings, until
from tuisim.ui.app import Lab

pytestmark = pytest.mark.usefixtures("home")


def footer(app: Lab) -> str:
    return screen_text(app).split("\n")[-1]


async def test_letters_that_are_typed_are_not_offered_as_keys() -> None:
    shown = frozenset({"code", "noise"})
    async with Lab(settings(LOGS, panels_on=shown)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        await until(pilot, lambda: "R run" in footer(app))
        await pilot.press("d")
        await until(pilot, lambda: "esc done" in footer(app))
        assert "R run" not in footer(app)
        await pilot.press("escape")
        await until(pilot, lambda: "R run" in footer(app))
        app.query_one("#light-number", Input).focus()
        await until(pilot, lambda: "⏎ take it" in footer(app) and "R run" not in footer(app))
        await pilot.press("escape")
        await until(pilot, lambda: "R run" in footer(app))
