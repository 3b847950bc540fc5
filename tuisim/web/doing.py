"""What an app says that it does: which program it runs, and since when."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from tuisim.errors import printable

_LONGEST_NAME = 80


class Doing:
    """Notes what an app tells its server.

    Args:
        clock: A monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._since_s = clock()
        self._program, self._runs, self._end = "", False, ""

    def note(self, told: Mapping[str, Any]) -> None:
        """Note what an app has told; it is not trusted."""
        what = told.get("what")
        if what in ("ready", "run"):
            self._program = printable(str(told.get("program", "")))[:_LONGEST_NAME]
        if what in ("run", "ended"):
            self._runs, self._since_s = what == "run", self._clock()
            self._end = printable(str(told.get("end", "")))[:_LONGEST_NAME]

    def to_plain(self) -> dict[str, Any]:
        """Return the program, whether it runs, how its last run has ended, and for how many seconds that is so."""
        since_s = round(self._clock() - self._since_s)
        return {"program": self._program, "runs": self._runs, "end": self._end, "since_s": since_s}
