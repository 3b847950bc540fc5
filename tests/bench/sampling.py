"""How often something is measured, and beside what."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from statistics import median

from tests.bench.processes import children_cpu_s


class MeasuringError(Exception):
    """What was measured cannot be."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is measured."""

    repeats: int
    """Runs of which the median counts, at least."""
    stops: int
    """Stops of each kind."""
    watch_s: float
    """How long the app is watched while the robot drives."""
    parquet_rows: int
    """Of the longest logs."""
    least_cpu_s: float = 2.0
    """So much CPU is used for each figure of CPU time, at least."""
    simulated: float = 1.0
    """Part of the usual simulated time that runs take."""


THOROUGH = Effort(repeats=7, stops=10, watch_s=6.0, parquet_rows=10_000_000)
QUICK = Effort(repeats=3, stops=5, watch_s=5.0, parquet_rows=1_000_000)


@dataclass(frozen=True, slots=True)
class Samples:
    """What was measured, each beside a sample of its reference."""

    values: Sequence[float]
    references: Sequence[float]

    @property
    def value(self) -> float:
        """The median of the values."""
        return median(self.values)

    @property
    def ratio(self) -> float:
        """The median of the ratios of each value to the reference beside it."""
        return median(
            value / beside for value, beside in zip(self.values, self.references, strict=True)
        )


def measured(value: float, what: str = "time") -> float:
    """Return a value that was measured.

    Raises:
        MeasuringError: it is not positive, as if nothing had been measured.
    """
    if not (isfinite(value) and value > 0):
        raise MeasuringError(f"the {what} that was measured is {value:g}")
    return value


def in_turns(
    measure: Callable[[], float],
    reference: Callable[[], float],
    effort: Effort,
    used_cpu_s: Callable[[], float] = lambda: time.process_time() + children_cpu_s(),
) -> Samples:
    """Measure something and its reference turn by turn, so that a slow minute of the machine slows both.

    Args:
        measure: Returns what is measured.
        reference: Returns what it is compared with.
        effort: How often, at least, and with how much CPU.
        used_cpu_s: Tells the CPU seconds that this process and its children have used until now.
    """
    values: list[float] = []
    references: list[float] = []
    used_s = 0.0
    while len(values) < effort.repeats or used_s < effort.least_cpu_s:
        references.append(measured(reference(), "reference"))
        before_s = used_cpu_s()
        values.append(measured(measure()))
        used_s += measured(used_cpu_s() - before_s, "CPU time")
    return Samples(values, references)
