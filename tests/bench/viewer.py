"""A program that shows a log in a terminal: what opening it and each key costs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Self

from tests.bench.processes import cpu_s
from tests.bench.screen import Screen
from tests.bench.terminal import Terminal

QUIET_S = 0.08
"""So long after the last output the answer to a key is on the screen."""
_CALM_S, _CALM_SHARE = 0.5, 0.05
"""A program that uses no more than this part of a core for so long has nothing left to do."""
_PATIENCE_S = 120.0


class Viewer:
    """A program in a terminal of 120×40.

    Args:
        command: The program and its words.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._terminal = Terminal(command[1:], command[:1])
        self._screen = Screen(self._terminal)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._terminal.__exit__(*error)

    def text(self) -> str:
        """Return what is on the screen."""
        return self._screen.text()

    def cpu_s(self) -> float:
        """Return the CPU seconds used since its start, by all its threads."""
        return cpu_s(self._terminal.pid)

    def until(self, text: str) -> float:
        """Wait until a text, a regular expression, is on the screen, and return the CPU seconds used till then."""
        used = 0.0

        def there() -> bool:
            nonlocal used
            used = self.cpu_s()
            return self._screen.has(text)

        self._terminal.read_until(there, _PATIENCE_S)
        return used

    def until_calm(self) -> float:
        """Wait until it does nothing any more, and return the CPU seconds used till then."""
        while True:
            before = self.cpu_s()
            self._terminal.read_for(_CALM_S)
            if self.cpu_s() - before < _CALM_SHARE * _CALM_S:
                return before

    def key_s(self, key: bytes) -> float:
        """Press a key and return the CPU seconds from there until the screen stands still."""
        terminal, before = self._terminal, self.cpu_s()
        terminal.type(key)
        length = len(terminal.seen)
        terminal.read_until(lambda: len(terminal.seen) > length)
        while length != len(terminal.seen):
            length = len(terminal.seen)
            terminal.read_for(QUIET_S)
        return self.cpu_s() - before

    def peak_bytes(self) -> int:
        """Return the most memory it has had in use."""
        status = Path(f"/proc/{self._terminal.pid}/status").read_text()
        found = re.search(r"VmHWM:\s+(\d+) kB", status)
        assert found is not None, status
        return int(found[1]) << 10
