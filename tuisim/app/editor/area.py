"""The text of the code panel: a `TextArea` with marks beside the line numbers, a highlighted line, and a find bar."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import events
from textual.binding import BindingType
from textual.geometry import Offset, Region
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import TextArea
from textual.widgets.text_area import Edit, EditResult, Selection

from tuisim.app.editor import text_lines
from tuisim.app.editor.candidate_list import CandidateList
from tuisim.app.editor.completion import Candidate, find_candidates, find_word
from tuisim.app.editor.strips import cut_strip, highlight_strip
from tuisim.app.editor.syntax import KINDS, Colouring
from tuisim.app.snapshot import shorten_value
from tuisim.base.data_class import dataclass
from tuisim.engine.protocol import Variable
from tuisim.programs.names import UnknownName
from tuisim.terminal.text_runs import Line, cut_line
from tuisim.terminal.textual_internals import count_tab_columns, find_line

# A `TextArea` treats these characters as line ends, Python does not: they are replaced by substitutes.
_BREAKS = "\x0b\x0c\x1c\x1d\x1e\x85\u2028\u2029"
_GUARD = {ord(char): 0xF700 + offset for offset, char in enumerate(_BREAKS)}
_UNGUARD = {stand_in: char for char, stand_in in _GUARD.items()}
_UNSHOWN = re.compile(r"[\x00-\x08\x0a-\x1f\x7f-\x9f\uf700-\uf707]")

VALUE_GAP = 2
MIN_VALUE_CELLS = 10
"""`VALUE_GAP` cells separate a line from its values; values wider than half of the text get at least this."""
_CURSOR_COLS = 3
"""If so many cells from the cursor on are visible with the text at its left edge, the text is scrolled there."""

EDITOR_KEYS = (
    ("Enter", "Start editing; Escape ends it"),
    ("F3 ctrl+s", "Save the program"),
    ("ctrl+r F5", "Run the text as it is"),
    ("ctrl+f", "Find; then ↓ ↑ next, previous"),
    ("ctrl+g", "Go to a line"),
    ("ctrl+home ctrl+end", "Start, end of the text"),
    (
        "tab",
        "Complete part of a name, or list what may follow, as a dot does",
    ),
    ("tab ⇧tab", "Elsewhere: indent, outdent; backspace removes an indent"),
    ("ctrl+/", "Comment or uncomment lines"),
    ("ctrl+z ctrl+y", "Undo, redo"),
    ("ctrl+a", "Select all"),
    ("ctrl+x ctrl+c ctrl+v", "Cut, copy, paste"),
)
"""Keys that have an effect while the cursor is in the program's text, and what each does, for the help."""


class EditorCommand(StrEnum):
    """What a key that is pressed in the text requests of the code panel, such as opening a file."""

    TYPE = "type"
    STOP_TYPING = "stop_typing"
    FIND = "find"
    LINE = "line"
    NEW = "new"
    OPEN = "open"


class CodeArea(TextArea):
    """The widget with a program's text; the text can be edited only while `typing`."""

    ALLOW_SELECT = False
    DEFAULT_CSS = "CodeArea { height: 1fr; border: none; padding: 0; overflow-x: hidden; &:focus { border: none; } }"
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "code--number-column",
        "code--lit",
        "code--error",
        "code--break",
        "code--unknown",
        "code--value",
        "code--changed",
        *(f"code--{kind}" for kind in KINDS),
    }
    BINDINGS: ClassVar[list[BindingType]] = [
        ("ctrl+f", "want('find')", "Find"),
        ("ctrl+g", "want('line')", "Go to a line"),
        ("ctrl+a", "select_text", "Select all"),
        ("ctrl+home", "go_to_end(False)", "Start of the text"),
        ("ctrl+end", "go_to_end(True)", "End of the text"),
    ]

    @dataclass
    class Wanted(Message):
        """Posted when a key was pressed that the code panel handles; it has the `EditorCommand`."""

        command: EditorCommand

    class LookedUp(Message):
        """Posted when a look-up of names begins and when it ends; between these, `is_completing` is True."""

    class LettersChanged(Message):
        """Posted when typed letters begin to go into the text, and when they become keys of the app again."""

    @dataclass
    class GutterClicked(Message):
        """Posted when the user has clicked a line number."""

        line: int

    def __init__(self) -> None:
        # The base class reads the first line in its `__init__`, which needs these attributes.
        self._colouring = Colouring()
        self._breaks: Mapping[int, str] = {}
        self._lit = self._error = 0
        self.is_completing = False
        """Whether names are being looked up; keys wait until the look-up ends, however long it takes."""
        self.unknown_word: str | None = None
        """The word at the cursor, if a look-up has found no name that begins with it; else None."""
        self.path = ""
        """Path of the program's file; the program's name if it has no file."""
        self.candidates = CandidateList()
        """The list of names that may complete the word at the cursor; the editor passes keys on to it."""
        self._unknown: tuple[UnknownName, ...] = ()
        self.can_be_typed_in = False
        """Whether, after a click on the text, the next letter starts typing."""
        self.awaits_letters = False
        """Whether the next letter starts typing, because the user has clicked the text."""
        self._values: Mapping[int, Sequence[Variable]] = {}
        super().__init__(
            read_only=True,
            show_line_numbers=True,
            compact=True,
            highlight_cursor_line=False,
            soft_wrap=False,
        )
        self.cursor_blink = False
        self.indent_type = "spaces"

    # Text

    @property
    def program_text(self) -> str:
        """The whole text of the program, with `\\n` as line ends."""
        return self.text.translate(_UNGUARD)

    def load_program(self, text: str) -> None:
        """Show the text of another program, and clear the undo history."""
        self._colouring = Colouring()
        self.load_text(text.translate(_GUARD))

    def replace_program(self, text: str) -> None:
        """Show a text that was changed elsewhere, as an edit that can be undone; cursor and scroll position stay."""
        top, (row, column) = self.scroll_offset.y, self.cursor_location
        self.history.checkpoint()
        self.replace(
            text.translate(_GUARD), (0, 0), self.document.end, maintain_selection_offset=False
        )
        self.move_cursor(self.clamp_visitable((row, column)))
        self.scroll_to(y=top, animate=False, force=True)

    def edit(self, edit: Edit) -> EditResult:
        """Apply an edit to the text, and update colours and marks; see `TextArea`."""
        self._colouring.forget_line(edit.top[0])
        text = edit.text.translate(_GUARD)
        guarded = Edit(text, edit.from_location, edit.to_location, edit.maintain_selection_offset)
        return super().edit(guarded)

    def undo(self) -> None:
        """Undo the last edits of the text."""
        self._colouring.forget_line(0)
        super().undo()

    def redo(self) -> None:
        """Redo the edits that were undone last."""
        self._colouring.forget_line(0)
        super().redo()

    def get_line(self, line_index: int) -> Text:
        """Return line `line_index` of the text, from 0, with its syntax colours."""
        line = self.document.get_line(line_index)
        text = Text(_UNSHOWN.sub("·", line), end="", no_wrap=True)
        for start, end, kind in self._colouring.color_line(self.document.lines, line_index):
            text.stylize(self._find_style(kind), start, end)
        for unknown_name in self._unknown:
            # The text may have been edited since it was checked.
            if (
                unknown_name.row == line_index
                and line[unknown_name.start : unknown_name.end] == unknown_name.name
            ):
                text.stylize(self._find_style("unknown"), unknown_name.start, unknown_name.end)
        return text

    def _find_style(self, kind: str) -> Style:
        return self.get_component_rich_style(f"code--{kind}", partial=True)

    @property
    def allow_horizontal_scroll(self) -> bool:
        """Whether long lines can be scrolled sideways: always True, but without a scroll bar."""
        return True

    def scroll_cursor_visible(self, center: bool = False, animate: bool = False) -> Offset:
        """Scroll so that the cursor is visible, and return by how much.

        If the part of the line up to the cursor fits into the widget, scroll to the left edge of the text.
        """
        scrolled = super().scroll_cursor_visible(center, animate)
        x = self.wrapped_document.location_to_offset(self.cursor_location).x
        if x + _CURSOR_COLS + self.gutter_width <= self.scrollable_content_region.width:
            self.scroll_to(x=0, animate=animate, force=True)
        return scrolled

    def on_resize(self) -> None:
        """Unless the user types, scroll to the left edge of the text, and up or down to the highlighted line."""
        if not self.typing:
            self.call_after_refresh(self.scroll_to, x=0, animate=False, force=True)
            self.call_after_refresh(self.scroll_to_line, self._lit)

    # Marks

    def set_breaks(self, breaks: Mapping[int, str]) -> None:
        """Show the markers of the breakpoints.

        Args:
            breaks: The marker of each line with a breakpoint, by line number from 1.
        """
        if breaks != self._breaks:
            self._breaks = dict(breaks)
            self.refresh()

    @property
    def error_line(self) -> int:
        """The line that is marked as an error, from 1; 0 for none."""
        return self._error

    def set_error(self, line: int) -> None:
        """Mark the line of an error, from 1; 0 removes the mark."""
        before = self._error
        self._error = line
        self._refresh_line(before)
        self._refresh_line(line)

    def light(self, line: int) -> None:
        """Highlight a line, from 1; 0 removes the highlight."""
        if line != self._lit:
            before = self._lit
            self._lit = line
            self._refresh_line(before)
            self._refresh_line(line)

    @property
    def unknown(self) -> Sequence[UnknownName]:
        """The names in the text that are marked as not defined."""
        return self._unknown

    def set_unknown(self, names: tuple[UnknownName, ...]) -> None:
        """Mark these names in the text as not defined."""
        if names != self._unknown:
            self._unknown = names
            # This clears the cache of drawn lines.
            self.notify_style_update()
            self.refresh()

    def set_values(self, values: Mapping[int, Sequence[Variable]]) -> None:
        """Show the values of variables behind the lines of the text.

        Args:
            values: The variables by line, from 1.
        """
        if values != self._values:
            self._values = values
            self.refresh()

    def _find_rows(self, line: int) -> range:
        if not 1 <= line <= self.document.line_count:
            return range(0)
        wrapped = self.wrapped_document
        first = wrapped.location_to_offset((line - 1, 0)).y
        return range(first, first + len(wrapped.get_sections(line - 1)))

    def _refresh_line(self, line: int) -> None:
        top = self.scroll_offset.y
        visible = [row - top for row in self._find_rows(line) if 0 <= row - top < self.size.height]
        if visible:
            self.refresh(*(Region(0, y, self.size.width, 1) for y in visible))

    def scroll_to_line(self, line: int) -> None:
        """Scroll so that a line, from 1, is visible."""
        rows = self._find_rows(line)
        height = self.scrollable_content_region.height
        if rows and not (
            self.scroll_offset.y <= rows.start and rows.stop <= self.scroll_offset.y + height
        ):
            self.scroll_to(y=max(0, rows.start - height // 3), animate=False, force=True)

    def move_to_code(self, line: int) -> None:
        """Put the cursor on the first non-blank character of a line, from 1."""
        text = self.document.get_line(min(line, self.document.line_count) - 1)
        self.move_cursor((line - 1, len(text) - len(text.lstrip())))

    @property
    def gutter_width(self) -> int:
        """Width of the gutter in cells.

        The gutter has the marker of a breakpoint, the marker of the current line or of an error, the line number, and a
        blank.
        """
        return max(2, len(str(self.document.line_count))) + 3

    def render_line(self, y: int) -> Strip:
        """Return row `y` of the widget."""
        strip = super().render_line(y)
        if self.placeholder and not self.text:
            return strip
        try:
            line_index, section = find_line(self, y + self.scroll_offset.y)
        except IndexError:
            return strip
        line = line_index + 1
        base = self.rich_style
        gutter = self.gutter_width
        text = strip.crop(gutter)
        number_style = base + self._find_style("number-column")
        lit = ""
        if line == self._error:
            lit = "error"
        elif line == self._lit:
            lit = "lit"
        if lit:
            number_style = base + self._find_style(lit)
            text = highlight_strip(text, base, number_style)
        room = self.scrollable_content_region.width - gutter
        is_typed = self.typing and line_index == self.cursor_location[0]
        if (values := self._values.get(line)) and section == 0 and not is_typed:
            text = self._append_values(text, values, room, number_style)
        elif cell_len(text.text.rstrip()) > room and not is_typed:
            text = cut_strip(text, room, number_style)
        run_mark = {"error": "✗", "lit": "▶"}.get(lit, " ") if section == 0 else " "
        number = f"{line if section == 0 else '':>{gutter - 3}}"
        mark = self._breaks.get(line, " ") if section == 0 else " "
        head = [
            Segment(mark, number_style + self._find_style("break")),
            Segment(f"{run_mark}{number} ", number_style),
        ]
        return Strip.join([Strip(head, gutter), text])

    def _append_values(
        self, text: Strip, values: Sequence[Variable], room: int, style: Style
    ) -> Strip:
        """Return a row of text with the names and values of variables behind it.

        If there is no room for the names, only the values are added. If even these do not fit, the text is cut, since a
        reader who looks for an error needs the values more.

        Args:
            text: The row.
            values: The variables.
            room: Width of the row in cells.
            style: Style of the values.
        """
        ground = Style(bgcolor=style.bgcolor)
        used = cell_len(text.text.rstrip()) + VALUE_GAP
        shown_values = [shorten_value(" ".join(variable.value.split())) for variable in values]
        looks = [
            self._find_style("changed" if variable.changed else "value") + ground
            for variable in values
        ]
        for befores in (
            [f"{variable.name} = " for variable in values],
            ["→ "] + [""] * (len(values) - 1),
        ):
            line: Line = [
                (f"{', ' if offset else ''}{before}{value}", look)
                for offset, (before, value, look) in enumerate(
                    zip(befores, shown_values, looks, strict=True)
                )
            ]
            width = sum(cell_len(piece) for piece, _ in line)
            if used + width <= room:
                break
        start = min(used, room - (width if width <= room // 2 else MIN_VALUE_CELLS))
        segments = [Segment(piece, style) for piece, style in cut_line(line, room - start)]
        if start < used:
            text = Strip.join([cut_strip(text, start - 1, style), Strip([Segment(" ", style)], 1)])
        return Strip.join([text.crop(0, start), Strip(segments)]).extend_cell_length(room, style)

    # The following methods handle keys and the mouse.

    @property
    def typing(self) -> bool:
        """Whether the user types in the text."""
        return not self.read_only

    @property
    def takes_letters(self) -> bool:
        """Whether letters are typed into the text, and so are no keys of the app."""
        return self.typing or self.awaits_letters

    def await_letters(self, on: bool) -> None:
        """Set whether the next letter that the user presses starts typing.

        Args:
            on: False if the next letter is a key of the app.
        """
        on = on and self.can_be_typed_in and not self.typing
        if on != self.awaits_letters:
            self.awaits_letters = on
            self.post_message(self.LettersChanged())

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Return whether a key runs an action of the text; a key for typing does so only while the user types."""
        return (
            self.typing if action in _TYPING_ACTIONS else super().check_action(action, parameters)
        )

    def action_want(self, command: str) -> None:
        self.post_message(self.Wanted(EditorCommand(command)))

    def action_select_text(self) -> None:
        self.action_select_all()

    def action_go_to_end(self, end: bool) -> None:
        self.move_cursor(self.document.end if end else (0, 0))

    async def on_key(self, event: events.Key) -> None:
        if not self.typing:
            self._begin_typing(event)
            return
        # The message about the last edit may not have arrived yet: update the list of names first.
        self.follow_word()
        self._set_unknown_word(None)
        if event.character in _NAME_ENDINGS and self.candidates.can_complete(
            self._find_word() or ""
        ):
            # The user types on without pressing Enter: the chosen name completes the word first.
            self.replace_word(self.candidates.take_key("enter"))
        elif self.candidates.takes_key(event):
            self._consume_event(event)
            if name := self.candidates.take_key(event.key):
                self.replace_word(name)
        elif event.key == "enter":
            self._consume_event(event)
            row, column = min(self.selection)
            self.insert_text("\n" + text_lines.compute_indent(self.document.get_line(row)[:column]))
        elif (
            event.key == "backspace"
            and self.selection.is_empty
            and (blanks := self._count_deletable_blanks())
        ):
            self._consume_event(event)
            row, column = self.cursor_location
            self.delete((row, column - blanks), (row, column), maintain_selection_offset=False)
        elif event.key == "tab" and self.selection.is_empty:
            self._consume_event(event)
            await self._complete()
        elif change := _CHANGES.get(event.key):
            self._consume_event(event)
            self._change_lines(change)
        elif command := _WHILE_TYPING.get(event.key):
            self._consume_event(event)
            self.post_message(self.Wanted(command))
        elif event.key.startswith("alt+"):
            # Textual would insert the character of the event.
            self._consume_event(event)

    def _begin_typing(self, event: events.Key) -> None:
        """Start typing if the key is Enter, or if it is a letter after a click on the text; the letter is then typed.

        If Escape is pressed after such a click, letters are keys of the app again.
        """
        is_letter = self.awaits_letters and event.is_printable
        if event.key == "enter" or is_letter:
            self._consume_event(event)
            self.post_message(self.Wanted(EditorCommand.TYPE))
            self.insert_text(event.character or "" if is_letter else "")
        elif self.awaits_letters and event.key == "escape":
            self._consume_event(event)
            self.await_letters(False)

    def _consume_event(self, event: events.Key) -> None:
        event.stop()
        event.prevent_default()

    def _count_deletable_blanks(self) -> int:
        """Return how many blanks backspace deletes before the cursor; 0 if anything but indentation is before it."""
        row, column = self.cursor_location
        return text_lines.count_deletable_blanks(self.document.get_line(row)[:column])

    # Completion

    async def _complete(self) -> None:
        """Complete the word before the cursor. Keys that are pressed meanwhile wait.

        If there are several completions, list them; if there is none, say so. If there is no word, indent.
        """
        place = self.cursor_location
        matches: tuple[Candidate, ...] = ()
        if self._find_word() is not None:
            self._set_completing(True)
            try:
                matches = await asyncio.to_thread(
                    find_candidates, self.program_text, self.path, *place
                )
            finally:
                self._set_completing(False)
        word = self._find_word()
        if self.cursor_location != place or not self.selection.is_empty or not self.typing:
            # Something else has moved the cursor, such as the mouse.
            return
        if len(matches) == 1:
            self.replace_word(matches[0].name)
        elif matches and word is not None:
            self.list_names(matches, (place[0], place[1] - len(word)))
        elif word is not None:
            self._set_unknown_word(word)
        else:
            self.insert_text(" " * count_tab_columns(self))

    def list_names(self, names: tuple[Candidate, ...], begin: tuple[int, int]) -> None:
        """Open the list of names for the word at the cursor, unless the cursor has left that word.

        Args:
            names: The possible names.
            begin: Row and column where the word begins.
        """
        word, (row, column) = self._find_word(), self.cursor_location
        if word is not None and (row, column - len(word)) == begin:
            self.candidates.open(names, begin, word, self._locate_word(word))

    def _set_unknown_word(self, word: str | None) -> None:
        if word != self.unknown_word:
            self.unknown_word = word
            self._announce_lookup()

    def _set_completing(self, on: bool) -> None:
        self.is_completing = on
        self._announce_lookup()

    def _announce_lookup(self) -> None:
        # The parent gets the message: messages to this widget wait until its key has been handled.
        if isinstance(self.parent, Widget):
            self.parent.post_message(self.LookedUp())

    def _find_word(self) -> str | None:
        """Return the word that ends at the cursor; None if no name can be there.

        Right after a dot, the word is empty.
        """
        row, column = self.cursor_location
        return find_word(self.document.get_line(row), column)

    def _locate_word(self, word: str) -> Offset:
        """Return the position on the screen of the first letter of `word`, a word that ends at the cursor."""
        x, y = self.cursor_screen_offset
        return Offset(x - cell_len(word), y)

    def replace_word(self, name: str) -> None:
        """Replace the word before the cursor with a name."""
        row, column = self.cursor_location
        word = self._find_word() or ""
        self.replace(
            name, (row, column - len(word)), (row, column), maintain_selection_offset=False
        )

    def follow_word(self) -> None:
        """Show in the list of names those that begin with the word as typed so far.

        If the cursor is no longer in that word, close the list.
        """
        if not self.candidates.is_open:
            return
        word, (row, column) = self._find_word(), self.cursor_location
        if word is None or (row, column - len(word)) != self.candidates.begin:
            self.candidates.close()
        else:
            self.candidates.filter(word, self._locate_word(word))

    def on_blur(self) -> None:
        """When the text loses the focus, close the list of names, and make letters keys of the app again."""
        self.candidates.close()
        self.await_letters(False)

    def insert_text(self, text: str) -> None:
        """Replace the selected text, or insert a text at the cursor."""
        self.replace(text, *sorted(self.selection), maintain_selection_offset=False)

    def _change_lines(self, change: text_lines.Change) -> None:
        """Replace the selected lines, or without a selection the line of the cursor, by the result of a function.

        Args:
            change: Returns the new lines for the old ones.
        """
        (top, left), (bottom, right) = sorted(self.selection)
        was_empty = self.selection.is_empty
        if bottom > top and right == 0:
            bottom -= 1
        lines = self.document.lines[top : bottom + 1]
        changed = change(lines)
        if changed == list(lines):
            return
        self.replace(
            "\n".join(changed), (top, 0), (bottom, len(lines[-1])), maintain_selection_offset=False
        )
        if was_empty:
            self.move_cursor((top, max(0, left + len(changed[0]) - len(lines[0]))))
        else:
            self.selection = Selection((top, 0), (bottom, len(changed[-1])))

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Report a click on a line number; after a click on the text, let the next letter start typing."""
        if event.x >= self.gutter_width:
            self.await_letters(True)
        else:
            event.stop()
            event.prevent_default()
            row = self.get_target_document_location(event)[0]
            if event.y + self.scroll_offset.y < self.wrapped_document.height:
                self.post_message(self.GutterClicked(row + 1))


_NAME_ENDINGS = frozenset(".(")
"""Characters that follow a name: if the user types one, the chosen name of the list completes the word first."""

_TYPING_ACTIONS = frozenset(
    {
        "undo",
        "redo",
        "cursor_page_up",
        "cursor_page_down",
        "cursor_line_start",
        "cursor_line_end",
        "select_line",
        "select_all",
        "delete_left",
    }
)

_WHILE_TYPING = {
    "escape": EditorCommand.STOP_TYPING,
    "ctrl+n": EditorCommand.NEW,
    "ctrl+o": EditorCommand.OPEN,
}
"""Keys of commands while the user types; at other times, ctrl+n and ctrl+o are keys of the robot and obstacles."""

_CHANGES: Mapping[str, text_lines.Change] = {
    "tab": text_lines.indent_lines,
    "shift+tab": text_lines.outdent_lines,
    # Terminals send this for ctrl and the slash key.
    "ctrl+underscore": text_lines.toggle_comments,
    "ctrl+slash": text_lines.toggle_comments,
}
