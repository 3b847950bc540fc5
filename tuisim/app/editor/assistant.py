"""Help while typing: what may follow a dot, the signature of a call, and names that are not defined."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from rich.text import Text
from textual.timer import Timer

from tuisim.app import background
from tuisim.app.editor import completion
from tuisim.app.editor.area import CodeArea
from tuisim.app.editor.candidate_list import format_signature
from tuisim.programs.names import (
    AttributeCheck,
    UnknownName,
    find_faulty_line,
    find_unknown_names,
)
from tuisim.terminal.text_runs import cut

CHECK_DELAY_S = 0.5
"""Seconds without typing after which the names in the program are checked."""
ASK_DELAY_S = 0.15
"""Seconds without typing after which the signature of a call, or what may follow a dot, is looked up."""
MAX_LINES = 5000
"""Programs with more lines than this are not checked for mistakes, because the check would delay the keys."""


class Assistant:
    """Helps the user to type: marks mistakes and unknown names, shows signatures, and lists the names after a dot.

    Args:
        area: The text, with its list of names.
        changed: Called when `describe_cursor` may return something else.
    """

    def __init__(self, area: CodeArea, changed: Callable[[], None]) -> None:
        self._area = area
        self._changed = changed
        self._attribute_check = AttributeCheck(completion.find_members)
        self._names: tuple[UnknownName, ...] = ()
        self._attributes: tuple[UnknownName, ...] = ()
        self._fault: UnknownName | None = None
        """The mark of a line that is not valid Python; None without one."""
        self._fresh_fault: UnknownName | None = None
        """The mark of the line with the cursor if that is not valid Python; it is shown once the cursor has left
        the line."""
        self._signature: completion.Signature | None = None
        self._check_timer: Timer | None = None
        self._ask_timer: Timer | None = None
        self._offer_timer: Timer | None = None
        self._is_asking = self._asks_again = False

    def describe_cursor(self, width: int) -> Text:
        """Return a message about the cursor's place in at most `width` cells.

        The message is about an unknown name at the cursor or, without one, the signature of the call around the cursor.
        The message is empty if there is no such name and no call.
        """
        row, column = self._area.cursor_location
        unknown = next(
            (
                name
                for name in self._area.unknown
                if name.row == row and name.start <= column <= name.end
            ),
            None,
        )
        # While the list of names is open, the word at the cursor is not complete.
        if unknown is not None and not self._area.candidates.is_open:
            whole = unknown.message
            hint = unknown.hint or unknown.message
            return Text(cut(whole if len(whole) <= width else hint, width))
        return format_signature(self._signature, width) if self._signature else Text()

    def load_program(self, path: str) -> None:
        """Forget the names of the former program, and check the names of the new program in the text.

        Args:
            path: Path of the new program's file, or its name.
        """
        self._area.path = path
        self._signature = None
        self._area.candidates.close()
        self._names = self._attributes = ()
        self._fault = self._fresh_fault = None
        self._mark()
        self.check_names()

    def schedule_check(self) -> None:
        """After an edit, check the names of the text soon, and list the possible names after a dot."""
        self._check_timer = self._restart_timer(self._check_timer, CHECK_DELAY_S, self.check_names)
        row, column = self._area.cursor_location
        is_after_dot = completion.find_word(self._area.document.get_line(row), column) == ""
        if self._area.typing and is_after_dot and completion.is_ready():
            self._offer_timer = self._restart_timer(
                self._offer_timer, ASK_DELAY_S, self._offer_names
            )

    def follow_cursor(self) -> None:
        """After the cursor has moved, update the list of names and the signature of the call around the cursor."""
        self._area.follow_word()
        row, column = self._area.cursor_location
        if self._fresh_fault is not None and self._fresh_fault.row != row:
            self._fault = self._fresh_fault
            self._fresh_fault = None
            self._mark()
        if self._area.typing and completion.is_in_call(self._area.document.lines, row, column):
            self._ask_timer = self._restart_timer(self._ask_timer, ASK_DELAY_S, self.ask_signature)
        else:
            self._signature = None
        self._changed()

    def _restart_timer(
        self, timer: Timer | None, after_s: float, call: Callable[[], None]
    ) -> Timer:
        if timer is not None:
            timer.stop()
        return self._area.set_timer(after_s, call)

    def start(self) -> None:
        """When typing begins, import the library that finds names, so that the first completion is quick."""
        if not completion.is_ready():
            background.start(completion.preload)

    def stop(self) -> None:
        """When typing ends, close the list of names and remove the signature."""
        self._area.candidates.close()
        self._signature = None

    # Names

    def _offer_names(self) -> None:
        background.begin(self._area, self._fetch_names, group="names", exclusive=True)

    async def _fetch_names(self) -> None:
        """Look up and list the names that may follow the dot at the cursor, unless a list is open already."""
        text, path, row, column = self._place()
        word = completion.find_word(self._area.document.get_line(row), column)
        if word is None or self._area.candidates.is_open:
            return
        names = await asyncio.to_thread(completion.find_candidates, text, path, row, column)
        if names and self._area.typing and not self._area.candidates.is_open:
            self._area.list_names(names, (row, column - len(word)))
            self._area.candidates.is_offered = True

    def check_names(self) -> None:
        """Mark a line that is not valid Python, and the names that are not defined."""
        if self._area.document.line_count > MAX_LINES:
            return
        fault = find_faulty_line(self._area.program_text, self._area.path)
        is_fresh = self._area.typing and fault and fault.row == self._area.cursor_location[0]
        self._fault, self._fresh_fault = (None, fault) if is_fresh else (fault, None)
        self._mark()
        names = find_unknown_names(self._area.program_text, self._area.path)
        if names is not None:
            self._names = names
            self._mark()
        if completion.is_ready():
            background.begin(self._area, self._check_attributes, group="attributes", exclusive=True)

    async def _check_attributes(self) -> None:
        text = self._area.program_text
        path = self._area.path
        attributes = await asyncio.to_thread(
            self._attribute_check.find_unknown_attributes, text, path
        )
        if (text, path) == (self._area.program_text, self._area.path):
            self._attributes = attributes
            self._mark()

    def _mark(self) -> None:
        faults = () if self._fault is None else (self._fault,)
        self._area.set_unknown((*faults, *self._names, *self._attributes))
        self._changed()

    # Signature

    def ask_signature(self) -> None:
        """Begin to look up the signature of the function whose arguments are at the cursor, to show it."""
        if self._is_asking:
            self._asks_again = True
        elif self._area.typing:
            self._is_asking = True
            background.begin(self._area, self._fetch_signature)

    async def _fetch_signature(self) -> None:
        try:
            signature = await asyncio.to_thread(completion.find_signature, *self._place())
        finally:
            self._is_asking = False
        if self._asks_again:
            self._asks_again = False
            self.ask_signature()
        row, column = self._area.cursor_location
        if self._area.typing and completion.is_in_call(self._area.document.lines, row, column):
            self._signature = signature
            self._changed()

    def _place(self) -> tuple[str, str, int, int]:
        return self._area.program_text, self._area.path, *self._area.cursor_location
