"""What the panels tell the app."""

from __future__ import annotations

import pytest
from textual.widgets import Input, Static

from tests.app.app_help import LOGS, open_lab, until
from tuisim.engine.core.geometry import Pose


@pytest.mark.slow
async def test_an_invalid_position_typed_is_refused_with_a_reason() -> None:
    async with open_lab(LOGS, panels_on=frozenset({"positioning"})) as (pilot, app):
        await until(pilot, lambda: len(app.query("Positioning Input")) == 3)
        for field, typed, message in (
            ("x", "abc", "X: a number from -10000 to 10000, not 'abc'"),
            ("x", "nan", "X: a number from -10000 to 10000, not 'nan'"),
            ("x", "150", "Enter: type and place"),
            ("y", "1e9", "Y: a number from -10000 to 10000, not '1e9'"),
            ("y", "500", "Enter: type and place"),
            ("angle", "", "Angle: a number from -36000 to 36000, not 'nothing'"),
        ):
            entry = app.query_one(f"#{field}", Input)
            entry.focus()
            entry.value = typed
            await pilot.press("enter")
            await pilot.pause()
            assert str(app.query_one("Positioning #message", Static).render()) == message
            assert app.run_controller.pose == Pose(150, 500, 0)


async def test_a_valid_position_typed_moves_the_robot() -> None:
    async with open_lab(LOGS, panels_on=frozenset({"positioning"})) as (pilot, app):
        await until(pilot, lambda: len(app.query("Positioning Input")) == 3)
        app.query_one("#x", Input).focus()
        await pilot.press("4", "0", "0", "comma", "5", "enter")
        await until(pilot, lambda: app.run_controller.pose == Pose(400.5, 500, 0))


@pytest.mark.slow
@pytest.mark.parametrize(
    "panel, field, words",
    [("positioning", "x", "not '999999'"), ("noise", "seed", "Seed")],
)
async def test_a_message_about_a_refused_value_goes_when_the_user_types_again(
    panel: str, field: str, words: str
) -> None:
    async with open_lab(LOGS, panels_on=frozenset({panel})) as (pilot, app):
        await until(pilot, lambda: bool(app.query(f"#{field}")))
        app.query_one(f"#{field}", Input).focus()

        def said() -> str:
            message = app.panel_area.panels[panel].query_one("#message", Static)
            return str(message.render())

        before = said()
        await pilot.press(*"999999" if panel == "positioning" else "-", "enter")
        await until(pilot, lambda: words in said())
        await pilot.press("backspace")
        await until(pilot, lambda: said() == before)
        assert not app.query(".wrong")
