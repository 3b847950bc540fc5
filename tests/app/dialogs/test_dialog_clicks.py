"""Fingers in a dialog: the words in the row below press its keys."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.widgets import Input

from tests.app.app_help import ready, screen_text, settings, until
from tuisim.app.app import LabApp
from tuisim.app.dialogs.save import SaveDialog


async def test_a_click_on_a_word_of_the_footer_presses_its_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    async with LabApp(settings()).run_test(size=(64, 60)) as pilot:
        app = await ready(pilot)

        async def click(word: str) -> None:
            await until(pilot, lambda: word in screen_text(app).splitlines()[-1])
            assert await pilot.click(offset=(screen_text(app).splitlines()[-1].index(word) + 1, 59))

        for word, writes in (("esc close", False), ("enter write", True)):
            await pilot.press("ctrl+s")
            await until(pilot, lambda: isinstance(app.screen, SaveDialog))
            app.screen.query_one(Input).value = "mine.toml"
            await click(word)
            await until(pilot, lambda: len(app.screen_stack) == 1)
            assert Path("mine.toml").exists() is writes, word
