"""The code panel: shows and edits the program; highlights the running line, marks the line of an error."""

from __future__ import annotations

import time
from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from enum import StrEnum
from typing import ClassVar, assert_never

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Static, TextArea
from textual.widgets.text_area import Selection

from tuisim.app.action import KeyWord, fill_keys
from tuisim.app.clipboard import Copied
from tuisim.app.editor.area import CodeArea, EditorCommand
from tuisim.app.editor.assistant import Assistant
from tuisim.app.editor.candidate_list import CandidateList
from tuisim.app.editor.text_lines import LineMap, find_matches
from tuisim.app.error_words import fit_words
from tuisim.app.panels import PANELS
from tuisim.app.panels.titles import build_title
from tuisim.app.snapshot import PauseView, RunPhase, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines
from tuisim.programs.line_values import map_line_values
from tuisim.terminal.text_runs import escape_markup

FIND = "find"
LINE = "line"


class FindBar(Horizontal):
    """The bar of the code panel with the field for a search, or for the number of a line."""

    DEFAULT_CSS = """
    FindBar { height: 1; }
    FindBar > Static { width: auto; }
    FindBar > Input { width: 1fr; height: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        ("escape", "close", "Close"),
        ("down,ctrl+f", "go(1)", "Next"),
        ("up", "go(-1)", "Before"),
    ]

    @dataclass
    class Asked(Message):
        """Posted when the user wants to find the typed text or, in the mode for lines, to go to the typed line."""

        mode: str
        text: str
        by: int
        """Which match to go to: 1 for the next one, -1 for the previous one, 0 for the one at or after the cursor."""

    class Closed(Message):
        """Posted when the bar was closed, so that the text gets the focus."""

    def __init__(self) -> None:
        super().__init__()
        self.mode = FIND
        self.wanted = ""
        """The text that the user last searched for."""
        self.display = False

    @property
    def field_keys(self) -> tuple[KeyWord, ...]:
        """The keys of the field, for the footer."""
        goes = (("enter", "next"), ("↑", "before")) if self.mode == FIND else (("enter", "go"),)
        return (*goes, ("esc", "close"))

    def compose(self) -> ComposeResult:
        yield Static(id="label", markup=False)
        yield Input(compact=True)
        yield Static(id="found", markup=False)

    def open(self, mode: str) -> None:
        """Open the bar of the code panel for a search or a line number, and focus its field.

        Args:
            mode: `FIND` for a field for a search; any other mode is for a field for a line number.
        """
        self.mode = mode
        self.display = True
        self.query_one("#label", Static).update("Find " if mode == FIND else "Line ")
        self.say("")
        field = self.query_one(Input)
        with field.prevent(Input.Changed):
            field.value = self.wanted if mode == FIND else ""
        field.select_all()
        field.focus()

    def say(self, text: str) -> None:
        """Show a message about the search, such as the number of matches, in the bar."""
        self.query_one("#found", Static).update(text)

    def action_close(self) -> None:
        self.display = False
        self.post_message(self.Closed())

    def action_go(self, by: int) -> None:
        text = self.query_one(Input).value
        if self.mode == FIND:
            self.wanted = text
        self.post_message(self.Asked(self.mode, text, by))

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        if self.mode == FIND:
            self.action_go(0)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_go(1)
        if self.mode == LINE:
            self.action_close()


LIT_GAP_S = 0.1
"""Minimum seconds between two moves of the highlighted line while the program runs: faster ones only flicker."""

_INFO = PANELS["code"]
NOTHING_OPEN = "No program: {open} opens one, {new} creates one"
_FRAME = 4
"""Cells of the panel's upper edge that words in it cannot have."""


class ProgramCommand(StrEnum):
    """A command of a key in the code panel that the app carries out, such as saving."""

    SAVE = "save"
    RUN = "run"
    NEW = "new"
    OPEN = "open"
    NONE = "none"
    """The key had no effect, because no program is open to be edited: the app says so."""


class Code(Vertical):
    """The code panel: the text of the open program, with its editor."""

    BINDINGS: ClassVar[list[BindingType]] = [
        ("ctrl+s", "want('save')", "Save the program"),
        ("f5,ctrl+r", "want('run')", "Run"),
    ]

    @dataclass
    class Edited(Message):
        """Posted when the user has edited the text in the panel."""

        text: str

    @dataclass
    class Wanted(Message):
        """Posted when a key was pressed that concerns the whole program; it has the `ProgramCommand`."""

        command: ProgramCommand

    @dataclass
    class TypingChanged(Message):
        """Posted when the user begins or ends typing in the text."""

        typing: bool

    @dataclass
    class BreakpointToggled(Message):
        """Posted when the user has clicked a line number.

        A breakpoint is then to be set there or, if there is one, removed.
        """

        line: int

    def __init__(self) -> None:
        super().__init__()
        self._area = CodeArea()
        self._assistant = Assistant(self._area, self._say)
        self._bar = FindBar()
        self._key: str | None = None
        self._shown = ""
        """The program's text in the panel, as the app last set it or the panel last reported it."""
        self._run_lines: list[str] | None = None
        self._mapped: tuple[list[str], LineMap] | None = None
        """The shown lines for which the line map was last computed, and that map; None if it must be computed anew."""
        self._tells_run = self._in_run = False
        self._lit_at_s = 0.0
        self._stands = False
        """Whether the program was paused, or the past was in view, when a line was last highlighted."""
        self._line = 0
        self._said = (_INFO.title, "")
        self._error_words = ""
        """What is wrong in the line that is marked as an error; empty if it is unknown."""
        self._break_words = ""
        self._pause: PauseView | None = None
        self._tick = 0
        """Tick of the instant in view."""
        self._named_line = 0, 0
        """A tick, and the line of the run's text to which the cursor moves at that tick; zeros for none."""

    def compose(self) -> ComposeResult:
        yield self._area
        yield self._bar
        yield self._area.candidates

    # Display

    @property
    def _nothing_open(self) -> str:
        return fill_keys(self.app, NOTHING_OPEN)

    @property
    def cursor_line(self) -> int:
        """The line of the text in which the cursor is, from 1."""
        return self._area.cursor_location[0] + 1

    @property
    def is_read(self) -> bool:
        """Whether the text has the focus; the arrow keys then move its cursor."""
        return self._area.has_focus

    @property
    def typing(self) -> bool:
        """Whether the user types in the text."""
        return self._area.typing

    @property
    def awaits_letters(self) -> bool:
        """Whether the next letter is typed into the text, because that was clicked, and is no key of the app."""
        return self._area.awaits_letters

    def set_program(self, name: str, text: str, key: str = "") -> None:
        """Show a program.

        Args:
            name: Name of its file; empty for no program.
            text: The text of the file.
            key: Identifies the program; if the program shown before has the same key, cursor and scroll position stay.
        """
        key = key or name
        if key != self._key:
            self._key = key
            self._run_lines = None
            self._mapped = None
            self._line = 0
            self._area.light(0)
            self._area.set_error(0)
            self._area.placeholder = "" if name else self._nothing_open
            # A text that was only saved to another file keeps its cursor and its history.
            if text != self._shown:
                self._area.load_program(text)
                self._area.scroll_to(y=0, animate=False, force=True)
            self._assistant.load_program(key)
            if not name:
                self.stop_typing()
        elif text != self._shown:
            self._area.replace_program(text)
            # The error was in the former text.
            self._area.set_error(0)
            self._assistant.schedule_check()
        self._shown = text
        self.set_title(name)

    def set_title(self, name: str, edited: bool = False) -> None:
        """Show the name of the program, and whether it has unsaved changes."""
        self._said = (build_title(self.app, _INFO.id, name), " • edited" if edited else "")
        self._say()

    @property
    def differs(self) -> bool:
        """Whether the run in view is a run of the shown program, but has run another text than the shown one."""
        tells = self._run_lines is not None and self._tells_run and self._in_run
        return tells and self._run_lines != source_lines(self._shown)

    def _say(self) -> None:
        title, edited = self._said
        self.border_title = title + edited
        words = fit_words(self._error_words, self.size.width - _FRAME) if self.error_line else ""
        title_words = words or ("running text differs" if self.differs else self._break_words)
        helped = Text() if words else self._assistant.describe_cursor(self.size.width - _FRAME)
        if self._area.is_completing:
            helped = Text("looking up …")
        elif (word := self._area.unknown_word) is not None:
            helped = Text(
                f"no known name begins with {word}" if word else "nothing known follows the dot"
            )
        self.border_subtitle = helped if helped else escape_markup(title_words)

    def on_resize(self) -> None:
        """Shorten the words in the frame to the new width."""
        self._say()

    def set_running(self, text: str | None, tells: bool = True) -> None:
        """Set the text that the run in view executes; the line numbers of the run refer to this text.

        Args:
            text: The text; None without a run.
            tells: Whether the panel says that the two texts differ, because the run is a run of the shown program.
        """
        self._run_lines = source_lines(text) if text is not None else None
        self._mapped = None
        self._tells_run = tells
        self._say()
        self._show_values()

    def set_marks(self, breaks: Mapping[int, str], words: str = "") -> None:
        """Set the breakpoint markers: `●` a breakpoint, `○` a disabled one, `◆` one with a condition.

        Args:
            breaks: The marker of each line with a breakpoint, by line number from 1.
            words: Words for the frame about breakpoints that are on no line.
        """
        self._area.set_breaks(breaks)
        self._break_words = words
        self._say()

    def mark_run_error(self, line: int, words: str = "") -> None:
        """Mark the line at which the run ended with an error, if the shown text still has that line.

        Args:
            line: From 1, in the text of the run; 0 removes the mark.
            words: What is wrong, see `mark_error`.
        """
        self.mark_error(self._find_shown_line(line), words)

    @property
    def error_line(self) -> int:
        """The line of the shown text that is marked as an error, 0 for none."""
        return self._area.error_line

    def mark_error(self, line: int, words: str = "") -> None:
        """Mark the line of an error, and show what is wrong.

        Args:
            line: From 1, in the shown text; 0 removes the mark.
            words: What is wrong; they stay in the frame as long as the mark.
        """
        self._area.set_error(line)
        self._error_words = words
        self._say()
        if line:
            self._area.scroll_to_line(line)

    def go_to_error(self) -> None:
        """Move the cursor to the line that is marked as an error, and scroll to it; do nothing without such a line."""
        if self.error_line:
            self._area.move_to_code(self.error_line)

    def name_line(self, tick: int, line: int) -> None:
        """Whenever a tick comes into view, put the cursor on a line, and scroll to this line.

        Args:
            tick: The tick, such as that of a printed sample.
            line: The line in the text of the run, from 1; 0 for no line.
        """
        self._named_line = tick, line
        self._go_to_named_line()

    def _go_to_named_line(self) -> None:
        tick, line = self._named_line
        if tick == self._tick and (shown_line := self._find_shown_line(line)) and not self.typing:
            self._area.move_to_code(shown_line)

    def show(self, snapshot: Snapshot) -> None:
        """Highlight the line that the program executes.

        In a live run, the highlight moves at most once in `LIT_GAP_S` seconds.
        """
        in_run = snapshot.state not in (RunPhase.IDLE, RunPhase.ENDED) or snapshot.past
        if in_run != self._in_run:
            self._in_run = in_run
            self._say()
        self._area.can_be_typed_in = bool(self._key) and not in_run
        if in_run:
            self._area.await_letters(False)
        if snapshot.instant.tick != self._tick:
            self._tick = snapshot.instant.tick
            self._show_values()
        line = snapshot.line if in_run else 0
        stands = snapshot.past or snapshot.state is RunPhase.PAUSED
        if line == self._line and stands == self._stands:
            return
        now = time.monotonic()
        if (
            snapshot.state == RunPhase.RUNNING
            and not snapshot.past
            and now - self._lit_at_s < LIT_GAP_S
        ):
            return
        self._lit_at_s = now
        self._stands = stands
        self.show_line(line)
        if (lit := self._find_shown_line(line)) and not self.typing and stands:
            # The cursor moves to the highlighted line, so that the arrow keys start from this line.
            self._area.move_to_code(lit)
            self._go_to_named_line()

    def show_line(self, line: int) -> None:
        """Highlight, in the shown text, the line that corresponds to a line of the run's text.

        0 removes the highlight.
        """
        self._line = line
        lit = self._find_shown_line(line)
        self._area.light(lit)
        if lit and not self.typing:
            self._area.scroll_to_line(lit)

    def _find_shown_line(self, line: int) -> int:
        """Return the number that a line of the run's text has in the shown text; 0 if that text lacks the line."""
        if self._run_lines is None:
            return line
        lines = self._area.document.lines
        if self._mapped is None or self._mapped[0] != lines:
            self._mapped = list(lines), LineMap(self._run_lines, lines)
        return self._mapped[1].find_shown_line(line)

    def show_pause(self, pause: PauseView | None) -> None:
        """Show the values of variables behind the lines that assign them, as they are at a pause.

        Args:
            pause: Where the program is paused; None while it runs, which removes the values.
        """
        self._pause = pause
        self._show_values()

    def _show_values(self) -> None:
        pause = self._pause
        values = {}
        # Values of another instant are not shown.
        if pause is not None and self._run_lines is not None and pause.paused.tick == self._tick:
            of_run = map_line_values("\n".join(self._run_lines), pause.inspected)
            values = {
                shown_line: variables
                for line, variables in of_run.items()
                if (shown_line := self._find_shown_line(line))
            }
        self._area.set_values(values)

    def copy_text(self) -> Copied:
        """Return the error that the panel shows; without an error, return the text of the program."""
        if self.error_line and self._error_words:
            return Copied("Error", f"line {self.error_line}: {self._error_words}")
        return Copied("Program", self._area.program_text)

    def page(self, by: int) -> None:
        """Move the cursor one page down if `by` is positive, else one page up."""
        if by > 0:
            self._area.action_cursor_page_down()
        else:
            self._area.action_cursor_page_up()

    # Typing

    def start_typing(self, at_error: bool = False, at_end: bool = False) -> None:
        """Start typing in the text.

        Args:
            at_error: Start on the line that is marked as an error, if there is one.
            at_end: Start at the end of the text.
        """
        if not self._key:
            self.post_message(self.Wanted(ProgramCommand.NONE))
            return
        self._area.focus()
        if at_error:
            self.go_to_error()
        if at_end:
            self._area.action_go_to_end(True)
        self._type(True)
        # A panel that was only opened now has no size yet, and cannot scroll.
        self.call_after_refresh(self.show_cursor)

    def stop_typing(self) -> None:
        """Stop typing, so that letters are keys of the app again."""
        self._type(False)
        self._area.scroll_to(x=0, animate=False, force=True)

    def show_cursor(self) -> None:
        """Scroll to the cursor, and as far left as the cursor stays visible."""
        self._area.scroll_to(x=0, animate=False, force=True)
        self._area.scroll_cursor_visible(animate=False)

    def _type(self, typing: bool) -> None:
        self._area.await_letters(False)
        if typing != self.typing:
            self._area.read_only = not typing
            if typing:
                self._assistant.start()
            else:
                self._assistant.stop()
            self._say()
            self.post_message(self.TypingChanged(typing))

    def on_text_area_changed(self, event: TextArea.Changed) -> None:
        event.stop()
        text = self._area.program_text
        if text != self._shown:
            self._shown = text
            self._area.set_error(0)
            self.show_line(self._line)
            self._show_values()
            self._say()
            self._assistant.schedule_check()
            self.post_message(self.Edited(text))

    def on_text_area_selection_changed(self, event: TextArea.SelectionChanged) -> None:
        event.stop()
        self._assistant.follow_cursor()

    def on_candidate_list_chosen(self, event: CandidateList.Chosen) -> None:
        event.stop()
        self._area.replace_word(event.name)

    def action_want(self, command: str) -> None:
        self.post_message(self.Wanted(ProgramCommand(command)))

    def on_code_area_looked_up(self, event: CodeArea.LookedUp) -> None:
        event.stop()
        self._say()

    def on_code_area_gutter_clicked(self, event: CodeArea.GutterClicked) -> None:
        event.stop()
        self.post_message(self.BreakpointToggled(event.line))

    def on_code_area_wanted(self, event: CodeArea.Wanted) -> None:
        event.stop()
        match event.command:
            case EditorCommand.TYPE:
                self.start_typing()
            case EditorCommand.STOP_TYPING:
                self.stop_typing()
            case EditorCommand.FIND:
                self._bar.open(FIND)
            case EditorCommand.LINE:
                self._bar.open(LINE)
            case EditorCommand.NEW:
                self.post_message(self.Wanted(ProgramCommand.NEW))
            case EditorCommand.OPEN:
                self.post_message(self.Wanted(ProgramCommand.OPEN))
            case _:
                assert_never(event.command)

    # The following methods search the text.

    def on_find_bar_asked(self, event: FindBar.Asked) -> None:
        event.stop()
        if event.mode == FIND:
            self._find(event.text, event.by)
        elif event.text.strip().isdecimal():
            line = min(max(1, int(event.text)), self._area.document.line_count)
            self._area.move_cursor((line - 1, 0), center=True)
        else:
            self._bar.say("a number, please")

    def on_find_bar_closed(self, event: FindBar.Closed) -> None:
        event.stop()
        self._area.focus()

    def _find(self, search: str, by: int) -> None:
        matches = find_matches(self._area.document.lines, search)
        if not matches:
            self._bar.say("not found" if search else "")
            return
        here = self._area.selection.start if by else min(self._area.selection)
        if by > 0:
            index = bisect_right(matches, here)
        elif by < 0:
            index = bisect_left(matches, here) - 1
        else:
            index = bisect_left(matches, here)
        index %= len(matches)
        row, column = matches[index]
        self._area.selection = Selection((row, column), (row, column + len(search)))
        self._area.scroll_cursor_visible(center=True)
        self._bar.say(f"{index + 1} of {len(matches)}")
