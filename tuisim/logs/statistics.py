"""Summary statistics of a numeric column."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tuisim.runs.arrays import FloatArray

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary statistics; NaN if there are no finite values."""

    count: int
    """Number of finite values."""
    left_out: int
    """Number of values that are not finite."""
    min: float
    mean: float
    max: float
    std: float
    """Standard deviation of the sample (divided by n - 1), 0 for a single value."""
    quantiles: tuple[float, ...]
    """Linearly interpolated, at `QUANTILES` by default."""


def summary_of(values: FloatArray, quantiles: Sequence[float] = QUANTILES) -> Summary:
    """Return the summary statistics of a column.

    Args:
        values: Shape (n,).
        quantiles: Fractions from 0 to 1; computing them takes most of the time.
    """
    finite = values[np.isfinite(values)]
    left_out = len(values) - len(finite)
    if not len(finite):
        nan = float("nan")
        return Summary(0, left_out, nan, nan, nan, nan, (nan,) * len(quantiles))
    low, high = float(finite.min()), float(finite.max())
    # Sums of very large values may overflow.
    with np.errstate(over="ignore", invalid="ignore"):
        # The mean of equal values may be off by rounding.
        mean = low if low == high else float(finite.mean(dtype=np.float64))
        std = float(finite.std(ddof=1, dtype=np.float64)) if len(finite) > 1 and low != high else 0.0
        found = tuple(float(value) for value in np.quantile(finite, quantiles)) if quantiles else ()
    return Summary(len(finite), left_out, low, mean, high, std, found)
