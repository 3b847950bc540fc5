"""An app of the terminal kit alone, with a widget of text and a field."""

from __future__ import annotations

import pyte
from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.app import ComposeResult
from textual.color import Color
from textual.widgets import Input

from tests.app.wires import on_wire, until_quiet, wire_of
from tuisim.terminal.app import BufferedApp, Sanitize
from tuisim.terminal.cell_view import LinesView

STYLE = Style.null()


class Plain(BufferedApp):
    """Shows some lines above a field."""

    CSS = "LinesView { height: 4; }"

    def __init__(self) -> None:
        super().__init__()
        self.view = LinesView()

    def compose(self) -> ComposeResult:
        yield self.view
        yield Input()

    def show(self, text: str) -> None:
        """Show a text in the first line."""
        self.view.set_lines([[(text, STYLE)]])


async def test_the_app_sends_only_changed_cells() -> None:
    app = Plain()
    async with on_wire(app) as pilot:
        app.show("left 1 right")
        await until_quiet(pilot)
        wire = wire_of(pilot)
        screen = pyte.Screen(120, 40)
        stream = pyte.Stream(screen)
        stream.feed("".join(wire.sent))
        assert screen.display[0].startswith("left 1 right")
        wire.sent.clear()
        app.show("left 2 right")
        await until_quiet(pilot)
        changes = "".join(wire.sent)
        stream.feed(changes)
        assert screen.display[0].startswith("left 2 right")
        assert "2" in changes and "left" not in changes and "right" not in changes


async def test_the_app_sends_every_cell_again_after_a_forced_redraw() -> None:
    app = Plain()
    async with on_wire(app) as pilot:
        app.show("a line")
        await until_quiet(pilot)
        wire_of(pilot).sent.clear()
        app.view.refresh()
        await until_quiet(pilot)
        assert "a line" not in "".join(wire_of(pilot).sent)
        app.action_redraw()
        await until_quiet(pilot)
        assert "a line" in "".join(wire_of(pilot).sent)


async def test_is_typed_into_is_true_only_while_an_input_field_has_the_focus() -> None:
    app = Plain()
    async with app.run_test() as pilot:
        app.set_focus(None)
        assert not app.is_typed_into
        app.query_one(Input).focus()
        await pilot.pause()
        assert app.is_typed_into


async def test_an_app_without_a_terminal_of_its_own_lends_none() -> None:
    app = Plain()
    async with on_wire(app):
        assert not app.lend_terminal(["true"])


def test_control_characters_are_not_drawn_and_text_keeps_its_width() -> None:
    bold = Style(bold=True)
    before = [Segment("Größe 😀", bold), Segment("a\x1b[31m\x9bb\u202e\x07\n")]
    after = Sanitize().apply(before, Color(0, 0, 0))
    assert [(segment.text, segment.style) for segment in after] == [
        ("Größe 😀", bold),
        ("a[31mb", None),
    ]
    assert [cell_len(segment.text) for segment in after] == [
        cell_len(segment.text) for segment in before
    ]
