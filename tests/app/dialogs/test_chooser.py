"""The dialog that opens programs: a path can be typed at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.app import App
from textual.widgets import Input
from textual.widgets._toast import Toast

from tuisim.app.dialogs.chooser import ChoiceGroup, Chooser, files_here


async def test_what_is_typed_goes_into_the_field_and_is_chosen() -> None:
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(
            Chooser("Open", [ChoiceGroup("Here", [("a.py", "a.py", "first")])], path_hint="path"), chosen.append
        )
        await pilot.pause()
        await pilot.press(*"nope.py", "enter")
        await pilot.pause()
    assert chosen == ["nope.py"]


async def test_enter_without_typing_takes_the_list() -> None:
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(
            Chooser("Open", [ChoiceGroup("", [("a.py", "a.py", "first")])], path_hint="path"), chosen.append
        )
        await pilot.pause()
        assert not app.screen.query_one(Input).has_focus
        await pilot.press("down", "enter")
        await pilot.pause()
    assert chosen == ["a.py"]


def test_the_second_file_of_an_export_is_not_listed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("robot.json", "log.csv", "log.csv.json", "my.robot.json"):
        Path(name).touch()
    assert [name for _, name, _ in files_here([".json"]).entries] == ["my.robot.json", "robot.json"]


async def test_what_was_said_before_covers_no_row_of_it() -> None:
    app: App[None] = App()
    async with app.run_test(notifications=True) as pilot:
        app.notify("said before")
        await pilot.pause()
        app.push_screen(Chooser("Open", [ChoiceGroup("", [("a.py", "a.py", "first")])]))
        await pilot.pause()
        assert not app.screen.query(Toast)
