"""Before the first run, each panel says what appears in it, or what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import lab, open_lab, until
from tests.app.panel_help import screen_text

EMPTY = {
    "output": ("", "What the program prints appears here: R runs it"),
    "chart": ("c", "Nothing logged yet."),
    "brick": ("K", "R: a program draws here"),
    "debug": ("G", "The program has not started."),
    "goals": ("J", "No goals: o opens a goals file"),
    "obstacles": ("B", "none: + or drag adds one"),
    "lesson": ("E", "No lesson is open: M opens one"),
}


async def _open_and_close(pilot: Pilot[Any], panel: str) -> None:
    """Make sure that a panel says what it must, on an app that does not show it, or always does."""
    app, (key, words) = lab(pilot), EMPTY[panel]
    if key:
        await pilot.press(key)
        await until(pilot, lambda: app.panel_area.is_shown(panel), panel)
    # The keys of the panel itself are shown while it has the focus.
    app.set_focus(None)
    await until(pilot, lambda: _has(screen_text(app), words), panel)
    if key:
        await pilot.press(key)
        await until(pilot, lambda: not app.panel_area.is_shown(panel), panel)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["80", "120"])
async def test_each_empty_panel_says_what_to_do(size: tuple[int, int]) -> None:
    async with open_lab("x = 1\n", size=size) as (pilot, _):
        for panel in EMPTY:
            await _open_and_close(pilot, panel)


def _has(screen: Sequence[str], words: str) -> bool:
    """Whether every word of a text, which may be wrapped beside other panels, is on the screen."""
    text = "\n".join(screen)
    return all(word in text for word in words.split())


async def test_output_of_a_silent_run_asks_for_no_run() -> None:
    async with open_lab("x = 1\n", speed=0.0) as (pilot, app):
        await until(pilot, lambda: _has(screen_text(app), "appears here"))
        await pilot.press("R")
        await until(pilot, lambda: _has(screen_text(app), "finished at"))
        assert not _has(screen_text(app), "appears here")
