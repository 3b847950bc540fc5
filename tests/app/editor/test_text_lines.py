"""Lines of a running text in the same text after it was edited: light, breakpoints, run to the cursor."""

from __future__ import annotations

import pytest

from tests.app.app_help import notices, ready, settings, until
from tuisim.app.app import LabApp
from tuisim.app.editor.text_lines import MOST_COMPARED, LineMap, code_line


@pytest.mark.parametrize(
    ("line", "code"), [(1, 4), (2, 4), (3, 4), (4, 4), (5, 0)], ids=["magic", "comment", "blank", "code", "end"]
)
def test_a_breakpoint_is_on_the_next_line_of_code(line: int, code: int) -> None:
    assert code_line(["%%sim_magic", "  # words", "", "x = 1  # more", "# the end"], line) == code


@pytest.mark.parametrize(
    ("run", "shown", "to_shown"),
    [
        ("abc", "abc", [1, 2, 3]),
        ("abc", "xabc", [2, 3, 4]),
        ("abc", "axc", [1, 0, 3]),
        ("abcd", "xbyd", [0, 2, 0, 4]),
        ("abcdef", "acxdef", [1, 0, 2, 4, 5, 6]),
        ("aaa", "aaaa", [1, 2, 3]),
        ("abc", "", [0, 0, 0]),
        ("", "abc", []),
    ],
    ids=["same", "one before", "one changed", "two changed", "out and in", "alike", "all gone", "all new"],
)
def test_lines_in_common(run: str, shown: str, to_shown: list[int]) -> None:
    lines = LineMap(run, shown)
    assert [lines.to_shown(line) for line in range(1, len(run) + 1)] == to_shown
    assert all(lines.to_run(there) == line for line, there in enumerate(to_shown, 1) if there)
    assert lines.to_shown(0) == lines.to_run(0) == lines.to_shown(len(run) + 1) == 0


def test_of_a_text_that_is_all_new_only_its_ends_are_compared() -> None:
    many = [str(number) for number in range(MOST_COMPARED + 1)]
    lines = LineMap(["first", *many, "last"], ["first", "new", *many[::-1], "last"])
    assert (lines.to_shown(1), lines.to_shown(len(many) + 2)) == (1, len(many) + 3)
    assert lines.to_shown(5) == 0


TURNS = """\
import time
n = 0
while True:
    n = n + 1
    time.sleep(0.05)
    m = n
"""


@pytest.mark.slow
@pytest.mark.usefixtures("home")
async def test_breakpoints_and_light_stay_on_their_lines_when_a_held_program_is_edited() -> None:
    async with LabApp(settings(TURNS, speed=0.0)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)

        def at(line: int) -> bool:
            return app.debugger.view is not None and app.debugger.view.paused.line == line

        await pilot.press("n")
        await until(pilot, lambda: at(1))
        app.debugger.toggle_line(6)
        await pilot.press("d", "ctrl+home", "#", "enter", "escape")
        assert app.debugger.texts == ("7",)
        assert app.panel_area.code is not None
        area = app.panel_area.code._area
        await until(pilot, lambda: area._lit == 2)
        await pilot.press("space")
        await until(pilot, lambda: at(6) and area._lit == 7)
        # The cursor is on a line that the run does not have, then on one that it has elsewhere.
        area.move_cursor((0, 0))
        await pilot.press("L")
        assert "This line is not in the running text" in notices(app)
        area.move_cursor((4, 0))
        await pilot.press("L")
        await until(pilot, lambda: at(4) and area._lit == 5)
