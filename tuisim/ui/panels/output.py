"""Output panel: what the program printed, said and was answered, and the field for `input()`."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from rich.segment import Segment
from rich.style import Style
from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip
from textual.widgets import Input, Static

from tuisim.datalog.records import INPUT, SPEECH, STDERR, STDOUT, OutputRow
from tuisim.ui.snapshot import Snapshot

KEPT_LINES = 2000
MAX_LINE_CHARS = 2000
"""What of one line is shown."""

_NOTE = 0
"""Stream of a line of the panel's own."""

_PREFIX = {SPEECH: "says: ", INPUT: "> "}
_COLORS = {STDOUT: "", STDERR: "log--error", SPEECH: "log--speech", INPUT: "log--answer", _NOTE: "log--note"}


def plain(text: str) -> str:
    """Return text without what a terminal would obey: tabs become spaces, other controls a dot."""
    if text.isprintable():
        return text
    return "".join(char if char.isprintable() else "·" for char in text.expandtabs(4))


def shown_lines(row: OutputRow, width: int) -> list[str]:
    """Return a row as lines of at most `width` cells, at least one."""
    text = row.text
    if len(text) > MAX_LINE_CHARS:
        text = f"{text[:MAX_LINE_CHARS]} … ({len(text) - MAX_LINE_CHARS} more characters)"
    text = _PREFIX.get(row.stream, "") + plain(text)
    if len(text) <= width and text.isascii():
        return [text]
    return chop_cells(text, max(width, 2)) or [""]


class Log(ScrollView, can_focus=True):
    """The lines, the newest at the bottom; follows them unless scrolled up."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"log--error", "log--speech", "log--answer", "log--note"}
    ALLOW_SELECT = False

    def __init__(self) -> None:
        super().__init__()
        self._rows: deque[OutputRow] = deque(maxlen=KEPT_LINES)
        self._count = 0
        self._lines: list[tuple[str, int]] = []
        self._width = 0
        self._following = True
        """Whether the newest line is kept in view: until the user scrolls up."""

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Follow the newest line again once the user has scrolled down to it."""
        super().watch_scroll_y(old_value, new_value)
        self._following = round(new_value) >= self.max_scroll_y

    def clear(self) -> None:
        """Forget every line."""
        self._rows.clear()
        self._lines.clear()
        self._count = 0
        self._following = True
        self._follow()

    def add(self, rows: Sequence[OutputRow], skipped: int = 0) -> None:
        """Append rows; `skipped` ones before them are only counted."""
        self._count += len(rows) + skipped
        newest = rows[-KEPT_LINES:]
        self._rows.extend(newest)
        if self._width:
            self._wrap(newest)
            del self._lines[: max(0, len(self._lines) - KEPT_LINES)]
        self._follow()

    @property
    def _hidden(self) -> int:
        """Rows that came earlier than those kept."""
        return self._count - len(self._rows)

    def _wrap(self, rows: Iterable[OutputRow]) -> None:
        for row in rows:
            self._lines.extend((line, row.stream) for line in shown_lines(row, self._width))

    def _follow(self) -> None:
        # A first line says what is not shown.
        height = len(self._lines) + (1 if self._hidden else 0)
        self.virtual_size = Size(self.scrollable_content_region.width, height)
        if self._following:
            self.scroll_to(y=self.max_scroll_y, animate=False, force=True)
        self.refresh()

    def on_resize(self, event: events.Resize) -> None:
        """Wrap anew."""
        # One column stays free for the scroll bar, so that its coming does not move the text.
        width = max(4, self.size.width - 1)
        if width != self._width:
            self._width = width
            self._lines.clear()
            self._wrap(self._rows)
            del self._lines[: max(0, len(self._lines) - KEPT_LINES)]
        self._follow()

    def render_line(self, y: int) -> Strip:
        """Return one row of the screen."""
        width = self.scrollable_content_region.width
        at = y + self.scroll_offset.y
        base = self.rich_style
        if self._hidden:
            if at == 0:
                note = f"… {self._hidden:,} earlier lines are in the log"
                return _strip(note, width, base + self.get_component_rich_style("log--note", partial=True))
            at -= 1
        if not 0 <= at < len(self._lines):
            return Strip.blank(width, base)
        text, stream = self._lines[at]
        color = _COLORS[stream]
        return _strip(text, width, base + self.get_component_rich_style(color, partial=True) if color else base)


def _strip(text: str, width: int, style: Style) -> Strip:
    return Strip([Segment(text, style)], cell_len(text)).adjust_cell_length(width, style)


class Answer(Input):
    """The field that answers `input()`."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+d", "end_of_file", "End of file", show=False, priority=True),
    ]

    class EndOfFile(Message):
        """The user gave end of file instead of an answer."""

    def action_end_of_file(self) -> None:
        """Answer with end of file."""
        self.post_message(self.EndOfFile())


class Output(Vertical):
    """What the program prints."""

    PANEL_ID: ClassVar[str] = "output"
    TITLE: ClassVar[str] = "Output"

    class Answered(Message):
        """The user answered `input()`; None is end of file."""

        def __init__(self, text: str | None) -> None:
            super().__init__()
            self.text = text

    def __init__(self) -> None:
        super().__init__()
        self.border_title = self.TITLE
        self._log = Log()
        self.asking = False
        """Whether the field for `input()` is there."""

    def compose(self) -> ComposeResult:
        """The lines; the field comes when it is wanted."""
        yield self._log

    def clear(self) -> None:
        """Forget every line."""
        self._log.clear()

    def add(self, rows: Sequence[OutputRow], skipped: int = 0) -> None:
        """Append rows; `skipped` ones before them are only counted."""
        self._log.add(rows, skipped)

    def note(self, text: str) -> None:
        """Append a line that is not the program's."""
        self._log.add([OutputRow(text, 0, 0, 0, _NOTE)])

    def ask(self, prompt: str) -> None:
        """Show the field for an answer, with the program's prompt before it."""
        self.asking = True
        words = plain(prompt).strip() or "The program waits for input"
        answer = Answer(placeholder="Enter answers, ctrl+d ends the input", compact=True)
        self.mount(Static(words, classes="prompt", markup=False), answer)
        answer.focus()

    def stop_asking(self) -> None:
        """Take the field away."""
        self.asking = False
        self.query(".prompt, Answer").remove()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self._answer(event.value)

    @on(Answer.EndOfFile)
    def _end_of_file(self, event: Answer.EndOfFile) -> None:
        event.stop()
        self._answer(None)

    def _answer(self, text: str | None) -> None:
        # The field goes when the run says that it no longer waits.
        self.post_message(self.Answered(text))

    def show(self, snapshot: Snapshot) -> None:
        """Rows come by `add`."""
