"""The welcome, later with what one may go on with; and a program with a syntax error, which opens at its line."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from threading import Event
from types import SimpleNamespace
from typing import Any

import pytest
from textual import events
from textual.widgets import OptionList

from tests.app.app_help import (
    lab,
    notices,
    open_lab,
    ready,
    screen_text,
    settings,
    until,
    until_shown,
    until_typing,
)
from tests.cases import cases
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.dialogs.chooser import Chooser
from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.dialogs.new_program import NewProgramDialog
from tuisim.app.dialogs.welcome import Welcome
from tuisim.app.editor.area import CodeArea
from tuisim.app.editor.text_file import keep_draft
from tuisim.app.setup.recent import Recent, list_recent
from tuisim.app.snapshot import IN_RUN, RunPhase
from tuisim.cli import run_command
from tuisim.commands import app as command
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

FIRST = AppSettings(spec=build_run_spec(Settings()), settings=Settings(), welcomes=True)
WRONG = "".join(f"x{number} = {number}\n" for number in range(60)) + "print((1)\n"


def is_closed(app: LabApp) -> bool:
    return not isinstance(app.screen, Welcome)


@pytest.mark.slow_cases("(120, 40)")
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=str)
async def test_the_welcome_appears_once(size: tuple[int, int], home: Path) -> None:
    for is_first in (True, False):
        async with open_lab(FIRST, size=size) as (pilot, app):
            if not is_first:
                assert is_closed(app)
            else:
                await until_shown(pilot, "4 Open a file")
                await pilot.press("escape")
                await until(pilot, partial(is_closed, app))


async def test_a_key_that_is_pressed_before_the_welcome_is_there_answers_it() -> None:
    app = LabApp(FIRST)
    async with app.run_test(size=(80, 24)) as pilot:
        assert not app.has_greeted
        app.post_message(events.Key("1", "1"))
        await until(pilot, lambda: isinstance(app.screen, NewProgramDialog))


CHOICES: dict[str, tuple[list[str], Any]] = {
    "new": (["1"], lambda app: isinstance(app.screen, NewProgramDialog)),
    "example by number": (["2"], lambda app: app.run_controller.state in {*IN_RUN, RunPhase.ENDED}),
    "example by enter": (
        ["down", "enter"],
        lambda app: app.run_controller.state in {*IN_RUN, RunPhase.ENDED},
    ),
    "learn": (
        ["down", "down", "enter"],
        lambda app: isinstance(app.screen, Chooser) and "Lessons" in app.screen.TITLE_TEXT,
    ),
    "help by its key": (["question_mark"], lambda app: "Search: words" in screen_text(app)),
    "quit by its key": (["q"], lambda app: not app.is_running or app._exit),
    "open": (
        ["4"],
        lambda app: isinstance(app.screen, Chooser) and "Lessons" not in app.screen.TITLE_TEXT,
    ),
}


@pytest.mark.quick_cases("new", "open")
@cases("keys, is_done", CHOICES)
async def test_each_choice_of_the_welcome_does_what_it_offers(
    keys: list[str], is_done: Any, home: Path
) -> None:
    async with open_lab(FIRST, size=(80, 24)) as (pilot, _):
        await pilot.press(*keys)
        await until(pilot, lambda: is_done(pilot.app))


DRAFTS: dict[str, tuple[str, str]] = {
    "of a new program": ("", "# %%sim_magic_preloaded -b Loop\nprint('kept')\n"),
    "of a file": ("mine.py", "print('kept')\n"),
}


@pytest.mark.slow_cases("of a file")
@cases("name, text", DRAFTS)
async def test_a_later_start_offers_unsaved_text_to_go_on_with(
    name: str, text: str, tmp_path: Path
) -> None:
    path = str(tmp_path / name) if name else ""
    if path:
        Path(path).write_text("print('before')\n")
    keep_draft(path, text)
    async with open_lab(FIRST) as (pilot, app):
        await until_shown(pilot, f"5 {name or 'new.py'}")
        await pilot.press("enter")
        await until_typing(pilot)
        assert app.query_one(CodeArea).program_text == text
        assert app.document.dirty
        assert name or app.run_controller.next_run.spec.world.background == "Loop"


async def test_the_selected_entry_of_the_welcome_never_changes_by_itself(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    keep_draft("", "print('kept')\n")
    is_found = Event()

    def list_late(name: str) -> list[Recent]:
        is_found.wait()
        return list_recent(name)

    monkeypatch.setattr("tuisim.app.setup.recent.list_recent", list_late)
    app = LabApp(FIRST)
    async with app.run_test(size=(80, 24)) as pilot:
        for _ in range(5):
            await pilot.pause()
        selected = [listed.highlighted for listed in app.screen.query(OptionList)]
        is_found.set()
        await until_shown(pilot, "5 new.py")
        assert {*selected, app.screen.query_one(OptionList).highlighted} == {5}


@pytest.mark.slow
async def test_all_that_the_first_welcome_offers_is_in_sight(tmp_path: Path) -> None:
    folder = tmp_path / ("far/" * 9 + "away")
    folder.mkdir(parents=True)
    for number in range(3):
        path = folder / f"a_program_with_a_name_{number}.py"
        path.write_text("tank_drive.on_for_seconds(9, 9, 0.1)\n")
        run_command(["run", str(path)])
    async with open_lab(FIRST, size=(80, 24)) as (pilot, _):
        await until_shown(pilot, "9 Run 2")
        await until_shown(pilot, "? shows all keys")
        assert "This is a robot lab." in screen_text(lab(pilot))


async def test_the_ways_to_begin_are_whole_on_a_narrow_screen(home: Path) -> None:
    async with open_lab(FIRST, size=(65, 58)) as (pilot, _):
        for words in ("mat, sensor and skeleton", "logs them", "a line follower", "an example"):
            await until_shown(pilot, words)


@pytest.mark.slow
async def test_the_footer_below_the_welcome_names_only_keys_that_work_there() -> None:
    async with open_lab("print(1)", size=(80, 24)) as (pilot, app):
        await pilot.press("f4")
        await until_shown(pilot, "Welcome to tuisim")
        await until_shown(pilot, "enter choose esc close o open M lessons ? help q quit")
        await pilot.press("R", "l", "d")
        await pilot.pause()
        assert not is_closed(app)
        assert not app.run_controller.run_id
        await pilot.press("o")
        await until(pilot, lambda: isinstance(app.screen, Chooser))


def test_every_dialog_tells_the_footer_its_own_keys() -> None:
    kinds: list[type[Dialog[Any]]] = [Dialog]
    for kind in kinds:
        kinds += kind.__subclasses__()
    assert [kind for kind in kinds if not isinstance(kind.keys, property)] == []


NAMED: dict[str, tuple[dict[str, Any], bool]] = {
    "nothing": ({}, True),
    "glyphs": ({"settings": {"cells": "half"}}, True),
    "program": ({"words": ("log_greys",)}, False),
    "mat": ({"settings": {"background": "Loop"}}, False),
}


@cases("given, is_empty", NAMED)
def test_the_welcome_is_for_those_who_name_nothing(given: dict[str, Any], is_empty: bool) -> None:
    none: dict[str, Any] = {"words": (), "world": None, "goals": None, "run": None, "settings": {}}
    opened = command.read_opened(SimpleNamespace(**{**none, **given}))
    assert opened is not None
    assert opened.is_empty is is_empty


@pytest.mark.slow_cases("(120, 40)")
@pytest.mark.parametrize("size", [(80, 24), (120, 40), (59, 14)], ids=str)
async def test_a_program_with_a_syntax_error_opens_at_its_line(size: tuple[int, int]) -> None:
    async with open_lab(WRONG, size=size) as (pilot, app):
        await until_shown(pilot, "print((1)")
        code = app.panel_area.code
        assert code is not None
        assert code.error_line == 61
        # No notice: the reason stays at the mark.
        assert notices(app) == []
        # It is written once the panel knows its width.
        await until(pilot, lambda: "line 61" in str(code.border_subtitle))


async def test_a_program_without_errors_opens_without_a_notice() -> None:
    async with LabApp(settings("print('A: 1')\n")).run_test(size=(80, 24)) as pilot:
        assert notices(await ready(pilot)) == []
