"""Code panel: the program, to be read and edited; the running line lit, the line of an error marked."""

from __future__ import annotations

import time
from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.widgets import TextArea
from textual.widgets.text_area import Selection

from tuisim.app.editor.area import CodeArea
from tuisim.app.editor.find_bar import FIND, LINE, FindBar
from tuisim.app.editor.line_edits import places
from tuisim.app.editor.line_map import LineMap
from tuisim.app.snapshot import ENDED, IDLE, RUNNING, Snapshot
from tuisim.source import source_lines

LIT_GAP_S = 0.1
"""The light moves no more often while the program runs: the eye would see only flicker."""

NOTHING_OPEN = "No program: o opens one, ctrl+t begins a new one"
_TYPING_KEYS = "esc done  ^s save  ^r run  ^f find"


class Code(Vertical):
    """The program's text."""

    TITLE: ClassVar[str] = "Code"

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+s", "want('save')", "Save the program", show=False),
        Binding("f5,ctrl+r", "want('run')", "Run", show=False),
    ]

    class Edited(Message):
        """The text was changed here."""

        def __init__(self, text: str) -> None:
            super().__init__()
            self.text = text

    class Wanted(Message):
        """To `save` the program, to `run` it, a `new` one, to `open` another; or there is `none` to be edited."""

        def __init__(self, what: str) -> None:
            super().__init__()
            self.what = what

    class TypingChanged(Message):
        """Letters go into the text from now on, or no more."""

        def __init__(self, typing: bool) -> None:
            super().__init__()
            self.typing = typing

    class BreakpointToggled(Message):
        """The number of a line, from 1, was clicked on."""

        def __init__(self, line: int) -> None:
            super().__init__()
            self.line = line

    def __init__(self) -> None:
        super().__init__()
        self.border_title = self.TITLE
        self._area = CodeArea()
        self._bar = FindBar()
        self._key: str | None = None
        self._shown = ""
        """The text as it was last given or told of."""
        self._run_lines: list[str] | None = None
        self._mapped: tuple[list[str], LineMap] | None = None
        """The lines that were shown when the run's were last looked for among them."""
        self._tells_run = self._in_run = False
        self._lit_at_s = 0.0
        self._line = 0
        self._said = (self.TITLE, "")

    def compose(self) -> ComposeResult:
        """The text, and the bar below it."""
        self._area.placeholder = NOTHING_OPEN
        yield self._area
        yield self._bar

    # What is shown

    @property
    def cursor_line(self) -> int:
        """The line that the cursor is on, from 1."""
        return self._area.cursor_location[0] + 1

    @property
    def typing(self) -> bool:
        """Whether letters go into the text."""
        return self._area.typing

    def set_program(self, name: str, text: str, key: str = "") -> None:
        """Show a program.

        Args:
            name: Of its file; empty for no program.
            text: As it stands in the file.
            key: Tells one program from another; of the same one, cursor and scroll stay.
        """
        key = key or name
        if key != self._key:
            self._key, self._run_lines, self._mapped, self._line = key, None, None, 0
            self._area.light(0)
            self._area.set_error(0)
            self._area.placeholder = "" if name else NOTHING_OPEN
            self._area.load_program(text)
            self._area.scroll_to(y=0, animate=False, force=True)
            if not name:
                self.stop_typing()
        elif text != self._shown:
            self._area.replace_program(text)
            # What was wrong was wrong with the text before.
            self._area.set_error(0)
        self._shown = text
        self.set_title(name)

    def set_title(self, name: str, edited: bool = False) -> None:
        """Say what program it is, and whether it has unsaved changes."""
        self._said = (f"{self.TITLE}: {name}" if name else self.TITLE, " • edited" if edited else "")
        self._say()

    def _say(self) -> None:
        title, edited = self._said
        # A file's name is no markup.
        self.border_title = title.replace("[", "\\[") + edited
        tells = self._run_lines is not None and self._tells_run and self._in_run
        differs = tells and self._run_lines != source_lines(self._shown)
        keys = _TYPING_KEYS if self.typing else ""
        self.border_subtitle = "  ".join(filter(None, ["running text differs" if differs else "", keys]))

    def set_running(self, text: str | None, tells: bool = True) -> None:
        """Say what text the run has that is looked at.

        Args:
            text: None without a run.
            tells: Whether it is a run of this program, so that it is told when the two texts differ.
        """
        self._run_lines, self._mapped = source_lines(text) if text is not None else None, None
        self._tells_run = tells
        self._say()

    def set_marks(self, breaks: Mapping[int, str]) -> None:
        """Put marks before lines: `●` a breakpoint, `○` one switched off, `◆` one with a condition."""
        self._area.set_breaks(breaks)

    def mark_run_error(self, line: int) -> None:
        """Mark the line of the run's text at which it ended with an error, as far as it is there; 0 for none."""
        self.mark_error(self._line_shown(line))

    @property
    def error_line(self) -> int:
        """The line that is marked as wrong, 0 for none."""
        return self._area.error_line

    def mark_error(self, line: int) -> None:
        """Mark the line of an error; 0 takes the mark away."""
        self._area.set_error(line)
        if line:
            self._area.scroll_to_line(line)

    def show(self, snapshot: Snapshot) -> None:
        """Light the line that lets the time pass."""
        in_run = snapshot.state not in (IDLE, ENDED) or snapshot.past
        if in_run != self._in_run:
            self._in_run = in_run
            self._say()
        line = snapshot.line if in_run else 0
        if line == self._line:
            return
        now = time.monotonic()
        if snapshot.state == RUNNING and not snapshot.past and now - self._lit_at_s < LIT_GAP_S:
            return
        self._lit_at_s = now
        self.show_line(line)

    def show_line(self, line: int) -> None:
        """Light a line of the run's text, 0 for none, where it is in the text that is shown."""
        self._line = line
        lit = self._line_shown(line)
        self._area.light(lit)
        if lit and not self.typing:
            self._area.scroll_to_line(lit)

    def _line_shown(self, line: int) -> int:
        """Where a line of the run's text is in the text that is shown, 0 if it is not there any more."""
        if self._run_lines is None:
            return line
        lines = self._area.document.lines
        if self._mapped is None or self._mapped[0] != lines:
            self._mapped = list(lines), LineMap(self._run_lines, lines)
        return self._mapped[1].to_shown(line)

    # Typing

    def start_typing(self, at_error: bool = False) -> None:
        """Let letters go into the text.

        Args:
            at_error: Begin on the line that is marked as wrong, if there is one.
        """
        if not self._key:
            self.post_message(self.Wanted("none"))
            return
        self._area.focus()
        if at_error and self.error_line:
            self._area.move_to_code(self.error_line)
        self._type(True)

    def stop_typing(self) -> None:
        """Let letters be the app's keys again."""
        self._type(False)
        self._area.scroll_to(x=0, animate=False, force=True)

    def _type(self, typing: bool) -> None:
        if typing != self.typing:
            self._area.read_only = not typing
            self._say()
            self.post_message(self.TypingChanged(typing))

    def on_text_area_changed(self, event: TextArea.Changed) -> None:
        """Tell of an edit."""
        event.stop()
        text = self._area.program_text
        if text != self._shown:
            self._shown = text
            self._area.set_error(0)
            self.show_line(self._line)
            self._say()
            self.post_message(self.Edited(text))

    def action_want(self, what: str) -> None:
        """Ask the app for something."""
        self.post_message(self.Wanted(what))

    def on_code_area_gutter_clicked(self, event: CodeArea.GutterClicked) -> None:
        """A breakpoint, there or away."""
        event.stop()
        self.post_message(self.BreakpointToggled(event.line))

    def on_code_area_wanted(self, event: CodeArea.Wanted) -> None:
        """Do what a key stands for."""
        event.stop()
        match event.what:
            case "type":
                self.start_typing()
            case "done":
                self.stop_typing()
            case "find":
                self._bar.open(FIND)
            case "line":
                self._bar.open(LINE)
            case "next":
                self._find(self._bar.wanted, 1)
            case "previous":
                self._find(self._bar.wanted, -1)
            case what:
                self.post_message(self.Wanted(what))

    # Finding

    def on_find_bar_asked(self, event: FindBar.Asked) -> None:
        """Go to a place in the text."""
        event.stop()
        if event.mode == FIND:
            self._find(event.text, event.by)
        elif event.text.strip().isdecimal():
            line = min(max(1, int(event.text)), self._area.document.line_count)
            self._area.move_cursor((line - 1, 0), center=True)
        else:
            self._bar.say("a number, please")

    def on_find_bar_closed(self, event: FindBar.Closed) -> None:
        """Back to the text."""
        event.stop()
        self._area.focus()

    def _find(self, wanted: str, by: int) -> None:
        found = places(self._area.document.lines, wanted)
        if not found:
            self._bar.say("not found" if wanted else "")
            return
        here = self._area.selection.start if by else min(self._area.selection)
        if by > 0:
            at = bisect_right(found, here)
        elif by < 0:
            at = bisect_left(found, here) - 1
        else:
            at = bisect_left(found, here)
        at %= len(found)
        row, column = found[at]
        self._area.selection = Selection((row, column), (row, column + len(wanted)))
        self._area.scroll_cursor_visible(center=True)
        self._bar.say(f"{at + 1} of {len(found)}")
