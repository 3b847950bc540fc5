"""Lines at which a run pauses: where a step is complete, and the line of code that a breakpoint means."""

from __future__ import annotations

import types
from collections.abc import Iterator
from typing import assert_never

from tuisim.data_class import dataclass
from tuisim.protocol import LineStep
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


def step_from(how: LineStep, task: ScheduledThread, depth: int) -> Step:
    """Return the step that starts at a line.

    Args:
        how: The way to step.
        task: Thread that is paused there.
        depth: Number of open calls of the program's own code.
    """
    match how:
        case LineStep.INTO:
            return Step(task, ENDLESS_DEPTH)
        case LineStep.OVER:
            return Step(task, depth)
        case LineStep.OUT:
            return Step(task, depth - 1)
        case _:
            assert_never(how)


NEXT_LINE = Step(None, ENDLESS_DEPTH)
"""Complete at the next line of any thread."""


def line_with_code(program: types.CodeType | None, line: int) -> int:
    """Return `line` or, if it has no code in the program, the next line that has: any other would never be hit.

    After the last such line, and for 0, return `line`.
    """
    if program is None or not line:
        return line
    return min((one for one in _lines_of(program) if one >= line), default=line)


def _lines_of(code: types.CodeType) -> Iterator[int]:
    left = [code]
    while left:
        one = left.pop()
        yield from (line for _, _, line in one.co_lines() if line)
        left += [part for part in one.co_consts if isinstance(part, types.CodeType)]
