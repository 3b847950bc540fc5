"""A dialog with one line of input: an instant to go to, a filter, a search text, a note."""

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
"""An accepted form, and what it means."""


class _Line(Input):
    """The input; tab accepts the suggested completion.

    Args:
        value: Initial text.
        words: Possible completions.
        placeholder: Text of the empty field.
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("tab", "cursor_right", "Accept the completion", show=False)]

    def __init__(self, value: str, words: Sequence[str], placeholder: str) -> None:
        super().__init__(value, placeholder, compact=True, select_on_focus=True)
        self._words = words

    @on(Input.Changed)
    def _complete(self, event: Input.Changed) -> None:
        # Done synchronously: Textual's own suggester leaves a task behind, with a warning, when the field closes first.
        if (completion := completed(event.value, self._words)) is not None:
            self.post_message(SuggestionReady(event.value, completion))


def completed(line: str, words: Sequence[str]) -> str | None:
    """Return the line with its last word completed, None if there is no completion.

    Args:
        line: The typed text.
        words: Possible completions; the first one with the prefix is used.
    """
    match = _LAST_WORD.search(line)
    if match is None:
        return None
    typed = match[0]
    begun = (word for word in words if word.lower().startswith(typed.lower()) and len(word) > len(typed))
    word = next(begun, None)
    # The typed text stays: a completion only appends to it.
    return None if word is None else line + word[len(typed) :]


def form_list(forms: Sequence[Form]) -> Static:
    """Return the accepted forms of a line, and what they mean."""
    table = Table.grid(padding=(0, 2))
    for form, meaning in forms:
        table.add_row(form, meaning)
    return Static(table)


class LinePrompt(Dialog[bool]):
    """Returns True once the action has been carried out.

    Args:
        title: Title of the dialog.
        do: The action; a TuisimError is shown and the line can be corrected.
        value: Initial text, selected, so that typing replaces it.
        forms: The accepted forms.
        words: Possible completions of the current word; tab accepts one.
        placeholder: Text of the empty field.
    """

    HINT = "Enter applies · Escape closes"

    def __init__(
        self,
        title: str,
        do: Callable[[str], None],
        value: str = "",
        forms: Sequence[Form] = (),
        words: Sequence[str] = (),
        placeholder: str = "",
    ) -> None:
        super().__init__()
        self._placeholder = placeholder
        self._words = words
        self.TITLE_TEXT = title.replace("[", "\\[")
        self._do = do
        self._value = value
        self._forms = forms

    def content(self) -> ComposeResult:
        """Return the field, its error line, and the accepted forms."""
        yield _Line(self._value, self._words, self._placeholder)
        yield Static(id="message", classes="wrong", markup=False)
        yield form_list(self._forms)

    @on(Input.Submitted)
    def _entered(self, event: Input.Submitted) -> None:
        event.stop()
        try:
            self._do(event.value.strip())
        except TuisimError as error:
            self.query_one("#message", Static).update(str(error))
            return
        self.dismiss(True)
