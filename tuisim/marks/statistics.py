"""What a class as a whole has met and missed."""

from __future__ import annotations

import math
from collections import Counter

from tuisim.data_class import dataclass
from tuisim.goals.spec import Goal
from tuisim.marks.sheet import Sheet

MOST_REASONS = 3
BINS = 10


@dataclass(frozen=True, slots=True)
class GoalStatistics:
    """How a class did with one goal."""

    goal: Goal
    met: int
    """Number of students who met it in each run."""
    partly: int
    """Number of students who met it in some runs."""
    mean: float
    """Mean points."""
    reasons: tuple[tuple[str, int], ...]
    """The most frequent reasons of those who missed it, each with the number of students."""


def goal_statistics(sheet: Sheet) -> tuple[GoalStatistics, ...]:
    """Return the statistics of each goal that is shown."""
    found = []
    for at, goal in enumerate(sheet.columns):
        cells = [(row, row.cells[at]) for row in sheet.rows]
        met = sum(bool(row.runs) and cell.met == row.runs for row, cell in cells)
        partly = sum(0 < cell.met < row.runs for row, cell in cells)
        mean = math.fsum(cell.points for _, cell in cells) / len(cells) if cells else 0.0
        reasons = Counter(cell.reason for _, cell in cells if cell.reason).most_common(MOST_REASONS)
        found.append(GoalStatistics(goal, met, partly, mean, tuple(reasons)))
    return tuple(found)


def distribution(sheet: Sheet) -> tuple[tuple[float, float, int], ...]:
    """Return how many students have how many points: lower end, upper end and number for equal parts of the scale.

    The upper end belongs to the next part, but for the last one; fewer and more points count at the ends.
    """
    most = sheet.most_points
    if not most:
        return ()
    counts = Counter(min(max(int(row.points / most * BINS), 0), BINS - 1) for row in sheet.rows)
    return tuple(
        (most * part / BINS, most * (part + 1) / BINS, counts[part]) for part in range(BINS)
    )
