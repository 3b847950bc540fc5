"""The line under the text in which one types what to find, or the number of a line."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Static

FIND, LINE = "find", "line"


class FindBar(Horizontal):
    """Shown while something is looked for."""

    DEFAULT_CSS = """
    FindBar { height: 1; }
    FindBar > Static { width: auto; }
    FindBar > Input { width: 1fr; height: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", "Close", show=False),
        Binding("down,f3,ctrl+f", "go(1)", "Next", show=False),
        Binding("up,shift+f3", "go(-1)", "Before", show=False),
    ]

    class Asked(Message):
        """Look for the text, or go to the line."""

        def __init__(self, mode: str, text: str, by: int) -> None:
            super().__init__()
            self.mode, self.text, self.by = mode, text, by
            """`by`: 1 the next place, -1 the one before, 0 the one at the cursor or after it."""

    class Closed(Message):
        """Back to the text."""

    def __init__(self) -> None:
        super().__init__()
        self.mode = FIND
        self.wanted = ""
        """What was looked for last."""
        self.display = False

    def compose(self) -> ComposeResult:
        """The field, and what was found."""
        yield Static(id="label", markup=False)
        yield Input(compact=True)
        yield Static(id="found", markup=False)

    def open(self, mode: str) -> None:
        """Ask for a text or a line."""
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
        """Show what was found."""
        self.query_one("#found", Static).update(text)

    def action_close(self) -> None:
        """Hide it."""
        self.display = False
        self.post_message(self.Closed())

    def action_go(self, by: int) -> None:
        """Next place, or the one before."""
        self._ask(by)

    def _ask(self, by: int) -> None:
        text = self.query_one(Input).value
        if self.mode == FIND:
            self.wanted = text
        self.post_message(self.Asked(self.mode, text, by))

    def on_input_changed(self, event: Input.Changed) -> None:
        """Look while one types."""
        event.stop()
        if self.mode == FIND:
            self._ask(0)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """The next place, or the line."""
        event.stop()
        self._ask(1)
        if self.mode == LINE:
            self.action_close()
