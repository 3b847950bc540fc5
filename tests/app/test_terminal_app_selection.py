"""Text that is selected with the mouse."""

from __future__ import annotations

from textual.app import App, ComposeResult
from textual.geometry import Offset
from textual.selection import Selection
from textual.widgets import Static

import tuisim.app.terminal_app  # noqa: F401  # what it changes in Textual is tested


class _Shown(App[None]):
    def compose(self) -> ComposeResult:
        yield Static("Colour: 100")


async def test_a_widget_of_a_removed_screen_is_drawn_without_its_selection() -> None:
    async with _Shown().run_test() as pilot:
        shown = pilot.app.query_one(Static)
        pilot.app.screen.selections = {shown: Selection(Offset(0, 0), Offset(6, 0))}
        before = shown.text_selection
        # As in one that has just been removed.
        pilot.app.screen._component_styles.clear()
        assert (before is None, shown.text_selection is None) == (False, True)
        shown.refresh()
        assert shown.render_lines(shown.size.region)[0].text.startswith("Colour: 100")
