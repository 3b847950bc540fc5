"""What can be said of a column of numbers in a line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tuisim.runs.arrays import FloatArray

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True, slots=True)
class Summary:
    """Figures of a column; not a number where there is nothing to count."""

    count: int
    """Finite values."""
    left_out: int
    """Values that are not finite."""
    min: float
    mean: float
    max: float
    std: float
    """Standard deviation of the sample (divided by n - 1), 0 for a single value."""
    quantiles: tuple[float, ...]
    """At `QUANTILES`, unless others were asked for, between neighbours in proportion."""


def summary_of(values: FloatArray, quantiles: Sequence[float] = QUANTILES) -> Summary:
    """Return the figures of a column.

    Args:
        values: Shape (n,).
        quantiles: Which ones; they take most of the time.
    """
    finite = values[np.isfinite(values)]
    left_out = len(values) - len(finite)
    if not len(finite):
        nan = float("nan")
        return Summary(0, left_out, nan, nan, nan, nan, (nan,) * len(quantiles))
    low, high = float(finite.min()), float(finite.max())
    # The sums of very large values may be infinite.
    with np.errstate(over="ignore", invalid="ignore"):
        # Summed up, equal values may come out a little off.
        mean = low if low == high else float(finite.mean(dtype=np.float64))
        std = float(finite.std(ddof=1, dtype=np.float64)) if len(finite) > 1 and low != high else 0.0
        found = tuple(float(value) for value in np.quantile(finite, quantiles)) if quantiles else ()
    return Summary(len(finite), left_out, low, mean, high, std, found)
