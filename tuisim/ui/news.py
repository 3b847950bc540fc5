"""What the app learns from a run at each look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.datalog.records import OutputRow

if TYPE_CHECKING:
    from tuisim.ui.branching import Branch


@dataclass(frozen=True, slots=True)
class News:
    """What has come from the run since the last poll."""

    rows: list[OutputRow]
    skipped: int = 0
    """Rows left out before `rows`."""
    ended: protocol.Ended | None = None
    """Set once, in the poll in which the end is learnt."""
    spoken: tuple[protocol.Spoke, ...] = ()
    """What the program said."""
    prompt: str | None = None
    """The prompt while the program waits in `input()`."""
    branched: Branch | None = None
    """Set once, when a branch has come to its instant, or has ended before."""
    held: tuple[protocol.Message, ...] = ()
    """That the program stands still or goes on, and what it looks like."""

    def __bool__(self) -> bool:
        """Whether anything has come; that the program still waits for an answer is nothing new."""
        return bool(self.rows or self.ended or self.spoken or self.branched or self.held)
