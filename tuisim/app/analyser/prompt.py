"""One line to type in: where to go, a filter, what to search for, a note."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import ClassVar

from rich.table import Table
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.suggester import SuggestionReady
from textual.widgets import Input, Static

from tuisim.app.dialogs.dialog import Dialog
from tuisim.errors import TuisimError

_LAST_WORD = re.compile(r"`[^`]+$|[^\W\d]\w*$")

Form = tuple[str, str]
"""What may be typed, and what it means."""


class _Line(Input):
    """The field: tab takes the offered end of the word.

    Args:
        value: What stands there at first.
        words: What may be offered.
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("tab", "cursor_right", "Take the offered word", show=False)]

    def __init__(self, value: str, words: Sequence[str]) -> None:
        super().__init__(value, compact=True, select_on_focus=True)
        self._words = words

    @on(Input.Changed)
    def _offer(self, event: Input.Changed) -> None:
        # At once: Textual's own suggester leaves work undone, and a warning, when the field closes first.
        if (offered := completed(event.value, self._words)) is not None:
            self.post_message(SuggestionReady(event.value, offered))


def completed(line: str, words: Sequence[str]) -> str | None:
    """Return the line with its last word ended, None if there is nothing to offer.

    Args:
        line: What has been typed.
        words: What may be offered, the first that begins like the last word of the line.
    """
    match = _LAST_WORD.search(line)
    if match is None:
        return None
    typed = match[0]
    begun = (word for word in words if word.lower().startswith(typed.lower()) and len(word) > len(typed))
    word = next(begun, None)
    # What was typed stays: an offer only adds to it.
    return None if word is None else line + word[len(typed) :]


class LinePrompt(Dialog[bool]):
    """Gives True once what was typed has been done.

    Args:
        title: What it is about.
        do: Does it; a TuisimError is told and the line can be mended.
        value: What stands there at first, selected: what is typed takes its place.
        forms: What may be typed.
        words: What the word that is being typed may become; tab takes what is offered.
    """

    HINT = "Enter does it · Escape closes"

    def __init__(
        self,
        title: str,
        do: Callable[[str], None],
        value: str = "",
        forms: Sequence[Form] = (),
        words: Sequence[str] = (),
    ) -> None:
        super().__init__()
        self._words = words
        self.TITLE_TEXT = title.replace("[", "\\[")
        self._do = do
        self._value = value
        self._forms = forms

    def content(self) -> ComposeResult:
        """The field, what is wrong with what stands there, and what may stand there."""
        yield _Line(self._value, self._words)
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
