"""Events: where a signal crosses a threshold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tuisim.datalog.analysis.signals import known_in_order
from tuisim.datalog.arrays import FloatArray
from tuisim.errors import LogError


@dataclass(frozen=True, slots=True)
class Crossing:
    """One crossing."""

    at: int
    """Position of the first sample beyond the threshold."""
    time_s: float
    """When the straight line between the samples on either side meets the threshold."""
    value: float
    """The sample at `at`."""
    rising: bool


def crossings(time_s: FloatArray, values: FloatArray, threshold: float, hysteresis: float = 0.0) -> list[Crossing]:
    """Return where a signal crosses a threshold, in order of time.

    A value on the threshold counts as beyond it when the signal comes from below, so
    that a signal that only touches it from above crosses nothing.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); those that are not finite are passed over.
        threshold: Where.
        hysteresis: A crossing counts if the signal is so far from the threshold before it and after it.

    Raises:
        LogError: the hysteresis is negative.
    """
    if not hysteresis >= 0.0:
        raise LogError(f"the hysteresis must not be negative, got {hysteresis:g}")
    known = np.arange(len(values))[known_in_order(time_s, values)]
    signal = values[known]
    above = signal >= threshold
    # The side on which the signal certainly is; 0 while it is too near the threshold to tell.
    side = np.where(signal >= threshold + hysteresis, 1, np.where(signal < threshold - hysteresis, -1, 0))
    decided = np.flatnonzero(side)
    turns = side[decided[1:]] != side[decided[:-1]]
    before, changes = decided[:-1][turns], decided[1:][turns]
    found = []
    for start, end in zip(before.tolist(), changes.tolist(), strict=True):
        rising = bool(side[end] > 0)
        beyond = above[start + 1 : end + 1] == rising
        # Where it went over for good, not where that became certain.
        at = start + 1 + (0 if beyond.all() else int(np.flatnonzero(~beyond)[-1]) + 1)
        first, last = int(known[at - 1]), int(known[at])
        found.append(Crossing(last, _meets(time_s, values, first, last, threshold), float(values[last]), rising))
    return found


def _meets(time_s: FloatArray, values: FloatArray, first: int, last: int, threshold: float) -> float:
    # Halves, whose difference is finite.
    start, stop = float(values[first]) / 2.0, float(values[last]) / 2.0
    part = (threshold / 2.0 - start) / (stop - start) if stop != start else 1.0
    return float(time_s[first]) + min(max(part, 0.0), 1.0) * float(time_s[last] - time_s[first])
