"""The hint to open the brick panel when a program uses the brick."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from tuisim.runs.records import OutputRow, Stream

_BUTTONS = re.compile(r"^[^#\n]*\bev3dev2(\.|\s+import\s.*\b)button\b", re.MULTILINE)


def looks_at_buttons(program: str) -> bool:
    """Return whether the text of a program uses the brick's buttons."""
    return bool(_BUTTONS.search(program))


class BrickHint:
    """Suggests the brick panel, once.

    Args:
        hint: Called with what the program does.
    """

    def __init__(self, hint: Callable[[str], None]) -> None:
        self._hint = hint
        self._given = False

    def started(self, program: str) -> None:
        """Check whether the text of a started program uses the brick's buttons."""
        if looks_at_buttons(program):
            self._give("reads the brick's buttons")

    def shown(self, rows: Iterable[OutputRow]) -> None:
        """Check the rows that the program has written."""
        if not self._given and any(row.stream in (Stream.DISPLAY, Stream.CONSOLE) for row in rows):
            self._give("uses the brick's display")

    def _give(self, what: str) -> None:
        if not self._given:
            self._given = True
            self._hint(what)
