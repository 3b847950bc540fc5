"""What the dialogs have in common: a frame with a title in the middle of the screen, Escape to leave."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen

Result = TypeVar("Result")


class Dialog(ModalScreen[Result], Generic[Result]):
    """A frame with a title; gives None when left by Escape."""

    TITLE_TEXT: ClassVar[str] = ""
    HINT: ClassVar[str] = "Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Close", show=False)]

    def compose(self) -> ComposeResult:
        """Frame the content."""
        frame = Vertical(classes="dialog")
        frame.border_title = self.TITLE_TEXT
        frame.border_subtitle = self.HINT
        with frame:
            yield from self.content()

    def content(self) -> ComposeResult:
        """The widgets in the frame."""
        yield from ()

    def action_leave(self) -> None:
        """Close without a result."""
        self.dismiss(None)
