"""Dialogs that ask for a file."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.widgets import Input

from tests.app.app_help import (
    notices,
    open_lab,
    ready,
    screen_text,
    settings,
    until,
    until_state,
)
from tuisim.app.app import LabApp
from tuisim.app.snapshot import RunPhase

NO_NAMES = {
    "too long": "x" * 300 + ".toml",
    "of nobody's home": "~no-such-user/lab.toml",
    "with a zero": "a\0b.toml",
}


@pytest.mark.quick_cases("ctrl+s")
@pytest.mark.parametrize("key", ["ctrl+s", "o"])
async def test_what_cannot_be_the_name_of_a_file_is_refused(key: str) -> None:
    async with LabApp(settings()).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        for kind, name in NO_NAMES.items():
            await pilot.press(key)
            dialog = app.screen
            field = app.screen.query_one(Input)
            field.focus()
            field.value = name
            await pilot.press("enter")
            await until(pilot, lambda: "cannot be the name of a file" in screen_text(app), kind)
            assert app.screen is dialog, kind
            await pilot.press("escape")
            await until(pilot, lambda: len(app.screen_stack) == 1, kind)
            app.clear_notifications()
            await until(pilot, lambda: "cannot be the name of a file" not in screen_text(app), kind)


async def test_an_export_without_rows_says_so(tmp_path: Path) -> None:
    async with open_lab("print('hello')\n", autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("e")
        await until(pilot, lambda: bool(app.screen.query(Input)))
        app.screen.query_one(Input).value = str(tmp_path / "log.csv")
        await pilot.press("enter")
        await until(pilot, lambda: "0 rows saved to" in "".join(notices(app)))
        assert (tmp_path / "log.csv").is_file()
