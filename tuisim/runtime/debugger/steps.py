"""Steps: at which line a step is complete."""

from __future__ import annotations

from dataclasses import dataclass

from tuisim.runtime.scheduler import ScheduledThread


@dataclass(frozen=True, slots=True)
class Step:
    """A step in progress."""

    task: ScheduledThread | None
    """Thread that is stepped; None completes it at the next line of any thread."""
    most_depth: int
    """Largest number of open calls of the program's own code at which it is complete."""

    def is_done(self, task: ScheduledThread, depth: int) -> bool:
        """Return whether a line that is about to run completes the step."""
        if self.task is None or self.task.done:
            return True
        return task is self.task and depth <= self.most_depth


ENDLESS_DEPTH = 1 << 30
"""Larger than the depth of any stack."""


def step_from(how: str, task: ScheduledThread, depth: int) -> Step:
    """Return the step that starts at a line.

    Args:
        how: One of `protocol.STEPS`.
        task: Thread that is paused there.
        depth: Number of open calls of the program's own code.
    """
    if how == "into":
        return Step(task, ENDLESS_DEPTH)
    return Step(task, depth if how == "over" else depth - 1)


NEXT_LINE = Step(None, ENDLESS_DEPTH)
"""Complete at the next line of any thread."""
