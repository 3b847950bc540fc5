"""Code panel: the program, its running line lit, the line of an error marked."""

from __future__ import annotations

import time
from typing import ClassVar

from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region, Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tuisim.ui.panels.log import plain
from tuisim.ui.snapshot import ENDED, IDLE, RUNNING, Snapshot

LIT_GAP_S = 0.1
"""The light moves no more often while the program runs: the eye would see only flicker."""

Piece = tuple[str, str]
"""Text and the kind of its token, one of `_KINDS` or empty."""

_KINDS = {
    "Keyword": "code--keyword",
    "String": "code--string",
    "Comment": "code--comment",
    "Number": "code--number",
    "Function": "code--name",
    "Class": "code--name",
    "Builtin": "code--name",
}


def _kind(token: tuple[str, ...]) -> str:
    for part in token:
        if part in _KINDS:
            return _KINDS[part]
    return ""


def plain_lines(text: str) -> list[list[Piece]]:
    """Return the lines of a program without colours."""
    return [[(plain(line), "")] for line in text.rstrip("\n").split("\n")]


def coloured_lines(text: str) -> list[list[Piece]]:
    """Return the lines of a program in pieces of one colour."""
    from pygments.lexers.python import PythonLexer

    lines: list[list[Piece]] = [[]]
    for token, value in PythonLexer(stripnl=False, ensurenl=False).get_tokens(text.rstrip("\n")):
        first, *more = value.split("\n")
        lines[-1].append((plain(first), _kind(token)))
        lines.extend([(plain(part), _kind(token))] for part in more)
    return lines


def wrapped(pieces: list[Piece], width: int) -> list[list[Piece]]:
    """Break a line into rows of at most `width` characters; what follows is indented."""
    rows: list[list[Piece]] = [[]]
    text = "".join(part for part, _ in pieces)
    indent = " " * min(len(text) - len(text.lstrip()) + 2, width // 3)
    left, fresh = width, True
    for part, kind in pieces:
        while len(part) > left:
            # A break at a blank reads better than one in a word; a word longer than a row must be cut.
            cut = part.rfind(" ", 0, left) + 1 or (left if fresh else 0)
            rows[-1].append((part[:cut], kind))
            rows.append([(indent, "")])
            part, left, fresh = part[cut:], width - len(indent), True
        rows[-1].append((part, kind))
        left -= len(part)
        fresh = fresh and not part.strip()
    return rows


class Code(ScrollView, can_focus=True):
    """The program's text."""

    PANEL_ID: ClassVar[str] = "code"
    TITLE: ClassVar[str] = "Code"
    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "code--number-column", "code--lit", "code--error", *_KINDS.values(),
    }  # fmt: skip

    def __init__(self) -> None:
        super().__init__()
        self.border_title = self.TITLE
        self._text = ""
        self._lines: list[list[Piece]] = []
        self._rows: list[tuple[int, bool, list[Piece]]] = []
        """Line number, whether it is the line's first row, and its pieces."""
        self._first_row: list[int] = [0]
        """Of each line, from line 1, the number of its first row; then the number of rows."""
        self._lit = 0
        self._lit_at_s = 0.0
        self._error = 0

    # What is shown

    def set_program(self, name: str, text: str) -> None:
        """Show a program; an empty text says how to open one."""
        self.border_title = f"{self.TITLE}: {name}" if name else self.TITLE
        self._text = text
        self._lit = self._error = 0
        self._lines = plain_lines(text) if text else []
        self._wrap()
        self.scroll_to(y=0, animate=False, force=True)
        if text:
            # The lexer is imported once the plain text is on the screen.
            self.set_timer(0.1, self._colour)

    def _colour(self) -> None:
        self._lines = coloured_lines(self._text)
        self._wrap()

    def mark_error(self, line: int) -> None:
        """Mark the line of an error; 0 takes the mark away."""
        before, self._error = self._error, line
        self._refresh_line(before)
        self._refresh_line(line)
        if line:
            self._scroll_to_line(line)

    def show(self, snapshot: Snapshot) -> None:
        """Light the line that lets the time pass."""
        line = 0 if snapshot.state in (IDLE, ENDED) else snapshot.line
        if line == self._lit:
            return
        now = time.monotonic()
        if snapshot.state == RUNNING and now - self._lit_at_s < LIT_GAP_S:
            return
        before, self._lit, self._lit_at_s = self._lit, line, now
        self._refresh_line(before)
        self._refresh_line(line)
        if line:
            self._scroll_to_line(line)

    # Rows

    @property
    def _gutter(self) -> int:
        return max(2, len(str(len(self._lines)))) + 2

    def _wrap(self) -> None:
        width = max(8, self.scrollable_content_region.width - self._gutter)
        self._rows, self._first_row = [], []
        for number, pieces in enumerate(self._lines, start=1):
            self._first_row.append(len(self._rows))
            self._rows.extend((number, at == 0, row) for at, row in enumerate(wrapped(pieces, width)))
        self._first_row.append(len(self._rows))
        self.virtual_size = Size(self.scrollable_content_region.width, len(self._rows))
        self.refresh()

    def on_resize(self, event: events.Resize) -> None:
        """Wrap anew."""
        self._wrap()
        if self._lit or self._error:
            self._scroll_to_line(self._lit or self._error)

    def _rows_of(self, line: int) -> range:
        if not 1 <= line < len(self._first_row):
            return range(0)
        return range(self._first_row[line - 1], self._first_row[line])

    def _refresh_line(self, line: int) -> None:
        top = self.scroll_offset.y
        visible = [row - top for row in self._rows_of(line) if 0 <= row - top < self.size.height]
        if visible:
            self.refresh(*(Region(0, y, self.size.width, 1) for y in visible))

    def _scroll_to_line(self, line: int) -> None:
        rows = self._rows_of(line)
        height = self.scrollable_content_region.height
        if rows and not (self.scroll_offset.y <= rows.start and rows.stop <= self.scroll_offset.y + height):
            self.scroll_to(y=max(0, rows.start - height // 3), animate=False, force=True)

    def render_line(self, y: int) -> Strip:
        """Return one row of the screen."""
        width = self.scrollable_content_region.width
        at = y + self.scroll_offset.y
        base = self.rich_style
        if not self._rows and y == 0:
            return Strip([Segment("No program: o opens one", base)]).adjust_cell_length(width, base)
        if at >= len(self._rows):
            return Strip.blank(width, base)
        line, first, pieces = self._rows[at]
        mark = " "
        number_style = base + self.get_component_rich_style("code--number-column", partial=True)
        if line == self._error:
            base += self.get_component_rich_style("code--error", partial=True)
            mark, number_style = "✗" if first else " ", base
        elif line == self._lit:
            base += self.get_component_rich_style("code--lit", partial=True)
            mark, number_style = "▶" if first else " ", base
        number = f"{mark}{line if first else '':>{self._gutter - 2}} "
        segments = [Segment(number, number_style), *(Segment(part, self._style(base, kind)) for part, kind in pieces)]
        return Strip(segments).adjust_cell_length(width, base)

    def _style(self, base: Style, kind: str) -> Style:
        return base + self.get_component_rich_style(kind, partial=True) if kind else base
