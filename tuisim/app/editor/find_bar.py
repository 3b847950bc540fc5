"""The find bar below the text of the code panel."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Static

from tuisim.base.data_class import dataclass

FIND = "find"
LINE = "line"


class FindBar(Horizontal):
    """The find bar, shown during a search."""

    DEFAULT_CSS = """
    FindBar { height: 1; }
    FindBar > Static { width: auto; }
    FindBar > Input { width: 1fr; height: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", "Close", show=False),
        Binding("down,ctrl+f", "go(1)", "Next", show=False),
        Binding("up", "go(-1)", "Before", show=False),
    ]

    @dataclass
    class Asked(Message):
        """Posted to find the text, or to go to the line."""

        mode: str
        text: str
        by: int
        """1 the next match, -1 the previous one, 0 the one at or after the cursor."""

    class Closed(Message):
        """Posted when the focus returns to the text."""

    def __init__(self) -> None:
        super().__init__()
        self.mode = FIND
        self.wanted = ""
        """The last search text."""
        self.display = False

    def compose(self) -> ComposeResult:
        yield Static(id="label", markup=False)
        yield Input(compact=True)
        yield Static(id="found", markup=False)

    def open(self, mode: str) -> None:
        """Open the bar to find a text or go to a line."""
        self.mode = mode
        self.display = True
        self.query_one("#label", Static).update("Find " if mode == FIND else "Line ")
        self.say("")
        field = self.query_one(Input)
        with field.prevent(Input.Changed):
            field.value = self.wanted if mode == FIND else ""
        field.select_all()
        field.focus()

    def say(self, text: str) -> None:
        """Show the result of the search."""
        self.query_one("#found", Static).update(text)

    def action_close(self) -> None:
        self.display = False
        self.post_message(self.Closed())

    def action_go(self, by: int) -> None:
        text = self.query_one(Input).value
        if self.mode == FIND:
            self.wanted = text
        self.post_message(self.Asked(self.mode, text, by))

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        if self.mode == FIND:
            self.action_go(0)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_go(1)
        if self.mode == LINE:
            self.action_close()
