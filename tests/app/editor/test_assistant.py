"""The keys of the list, the signature and the marks while one types."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import pytest
from textual import events
from textual.geometry import Offset
from textual.pilot import Pilot

from tests.app.app_help import open_lab, until
from tests.app.code_help import CodeApp, alone
from tests.app.panel_help import screen_text
from tests.running import PATIENCE_S
from tuisim.app.editor import area as area_module
from tuisim.app.editor import assistant, completion
from tuisim.app.editor.area import CodeArea
from tuisim.app.editor.completion import Candidate
from tuisim.app.panels.code import Code

SIZE = (80, 24)


async def typed(pilot: Pilot[Any], text: str, before: str = "") -> tuple[Code, CodeArea]:
    """Open a program, and type a text at its end."""
    code, area = await alone(pilot, before)
    await pilot.press("enter")
    area.move_cursor(area.document.end)
    area.insert_text(text)
    await pilot.pause()
    return code, area


async def listed(pilot: Pilot[Any], text: str) -> tuple[Code, CodeArea]:
    """Type a text with several names that may follow, and open their list."""
    code, area = await typed(pilot, text)
    await pilot.press("tab")
    await until(pilot, lambda: area.candidates.is_open)
    await pilot.pause()
    return code, area


@pytest.mark.slow
async def test_the_completion_library_is_loaded_only_when_typing_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    is_warm = Event()
    monkeypatch.setattr(completion, "preload", is_warm.set)
    monkeypatch.setattr(completion, "is_ready", lambda: False)
    async with CodeApp().run_test(size=SIZE) as pilot:
        await alone(pilot, "x = 1")
        await pilot.pause()
        assert not is_warm.is_set()
        await pilot.press("enter")
        await until(pilot, is_warm.is_set)


@pytest.mark.slow
async def test_tab_inserts_the_name_if_only_one_completes_the_word(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await typed(pilot, "tank_drive.of")
        await pilot.press("tab")
        await until(pilot, lambda: area.program_text == "tank_drive.off")
        assert not area.candidates.is_open


@pytest.mark.slow
@pytest.mark.parametrize(
    "keys, text",
    [
        (["enter"], "tank_drive.on"),
        (["down", "tab"], "tank_drive.off"),
        (["up", "enter"], "tank_drive.on_for_seconds"),
        (["n", "underscore", "enter"], "tank_drive.on_for_degrees"),
        (["n", "underscore", "backspace", "backspace", "enter"], "tank_drive.on"),
        (["pagedown", "enter"], "tank_drive.on_for_seconds"),
        (["escape"], "tank_drive.o"),
        (["left_parenthesis"], "tank_drive.on("),
        (["space"], "tank_drive.o "),
        (["x"], "tank_drive.ox"),
    ],
    ids=[
        "first",
        "next",
        "last",
        "filter",
        "filter and back",
        "page",
        "close",
        "the next character",
        "other character",
        "no such name",
    ],
)
async def test_arrows_with_tab_or_enter_insert_the_chosen_name_of_the_completion_list(
    home: Path, keys: list[str], text: str
) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await listed(pilot, "tank_drive.o")
        await pilot.press(*keys)
        await until(pilot, lambda: not area.candidates.is_open)
        await pilot.pause()
        assert area.program_text == text
        assert area.typing


@pytest.mark.slow
async def test_the_list_shows_names_signatures_and_help(home: Path) -> None:
    app = CodeApp()
    async with app.run_test(size=SIZE) as pilot:
        await listed(pilot, "tank_drive.o")
        await until(pilot, lambda: "Start rotating" in "".join(screen_text(app)))
        rows = "\n".join(screen_text(app))
        assert "▸on(left_speed, right_speed)" in rows
        assert " on_for_degrees(left_speed, right_speed, degrees, brake=True, block=True)" in rows


@pytest.mark.slow
async def test_what_is_typed_during_a_lookup_goes_on_with_the_name(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = Event()
    found = Candidate("tank_drive"), Candidate("tank_turn")

    def slow(*_: object) -> tuple[Candidate, ...]:
        answers.wait(PATIENCE_S)
        return found

    monkeypatch.setattr(area_module, "find_candidates", slow)
    async with open_lab("tan") as (pilot, app):
        code = app.query_one(Code)
        code.start_typing(at_end=True)
        await until(pilot, lambda: code.typing and code.query_one(CodeArea).has_focus)
        for key, character in (("tab", "\t"), ("full_stop", "."), ("o", "o"), ("n", "n")):
            app.post_message(events.Key(key, character))
        await until(pilot, lambda: str(code.border_subtitle) == "looking up …")
        answers.set()
        await until(pilot, lambda: code.query_one(CodeArea).program_text == "tank_drive.on")
        await until(pilot, lambda: "looking up" not in str(code.border_subtitle))


async def test_enter_during_a_lookup_chooses_nothing_from_the_list_that_follows(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = Event()

    def slow(*_: object) -> tuple[Candidate, ...]:
        answers.wait(PATIENCE_S)
        return Candidate("tank_drive"), Candidate("tank_turn")

    monkeypatch.setattr(area_module, "find_candidates", slow)
    async with open_lab("tan") as (pilot, app):
        code = app.query_one(Code)
        code.start_typing(at_end=True)
        await until(pilot, lambda: code.typing and code.query_one(CodeArea).has_focus)
        for key, character in (("tab", "\t"), ("enter", "\r"), ("o", "o")):
            app.post_message(events.Key(key, character))
        await until(pilot, lambda: str(code.border_subtitle) == "looking up …")
        answers.set()
        await until(pilot, lambda: code.query_one(CodeArea).program_text.endswith("o"))
        assert code.query_one(CodeArea).program_text == "tan\no"


@pytest.mark.slow
async def test_a_click_in_the_completion_list_inserts_that_name(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await listed(pilot, "tank_drive.o")
        await pilot.click(area.candidates, offset=(5, 2))
        await until(pilot, lambda: area.program_text == "tank_drive.on_for_degrees")
        assert area.has_focus


@pytest.mark.slow
async def test_the_completion_list_closes_when_the_cursor_or_focus_moves_away(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await listed(pilot, "tank_drive.o")
        await pilot.press("home")
        await until(pilot, lambda: not area.candidates.is_open)
        await pilot.press("end", "tab")
        await until(pilot, lambda: area.candidates.is_open)
        area.blur()
        await until(pilot, lambda: not area.candidates.is_open)


async def test_tab_after_a_name_that_nothing_begins_with_says_so(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await typed(pilot, "nothing_like_it")
        await pilot.press("tab")
        await until(
            pilot, lambda: "no known name begins with nothing_like_it" in str(code.border_subtitle)
        )
        assert area.program_text == "nothing_like_it"
        await pilot.press("backspace")
        await until(pilot, lambda: "no known name" not in str(code.border_subtitle))


async def test_tab_indents_in_a_comment_where_no_name_may_follow(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await typed(pilot, "x = 1  #")
        await pilot.press("tab")
        await until(pilot, lambda: area.program_text.startswith("x = 1  # "))


@pytest.mark.slow
async def test_the_frame_shows_the_signature_of_the_call(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await typed(pilot, "tank_drive.on(1, ")
        code._assistant.ask_signature()
        await until(pilot, lambda: "right_speed" in str(code.border_subtitle))
        assert str(code.border_subtitle) == "on(left_speed, [bold]right_speed[/bold])"
        area.insert_text(")")
        await until(pilot, lambda: "right_speed" not in str(code.border_subtitle))


@pytest.mark.slow
async def test_undefined_names_are_marked_in_the_editor_with_a_hint(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assistant, "CHECK_DELAY_S", 3600.0)
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await typed(pilot, "tank_drve.on(1)\n")
        assert not area.unknown
        code._assistant.check_names()
        assert [one.name for one in area.unknown] == ["tank_drve"]
        assert "did you mean" not in str(code.border_subtitle)
        await pilot.press("up")
        await until(pilot, lambda: "did you mean" in str(code.border_subtitle))
        assert str(code.border_subtitle) == "`tank_drve` is not defined: did you mean `tank_drive`?"
        area.candidates.open((Candidate("tank_drive"),), (0, 0), "tank", Offset(0, 0))
        assert not code._assistant.describe_cursor(80)
        area.candidates.close()
        area.replace("tank_drive", (0, 0), (0, 9))
        code._assistant.check_names()
        assert not area.unknown


async def test_a_bracket_that_is_not_closed_is_marked_once_the_cursor_has_left_its_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(assistant, "CHECK_DELAY_S", 3600.0)
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await typed(pilot, "    print(str(1)", "if True:\n")
        code._assistant.check_names()
        assert not area.unknown
        area.insert_text("\nb = 2")
        await pilot.pause()
        code._assistant.check_names()
        assert [(fault.row, fault.start, fault.name) for fault in area.unknown] == [
            (1, 4, "print(str(1)")
        ]
        area.move_cursor((1, 16))
        await until(pilot, lambda: str(code.border_subtitle) == "'(' was never closed")
        area.insert_text(")")
        code._assistant.check_names()
        assert not area.unknown


async def test_a_fault_in_the_line_of_the_cursor_is_marked_when_the_cursor_leaves(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(assistant, "CHECK_DELAY_S", 3600.0)
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await typed(pilot, "a = 1\nif a\nb = 2")
        area.move_cursor((1, 4))
        await pilot.pause()
        code._assistant.check_names()
        assert not area.unknown
        await pilot.press("down")
        await until(pilot, lambda: [fault.fault for fault in area.unknown] == ["expected ':'"])


async def test_a_program_is_checked_when_it_is_opened() -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await alone(pilot, "prnt('a')\n")
        assert [one.name for one in area.unknown] == ["prnt"]


async def test_a_narrow_code_panel_shows_the_hint_for_a_misspelt_name() -> None:
    async with CodeApp().run_test(size=(40, 12)) as pilot:
        code, _ = await alone(pilot, "tank_drve.on(1)\n")
        await until(pilot, lambda: str(code.border_subtitle) == "did you mean `tank_drive`?")


@pytest.mark.slow
async def test_unknown_attributes_are_marked_once_names_were_looked_up(home: Path) -> None:
    async with CodeApp().run_test(size=SIZE) as pilot:
        code, area = await listed(pilot, "tank_drive.onn(1)\ntank_drive.o")
        await pilot.press("enter")
        code._assistant.check_names()
        await until(pilot, lambda: [one.name for one in area.unknown] == ["onn"])


@pytest.mark.slow
async def test_typing_a_dot_opens_the_list_of_names_that_may_follow(home: Path) -> None:
    completion.preload()
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await typed(pilot, "tank_drive.")
        await until(pilot, lambda: area.candidates.is_open)
        await pilot.press("down", "enter")
        await until(pilot, lambda: area.program_text == "tank_drive.off")


@pytest.mark.slow
@pytest.mark.parametrize(
    "keys, text",
    [
        (["o", "left_parenthesis"], "tank_drive.o("),
        (["o", "n", "enter"], "tank_drive.on\n"),
        (["o", "n", "underscore", "enter"], "tank_drive.on_for_degrees"),
    ],
    ids=["another name", "a whole name", "a part of a name"],
)
async def test_typing_on_with_an_automatic_completion_list_open_inserts_no_name(
    home: Path, keys: list[str], text: str
) -> None:
    completion.preload()
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await typed(pilot, "tank_drive.")
        await until(pilot, lambda: area.candidates.is_open)
        await pilot.press(*keys)
        await until(pilot, lambda: area.program_text == text)


async def test_no_completion_list_opens_after_a_number_with_a_dot(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assistant, "ASK_DELAY_S", 0.0)
    monkeypatch.setattr(completion, "is_ready", lambda: True)
    async with CodeApp().run_test(size=SIZE) as pilot:
        _, area = await typed(pilot, "x = 3.")
        await pilot.pause()
        assert not area.candidates.is_open
