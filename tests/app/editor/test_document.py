"""Editing a program in the app: typing, saving, running, unsaved work, files that change elsewhere."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import (
    notices,
    open_lab,
    program_of,
    screen_text,
    until,
    until_shown,
    until_state,
    until_typing,
)
from tuisim.app.actions.files import open_path
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.dialogs.question import Question
from tuisim.app.dialogs.save import ProgramDialog
from tuisim.app.editor.area import CodeArea
from tuisim.app.editor.text_file import find_draft, keep_draft
from tuisim.app.panels.code import Code
from tuisim.app.snapshot import RunPhase
from tuisim.base.folders import programs_folder
from tuisim.programs.program_file import build_program, list_programs, read_program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

TEXT = "print('A: 1')\nfor n in range(3):\n    print('B: ' + str(n))\n"


def own(path: Path, text: str = TEXT) -> AppSettings:
    """The app with a program that is in a file."""
    if not path.exists():
        path.write_text(text)
    program = read_program(path).program
    spec = build_run_spec(Settings({"background": "Empty_Map"}))
    return AppSettings(spec=spec, program=program)


@asynccontextmanager
async def open_code(opened: AppSettings) -> AsyncIterator[tuple[Pilot[Any], LabApp, Code]]:
    """Open the app and wait until it shows its program."""
    async with open_lab(opened) as (pilot, app):
        await until(pilot, lambda: app.panel_area.code is not None)
        assert app.panel_area.code is not None
        yield pilot, app, app.panel_area.code


async def typed(pilot: Pilot[Any], code: Code, *keys: str) -> None:
    """Type at the start of the text."""
    await pilot.press("d")
    await until(pilot, lambda: code.typing)
    await pilot.press(*keys)
    await pilot.pause()


async def asked(pilot: Pilot[Any]) -> Question:
    await until(pilot, lambda: isinstance(pilot.app.screen, Question))
    await pilot.pause()
    assert isinstance(pilot.app.screen, Question)
    return pilot.app.screen


@pytest.mark.slow
async def test_edited_text_runs_unsaved_and_is_stored_with_the_run(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, *"print", "left_parenthesis", "7", "right_parenthesis", "enter")
        assert str(code.border_title).endswith("Code: prog.py • edited")
        await pilot.press("ctrl+r")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.pause()
        assert app.run_controller.timeline.recording is not None
        assert app.run_controller.timeline.recording.program.text == "print(7)\n" + TEXT
        assert path.read_text() == TEXT
        await pilot.press("f3")
        await pilot.pause()
        assert path.read_text() == "print(7)\n" + TEXT
        assert str(code.border_title).endswith("Code: prog.py")
        assert find_draft(str(path)) is None


@pytest.mark.slow
async def test_a_mistake_is_saved_and_marked(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, "enter", "i", "f", "space", "ctrl+s")
        assert path.read_text() == "\nif " + TEXT
        assert any("line 2" in text and "is saved" in text for text in notices(app))
        assert "✗ 2 if print" in screen_text(app)


@pytest.mark.slow
async def test_the_key_for_errors_goes_to_the_line_that_does_not_compile(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await pilot.press("exclamation_mark")
        await until(pilot, lambda: any("No run yet" in text for text in notices(app)))
        await pilot.press("ctrl+r")
        await until_state(pilot, RunPhase.ENDED)
        await typed(pilot, code, "enter", "i", "f", "space", "ctrl+r", "ctrl+end", "escape")
        app.clear_notifications()
        await pilot.press("exclamation_mark")
        await until(pilot, lambda: any("cannot run: line 2" in text for text in notices(app)))
        assert code.error_line == 2
        await until(pilot, lambda: app.query_one(CodeArea).cursor_location[0] == 1)


@pytest.mark.slow
async def test_a_program_opened_without_its_mat_runs_only_on_one_that_is_chosen(
    tmp_path: Path,
) -> None:
    wrong = "# %%sim_magic_preloaded -b Grey_bnds\n" + TEXT
    async with open_code(own(tmp_path / "prog.py", wrong)) as (pilot, app, code):
        await until(pilot, lambda: code.error_line == 1)
        told = "prog.py cannot run: line 1: no such mat 'Grey_bnds', did you mean Grey_bands?"
        assert "prog.py cannot run" in screen_text(app)
        assert str(code.border_subtitle) == "no Grey_bnds: did you mean Grey_bands?"
        assert not app.document.apply()
        await pilot.pause()
        assert told in notices(app)
        assert code.error_line == 1
        app.loader.change_mat("Square")
        assert app.document.apply()


async def test_after_a_syntax_error_a_code_panel_shown_alone_stays_alone(
    tmp_path: Path,
) -> None:
    async with open_lab(own(tmp_path / "prog.py"), size=(80, 24)) as (pilot, app):
        await pilot.press("d")
        await until(pilot, lambda: app.panel_area.alone == "code")
        await pilot.press("i", "f", "enter", "ctrl+r")
        await until(
            pilot, lambda: app.panel_area.code is not None and app.panel_area.code.error_line == 1
        )
        await pilot.pause()
        assert app.panel_area.alone == "code"


@pytest.mark.slow
async def test_an_example_is_saved_to_another_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    example = list_programs()[0]
    before = example.path.read_bytes()
    async with open_code(own(example.path)) as (pilot, app, code):
        await typed(pilot, code, "#", "enter", "ctrl+s")
        await until(pilot, lambda: isinstance(app.screen, ProgramDialog))
        await pilot.press("enter")
        await until(pilot, lambda: not isinstance(app.screen, ProgramDialog))
        assert (tmp_path / example.name).read_bytes() == b"#\n" + before
        assert example.path.read_bytes() == before
        assert program_of(app).path == str(tmp_path / example.name)


WRONG = "print('A: 1')\nfor n in range(3):\n    n.x\n"


@pytest.mark.slow_cases("panel shown")
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["panel hidden", "panel shown"])
async def test_after_an_error_typing_begins_on_its_line(
    size: tuple[int, int], tmp_path: Path
) -> None:
    async with open_lab(own(tmp_path / "prog.py", WRONG), size=size) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press("d")
        await until_typing(pilot)
        assert app.panel_area.code is not None
        await until(
            pilot, lambda: app.panel_area.code is not None and app.panel_area.code.error_line == 3
        )
        assert app.query_one(CodeArea).cursor_location == (2, 4)


@pytest.mark.slow
async def test_no_line_is_marked_any_more_once_the_file_was_mended_elsewhere(
    tmp_path: Path,
) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path, WRONG)) as (pilot, app, code):
        await pilot.press("R")
        await until(pilot, lambda: code.error_line == 3)
        path.write_text(WRONG.replace("n.x", "n + 1"))
        app.check_files()
        await pilot.pause()
        assert "n + 1" in code.query_one(CodeArea).program_text
        assert code.error_line == 0


@pytest.mark.slow
async def test_ctrl_s_saves_the_world_outside_the_editor(tmp_path: Path) -> None:
    async with open_code(own(tmp_path / "prog.py")) as (pilot, _, code):
        await typed(pilot, code, "x", "escape", "escape")
        await pilot.press("ctrl+s")
        await until_shown(pilot, "Save the world")


@pytest.mark.quick_cases("save")
@pytest.mark.parametrize(
    "answer, in_file", [("s", "x" + TEXT), ("d", TEXT)], ids=["save", "discard"]
)
async def test_leaving_with_unsaved_changes_asks(answer: str, in_file: str, tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, "x", "escape", "escape")
        await until(pilot, lambda: find_draft(str(path)) is not None)
        for key, expected, left in (("escape", TEXT, False), (answer, in_file, True)):
            await pilot.press("q")
            await asked(pilot)
            await pilot.press(key)
            await pilot.pause()
            assert path.read_text() == expected
            assert app._exit is left
            assert (find_draft(str(path)) is None) is left


@pytest.mark.slow
async def test_opening_another_program_with_unsaved_changes_asks(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    other = tmp_path / "other.py"
    other.write_text("print('other')\n")
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, "x", "escape")
        open_path(app.context, str(other))
        await asked(pilot)
        await pilot.press("d")
        await until_shown(pilot, "print('other')")
        assert path.read_text() == TEXT
        assert not app.document.dirty


@pytest.mark.quick_cases("later")
@pytest.mark.parametrize(
    "answer, shown, kept",
    [
        ("r", "draft = 1\n", True),
        ("ctrl+d", TEXT, False),
        ("escape", TEXT, True),
        ("d", None, True),
    ],
    ids=["restore", "discard", "later", "a key of the app"],
)
async def test_a_draft_is_offered(
    answer: str, shown: str | None, kept: bool, tmp_path: Path
) -> None:
    path = tmp_path / "prog.py"
    keep_draft(str(path), "draft = 1\n")
    async with open_code(own(path)) as (pilot, app, code):
        await asked(pilot)
        assert "3 lines differ" in screen_text(app)
        await pilot.press(answer)
        await pilot.pause()
        assert isinstance(app.screen, Question) is (shown is None)
        assert code.query_one(CodeArea).program_text == (shown or TEXT)
        is_restored = answer == "r"
        assert app.document.dirty is is_restored
        await until(
            pilot,
            lambda: any("unsaved text is back" in words for words in notices(app)) is is_restored,
        )
    assert (find_draft(str(path)) is not None) is kept


@pytest.mark.slow
async def test_an_edit_is_stored_as_draft_soon_and_the_draft_goes_when_undone(
    tmp_path: Path,
) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, "x")
        await until(pilot, lambda: find_draft(str(path)) is not None)
        await pilot.press("ctrl+z")
        await until(pilot, lambda: find_draft(str(path)) is None)
        assert not app.document.dirty


async def test_an_opened_example_is_called_one_and_says_where_its_changes_go() -> None:
    async with open_code(own(programs_folder() / "square.py")) as (pilot, app, code):
        await until(pilot, lambda: any("the example square.py" in word for word in notices(app)))
        assert f"saves a copy into {Path.cwd().name}/" in "".join(notices(app))
        await typed(pilot, code, "x", "escape")
        app.document.run_when_saved(lambda: None)
        await asked(pilot)
        assert "Save them into a file of yours" in screen_text(app)


@pytest.mark.quick_cases("mine")
@pytest.mark.parametrize(
    "answer, shown", [("k", "x" + TEXT), ("t", "other = 1\n")], ids=["mine", "file"]
)
async def test_a_file_changed_on_disk_under_unsaved_edits_is_asked_about(
    answer: str, shown: str, tmp_path: Path
) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        await typed(pilot, code, "x", "escape")
        path.write_text("other = 1\n")
        app.check_files()
        await asked(pilot)
        await pilot.press(answer)
        await pilot.pause()
        assert code.query_one(CodeArea).program_text == shown
        assert app.document.dirty is (answer == "k")


@pytest.mark.slow
async def test_changing_the_mat_keeps_unsaved_edits(tmp_path: Path) -> None:
    async with open_code(own(tmp_path / "prog.py")) as (pilot, app, code):
        await typed(pilot, code, "x", "escape")
        app.loader.change_mat("Grey_bands")
        await pilot.pause()
        assert code.query_one(CodeArea).program_text == "x" + TEXT
        assert app.document.dirty


@pytest.mark.slow
async def test_an_edited_magic_line_changes_the_world_when_it_runs(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    text = "%%sim_magic_preloaded -x 300\nprint('A: 1')\n"
    async with open_code(own(path, text)) as (pilot, app, code):
        assert "%%sim_magic_preloaded -x 300" in screen_text(app)
        await typed(pilot, code, *["right"] * 25, "delete", "5", "escape")
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        assert app.run_controller.timeline.recording is not None
        assert app.run_controller.timeline.recording.spec.world.start.x_mm == 500


@pytest.mark.slow
async def test_a_file_that_may_not_be_written_is_saved_elsewhere(tmp_path: Path) -> None:
    path = tmp_path / "prog.py"
    async with open_code(own(path)) as (pilot, app, code):
        path.chmod(0o444)
        if os.access(path, os.W_OK):
            # The superuser may write it all the same, and does.
            await typed(pilot, code, "x", "ctrl+s")
            assert path.read_text() == "x" + TEXT
            return
        await typed(pilot, code, "x", "ctrl+s")
        await until(pilot, lambda: isinstance(app.screen, ProgramDialog))


@pytest.mark.parametrize("exists", [True, False], ids=["an empty file", "a new file"])
async def test_saving_a_program_begun_in_an_empty_file_asks_nothing(
    exists: bool, tmp_path: Path
) -> None:
    path = tmp_path / "mine.py"
    if exists:
        path.touch()
    program = build_program("", path, path.name).program
    spec = build_run_spec(Settings({"background": "Empty_Map"}))
    async with open_code(AppSettings(spec=spec, program=program)) as (pilot, app, code):
        await typed(pilot, code, "x", "ctrl+s")
        await until(pilot, lambda: path.exists() and path.read_text() == "x")
        assert not app.document.dirty


async def test_a_program_with_a_wrong_option_in_its_first_line_opens_but_does_not_run(
    tmp_path: Path,
) -> None:
    path = tmp_path / "prog.py"
    path.write_text("# %%sim_magic_preloaded -A 90\n" + TEXT)
    async with open_code(own(tmp_path / "other.py")) as (pilot, app, code):
        open_path(app.context, str(path))
        await until(pilot, lambda: code.error_line == 1)
        assert program_of(app).name == "prog.py"
        app.clear_notifications()
        await pilot.press("R")
        await until(pilot, lambda: any("cannot run: line 1" in text for text in notices(app)))
        assert app.run_controller.run is None
