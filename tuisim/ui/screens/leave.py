"""The question before leaving a run."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tuisim.ui.screens.dialog import Dialog


class LeaveQuestion(Dialog[bool]):
    """Gives True if the user wants to leave all the same."""

    TITLE_TEXT: str = "Quit?"
    HINT: str = "y quits · n goes on"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y,q,enter", "yes", "Quit", show=False),
        Binding("n", "leave", "Stay", show=False),
    ]

    def content(self) -> ComposeResult:
        """The question."""
        yield Static("A program is running. What it has logged so far is kept.", markup=False)
        yield Static("[@click=screen.yes]  y  Stop it and quit  [/]   [@click=screen.leave]  n  Stay  [/]")

    def action_yes(self) -> None:
        """Leave."""
        self.dismiss(True)
