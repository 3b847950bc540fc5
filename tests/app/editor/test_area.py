"""The editor's text area: keys, gutter, light, finding."""

from __future__ import annotations

import pytest

from tests.app.app_help import until
from tests.app.code_help import TEXT, CodeApp, alone
from tests.app.panel_help import moment, screen_text
from tuisim.engine.protocol import Variable

Keys = list[str]


@pytest.mark.quick_cases("letters*", "typing", "redo", "outdent", "comment", "after*", "cut*")
@pytest.mark.parametrize(
    "keys, after",
    [
        (["x", "R", "space"], TEXT),
        (["enter", "x"], "x" + TEXT),
        (["enter", "x", "escape", "y"], "x" + TEXT),
        (["enter", "x", "ctrl+z", "ctrl+y"], "x" + TEXT),
        (["enter", "shift+down", "shift+down", "tab"], "    " + TEXT.replace("for", "    for")),
        (["down", "down", "enter", "shift+tab"], TEXT.replace("    ", "")),
        (["enter", "ctrl+underscore"], "# " + TEXT),
        (["down", "enter", "end", "enter", "p"], TEXT.replace(":\n", ":\n    p\n")),
        (["down", "down", "down", "enter", "i", "f", "colon", "enter", "p"], TEXT + "if:\n    p"),
        (["down", "down", "enter", "home", "backspace"], TEXT.replace("    ", "")),
        (["down", "down", "enter", "home", "right", "backspace"], TEXT.replace("    p", "    ")),
        (
            ["enter", "shift+end", "ctrl+x", "down", "ctrl+v"],
            "\nprint('A: 1')" + TEXT.split("\n", 1)[1],
        ),
    ],
    ids=[
        "letters are no text",
        "typing",
        "escape ends it",
        "redo",
        "indent",
        "outdent",
        "comment",
        "indented line",
        "after a colon",
        "backspace in an indent",
        "backspace in code",
        "cut and paste",
    ],
)
async def test_keys_edit_the_programs_text_only_while_typing(keys: Keys, after: str) -> None:
    async with CodeApp().run_test(size=(60, 12)) as pilot:
        _, area = await alone(pilot)
        await pilot.press(*keys)
        assert area.program_text == after


@pytest.mark.slow
async def test_the_editor_scrolls_back_to_the_left_once_the_cursor_fits_in_view() -> None:
    async with CodeApp().run_test(size=(40, 12)) as pilot:
        _, area = await alone(pilot)
        await pilot.press("enter", *"x" * 40)
        await until(pilot, lambda: area.scroll_offset.x > 0)
        await pilot.press("enter")
        await until(pilot, lambda: area.scroll_offset.x == 0)
        assert area.cursor_location == (1, 0)
        # In a line that has a start in view, too.
        await pilot.press(*"x" * 28)
        await until(pilot, lambda: area.scroll_offset.x == 0)


async def test_the_keys_of_layouts_select_text_only_while_one_types() -> None:
    async with CodeApp().run_test(size=(60, 12)) as pilot:
        _, area = await alone(pilot)
        await pilot.press("f7", "f6")
        assert area.selection.is_empty
        await pilot.press("enter", "f7")
        assert area.selected_text == TEXT


@pytest.mark.slow
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


async def test_of_a_long_value_the_beginning_is_in_sight() -> None:
    app = CodeApp()
    async with app.run_test(size=(35, 12)) as pilot:
        _, area = await alone(pilot, "level = read()\n")
        area.set_values({1: [Variable("level", "list", "[" + "1, " * 99 + "1]", False)]})
        await pilot.pause()
        assert screen_text(app)[0].strip() == "1 level = read()  → [1, 1, 1, 1…"


async def test_the_editors_gutter_shows_breakpoints_and_errors_and_reports_clicks() -> None:
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


async def test_the_running_line_is_not_marked_once_the_text_differs_from_the_run() -> None:
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


async def test_search_in_the_editor_wraps_around_and_counts_its_matches() -> None:
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
        await pilot.press("up")
        await pilot.pause()
        assert code.cursor_line == 3
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("ctrl+g", "2", "enter")
        await pilot.pause()
        assert code.cursor_line == 2
