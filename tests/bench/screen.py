"""What a terminal shows, as text."""

from __future__ import annotations

import re

import pyte

from tests.bench.terminal import COLUMNS, ROWS, Terminal

_UNKNOWN = re.compile(
    rb"\x1b\[[<>=?][0-9;]*[a-zA-Z]|\x1b\[[?>]?[0-9;]*\$p|\x1bP[^\x1b]*\x1b\\|\x1b_[^\x1b]*\x1b\\"
)
"""Sequences that ask for abilities of a terminal; the screen in memory has none of them."""


class Screen:
    """The screen of a terminal.

    Args:
        terminal: Whose bytes are shown.
    """

    def __init__(self, terminal: Terminal) -> None:
        self._terminal = terminal
        self._screen = pyte.Screen(COLUMNS, ROWS)
        self._stream = pyte.ByteStream(self._screen)
        self._fed = 0

    def text(self, length: int | None = None) -> str:
        """Return what is on the screen; with a length, after so many bytes. Later calls take no smaller one."""
        # What may be but the beginning of a sequence waits for its end.
        seen = bytes(self._terminal.seen[self._fed : length])
        whole = len(seen) if b"\x1b" not in seen[-40:] else seen.rfind(b"\x1b")
        self._stream.feed(_UNKNOWN.sub(b"", seen[:whole]))
        self._fed += whole
        return "\n".join(self._screen.display)

    def has(self, text: str) -> bool:
        """Return whether a text, a regular expression, is on the screen."""
        return re.search(text, self.text()) is not None
