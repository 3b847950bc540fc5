"""Operations on time series: derivative, integral, rolling mean, resampling, summary statistics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.magnitude import find_scale


class Between(StrEnum):
    """What a signal is taken to be between two samples: the last value, or a straight line."""

    HOLD = "hold"
    """The last value."""
    LINEAR = "linear"


MAX_RESAMPLED = 50_000_000


def sort_known(time_s: FloatArray, values: FloatArray) -> IntArray | slice:
    """Return the indices of the finite values in order of time; values at the same time keep their order.

    If all values are finite and in order already, the result is a slice of all of them.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,).
    """
    finite = np.isfinite(values)
    falls = bool((time_s[1:] < time_s[:-1]).any())
    if not falls:
        # A slice avoids a copy for most logs.
        return slice(None) if finite.all() else np.flatnonzero(finite)
    known = np.flatnonzero(finite)
    return known[np.argsort(time_s[known], kind="stable")]


def compute_derivative(time_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return the derivative at each sample, in units per second, shape (n,); NaN if all times are equal.

    The derivative is computed by second-order differences for uneven spacing (`numpy.gradient`), one-sided at both
    ends.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); values that are not finite are skipped, with NaN in the result.
    """
    slopes = np.full(len(values), np.nan)
    known = sort_known(time_s, values)
    # If several samples have the same time, the first one represents all.
    moments, first, which = np.unique(time_s[known], return_index=True, return_inverse=True)
    if len(moments) > 1:
        with np.errstate(all="ignore"):
            slopes[known] = np.gradient(values[known][first], moments)[which]
    return slopes


def compute_integral(
    time_s: FloatArray, values: FloatArray, between: Between = Between.LINEAR
) -> FloatArray:
    """Return the integral from the first sample to each sample, in units times seconds, shape (n,).

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); values that are not finite are skipped, with NaN in the result.
        between: The interpolation between samples.
    """
    sums = np.full(len(values), np.nan)
    known = sort_known(time_s, values)
    moments = time_s[known]
    heights = np.asarray(values[known], np.float64)
    if not len(moments):
        return sums
    heights = heights[:-1] if between == Between.HOLD else heights[:-1] / 2.0 + heights[1:] / 2.0
    with np.errstate(over="ignore", invalid="ignore"):
        sums[known] = np.concatenate(([0.0], np.cumsum(heights * np.diff(moments))))
    return sums


def compute_moving_average(values: FloatArray, width: int) -> FloatArray:
    """Return the centred rolling mean of `width` samples, shape (n,); at both ends, the mean of fewer samples.

    Values that are not finite are ignored.

    Args:
        values: Shape (n,).
        width: Window in samples; odd, so that the result is not shifted.

    Raises:
        LogError: the width is not odd or not positive.
    """
    if width < 1 or width % 2 == 0:
        raise LogError(
            f"a moving average needs an odd number of samples, got {width}", "such as 3, 5 or 7"
        )
    import pandas as pd

    known = pd.Series(np.where(np.isfinite(values), values, np.nan), dtype=np.float64)
    # The width is limited, as wider windows give the same result.
    width = min(width, 2 * len(values) + 1)
    means: FloatArray = known.rolling(width, min_periods=1, center=True).mean().to_numpy()
    return means


def resample(
    time_s: FloatArray, values: FloatArray, period_s: float
) -> tuple[FloatArray, FloatArray]:
    """Return a signal resampled at a fixed period, from the first sample to the last.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); values that are not finite are skipped.
        period_s: Sampling period, above 0.

    Returns:
        The times in s, and the values at these times.

    Raises:
        LogError: the period is not above 0, or gives too many samples.
    """
    if not len(values):
        return np.empty(0), np.empty(0)
    moments = build_even_moments(float(time_s.min()), float(time_s.max()), period_s)
    known = sort_known(time_s, values)
    return moments, sample_signal(time_s[known], values[known], moments)


def build_even_moments(start_s: float, stop_s: float, period_s: float) -> FloatArray:
    """Return times at a fixed period, from `start_s` to at most `stop_s`.

    Raises:
        LogError: the period is not above 0, or gives too many samples.
    """
    if not 0.0 < period_s < math.inf:
        raise LogError(f"the period must be above 0 s, got {period_s:g}")
    # The small margin prevents that rounding drops the last time.
    count = (stop_s - start_s) / period_s * (1.0 + 1e-12) + 1e-9 + 1
    if count > MAX_RESAMPLED:
        raise LogError(
            f"a period of {period_s:g} s gives {count:.0f} rows", f"at most {MAX_RESAMPLED}"
        )
    moments: FloatArray = start_s + np.arange(int(count), dtype=np.float64) * period_s
    return moments


def sample_signal(
    time_s: FloatArray, values: FloatArray, moments_s: FloatArray, between: Between = Between.HOLD
) -> FloatArray:
    """Return the values of a sorted signal at given times, shape (m,); NaN before its first sample.

    Args:
        time_s: Shape (n,), not decreasing, see `sort_known`.
        values: Shape (n,).
        moments_s: Shape (m,).
        between: The interpolation between samples. The last value is held after the end.
    """
    if not len(values):
        return np.full(len(moments_s), np.nan)
    if between == Between.LINEAR:
        return np.interp(moments_s, time_s, values, left=np.nan)
    # If several samples have the same time, the last one is taken. The margin allows for rounding of the times.
    indices = np.searchsorted(time_s, moments_s + 1e-9, side="right") - 1
    sampled = values[np.maximum(indices, 0)].astype(np.float64)
    sampled[indices < 0] = np.nan
    return sampled


QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary statistics of a column; NaN if it has no finite values."""

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


def format_figure(value: float) -> str:
    """Return a number of a table in four digits, or with one decimal from 1000 on; a dash if it is not finite."""
    if not math.isfinite(value):
        return "–"
    return format(value, ".4g" if abs(value) < 1000 else ".1f")


def compute_summary(values: FloatArray, quantiles: Sequence[float] = QUANTILES) -> Summary:
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
    scale = find_scale(low, high)
    scaled = finite if scale == 1.0 else finite / scale
    # The limits undo rounding out of the values' range.
    mean = min(max(float(scaled.mean(dtype=np.float64)) * scale, low), high)
    std = 0.0 if low == high else float(scaled.std(ddof=1, dtype=np.float64)) * scale
    quantile_values = tuple((np.quantile(scaled, quantiles) * scale).tolist()) if quantiles else ()
    return Summary(len(finite), left_out, low, mean, high, std, quantile_values)
