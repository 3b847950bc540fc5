"""What can be said of a column of numbers in a line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tuisim.datalog.arrays import FloatArray

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
    """At `QUANTILES`, between neighbours in proportion."""


def summary_of(values: FloatArray) -> Summary:
    """Return the figures of a column, shape (n,)."""
    finite = values[np.isfinite(values)]
    left_out = len(values) - len(finite)
    if not len(finite):
        nan = float("nan")
        return Summary(0, left_out, nan, nan, nan, nan, (nan,) * len(QUANTILES))
    low, high = float(finite.min()), float(finite.max())
    # Summed up, equal values may come out a little off.
    mean = low if low == high else float(finite.mean())
    std = float(finite.std(ddof=1)) if len(finite) > 1 and low != high else 0.0
    quantiles = tuple(float(value) for value in np.quantile(finite, QUANTILES))
    return Summary(len(finite), left_out, low, mean, high, std, quantiles)
