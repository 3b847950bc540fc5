"""What the dialogs have in common: they close once, have a frame with a title, and are left by Escape."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.await_complete import AwaitComplete
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
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


class ClosesOnce(ModalScreen[Result], Generic[Result]):
    """A screen over another one. It gives one result, and hears nothing after that.

    Textual takes the uppermost screen away for each call of `dismiss`, whichever screen it is called for. A key that
    is pressed twice would give two results, and take away the screen below as well.
    """

    # The keys of the app do not reach through a screen.
    BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+z", "app.suspend_process", "Suspend", show=False)]

    class Changed(Message):
        """A screen can be given keys, or has closed."""

    is_ready = False
    """Whether it is built, and has given the focus to the one of its widgets that is to hear the first key."""

    def on_mount(self) -> None:
        """Be ready after the first layout, and after the focus that was asked for until then."""
        self.call_after_refresh(self.app.call_later, self._become_ready)

    def _become_ready(self) -> None:
        self.is_ready = True
        self.app.post_message(self.Changed())

    @property
    def is_closed(self) -> bool:
        """Whether it has given its result, or has never been opened."""
        return self not in self.app.screen_stack

    def dismiss(self, result: Result | None = None) -> AwaitComplete:
        """Give the result and close, with every screen above; do nothing if that has been done."""
        if self.is_closed:
            return AwaitComplete()
        stack = self.app.screen_stack
        opened = stack[stack.index(self) :]
        for screen in opened:
            if not screen.is_mounted:
                # Textual cannot take away what it is still building.
                screen.call_later(self.dismiss, result)
                return AwaitComplete()
        for above in reversed(opened[1:]):
            above.dismiss(None)
        self.app.post_message(self.Changed())
        return super().dismiss(result)

    async def _on_message(self, message: Message) -> None:
        # A widget of a closed screen may have more to tell, such as a second Enter.
        if not (message.bubble and self.is_closed):
            await super()._on_message(message)


class Dialog(ClosesOnce[Result], Generic[Result]):
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
