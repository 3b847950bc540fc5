"""The welcome: ways to begin, and recent work to continue."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.action import ActionHost, fill_keys
from tuisim.app.dialogs.dialog import Dialog, name_and_title
from tuisim.app.setup.recent import Recent
from tuisim.terminal.textual_internals import find_bindings


class Begin(StrEnum):
    """A choice of the welcome with which a user can begin, such as a lesson or a new program."""

    NEW = "new"
    EXAMPLE = "example"
    LEARN = "learn"
    OPEN = "open"


_TEXT = (
    "This is a robot lab. A program drives the robot over a printed mat, and you see, plot and log what its sensors "
    "measure. How do you want to begin?"
)
_CHOICES = {
    Begin.NEW: ("A new program", "Choose mat, sensor and skeleton"),
    Begin.EXAMPLE: ("Run the example", "Drives over grey bands, logs them"),
    Begin.LEARN: ("Learn", "Lessons up to a line follower"),
    Begin.OPEN: ("Open a file", "Your own program or an example"),
}
_KEY_WORDS = (
    "Always: {open} opens a file, {lesson-menu} the lessons, {help} shows all keys, {quit} quits."
)
_NAME_CELLS = 18
_MAX_NUMBERED = 9


class Welcome(Dialog[Begin | Recent]):
    """The welcome; it returns what to begin with, or the recent work to continue; None on Escape.

    Args:
        is_first: Whether this is the first start, so that the text says what the app is.
        recent: The recent work to list; its first entry is selected.
    """

    TITLE_TEXT: str = "Welcome to tuisim"
    HINT: str = "A number, or ↑ ↓ and Enter · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        (str(number), f"take({number})", "Begin") for number in range(1, _MAX_NUMBERED + 1)
    ]

    def __init__(self, is_first: bool, recent: Sequence[Recent]) -> None:
        super().__init__()
        self._is_first = is_first
        self._entries: list[Begin | Recent] = [*Begin, *recent]
        self._app_keys: list[Binding] = []

    def compose_content(self) -> ComposeResult:
        if self._is_first:
            yield Static(_TEXT, classes="start", markup=False)
        yield OptionList(*self._build_options(), markup=False)
        yield Static()
        yield Static(fill_keys(self.app, _KEY_WORDS), markup=False)

    def on_mount(self) -> None:
        actions = self.app.ACTIONS if isinstance(self.app, ActionHost) else {}
        self._app_keys = [
            Binding(action.key, f"leave_for('{name}')", action.footer or name)
            for name, action in actions.items()
            if f"{{{name}}}" in _KEY_WORDS
        ]
        for binding in self._app_keys:
            for key in binding.key.split(","):
                find_bindings(self).bind(key, binding.action, binding.description)
        listed = self.query_one(OptionList)
        listed.focus()
        if len(self._entries) > len(Begin):
            # Select the first entry below the heading.
            listed.highlighted = len(Begin) + 1

    def _build_options(self) -> Iterator[Option | None]:
        for number, entry in enumerate(self._entries, start=1):
            if number == len(Begin) + 1:
                yield None
                yield Option(Text("Go on with", "italic"), disabled=True)
            words = (entry.name, entry.title) if isinstance(entry, Recent) else _CHOICES[entry]
            yield _build_option(number, *words)

    def _collect_bindings(self) -> list[Binding]:
        # The frame already names the number keys; the text names keys of the app, which work here as well.
        own = (binding for binding in super()._collect_bindings() if not binding.key.isdigit())
        return [*own, *self._app_keys]

    @on(OptionList.OptionSelected)
    def _take_selected(self, event: OptionList.OptionSelected) -> None:
        self.action_take(int(event.option.id or 0))

    def action_leave_for(self, action: str) -> None:
        """Close the welcome without a result, and run an action of the app as if its key was pressed."""
        self.dismiss(None)
        self.app.call_later(self.app.run_action, f"app.act('{action}')")

    def action_take(self, number: int) -> None:
        if number <= len(self._entries):
            self.dismiss(self._entries[number - 1])


def _build_option(number: int, name: str, title: str) -> Option:
    # With one line for each entry, nine entries and the keys below them fit into 80x24.
    return Option(
        name_and_title(f"{number} {name}", title, _NAME_CELLS, wraps=False), id=str(number)
    )
