"""Runs until a mean is known: each combination takes further seeds as long as its mean is not known well enough."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Iterable, Iterator
from statistics import NormalDist, stdev
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.batch.table import POINTS, POSE, is_statistic, name_goals
from tuisim.engine.core.conditions import NUMBER
from tuisim.engine.protocol import End

if TYPE_CHECKING:
    from tuisim.batch.plan import Plan
    from tuisim.batch.sweep import Sweep

MIN_RUNS = 10
"""The number of runs with which each combination begins: the spread of fewer says little."""
_MIN_MORE = 4
_CONFIDENCE = 0.95
_FORM = re.compile(rf"\s*(?P<column>[^±]+?)\s*(?:±|\+-)\s*(?P<margin>{NUMBER})\s*")


@dataclass(frozen=True, slots=True)
class Precision:
    """How precisely the mean of a column must be known: within a margin, with a probability of 95 %."""

    column: str
    margin: float
    """Half the width of the interval in which the mean is with a probability of 95 %."""


def parse_precision(text: str, key: str, plan: Plan, columns: Iterable[str]) -> Precision:
    """Return the precision in a text `COLUMN ± MARGIN`.

    Args:
        text: The text; `+-` is the same as `±`.
        key: The argument, for errors.
        plan: The plan of the batch.
        columns: The columns of this batch's table with other numbers than time, pose, goals and points, such as
            metrics.

    Raises:
        ConfigError: the text cannot be parsed, there will be no such column of numbers, or there is only one seed.
    """
    match = _FORM.fullmatch(text) if isinstance(text, str) else None
    if match is None or not 0 < float(match["margin"]) < math.inf:
        raise ConfigError(f"must be COLUMN ± MARGIN, got {text!r}", "such as 'x_mm ± 2'", key=key)
    goals = [*name_goals(goal.name for goal in plan.goals), *([POINTS] if plan.goals else [])]
    known = ["time_s", *POSE, *goals, *columns]
    column = match["column"]
    if column not in known and not is_statistic(column):
        hint = f"{nearest(column, known)}; the last value of a printed variable is NAME_last"
        raise ConfigError(f"there will be no column {column!r} of numbers", hint, key=key)
    if plan.count_seeds() < 2:
        raise ConfigError("needs the seeds that it may take", "such as range(200)", key=key)
    return Precision(column, float(match["margin"]))


class Rounds(Iterator[int]):
    """An iterator over the indices of the tasks to run until each mean is known precisely enough.

    The iteration stops when it has to wait for results; once they have arrived, it can be continued. Which tasks come
    next depends only on the rows of their combination, not on the order in which rows arrive.

    Args:
        plan: All runs that may be necessary.
        sweep: The finished runs.
        precision: How precisely the mean of each combination must be known.
    """

    def __init__(self, plan: Plan, sweep: Sweep, precision: Precision) -> None:
        self._sweep = sweep
        self._precision = precision
        self._due: deque[int] = deque()
        seeds = plan.count_seeds()
        self._counts = {range(first, first + seeds): 0 for first in range(0, len(plan), seeds)}
        """The number of runs that each combination needs so far, by its indices; only while it needs more."""
        self.unknown: list[float] = []
        """The margins of the combinations that have no more seeds, or whose runs have all raised."""

    def __next__(self) -> int:
        if not self._due:
            for indices in [*self._counts]:
                self._ask(indices)
        if not self._due:
            raise StopIteration
        return self._due.popleft()

    def _ask(self, indices: range) -> None:
        """If all runs of a combination so far are done and its mean is not precise enough, request further runs.

        Args:
            indices: The indices of all runs that the combination can have.
        """
        rows = self._sweep.rows
        while all(index in rows for index in indices[: self._counts[indices]]):
            count = self._counts[indices]
            margin = self._find_margin(indices[:count]) if count else math.inf
            has_raised = count and all(
                rows[index]["end"] == End.RAISED for index in indices[:count]
            )
            if margin <= self._precision.margin or count == len(indices) or has_raised:
                self.unknown += [margin] if margin > self._precision.margin else []
                del self._counts[indices]
                return
            self._counts[indices] = min(self._find_next_count(count, margin), len(indices))
            self._due += [
                index for index in indices[count : self._counts[indices]] if index not in rows
            ]

    def _find_next_count(self, count: int, margin: float) -> int:
        """Return how many runs a combination probably needs, at most twice as many as it has.

        Args:
            count: The number of its runs so far.
            margin: The margin of its mean so far.
        """
        share = (margin / self._precision.margin) ** 2
        return max(MIN_RUNS, count + _MIN_MORE, math.ceil(count * min(share, 2)))

    def _find_margin(self, indices: Iterable[int]) -> float:
        frame = self._sweep.build_frame(indices)
        frame = frame[frame["end"] != End.RAISED]
        column = frame.get(self._precision.column)
        if column is None or column.empty:
            return math.inf
        if column.dtype.kind not in "bif":
            raise ConfigError(f"{self._precision.column!r} is not a number", key="until")
        return compute_margin([value for value in column.tolist() if math.isfinite(value)])


def compute_margin(values: list[float]) -> float:
    """Return half the width of the 95 % confidence interval of a mean; infinite for fewer than two values."""
    count = len(values)
    if count < 2:
        return math.inf
    return _compute_quantile(count - 1) * stdev(values) / math.sqrt(count)


def _compute_quantile(freedom: int) -> float:
    """Return the quantile of Student's t-distribution for a confidence interval of 95 %.

    The error is below 0.1 % for nine degrees of freedom or more.

    Args:
        freedom: The degrees of freedom.
    """
    z = NormalDist().inv_cdf((1 + _CONFIDENCE) / 2)
    terms = (
        z,
        (z**3 + z) / 4,
        (5 * z**5 + 16 * z**3 + 3 * z) / 96,
        (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384,
    )
    return math.fsum(term / freedom**power for power, term in enumerate(terms))
