"""Rows of a form: a label, a text field or a choice, and an error line below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Input, Label, Static

from tuisim.app.keys.action import ActionHost
from tuisim.errors import ConfigError, TuisimError


def reason(error: TuisimError) -> str:
    """Return the message of an error without its location, which the field shows."""
    message = error.message
    if isinstance(error, ConfigError) and error.key and not error.file:
        message = message.removeprefix(f"{error.key}: ")
    return f"{message} ({error.hint})" if error.hint else message


def typed_number(text: str, error: type[ConfigError]) -> float:
    """Parse a typed number, with a point or a comma.

    Raises:
        ConfigError: of the class `error`: the text is no number.
    """
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        raise error(f"must be a number, got {text.strip()[:20]!r}") from None


class Choice(Widget, can_focus=True):
    """One of several words, changed by ← → or a click."""

    DEFAULT_CSS = "Choice { height: 1; width: 1fr; }"
    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "step(-1)", "Before", show=False),
        Binding("right,enter,space", "step(1)", "Next", show=False),
    ]

    @dataclass
    class Stepped(Message):
        """Posted when the user asks for another choice, some steps further on."""

        choice: Choice
        by: int

    def __init__(self) -> None:
        super().__init__()
        self._word = ""

    @property
    def value(self) -> str:
        """The word shown; setting it posts no message."""
        return self._word

    @value.setter
    def value(self, word: str) -> None:
        if word != self._word:
            self._word = word
            self.refresh()

    def action_step(self, by: int) -> None:
        """Ask for the choice `by` steps further on."""
        self.post_message(self.Stepped(self, by))

    def on_click(self, event: events.Click) -> None:
        """Ask for the previous choice at the left end, else for the next."""
        event.stop()
        self.action_step(-1 if event.x == 0 else 1)

    def on_focus(self) -> None:
        """Show that the keys work here."""
        self.refresh()

    def on_blur(self) -> None:
        """Show that the keys no longer work here."""
        self.refresh()

    def render(self) -> Text:
        """Return the row."""
        line = Text(f"‹ {self._word}", no_wrap=True, end="")
        line.truncate(max(self.size.width - 2, 1), overflow="ellipsis")
        line.append(" ›")
        return line


class Row(Vertical):
    """One row of a form.

    Args:
        field: Id of the edited field, which identifies the row.
        label: Its label; empty gives the field the whole width.
        chosen: Whether it is a choice instead of a text field.
    """

    DEFAULT_CSS = """
    Row { height: auto; }
    Row > Horizontal { height: 1; }
    Row Input { width: 1fr; height: 1; }
    Row > .message { display: none; height: auto; }
    Row.-wrong > .message { display: block; }
    """

    @dataclass
    class Entered(Message):
        """Posted when the user has typed a value, or asks for another choice."""

        row: Row
        text: str
        """What was typed."""
        by: int = 0
        """Steps to another choice."""

    def __init__(self, field: str, label: str, chosen: bool) -> None:
        super().__init__()
        self.field = field
        self._label = label
        self.entry: Choice | Input = Choice() if chosen else Input(compact=True, select_on_focus=True)
        self._shown = ""

    def compose(self) -> ComposeResult:
        """Create the child widgets."""
        with Horizontal():
            if self._label:
                yield Label(self._label, markup=False)
            yield self.entry
        yield Static(classes="message", markup=False)

    def show(self, text: str) -> None:
        """Show a value, unless another one is being typed."""
        if text != self._shown or not self._typing:
            self._shown = self.entry.value = text
            self.complain("")

    @property
    def _typing(self) -> bool:
        return self.entry.has_focus and self.entry.value != self._shown

    def complain(self, text: str) -> None:
        """Show an error below the field; empty removes it."""
        self.set_class(bool(text), "-wrong")
        self.entry.set_class(bool(text), "wrong")
        if self.is_mounted:
            self.query_one(".message", Static).update(text)

    def refuse(self, error: TuisimError) -> None:
        """Show below the field why its value was rejected."""
        self.complain(reason(error))

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self._enter()

    def on_descendant_blur(self) -> None:
        """Apply the typed value when the field loses the focus."""
        if isinstance(self.entry, Input) and self.entry.value != self._shown:
            self._enter()

    def _enter(self) -> None:
        self.post_message(self.Entered(self, self.entry.value))

    @on(Choice.Stepped)
    def _stepped(self, event: Choice.Stepped) -> None:
        event.stop()
        self.post_message(self.Entered(self, self.entry.value, event.by))


_SIGNS = frozenset({
    "colon", "equals_sign", "left_parenthesis", "left_square_bracket", "less_than_sign", "greater_than_sign",
    "question_mark", "right_parenthesis", "right_square_bracket", "space",
})  # fmt: skip
"""Keys of punctuation that cannot be part of a number."""


class NumberInput(Input):
    """A text field for a number; letters and other characters remain keys of the app."""

    def on_mount(self) -> None:
        """Leave the keys of the app to the app."""
        for action in self.app.ACTIONS.values() if isinstance(self.app, ActionHost) else ():
            for key in action.key.split(","):
                if len(key) == 1 or key in _SIGNS:
                    self._bindings.bind(key, f"app.act('{action.id}')", action.title, show=False, priority=True)
