"""How a run is stopped from outside the program."""

from __future__ import annotations

DISK_FULL = "disk_full"
"""How a run ends that cannot be recorded any further."""


class StopProgram(BaseException):
    """Unwinds the program. Not an `Exception`, so that the program's handlers do not catch it.

    Args:
        end: The reason, as in `protocol.Ended.end`.
        summary: One line for the user.
    """

    def __init__(self, end: str, summary: str) -> None:
        super().__init__(summary)
        self.end = end
        self.summary = summary


class Deadlock(RuntimeError):
    """Every thread of the program waits for another one."""
