"""The welcome at the first start: three ways to begin."""

from __future__ import annotations

from enum import StrEnum
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.action import ActionHost, with_keys_of
from tuisim.app.dialogs.dialog import Dialog, name_and_title
from tuisim.terminal.textual_internals import bindings_of


class Begin(StrEnum):
    """What to begin with."""

    EXAMPLE = "example"
    LEARN = "learn"
    OPEN = "open"


_TEXT = (
    "This is a robot lab. A program drives the robot over a printed mat, and all that its sensors see is shown, drawn "
    "and logged. How do you want to begin?"
)
_CHOICES = {
    Begin.EXAMPLE: ("Run the example", "It drives over grey bands and logs them"),
    Begin.LEARN: ("Learn", "Lessons, from the first run to a line follower"),
    Begin.OPEN: ("Open a file", "A program of your own, or one of the examples"),
}
_ACTIONS = ("open", "lesson-menu", "help", "quit")
"""Actions of the app whose keys work here as well."""
_KEY_WORDS = "Always: {open} opens a file, {lesson-menu} the lessons, {help} shows all keys, {quit} quits."
_NAME_CELLS = 18


class Welcome(Dialog[Begin]):
    """Returns what to begin with; None on Escape."""

    TITLE_TEXT: str = "Welcome to tuisim"
    HINT: str = "1 2 3, or ↑ ↓ and Enter · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        *(
            Binding(str(number), f"begin('{what}')", _CHOICES[what][0], show=False)
            for number, what in enumerate(Begin, start=1)
        )
    ]

    def content(self) -> ComposeResult:
        yield Static(_TEXT, classes="start", markup=False)
        yield OptionList(
            *(
                Option(name_and_title(f"{number} {name}", title, _NAME_CELLS), id=what)
                for number, (what, (name, title)) in enumerate(_CHOICES.items(), start=1)
            ),
            markup=False,
        )
        yield Static()
        yield Static(with_keys_of(self.app, _KEY_WORDS), markup=False)

    def on_mount(self) -> None:
        actions = self.app.ACTIONS if isinstance(self.app, ActionHost) else {}
        for name in _ACTIONS if actions else ():
            for key in actions[name].key.split(","):
                bindings_of(self).bind(key, f"leave_for('{name}')", name, show=False)
        self.query_one(OptionList).focus()

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(Begin(event.option.id or ""))

    def action_leave_for(self, action: str) -> None:
        """Close, and do what the key does in the app."""
        self.dismiss(None)
        self.app.call_later(self.app.run_action, f"app.act('{action}')")

    def action_begin(self, what: str) -> None:
        self.dismiss(Begin(what))
