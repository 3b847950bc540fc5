"""How a run is stopped from outside the program."""

from __future__ import annotations

from tuisim.protocol import End


class StopProgram(BaseException):
    """Unwinds the program. Not an `Exception`, so that the program's handlers do not catch it.

    Args:
        end: How the run ends by it.
        summary: One line for the user.
    """

    def __init__(self, end: End, summary: str) -> None:
        super().__init__(summary)
        self.end = end
        self.summary = summary


class Deadlock(RuntimeError):
    """Every thread of the program waits for another one."""
