"""The list of names that may stand at the cursor, over the text; and a signature as one line."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import ClassVar

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import events
from textual.geometry import Offset, Size
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget

from tuisim.app import design
from tuisim.app.editor.completion import Candidate, Signature
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.terminal.text_runs import Line, cut, cut_line, find_first_row

MAX_ROWS = 8
MAX_WIDTH = 76
MIN_WIDTH = 24
_GROUND, _CHOSEN_GROUND = Style(bgcolor=palette.FIELD), Style(bgcolor=design.CHOSEN, bold=True)
_NAME, _SIGNATURE, _HELP = (
    Style(color=palette.WHITE),
    Style(color=design.PALE),
    Style(color=palette.YELLOW),
)
_HELP_GROUND = Style(bgcolor=design.RAISED)


def list_lines(candidates: Sequence[Candidate], chosen: int, width: int) -> list[Line]:
    """Return the rows of a list of names, `width` cells wide: the names around the chosen one, and its help."""
    room = min(MAX_ROWS, len(candidates))
    first = find_first_row(chosen, len(candidates), room)
    lines: list[Line] = []
    for index, candidate in enumerate(candidates[first : first + room], start=first):
        ground = _CHOSEN_GROUND if index == chosen else _GROUND
        after = candidate.signature or (f" {candidate.kind}" if candidate.kind else "")
        row = cut_line(
            [
                ("▸" if index == chosen else " ", _NAME),
                (candidate.name, _NAME),
                (after, _SIGNATURE),
            ],
            width - 1,
        )
        lines.append(_pad_line([(text, style + ground) for text, style in row], width, ground))
    count = f" {chosen + 1}/{len(candidates)} " if len(candidates) > room else " "
    help_text = cut(candidates[chosen].help, width - 1 - len(count))
    row = [
        (f" {help_text}".ljust(width - len(count)), _HELP + _HELP_GROUND),
        (count, _SIGNATURE + _HELP_GROUND),
    ]
    return [*lines, row]


def _pad_line(line: Sequence[tuple[str, Style]], width: int, style: Style) -> Line:
    return [*line, (" " * (width - sum(len(text) for text, _ in line)), style)]


def measure_width(candidates: Sequence[Candidate], room: int) -> int:
    """Return the width that a list of names needs, in cells; at most `room`."""
    longest = max(
        max(len(candidate.name) + len(candidate.signature or candidate.kind), len(candidate.help))
        for candidate in candidates
    )
    return min(room, MAX_WIDTH, max(MIN_WIDTH, longest + 3))


def list_place(word: Offset, size: Size, screen: Size) -> Offset:
    """Return the position on the screen at which the whole list of names is visible.

    The list is below the word that is being typed or, if there is no room, above the word.

    Args:
        word: Position of the word.
        size: Size of the list.
        screen: Size of the screen.
    """
    below = word.y + 1
    y = below if below + size.height <= screen.height else max(0, word.y - size.height)
    return Offset(max(0, min(word.x - 1, screen.width - size.width - 1)), y)


def format_signature(signature: Signature, width: int) -> Text:
    """Return a signature with its current parameter in bold, cut to `width` cells around that parameter."""
    indices = range(len(signature.parameters))
    middle = signature.index or 0
    while len(text := _build_signature(signature, indices)) > width and len(indices) > 1:
        # The parameters that are farther away go first.
        indices = (
            indices[1:] if middle - indices.start >= indices.stop - 1 - middle else indices[:-1]
        )
    text.truncate(max(width, 1), overflow="ellipsis")
    return text


def _build_signature(signature: Signature, indices: range) -> Text:
    text = Text(f"{signature.name}(", end="", no_wrap=True)
    words = [
        (signature.parameters[index], "bold" if index == signature.index else "")
        for index in indices
    ]
    before = [("…", "")] if indices.start else []
    after = [("…", "")] if indices.stop < len(signature.parameters) else []
    for index, (word, style) in enumerate([*before, *words, *after]):
        text.append(", " if index else "")
        text.append(word, style)
    return text.append(")")


class CandidateList(Widget):
    """The list of names that may complete a word, above everything else on the screen.

    The focus always stays in the text; the text passes on the keys that are meant for the list.
    """

    ALLOW_SELECT = False
    DEFAULT_CSS = "CandidateList { overlay: screen; display: none; width: auto; height: auto; }"
    _KEYS: ClassVar[frozenset[str]] = frozenset(
        {"up", "down", "pageup", "pagedown", "enter", "tab", "escape"}
    )

    @dataclass
    class Chosen(Message):
        """Posted when a name in the list was clicked."""

        name: str

    def __init__(self) -> None:
        super().__init__()
        self._candidates: tuple[Candidate, ...] = ()
        self._shown: tuple[Candidate, ...] = ()
        self._chosen = 0
        self._width = 0
        self._word = ""
        self._opened_s = 0.0
        self.is_offered = False
        """Whether the list opened by itself; then only Enter, Tab and a click write a name into the text."""
        self.begin = (0, 0)
        """Row and column at which the word that is being completed begins."""

    @property
    def is_open(self) -> bool:
        """Whether the list of names is on the screen."""
        return bool(self._shown)

    def open(
        self, candidates: tuple[Candidate, ...], begin: tuple[int, int], word: str, place: Offset
    ) -> None:
        """Show the names that begin with a word.

        Args:
            candidates: All names, also those that do not begin with the word.
            begin: Row and column of the word in the text.
            word: The letters typed so far.
            place: Position of the word on the screen.
        """
        self._candidates = candidates
        self.begin = begin
        self.is_offered = False
        self._opened_s = time.monotonic()
        self._width = measure_width(candidates, self.screen.size.width - 2)
        self.filter(word, place)

    def filter(self, word: str, place: Offset) -> None:
        """Show only the names that begin with a word.

        Close the list if there is no such name, or if the only such name is the word itself.

        Args:
            word: The letters typed so far.
            place: Position of the word on the screen.
        """
        if word == self._word and self.is_open:
            return
        self._word = word
        begin = [
            candidate
            for candidate in self._candidates
            if candidate.name.lower().startswith(word.lower())
        ]
        if not begin or [candidate.name for candidate in begin] == [word]:
            self.close()
            return
        self._shown = tuple(begin)
        self._chosen = 0
        size = Size(self._width, min(len(begin), MAX_ROWS) + 1)
        self.absolute_offset = list_place(place, size, self.screen.size)
        self.styles.width, self.styles.height = size
        self.display = True
        self.refresh()

    def close(self) -> None:
        """Hide the list of names."""
        self._candidates = self._shown = ()
        self.display = False

    def can_complete(self, word: str) -> bool:
        """Return whether a dot or a parenthesis typed after a word replaces the word by the selected name of the list.

        This is so only if the user has asked for the open list, and the word itself is not a name in it.
        """
        return (
            self.is_open and bool(word) and not self.is_offered and not self._has_whole_name(word)
        )

    def takes_key(self, event: events.Key) -> bool:
        """Return whether the open list, and not the text, handles a key.

        Enter begins a new line in the text instead if it was pressed before the list was visible, or if the list has
        opened by itself and the word is a complete name already.
        """
        is_whole = self.is_offered and self._has_whole_name(self._word)
        ends_line = event.key == "enter" and (is_whole or event.time < self._opened_s)
        return self.is_open and event.key in self._KEYS and not ends_line

    def _has_whole_name(self, word: str) -> bool:
        return any(candidate.name == word for candidate in self._shown)

    def take_key(self, key: str) -> str:
        """Handle a key of the list; return the name to write into the text, empty if the key chooses none."""
        name = ""
        match key:
            case "escape":
                self.close()
            case "enter" | "tab":
                name = self._shown[self._chosen].name
                self.close()
            case "pageup" | "pagedown":
                by = MAX_ROWS if key == "pagedown" else -MAX_ROWS
                self._chosen = min(max(0, self._chosen + by), len(self._shown) - 1)
            case _:
                self._chosen = (self._chosen + (1 if key == "down" else -1)) % len(self._shown)
        self.refresh()
        return name

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the list."""
        lines = list_lines(self._shown, self._chosen, self._width) if self._shown else []
        segments = [Segment(text, style) for text, style in lines[y]] if y < len(lines) else []
        return Strip(segments, self._width if segments else 0)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Choose the name that was clicked, and leave the focus in the text."""
        event.stop()
        event.prevent_default()
        first = find_first_row(self._chosen, len(self._shown), min(MAX_ROWS, len(self._shown)))
        if event.y < min(MAX_ROWS, len(self._shown)):
            name = self._shown[first + event.y].name
            self.close()
            self.post_message(self.Chosen(name))

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Choose the next name in the list."""
        event.stop()
        self.take_key("down")

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Choose the previous name in the list."""
        event.stop()
        self.take_key("up")
