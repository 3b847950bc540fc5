"""Whether a visitor does anything."""

from __future__ import annotations

import re
import time
from collections.abc import Callable

_ANSWER = re.compile(r"\x1b(\[[\d;]*[cnRt]|\[[?>=][\d;:]*\$?[A-Za-z]|[P_\]^][^\x07\x1b]*(\x07|\x1b\\))")
"""What a terminal sends by itself: reports of its cursor, size, modes, colours and name."""


def is_done_by_a_person(text: str) -> bool:
    """Return whether input contains more than answers of the terminal: a key, the mouse, a paste."""
    return _ANSWER.sub("", text) != ""


class Activity:
    """Measures how long a visitor has done nothing.

    Args:
        clock: A monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._last_s = clock()

    def note(self) -> None:
        """Note that the visitor has done something."""
        self._last_s = self._clock()

    @property
    def idle_s(self) -> float:
        """Seconds since the visitor has done something."""
        return self._clock() - self._last_s
