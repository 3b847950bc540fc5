"""Signals: functions of a time series that give another one."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np

from tuisim.datalog.arrays import FloatArray
from tuisim.errors import LogError

Between = Literal["hold", "linear"]
"""What a signal is between two samples: the last one still, or on the straight line to the next."""

HOLD: Final = "hold"
LINEAR: Final = "linear"

MAX_RESAMPLED = 50_000_000


def derivative(time_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return the slope at each sample, in units a second; not a number where time stands still.

    Second-order differences at uneven distances, one-sided at both ends.

    Args:
        time_s: Not falling, shape (n,).
        values: Shape (n,).
    """
    if len(values) < 2:
        return np.full(len(values), np.nan)
    # Samples of one moment cannot have a slope between them: the first of them stands for all.
    moments, first, which = np.unique(time_s, return_index=True, return_inverse=True)
    if len(moments) < 2:
        return np.full(len(values), np.nan)
    slopes: FloatArray = np.gradient(values[first], moments)[which]
    return slopes


def integral(time_s: FloatArray, values: FloatArray, between: Between = LINEAR) -> FloatArray:
    """Return the integral from the first sample to each, in units times seconds, shape (n,).

    Args:
        time_s: Not falling, shape (n,).
        values: Shape (n,).
        between: What the signal is between two samples.
    """
    if not len(values):
        return np.empty(0)
    heights = values[:-1] if between == HOLD else (values[:-1] + values[1:]) / 2.0
    return np.concatenate(([0.0], np.cumsum(heights * np.diff(time_s))))


def moving_average(values: FloatArray, width: int) -> FloatArray:
    """Return the mean of the `width` samples around each, of fewer at both ends, shape (n,).

    Values that are not finite are left out of the means.

    Args:
        values: Shape (n,).
        width: Odd, so that nothing is shifted.

    Raises:
        LogError: the width is not odd or not positive.
    """
    if width < 1 or width % 2 == 0:
        raise LogError(f"a moving average needs an odd number of samples, got {width}", "such as 3, 5 or 7")
    known = np.isfinite(values)
    # Means of what is left after the overall mean is taken away lose no digits to large sums.
    base = float(values[known].mean()) if known.any() else 0.0
    sums = np.concatenate(([0.0], np.cumsum(np.where(known, values - base, 0.0))))
    counts = np.concatenate(([0], np.cumsum(known)))
    half = width // 2
    at = np.arange(len(values))
    start, stop = np.maximum(at - half, 0), np.minimum(at + half + 1, len(values))
    number = counts[stop] - counts[start]
    with np.errstate(invalid="ignore", divide="ignore"):
        means: FloatArray = (sums[stop] - sums[start]) / number + base
    return means


def resample(
    time_s: FloatArray, values: FloatArray, period_s: float, between: Between = HOLD
) -> tuple[FloatArray, FloatArray]:
    """Return a signal at even moments, from the first sample's to the last one's.

    Args:
        time_s: Not falling, shape (n,).
        values: Shape (n,).
        period_s: Distance of the moments, above 0.
        between: What the signal is between two samples.

    Returns:
        The moments in s and the values there.

    Raises:
        LogError: the period is not above 0, or so short that there were too many moments.
    """
    if not period_s > 0.0:
        raise LogError(f"the period must be above 0 s, got {period_s:g}")
    if not len(values):
        return np.empty(0), np.empty(0)
    # A hair more, so that the last moment is not lost to rounding.
    count = int((time_s[-1] - time_s[0]) / period_s * (1.0 + 1e-12) + 1e-9) + 1
    if count > MAX_RESAMPLED:
        raise LogError(f"a period of {period_s:g} s gives {count} rows", f"at most {MAX_RESAMPLED}")
    moments = time_s[0] + np.arange(count) * period_s
    return moments, value_at(time_s, values, moments, between)


def value_at(time_s: FloatArray, values: FloatArray, moments_s: FloatArray, between: Between = HOLD) -> FloatArray:
    """Return what a signal is at some moments; not a number before its first sample.

    Args:
        time_s: Not falling, shape (n,), not empty.
        values: Shape (n,).
        moments_s: Shape (m,).
        between: What the signal is between two samples. After the last one it stays.
    """
    if between == LINEAR:
        return np.interp(moments_s, time_s, values, left=np.nan)
    # Of several samples at one moment the last one counts. A hair for moments counted up in floats.
    at = np.searchsorted(time_s, moments_s + 1e-9, side="right") - 1
    found = values[np.maximum(at, 0)].astype(np.float64)
    found[at < 0] = np.nan
    return found
