"""The footer names keys that work where the focus is."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from tests.app.app_help import LOGS, ready, screen_text, settings, until
from tuisim.app.actions.table import Situation, working
from tuisim.app.app import LabApp
from tuisim.app.keys.footer import fitting
from tuisim.app.snapshot import ENDED

pytestmark = pytest.mark.usefixtures("home")


@pytest.mark.parametrize("width", [80, 100, 120])
def test_after_a_run_the_next_steps_of_a_student_come_first(width: int) -> None:
    status = " time limit max "
    shown = fitting(working(Situation(ENDED, has_program=True, has_run=True)), width - len(status))
    assert [action.footer_key or action.key for action in shown][:5] == ["R", "l", "e", "c", "d"]


FAILS = "print('Colour: 1')\n1 / 0\n"


async def test_the_state_of_a_run_that_failed_is_a_warning() -> None:
    async with LabApp(settings(FAILS, autorun=True, speed=0.0)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        warning = app.key_footer.get_component_rich_style("footer--failed").color

        def said() -> list[object]:
            pieces = (piece for row in app.screen._compositor.render_strips() for piece in row)
            return [one.style.color for one in pieces if one.style and one.text.split()[:1] == ["error"]]

        # In the footer, the instrumentation and the simulator controls.
        await until(pilot, lambda: len(said()) == 3)
        assert said() == [warning] * 3


def footer(app: LabApp) -> str:
    return screen_text(app).split("\n")[-1]


async def test_letters_that_are_typed_are_not_offered_as_keys() -> None:
    shown = frozenset({"code", "noise"})
    async with LabApp(settings(LOGS, panels_on=shown)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        await until(pilot, lambda: "R run" in footer(app))
        await pilot.press("d")
        await until(pilot, lambda: "esc done" in footer(app))
        assert "R run" not in footer(app)
        await pilot.press("escape")
        await until(pilot, lambda: "R run" in footer(app))
        app.query_one("#light-number", Input).focus()
        await until(pilot, lambda: "⏎ take it" in footer(app) and "R run" not in footer(app))
        await pilot.press("escape")
        await until(pilot, lambda: "R run" in footer(app))
