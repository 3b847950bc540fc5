"""What the dialogs have in common: a frame with a title in the middle of the screen, Escape to leave."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen

Result = TypeVar("Result")


def name_and_title(name: str, title: str, name_cells: int) -> Table:
    """Return a line of a list: a name, and a title that wraps beside it."""
    table = Table.grid(padding=(0, 2), expand=True)
    table.add_column(width=name_cells, style="bold")
    table.add_column(ratio=1)
    # A name that somebody has given is no markup.
    table.add_row(Text(name), Text(title))
    return table


class Dialog(ModalScreen[Result], Generic[Result]):
    """A frame with a title; gives None when left by Escape."""

    TITLE_TEXT: str = ""
    HINT: str = "Escape closes"
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
