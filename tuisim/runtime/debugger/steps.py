"""Steps: at which of the lines that are met one of them is done."""

from __future__ import annotations

from dataclasses import dataclass

from tuisim.runtime.scheduler import ScheduledThread


@dataclass(frozen=True, slots=True)
class Step:
    """A step that is under way."""

    task: ScheduledThread | None
    """Thread that is stepped; None ends it at the next line of any thread."""
    most_depth: int
    """It ends where at most so many calls of the program's own code are open."""

    def is_done(self, task: ScheduledThread, depth: int) -> bool:
        """Whether a line that is about to run ends it."""
        if self.task is None or self.task.done:
            return True
        return task is self.task and depth <= self.most_depth


ENDLESS_DEPTH = 1 << 30
"""Deeper than any stack."""


def step_from(how: str, task: ScheduledThread, depth: int) -> Step:
    """Return the step that begins at a line.

    Args:
        how: One of `protocol.STEPS`.
        task: Thread that is held there.
        depth: How many calls of the program's own code are open.
    """
    if how == "into":
        return Step(task, ENDLESS_DEPTH)
    return Step(task, depth if how == "over" else depth - 1)


NEXT_LINE = Step(None, ENDLESS_DEPTH)
"""Ends at the next line of any thread."""
