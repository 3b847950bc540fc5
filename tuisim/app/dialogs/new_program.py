"""The dialog of a new program: its mat, the sensor that it reads, and its skeleton, with the text that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.setup.new_program import READINGS, SKELETON_TITLES, Skeleton, program_text

_LISTS = ("mat", "sensor", "skeleton")


class NewProgramDialog(Dialog[str]):
    """Returns the text of a new program.

    Args:
        mats: The mats that can be chosen: titles by the word that names one in a magic line.
        current: The word of the mat that is laid out, chosen at first.
    """

    TITLE_TEXT: str = "A new program"
    HINT: str = "Letters or ↑ ↓ choose · ← → next list · Enter begins · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,tab", "app.focus_next", "Next list", show=False),
        Binding("left,shift+tab", "app.focus_previous", "Previous list", show=False),
    ]

    def __init__(self, mats: Mapping[str, str], current: str) -> None:
        super().__init__()
        self._offers: Sequence[Mapping[str, str]] = (
            mats,
            {name: reading.noun.capitalize() for name, reading in READINGS.items()},
            {str(one): title for one, title in SKELETON_TITLES.items()},
        )
        self._current = current
        self._typed = ""
        """Letters typed in the list with the focus, to find an entry."""

    def content(self) -> ComposeResult:
        with Horizontal():
            for name, offers in zip(_LISTS, self._offers, strict=True):
                listed = OptionList(
                    *(Option(title, id=word) for word, title in offers.items()),
                    id=name,
                    markup=False,
                )
                listed.highlighted = (
                    [*offers].index(self._current) if self._current in offers else 0
                )
                yield listed
        yield Static(id="text", markup=False)

    def on_mount(self) -> None:
        self.query_one("#mat").focus()

    @on(events.DescendantFocus)
    def _in_another_list(self) -> None:
        self._typed = ""

    def on_key(self, event: events.Key) -> None:
        """Go to the first entry with the letters that were typed."""
        listed = self.focused
        if not event.character or not event.is_printable or not isinstance(listed, OptionList):
            return
        event.stop()
        titles = [*self._offers[_LISTS.index(listed.id or "")].values()]
        for typed in (self._typed + event.character.lower(), event.character.lower()):
            if (found := _found(titles, typed)) is not None:
                self._typed, listed.highlighted = typed, found
                return

    @on(OptionList.OptionHighlighted)
    def _show(self) -> None:
        self.query_one("#text", Static).update(self._text())

    @on(OptionList.OptionSelected)
    def _chosen(self) -> None:
        self.dismiss(self._text())

    def _text(self) -> str:
        mat, sensor, skeleton = (
            [*offers][self.query_one(f"#{name}", OptionList).highlighted or 0]
            for name, offers in zip(_LISTS, self._offers, strict=True)
        )
        return program_text(mat, sensor, Skeleton(skeleton))


def _found(titles: Sequence[str], typed: str) -> int | None:
    """Return the index of the first title that begins with a text, else with its letters in their order; or None."""
    for fits in (lambda title: title.startswith(typed), lambda title: _has_letters(title, typed)):
        if (
            at := next((at for at, title in enumerate(titles) if fits(title.lower())), None)
        ) is not None:
            return at
    return None


def _has_letters(title: str, typed: str) -> bool:
    left = iter(title)
    return all(letter in left for letter in typed)
