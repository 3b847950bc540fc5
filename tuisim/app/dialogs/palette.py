"""Lists that are searched by typing, one line an entry: the command palette, and the themes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from typing import Any, ClassVar, NamedTuple

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app import design
from tuisim.app.action import Action
from tuisim.app.dialogs.dialog import MOVE_KEYS, Dialog
from tuisim.base import palette
from tuisim.terminal.text_runs import cut

_WIDTH = 74
_BESIDE = 10
"""Cells of the frame's width that borders, padding and scroll bar take; `_WIDTH` is the frame's width in cells."""
_OUTSIDE = 4
"""Cells that the frame leaves free at both sides together if the terminal is narrow."""
_SHOW = "show or hide "
GUIDE_PREFIX = "?"
"""The palette returns this and a question if the user searches the guide; else it returns an action's id."""
_QUESTION_WORDS = (
    "how",
    "what",
    "where",
    "do",
    "does",
    "can",
    "i",
    "to",
    "the",
    "a",
    "my",
    "of",
    "in",
    "is",
)
_ALIKE = 0.75
"""Minimum similarity, from 0 to 1 in the measure of `difflib`, of a mistyped word to the word that it may mean."""
_MIN_ROWS, _OTHER_ROWS = 16, 5
"""Rows of a long list on a low terminal; `_OTHER_ROWS` is the number of rows of the dialog around the list."""


class Entry(NamedTuple):
    """One line of a list that can be searched, such as an action of the command palette."""

    id: str
    title: str
    group: str = ""
    key: str = ""
    words: str = ""
    """Further words by which a search finds the entry."""
    works: bool = True
    """Whether choosing the entry has an effect now; else it is greyed."""


def find_entries(entries: Sequence[Entry], typed: str) -> list[Entry]:
    """Return the entries that contain every word of a text, the best first.

    Small words of a question, such as `how`, are ignored. A word that no entry contains is replaced by the most similar
    known word. The entries come in this order:

    1. The title starts with the text; "Show or hide" at the start of a title is not counted.
    2. Each word is at the start of a word of the title.
    3. All words are in the title or the name of the group.
    4. All words are among the further words by which the entry can be found.
    5. All other entries.

    In each group, entries that show or hide something come first.
    """
    typed_words = typed.lower().rstrip("?").split()
    words = [word for word in typed_words if word not in _QUESTION_WORDS] or typed_words
    texts = {entry.id: " ".join(entry[1:5]).lower() for entry in entries}
    known = " ".join(texts.values())
    words = [
        word if word in known else (get_close_matches(word, known.split(), 1, _ALIKE) or [word])[0]
        for word in words
    ]

    def rank(entry: Entry) -> tuple[int, bool]:
        title, title_and_group = entry.title.lower(), f"{entry.title} {entry.group}".lower()
        fits = (
            title.removeprefix(_SHOW).startswith(" ".join(words)),
            all(f" {word}" in f" {title}" for word in words),
            all(word in title_and_group for word in words),
            set(words) <= {*entry.words.split()},
        )
        step = fits.index(True) if True in fits else len(fits)
        return step, not title.startswith(_SHOW)

    matches = [
        candidate for candidate in entries if all(word in texts[candidate.id] for word in words)
    ]
    return sorted(matches, key=rank) if words else matches


class SearchList(Dialog[str]):
    """The dialog with a list that the user searches by typing words; it returns the id of the chosen entry.

    Args:
        entries: The list, in its order.
        current: Id of the entry that is selected at first.
    """

    HINT: str = "type to search · ↑ ↓ and Enter · Escape closes"
    NOTHING: str = "Nothing found"
    """The message in place of the list if no entry matches the typed text."""
    BINDINGS: ClassVar[list[BindingType]] = [*MOVE_KEYS]

    def __init__(self, entries: Sequence[Entry], current: str = "") -> None:
        super().__init__()
        self._entries = entries
        self._current = current

    def compose_content(self) -> ComposeResult:
        yield Input(placeholder="Search", compact=True, select_on_focus=False)
        yield OptionList()
        yield Static(self.NOTHING, id="message", markup=False)

    def on_mount(self) -> None:
        self.app.clear_notifications()
        self.query_one(Input).focus()

    def on_resize(self) -> None:
        # A fixed height keeps the dialog in place while the list becomes shorter.
        rows = min(len(self._entries), max(_MIN_ROWS, self.size.height // 2))
        self.query_one(".dialog").styles.height = rows + _OTHER_ROWS
        self._list(self.query_one(Input).value)

    @on(Input.Changed)
    def _search(self, event: Input.Changed) -> None:
        self._list(event.value)

    def find_matches(self, typed: str) -> list[Entry]:
        """Return the lines of the list for a typed text."""
        return find_entries(self._entries, typed)

    def _list(self, typed: str) -> None:
        matches = self.find_matches(typed)
        listed = self.query_one(OptionList)
        cells = min(_WIDTH, self.size.width - _OUTSIDE) - _BESIDE
        listed.clear_options()
        listed.add_options(Option(_build_line(entry, cells), id=entry.id) for entry in matches)
        names = [entry.id for entry in matches]
        if not matches:
            listed.highlighted = None
        elif self._current in names:
            listed.highlighted = names.index(self._current)
        else:
            listed.highlighted = 0
        listed.display = bool(matches)
        self.query_one("#message").display = not matches

    @on(Input.Submitted)
    def _choose_selected(self) -> None:
        self.query_one(OptionList).action_select()

    @on(OptionList.OptionSelected)
    def _handle_selection(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option.id)


def _build_line(entry: Entry, cells: int) -> Text:
    """Return an entry as a line of the list, `cells` wide, with its key at the right."""
    right = f"{entry.group}  {entry.key:>7}" if entry.key else entry.group
    title = cut(entry.title, cells - len(right) - 1)
    line = Text(no_wrap=True, overflow="ellipsis")
    line.append(f"{title:<{cells - len(right)}}", "" if entry.works else design.SUBTITLE)
    line.append(right[: len(entry.group)], design.SUBTITLE)
    line.append(
        right[len(entry.group) :], f"bold {palette.YELLOW}" if entry.works else design.SUBTITLE
    )
    return line


class Palette(SearchList):
    """The command palette; it returns the id of the action that the user chooses. Actions that work now come first.

    The last line searches the guide for the typed words: it returns `GUIDE_PREFIX` and these words.
    """

    TITLE_TEXT: str = "Commands"

    def __init__(self, actions: Iterable[Action[Any, Any]], now: object) -> None:
        entries = (
            Entry(
                action.id,
                action.title,
                action.group,
                action.key_label,
                action.words,
                not action.why_not(now),
            )
            for action in actions
        )
        super().__init__(sorted(entries, key=lambda entry: not entry.works))

    def find_matches(self, typed: str) -> list[Entry]:
        """Return the actions that match a typed text, and after them the question to the guide."""
        matches = super().find_matches(typed)
        if question := typed.strip():
            title = f"Search the guide for: {question}"
            matches.append(Entry(GUIDE_PREFIX + question, title, "Guide"))
        return matches


class ThemeChooser(SearchList):
    """The dialog that returns the name of a theme; while it is open, the app has the highlighted theme.

    Args:
        names: The themes.
        current: The present theme, to which the app returns on Escape.
        show: Gives the app a theme.
    """

    TITLE_TEXT: str = "Themes"

    def __init__(self, names: Iterable[str], current: str, show: Callable[[str], None]) -> None:
        super().__init__(
            [Entry(name, name, "current" if name == current else "") for name in names], current
        )
        self._show = show

    @on(OptionList.OptionHighlighted)
    def _look(self, event: OptionList.OptionHighlighted) -> None:
        if event.option.id:
            self._show(event.option.id)

    def action_leave(self) -> None:
        self._show(self._current)
        super().action_leave()
