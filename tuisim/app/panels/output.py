"""The output panel: prints, speech and answers of a run, and the field for `input()`."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Sequence
from typing import ClassVar

from rich.cells import cell_len, chop_cells
from rich.segment import Segment
from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Input, Static

from tuisim.app.action import fill_keys
from tuisim.app.clipboard import Copied
from tuisim.app.panels import PANELS
from tuisim.app.panels.titles import build_title
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.runs.records import OutputRow, Stream

_INFO = PANELS["output"]
IDLE_WORDS = "What the program prints appears here: {run} runs it"


class Answer(Input):
    """The text field for an answer to `input()`."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+d", "end_of_file", "End of file", priority=True),
    ]

    class EndOfFile(Message):
        """Posted when the user answers `input()` with end of file."""

    def action_end_of_file(self) -> None:
        self.post_message(self.EndOfFile())


class Output(Vertical):
    """The output panel: what the program has printed, and the field for its `input()`."""

    @dataclass
    class Answered(Message):
        """Posted when the user has answered `input()`; a text of None stands for end of file."""

        text: str | None

    def __init__(self) -> None:
        super().__init__()
        self._log = Log()
        self._past_log = Log()
        """The output up to a past instant, shown instead of the whole output."""
        self._past_log.display = False
        self.asking = False
        """Whether the field for `input()` is shown."""
        self._program_name = ""

    def compose(self) -> ComposeResult:
        yield self._log
        yield self._past_log

    def set_program(self, name: str) -> None:
        """Show the name of the program that has printed the output."""
        if name != self._program_name:
            self._program_name, self.border_title = name, build_title(self.app, _INFO.id, name)

    def copy_text(self) -> Copied:
        """Return the lines of the output at the instant in view, also those scrolled out of the panel."""
        return Copied(_INFO.title, (self._log if self._log.display else self._past_log).text)

    def clear(self) -> None:
        """Remove all lines of the output."""
        self._log.clear()

    def show_past(self, rows: Sequence[OutputRow] | None, before: int = 0) -> None:
        """Show the output up to a past instant.

        Args:
            rows: The last rows up to that instant; None shows the whole output again.
            before: The number of rows before them.
        """
        self._log.display = rows is None
        self._past_log.display = rows is not None
        if rows is not None:
            self._past_log.clear()
            self._past_log.add(rows, before)

    def add(self, rows: Sequence[OutputRow], skipped: int = 0) -> None:
        """Append rows to the output.

        Args:
            rows: The rows.
            skipped: Number of rows before them that are not shown, but counted.
        """
        self._log.add(rows, skipped)

    def note(self, text: str) -> None:
        """Append a line that comes from the app, not from the program."""
        self._log.add([OutputRow(text, 0, 0, 0, Stream.NOTE)])

    def ask(self, prompt: str) -> None:
        """Show the field for an answer to `input()`, with the prompt of the program before it."""
        self.asking = True
        words = replace_controls(prompt).strip() or "The program waits for input"
        answer = Answer(placeholder="Enter sends, ctrl+d ends", compact=True)
        self.mount(Static(words, classes="prompt", markup=False), answer)
        answer.focus()

    def stop_asking(self) -> None:
        """Remove the field for an answer."""
        self.asking = False
        self.query(".prompt, Answer").remove()

    @on(Input.Submitted)
    def _post_answer(self, event: Input.Submitted) -> None:
        event.stop()
        # The field is removed when the run reports that it no longer waits.
        self.post_message(self.Answered(event.value))

    @on(Answer.EndOfFile)
    def _end_of_file(self, event: Answer.EndOfFile) -> None:
        event.stop()
        self.post_message(self.Answered(None))

    def show(self, snapshot: Snapshot) -> None:
        """Before the first run, show in the empty panel what it is for; the output itself comes through `add`."""
        self._log.say_if_empty(
            fill_keys(self.app, IDLE_WORDS) if snapshot.state is RunPhase.IDLE else ""
        )


KEPT_LINES = 2000
MAX_LINE_CHARS = 2000
"""Longest part of a line that is shown."""

_STYLES = {
    Stream.STDOUT: "",
    Stream.STDERR: "log--error",
    Stream.SPEECH: "log--speech",
    Stream.INPUT: "log--answer",
    Stream.NOTE: "log--note",
}

_BREAKS = " /\\", "(,._"
"""The characters after which a line may break, the best ones first."""
_LOW_ROWS = 5
"""In a panel of at most as many rows, those of a traceback that only point stand back for those that tell."""
_CARETS = re.compile(r" +[~^]+")
"""A line of a traceback that points at a part of the line above."""

Line = tuple[str, Stream]
"""The text of a line, and its stream."""


def replace_controls(text: str) -> str:
    """Return a text with blanks in place of tabs, and dots in place of other control characters."""
    if text.isprintable():
        return text
    return "".join(char if char.isprintable() else "·" for char in text.expandtabs(4))


def split_row(row: OutputRow, width: int) -> list[str]:
    """Return an output row as one or more lines of at most `width` cells."""
    text = row.format_line()
    if len(text) > MAX_LINE_CHARS:
        text = (
            f"{text[:MAX_LINE_CHARS]} … ({counted(len(text) - MAX_LINE_CHARS, 'more character')})"
        )
    text = replace_controls(text)
    if cell_len(text) != len(text):
        return chop_cells(text, max(width, 2)) or [""]
    lines = []
    while len(text) > width:
        cut = _find_break(text, width)
        lines.append(text[:cut])
        text = text[cut:]
    return [*lines, text]


def _find_break(text: str, width: int) -> int:
    """Return the index at which to break a text that is longer than `width` cells.

    The break is behind a separator if at least half of the row is then filled; else at the last blank, if the word
    after it fits into one row; else at `width`.
    """
    good, fair = (
        max(text.rfind(sign, width // 2, width) for sign in signs) + 1 for signs in _BREAKS
    )
    blank = text.rfind(" ", 0, width) + 1
    end = text.find(" ", blank)
    fits = text[:blank].strip() and (end if end >= 0 else len(text)) - blank <= width
    return good or (blank if fits else 0) or fair or width


class Log(Widget, can_focus=True):
    """The lines of the output; the newest lines are visible unless the user has scrolled up."""

    # A ScrollView repaints all rows for each new line; this widget does not resend unchanged rows.
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "log--error",
        "log--speech",
        "log--answer",
        "log--note",
        "log--thumb",
    }
    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        ("up", "scroll_lines(-1)", "Scroll up"),
        ("down", "scroll_lines(1)", "Scroll down"),
        ("pageup", "scroll_pages(-1)", "Page up"),
        ("pagedown", "scroll_pages(1)", "Page down"),
        ("home", f"scroll_lines(-{KEPT_LINES * MAX_LINE_CHARS})", "First"),
        ("end", f"scroll_lines({KEPT_LINES * MAX_LINE_CHARS})", "Newest"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._rows: deque[OutputRow] = deque(maxlen=KEPT_LINES)
        self._count = 0
        """Number of rows ever added."""
        self._lines: list[Line] = []
        self._has_broken = False
        """Whether the newest row takes several lines."""
        self._top: int | None = None
        """First visible line; None follows the newest."""
        self._shown: list[tuple[Line, bool]] = []
        """For each row of the screen: its line, and whether the scroll thumb covers it."""
        self._empty_words = ""
        """Words that are shown while there are no lines."""

    # Content

    def say_if_empty(self, words: str) -> None:
        """Set the words to show while there are no lines."""
        if words != self._empty_words:
            self._empty_words = words
            self._update()

    @property
    def text(self) -> str:
        """The stored output rows as one text, without line breaks of the panel."""
        return "\n".join(replace_controls(row.format_line()) for row in self._rows)

    def clear(self) -> None:
        """Remove all lines from the list."""
        self._rows.clear()
        self._lines.clear()
        self._count = 0
        self._top = None
        self._update()

    def add(self, rows: Sequence[OutputRow], skipped: int = 0) -> None:
        """Append rows to the output; rows that are not text are ignored.

        Args:
            rows: The rows.
            skipped: Number of rows before them that are not shown, but counted.
        """
        texts = [row for row in rows if row.stream in _STYLES]
        self._count += len(texts) + skipped
        newest = texts[-KEPT_LINES:]
        self._rows.extend(newest)
        self._wrap(newest)
        self._update()

    def _wrap(self, rows: Iterable[OutputRow]) -> None:
        # The last column belongs to the scroll thumb.
        width = self.size.width - 1
        if width < 1:
            return
        for row in rows:
            lines = split_row(row, width)
            points = row.stream is Stream.STDERR and _CARETS.fullmatch(row.text)
            has_room = len(lines) == 1 and self.size.height > _LOW_ROWS
            if not points or (has_room and not self._has_broken):
                self._lines.extend((line, row.stream) for line in lines)
            self._has_broken = len(lines) > 1
        too_many = len(self._lines) - KEPT_LINES
        if too_many > 0:
            del self._lines[:too_many]
            if self._top is not None:
                self._top = max(0, self._top - too_many)

    def on_resize(self, event: events.Resize) -> None:
        self._lines.clear()
        self._wrap(self._rows)
        self._shown.clear()
        self._update()

    # View

    @property
    def _all(self) -> int:
        """The number of lines to scroll through: the stored lines, and one line for older rows that are not stored."""
        return len(self._lines) + (1 if self._count > len(self._rows) else 0)

    def _find_line(self, index: int) -> Line:
        hidden = self._count - len(self._rows)
        if hidden:
            if index == 0:
                text = f"… {counted(hidden, 'earlier line is', 'earlier lines are')} in the log"
                return text[: self.size.width - 1], Stream.NOTE
            index -= 1
        return self._lines[index] if 0 <= index < len(self._lines) else ("", Stream.STDOUT)

    def _update(self) -> None:
        height = self.size.height
        if not height:
            return
        last_top = max(0, self._all - height)
        top = last_top if self._top is None else min(self._top, last_top)
        thumb = range(0)
        if last_top:
            size = max(1, height * height // self._all)
            start = round((height - size) * top / last_top)
            thumb = range(start, start + size)
        rows = [(self._find_line(top + y), y in thumb) for y in range(height)]
        if (line := rows[0][0])[1] is Stream.STDERR and _CARETS.fullmatch(line[0]):
            # The first visible row has only carets, which mark an error in the line above: leave them out.
            rows[0] = ("", Stream.STDERR), rows[0][1]
        if not self._all and self._empty_words:
            words = split_row(
                OutputRow(self._empty_words, 0, 0, 0, Stream.NOTE), max(1, self.size.width - 1)
            )
            rows[: len(words)] = [((text, Stream.NOTE), False) for text in words[:height]]
        before = self._shown
        self._shown = rows
        if len(before) != height:
            self.refresh()
            return
        changed = [Region(0, y, self.size.width, 1) for y in range(height) if rows[y] != before[y]]
        if changed:
            self.refresh(*changed)

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the widget."""
        width = self.size.width
        base = self.rich_style
        if y >= len(self._shown) or width < 2:
            return Strip.blank(width, base)
        (text, stream), thumb = self._shown[y]
        name = _STYLES[stream]
        style = base + self.get_component_rich_style(name, partial=True) if name else base
        strip = Strip([Segment(text, style)], cell_len(text)).adjust_cell_length(width - 1, base)
        end = base + self.get_component_rich_style("log--thumb", partial=True) if thumb else base
        return Strip([*strip, Segment(" ", end)], width)

    # Scrolling

    def action_scroll_lines(self, lines: int) -> None:
        """Scroll down by a number of lines; a negative number scrolls up."""
        last_top = max(0, self._all - self.size.height)
        top = (last_top if self._top is None else self._top) + lines
        # When the user has scrolled to the end, the view follows the newest line again.
        self._top = None if top >= last_top else max(0, top)
        self._update()

    def action_scroll_pages(self, pages: int) -> None:
        self.action_scroll_lines(pages * max(1, self.size.height - 1))

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        event.stop()
        self.action_scroll_lines(-3)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        event.stop()
        self.action_scroll_lines(3)
