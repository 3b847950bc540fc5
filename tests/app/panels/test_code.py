"""The code panel by itself: typing, marks, the line that is lit, finding."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import until
from tests.app.panel_help import PanelApp, moment, screen_text
from tuisim.app.editor.area import CodeArea
from tuisim.app.panels.code import Code

TEXT = "print('A: 1')\nfor n in range(3):\n    print('B: ' + str(n))\n"


class CodeApp(PanelApp[Code]):
    """The code panel alone."""

    def __init__(self) -> None:
        super().__init__(Code())
        self.wishes: list[int | str] = []

    def on_code_breakpoint_toggled(self, message: Code.BreakpointToggled) -> None:
        """Keep the line."""
        self.wishes.append(message.line)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        """Keep what is wanted."""
        self.wishes.append(message.command)


async def alone(pilot: Pilot[Any], text: str = TEXT) -> tuple[Code, CodeArea]:
    code = pilot.app.query_one(Code)
    code.set_program("prog.py", text, "prog")
    area = code.query_one(CodeArea)
    area.focus()
    await pilot.pause()
    return code, area


Keys = list[str]


@pytest.mark.quick_cases("after a colon", "indented line", "comment", "undo", "letters are no text")
@pytest.mark.parametrize(
    ("keys", "after"),
    [
        (["x", "R", "space"], TEXT),
        (["enter", "x"], "x" + TEXT),
        (["enter", "x", "escape", "y"], "x" + TEXT),
        (["enter", "x", "ctrl+z"], TEXT),
        (["enter", "x", "ctrl+z", "ctrl+y"], "x" + TEXT),
        (["enter", "tab"], "    " + TEXT),
        (["enter", "shift+down", "shift+down", "tab"], "    " + TEXT.replace("for", "    for")),
        (["down", "down", "enter", "shift+tab"], TEXT.replace("    ", "")),
        (["enter", "ctrl+underscore"], "# " + TEXT),
        (["down", "enter", "end", "enter", "p"], TEXT.replace(":\n", ":\n    p\n")),
        (["down", "down", "down", "enter", "i", "f", "colon", "enter", "p"], TEXT + "if:\n    p"),
        (["down", "down", "enter", "home", "backspace"], TEXT.replace("    ", "")),
        (["down", "down", "enter", "home", "right", "backspace"], TEXT.replace("    p", "    ")),
        (["down", "enter", "ctrl+a", "x"], "x"),
        (["enter", "ctrl+end", "x"], TEXT + "x"),
        (["down", "enter", "end", "ctrl+home", "x"], "x" + TEXT),
        (["enter", "shift+end", "ctrl+x", "down", "ctrl+v"], "\nprint('A: 1')" + TEXT.split("\n", 1)[1]),
    ],
    ids=[
        "letters are no text", "typing", "escape ends it", "undo", "redo", "tab", "indent", "outdent",
        "comment", "indented line", "after a colon", "backspace in an indent", "backspace in code", "select all",
        "end of the text", "start of the text", "cut and paste",
    ],
)  # fmt: skip
async def test_keys_change_the_text(keys: Keys, after: str) -> None:
    async with CodeApp().run_test(size=(60, 12)) as pilot:
        _, area = await alone(pilot)
        await pilot.press(*keys)
        assert area.program_text == after


async def test_it_says_that_there_is_no_program_only_when_it_knows() -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        await pilot.pause()
        assert "No program" not in "".join(screen_text(app))
        app.query_one(Code).set_program("", "")
        await until(pilot, lambda: "No program" in "".join(screen_text(app)))


async def test_no_line_is_wrapped_and_the_rest_is_scrolled_to() -> None:
    app = CodeApp()
    async with app.run_test(size=(30, 12)) as pilot:
        await alone(pilot, "colorLeft.reflected_light_intensity_pc\nprint(1)\n")
        await until(pilot, lambda: [row.split()[0] for row in screen_text(app)[:2]] == ["1", "2"])
        assert screen_text(app)[0].endswith("…")
        await pilot.press("enter", "end")
        await until(pilot, lambda: "intensity_pc" in screen_text(app)[0])
        await pilot.press("escape")
        await until(pilot, lambda: "1 colorLeft" in screen_text(app)[0])


async def test_the_gutter_shows_marks_and_tells_of_clicks() -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        code, area = await alone(pilot)
        code.set_marks({1: "●", 2: "◆"})
        code.mark_error(3)
        code.show(moment(line=1))
        await pilot.pause()
        text = "\n".join(strip.text.rstrip() for strip in app.screen._compositor.render_strips())
        assert text.splitlines()[:3] == [
            "●▶ 1 print('A: 1')",
            "◆  2 for n in range(3):",
            " ✗ 3     print('B: ' + str(n))",
        ]
        await pilot.click(area, offset=(2, 1))
        await pilot.click(area, offset=(2, 9))
        await pilot.click(area, offset=(9, 2))
        assert app.wishes == [2]
        assert code.cursor_line == 3


async def test_a_line_is_lit_only_while_it_is_the_one_that_runs() -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        code, area = await alone(pilot)
        code.set_running(TEXT)
        code.show(moment(line=2))
        await pilot.press("down", "enter", "x")
        await pilot.pause()
        assert "▶" not in "".join(area.render_line(y).text for y in range(4))
        assert str(code.border_subtitle).startswith("running text differs")
        await pilot.press("backspace")
        await pilot.pause()
        assert area.render_line(1).text.startswith(" ▶ 2")
        assert "differs" not in str(code.border_subtitle)


async def test_finding_goes_round_and_says_where_it_is() -> None:
    app = CodeApp()
    async with app.run_test(size=(60, 12)) as pilot:
        code, area = await alone(pilot)
        await pilot.press("ctrl+f", *"print")
        await pilot.pause()
        assert area.selected_text == "print"
        assert code.cursor_line == 1
        await pilot.press("enter")
        await pilot.pause()
        assert code.cursor_line == 3
        assert "2 of 2" in app.screen._compositor.render_strips()[-1].text
        await pilot.press("down")
        await pilot.pause()
        assert code.cursor_line == 1
        await pilot.press("escape", "shift+f3")
        await pilot.pause()
        assert code.cursor_line == 3
        await pilot.press("ctrl+g", "2", "enter")
        await pilot.pause()
        assert code.cursor_line == 2


@pytest.mark.parametrize(
    ("keys", "wanted"),
    [
        (["ctrl+s"], ["save"]),
        (["f5"], ["run"]),
        (["ctrl+f", "ctrl+s", "ctrl+r"], ["save", "run"]),
        (["enter", "ctrl+n", "ctrl+o"], ["new", "open"]),
        (["ctrl+n", "ctrl+o"], []),
    ],
    ids=["save", "run", "while finding", "while typing", "not typing"],
)
async def test_keys_ask_the_app(keys: Keys, wanted: list[str]) -> None:
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


@pytest.mark.parametrize("text", ["", "\n", "a\n\n", "x = '\x0c\u2028\x85'\n", "\x1b[31m", "漢字 = 1\n", "\ta\n"])
async def test_no_text_is_changed_by_being_shown(text: str) -> None:
    async with CodeApp().run_test(size=(40, 8)) as pilot:
        _, area = await alone(pilot, text)
        assert area.program_text == text
