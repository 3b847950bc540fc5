"""The `go to` dialog."""

from __future__ import annotations

from rich.table import Table
from textual import on
from textual.app import ComposeResult
from textual.widgets import Input, Static

from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.goto import FORMS, find
from tuisim.app.timeline import Timeline
from tuisim.errors import TuisimError


class GoTo(Dialog[int]):
    """Returns the tick that was asked for.

    Args:
        timeline: The run, and the instant in view.
    """

    TITLE_TEXT: str = "Go to"
    HINT: str = "Enter goes there · Escape closes"

    def __init__(self, timeline: Timeline) -> None:
        super().__init__()
        self._timeline = timeline

    def content(self) -> ComposeResult:
        """Return the field, its error line, and the accepted forms."""
        yield Input(placeholder=f"now at {self._timeline.time_s:.2f} s", compact=True)
        yield Static(id="message", classes="wrong", markup=False)
        forms = Table.grid(padding=(0, 2))
        for form, meaning in FORMS:
            forms.add_row(form, meaning)
        yield Static(forms)

    @on(Input.Submitted)
    def _entered(self, event: Input.Submitted) -> None:
        try:
            self.dismiss(find(event.value, self._timeline))
        except TuisimError as error:
            self.query_one("#message", Static).update(str(error))
