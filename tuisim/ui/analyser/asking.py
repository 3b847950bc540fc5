"""One line to type in: where to go, a filter, what to search for, a note."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.table import Table
from textual import on
from textual.app import ComposeResult
from textual.widgets import Input, Static

from tuisim.errors import TuisimError
from tuisim.ui.screens.dialog import Dialog

Form = tuple[str, str]
"""What may be typed, and what it means."""


class Asking(Dialog[bool]):
    """Gives True once what was typed has been done.

    Args:
        title: What it is about.
        do: Does it; a TuisimError is told and the line can be mended.
        value: What stands there at first.
        forms: What may be typed.
    """

    HINT = "Enter does it · Escape closes"

    def __init__(self, title: str, do: Callable[[str], None], value: str = "", forms: Sequence[Form] = ()) -> None:
        super().__init__()
        self.TITLE_TEXT = title.replace("[", "\\[")
        self._do = do
        self._value = value
        self._forms = forms

    def content(self) -> ComposeResult:
        """The field, what is wrong with what stands there, and what may stand there."""
        yield Input(self._value, compact=True, select_on_focus=False)
        yield Static(id="message", classes="wrong", markup=False)
        forms = Table.grid(padding=(0, 2))
        for form, meaning in self._forms:
            forms.add_row(form, meaning)
        yield Static(forms)

    @on(Input.Submitted)
    def _entered(self, event: Input.Submitted) -> None:
        event.stop()
        try:
            self._do(event.value.strip())
        except TuisimError as error:
            self.query_one("#message", Static).update(str(error))
            return
        self.dismiss(True)
