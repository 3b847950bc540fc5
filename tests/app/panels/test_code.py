"""The code panel by itself: what it asks of the app, and a text that is loaded again."""

from __future__ import annotations

import pytest

from tests.app.app_help import until
from tests.app.code_help import CodeApp, alone
from tests.app.panel_help import moment, screen_text
from tuisim.app.panels.code import Code
from tuisim.app.snapshot import PauseView, RunPhase
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.state import Instant
from tuisim.engine.protocol import FrameState, Inspected, Paused, Variable

Keys = list[str]


async def test_code_says_no_program_only_once_that_is_known() -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        await pilot.pause()
        assert "No program" not in "".join(screen_text(app))
        app.query_one(Code).set_program("", "")
        await until(pilot, lambda: "No program" in "".join(screen_text(app)))


@pytest.mark.parametrize(
    "keys, wanted",
    [
        (["ctrl+s"], ["save"]),
        (["f5"], ["run"]),
        (["ctrl+f", "ctrl+s", "ctrl+r"], ["save", "run"]),
        (["enter", "ctrl+n", "ctrl+o"], ["new", "open"]),
        (["ctrl+n", "ctrl+o"], []),
    ],
    ids=["save", "run", "while finding", "while typing", "not typing"],
)
async def test_keys_in_the_code_panel_ask_the_app_to_save_or_run(
    keys: Keys, wanted: list[str]
) -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        await alone(pilot)
        await pilot.press(*keys)
        await pilot.pause()
        assert app.wishes == wanted


async def test_a_reload_keeps_cursor_and_scroll_and_can_be_undone() -> None:
    lines = [f"x{n} = {n}" for n in range(200)]
    async with CodeApp().run_test(size=(60, 12)) as pilot:
        code, area = await alone(pilot, "\n".join(lines))
        await pilot.press(*["pagedown"] * 5)
        await pilot.pause()
        before = area.scroll_offset.y, code.cursor_line
        lines[10] = "new"
        code.set_program("prog.py", "\n".join(lines), "prog")
        await pilot.pause()
        assert (area.scroll_offset.y, code.cursor_line) == before
        assert area.document.get_line(10) == "new"


async def test_a_text_saved_to_another_file_keeps_its_cursor() -> None:
    async with CodeApp().run_test(size=(60, 12)) as pilot:
        code, area = await alone(pilot, "x = 1\ny = 2\n")
        await pilot.press("enter", "down", "end")
        code.set_program("saved.py", area.program_text, "folder/saved.py")
        await pilot.pause()
        assert area.cursor_location == (1, 5)


async def test_the_line_that_runs_stays_in_sight_when_the_panel_shrinks() -> None:
    async with CodeApp().run_test(size=(60, 30)) as pilot:
        code, area = await alone(pilot, "\n".join(f"x{n} = {n}" for n in range(200)))
        code.show_line(20)
        await pilot.resize_terminal(60, 10)
        await until(
            pilot, lambda: area.scroll_offset.y <= 19 < area.scroll_offset.y + area.size.height
        )


async def test_showing_a_program_in_the_code_panel_does_not_change_its_text() -> None:
    texts = "", "\n", "a\n\n", "x = '\x0c\u2028\x85'\n", "\x1b[31m", "漢字 = 1\n", "\ta\n"
    async with CodeApp().run_test(size=(40, 8)) as pilot:
        for text in texts:
            _, area = await alone(pilot, text)
            assert area.program_text == text


LOOP = "total = 0\nfor n in range(9):\n    total = total + n * 100000000000\n    print(total)\n"


def pause(*variables: Variable) -> PauseView:
    stack = (FrameState("<module>", 4, ""),)
    return PauseView(
        Paused(321, 0, 4), Inspected(321, 0, "", 0, "", (), stack, variables, (), ()), False
    )


def pause_at_print(code: Code) -> None:
    """Show that the loop is paused."""
    code.set_running(LOOP)
    code.show(moment(state=RunPhase.PAUSED, line=4))
    code.show_pause(PAUSE)


PAUSE = pause(Variable("total", "int", "100000000000", True), Variable("n", "int", "1", False))


@pytest.mark.parametrize(
    "width, rows",
    [
        (
            70,
            [
                "total = 0",
                "for n in range(9):  n = 1",
                "total = total + n * 100000000000  total = 100000000000",
            ],
        ),
        (
            60,
            [
                "total = 0",
                "for n in range(9):  n = 1",
                "total = total + n * 100000000000  → 100000000000",
            ],
        ),
        (44, ["total = 0", "for n in range(9):  n = 1", "total = total + n *… → 100000000000"]),
    ],
    ids=["fits", "without the name", "instead of the end of the line"],
)
async def test_values_stand_behind_the_lines_that_assign_them(width: int, rows: list[str]) -> None:
    app = CodeApp()
    async with app.run_test(size=(width, 12)) as pilot:
        code, area = await alone(pilot, LOOP)
        pause_at_print(code)
        await pilot.pause()
        assert [area.render_line(y).text[5:].strip() for y in range(3)] == rows
        assert {area.render_line(y).cell_length for y in range(4)} == {width}
        assert area.program_text == LOOP


@pytest.mark.parametrize("then", ["go on", "another instant", "another run"])
async def test_values_beside_the_code_vanish_once_another_instant_is_shown(then: str) -> None:
    app = CodeApp()
    async with app.run_test(size=(70, 12)) as pilot:
        code, area = await alone(pilot, LOOP)
        pause_at_print(code)
        assert "n = 1" in area.render_line(1).text
        match then:
            case "go on":
                code.show_pause(None)
            case "another instant":
                code.show(
                    moment(
                        state=RunPhase.PAUSED,
                        line=4,
                        instant=Instant(322, Pose(0, 0, 0), 0, 0, 0, 0),
                    )
                )
            case _:
                code.set_running(None)
        assert "n = 1" not in area.render_line(1).text


async def test_values_follow_their_lines_in_an_edited_text() -> None:
    app = CodeApp()
    async with app.run_test(size=(70, 12)) as pilot:
        code, area = await alone(pilot, LOOP)
        pause_at_print(code)
        await pilot.press("enter", "ctrl+home", "number_sign", "enter")
        await until(pilot, lambda: area.render_line(2).text.rstrip().endswith("range(9):  n = 1"))
