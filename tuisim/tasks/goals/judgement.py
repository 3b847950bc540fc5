"""How a run did on the goals of a task: states, when they changed, and why a goal is not met."""

from __future__ import annotations

import math
from collections.abc import Iterable
from enum import StrEnum
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.tasks.goals.condition import ConditionKind

if TYPE_CHECKING:
    from tuisim.tasks.goals.spec import Goal

GOAL = "goal_"
"""The prefix of a goal's name in the name of its column in a table."""


class GoalState(StrEnum):
    """The state of a goal at an instant of a run: open, met or missed; unknown if it cannot be judged."""

    OPEN = "open"
    MET = "met"
    MISSED = "missed"
    UNKNOWN = "unknown"
    """The goal cannot be judged, for a reason that is not the program's fault."""


@dataclass(frozen=True, slots=True)
class Change:
    """A change of a goal's state, with the time and the robot's position."""

    tick: int
    time_s: float
    state: GoalState
    x_mm: float
    y_mm: float


@dataclass(frozen=True, slots=True)
class Judgement:
    """The verdict on a goal for one run: whether the run has met it, and when, where and why."""

    goal: Goal
    changes: tuple[Change, ...]
    """Empty while the goal is open; it is decided once."""
    reason: str = ""
    """Why it is not met, in one sentence; empty if it is met, and possibly while it is open."""
    line: int = 0
    """The program's line that the last change, or the reason, is about; 0 if there is none."""
    happened: Change | None = None
    """When and where the goal was met, if a later moment has decided it; None: at the last change."""

    @property
    def state(self) -> GoalState:
        """The goal's state at the end of the recording."""
        return self.changes[-1].state if self.changes else GoalState.OPEN

    @property
    def is_good(self) -> bool:
        """Whether the goal is met; for a goal with negative points, whether it is not met.

        The result is False if the goal cannot be judged.
        """
        if self.state is GoalState.UNKNOWN:
            return False
        return (self.state is GoalState.MET) is (self.goal.points >= 0)

    @property
    def is_of_text(self) -> bool:
        """Whether the program's text alone decides the goal."""
        return all(part.KIND is ConditionKind.FIXED for part in self.goal.parts)

    @property
    def event(self) -> Change | None:
        """When and where the goal was decided as met or missed; None while the goal is open."""
        return self.happened or (self.changes[-1] if self.changes else None)

    def at(self, tick: int) -> GoalState:
        """Return the goal's state at the end of a tick."""
        known = [change.state for change in self.changes if change.tick <= tick]
        return known[-1] if known else GoalState.OPEN


def compute_points(judgements: Iterable[Judgement]) -> float:
    """Return the sum of the points of the goals that are met, at least 0; NaN if a goal cannot be judged."""
    counts = (GoalState.MET, GoalState.UNKNOWN)
    return sum_points(
        math.nan if each.state is GoalState.UNKNOWN and each.goal.points else each.goal.points
        for each in judgements
        if each.state in counts
    )


def sum_points(met: Iterable[float]) -> float:
    """Return the sum of points, some of which may be negative; at least 0, and NaN if some points are NaN (unknown).

    Args:
        met: The points of the goals that are met.
    """
    # The order matters: `max(nan, 0.0)` is NaN, but `max(0.0, nan)` is 0.
    return max(math.fsum(met), 0.0)


def compute_max_points(goals: Iterable[Goal]) -> float:
    """Return the points of a run that meets every goal with positive points and no goal with negative points."""
    return math.fsum(goal.points for goal in goals if goal.points > 0)


def format_points(points: float) -> str:
    """Return points as text, at most two decimals; `?` for NaN."""
    return "?" if math.isnan(points) else f"{points:.2f}".rstrip("0").rstrip(".")
