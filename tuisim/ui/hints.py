"""What the user is told once: a program makes use of the brick, and its panel is hidden."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from tuisim.datalog.records import CONSOLE, DISPLAY, OutputRow
from tuisim.ui.panels import PANELS

if TYPE_CHECKING:
    from tuisim.ui.app import Lab

_BUTTONS = re.compile(r"^[^#\n]*\bev3dev2(\.|\s+import\s.*\b)button\b", re.MULTILINE)
"""How a program comes by the buttons."""


def looks_at_buttons(program: str) -> bool:
    """Return whether the text of a program asks for the brick's buttons."""
    return bool(_BUTTONS.search(program))


class BrickHint:
    """One for the app.

    Args:
        lab: The app.
    """

    def __init__(self, lab: Lab) -> None:
        self._lab = lab
        self._told = False

    def started(self, program: str) -> None:
        """A program was started; its text tells whether it looks at the buttons."""
        if not self._told and looks_at_buttons(program):
            self._tell("looks at the brick's buttons")

    def shown(self, rows: Iterable[OutputRow]) -> None:
        """The program has written these rows."""
        if not self._told and any(row.stream in (DISPLAY, CONSOLE) for row in rows):
            self._tell("shows something on the brick")

    def _tell(self, what: str) -> None:
        self._told = True
        if not self._lab.desk.shown("brick"):
            self._lab.say(f"The program {what}: {PANELS['brick'].key} opens its panel")
