"""Numbers in the position panel."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from tests.app.panel_help import PanelApp, moment
from tuisim.app.panels.position import Positioning, parse_field
from tuisim.engine.core.geometry import Pose


@pytest.mark.parametrize("text", ["1", " -2.5 ", "3,5", "+4e2"])
def test_position_fields_read_signs_spaces_exponents_and_decimal_commas(text: str) -> None:
    assert parse_field("x", text) == float(text.replace(",", "."))


async def test_what_is_typed_replaces_a_number_that_is_shown_after_its_field_got_the_focus() -> (
    None
):
    panel = Positioning()
    async with PanelApp(panel).run_test(size=(40, 12)) as pilot:
        field = panel.query_one("#x", Input)
        field.focus()
        await pilot.pause()
        panel.show(moment(Pose(150.0, 500.0, 0.0)))
        await pilot.press(*"700")
        assert field.value == "700"
