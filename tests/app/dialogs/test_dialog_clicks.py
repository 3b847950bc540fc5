"""Fingers in a dialog: the words in the row below press its keys."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from textual.widgets import Input

from tests.app.app_help import open_lab, screen_text, settings, until, until_shown
from tuisim.app.dialogs.save import SaveDialog
from tuisim.base.source import Program


@pytest.mark.slow
async def test_a_click_on_a_word_of_the_footer_presses_its_key(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    async with open_lab(size=(64, 60)) as (pilot, app):

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


async def test_a_click_on_a_word_of_the_editors_keys_saves_the_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "mine.py"
    file.write_text("print(1)\n")
    given = Program(file.name, file.read_text(), "preloaded", str(file))
    async with open_lab(replace(settings(), program=given), size=(80, 24)) as (pilot, app):
        await pilot.press("d")
        await until_shown(pilot, "^s save")
        await pilot.press("#")
        for word in ("^s save", "esc done"):
            await pilot.click(offset=(screen_text(app).splitlines()[-1].index(word) + 1, 23))
            await until(pilot, lambda: file.read_text() == "#print(1)\n")
        await until(pilot, lambda: not app.is_typed_into)
