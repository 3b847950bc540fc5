"""Signals: functions of a time series that give another one."""

from __future__ import annotations

import math
from typing import Final, Literal

import numpy as np

from tuisim.errors import LogError
from tuisim.runs.arrays import FloatArray, IntArray

Between = Literal["hold", "linear"]
"""What a signal is between two samples: the last one still, or on the straight line to the next."""

HOLD: Final = "hold"
LINEAR: Final = "linear"

MAX_RESAMPLED = 50_000_000


def known_in_order(time_s: FloatArray, values: FloatArray) -> IntArray | slice:
    """Return the positions of the finite values in the order of their times, those of one moment as they stand.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,).
    """
    finite = np.isfinite(values)
    falls = bool((time_s[1:] < time_s[:-1]).any())
    if not falls:
        # Most logs are used as they are, not copied.
        return slice(None) if finite.all() else np.flatnonzero(finite)
    known = np.flatnonzero(finite)
    return known[np.argsort(time_s[known], kind="stable")]


def derivative(time_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return the slope at each sample, in units a second; not a number where time stands still.

    Second-order differences at uneven distances, one-sided at both ends.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); those that are not finite are passed over and have no slope.
    """
    slopes = np.full(len(values), np.nan)
    known = known_in_order(time_s, values)
    # Samples of one moment cannot have a slope between them: the first of them stands for all.
    moments, first, which = np.unique(time_s[known], return_index=True, return_inverse=True)
    if len(moments) > 1:
        with np.errstate(all="ignore"):
            slopes[known] = np.gradient(values[known][first], moments)[which]
    return slopes


def integral(time_s: FloatArray, values: FloatArray, between: Between = LINEAR) -> FloatArray:
    """Return the integral from the first sample to each, in units times seconds, shape (n,).

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); those that are not finite are passed over and have no integral.
        between: What the signal is between two samples.
    """
    sums = np.full(len(values), np.nan)
    known = known_in_order(time_s, values)
    moments, heights = time_s[known], np.asarray(values[known], np.float64)
    if not len(moments):
        return sums
    heights = heights[:-1] if between == HOLD else heights[:-1] / 2.0 + heights[1:] / 2.0
    with np.errstate(over="ignore", invalid="ignore"):
        sums[known] = np.concatenate(([0.0], np.cumsum(heights * np.diff(moments))))
    return sums


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
    # A window that reaches beyond both ends of the log takes in no more than one of this width.
    width = min(width, 2 * len(values) + 1)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        sums = _window_sums(np.where(known, values, 0.0), width)
        means: FloatArray = sums / _window_sums(known.astype(np.float64), width)
    return means


def _window_sums(values: FloatArray, width: int) -> FloatArray:
    """Return the sum of the `width` values around each.

    A window is the end of one block of that width and the beginning of the next, so that nothing
    but its own values adds to it: the difference of two sums of all loses the digits of the small ones.
    """
    count, half = len(values), width // 2
    blocks = np.zeros((-(-(count + width - 1) // width), width))
    blocks.ravel()[half : half + count] = values
    from_start = np.cumsum(blocks, axis=1).ravel()
    to_end = np.cumsum(blocks[:, ::-1], axis=1)[:, ::-1].ravel()
    sums = to_end[:count].copy()
    across = np.arange(count) % width > 0
    sums[across] += from_start[width - 1 : width - 1 + count][across]
    return sums


def resample(
    time_s: FloatArray, values: FloatArray, period_s: float, between: Between = HOLD
) -> tuple[FloatArray, FloatArray]:
    """Return a signal at even moments, from the first sample's to the last one's.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); those that are not finite are passed over.
        period_s: Distance of the moments, above 0.
        between: What the signal is between two samples.

    Returns:
        The moments in s and the values there.

    Raises:
        LogError: the period is not above 0, or so short that there were too many moments.
    """
    if not len(values):
        return np.empty(0), np.empty(0)
    moments = even_moments(float(time_s.min()), float(time_s.max()), period_s)
    return moments, known_at(time_s, values, moments, between)


def even_moments(start_s: float, stop_s: float, period_s: float) -> FloatArray:
    """Return moments so far apart, from `start_s` to at most `stop_s`.

    Raises:
        LogError: the period is not above 0, or so short that there were too many moments.
    """
    if not 0.0 < period_s < math.inf:
        raise LogError(f"the period must be above 0 s, got {period_s:g}")
    # A hair more, so that the last moment is not lost to rounding.
    count = (stop_s - start_s) / period_s * (1.0 + 1e-12) + 1e-9 + 1
    if count > MAX_RESAMPLED:
        raise LogError(f"a period of {period_s:g} s gives {count:.0f} rows", f"at most {MAX_RESAMPLED}")
    moments: FloatArray = start_s + np.arange(int(count), dtype=np.float64) * period_s
    return moments


def known_at(time_s: FloatArray, values: FloatArray, moments_s: FloatArray, between: Between = HOLD) -> FloatArray:
    """Return what a signal is at some moments, shape (m,), as `value_at`, whatever was read of it.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); those that are not finite are passed over.
        moments_s: Shape (m,).
        between: What the signal is between two samples.
    """
    known = known_in_order(time_s, values)
    return value_at(time_s[known], values[known], moments_s, between)


def value_at(time_s: FloatArray, values: FloatArray, moments_s: FloatArray, between: Between = HOLD) -> FloatArray:
    """Return what a signal is at some moments; not a number before its first sample.

    Args:
        time_s: Not falling, shape (n,), see `known_in_order`.
        values: Shape (n,).
        moments_s: Shape (m,).
        between: What the signal is between two samples. After the last one it stays.
    """
    if not len(values):
        return np.full(len(moments_s), np.nan)
    if between == LINEAR:
        return np.interp(moments_s, time_s, values, left=np.nan)
    # Of several samples at one moment the last one counts. A hair for moments counted up in floats.
    at = np.searchsorted(time_s, moments_s + 1e-9, side="right") - 1
    found = values[np.maximum(at, 0)].astype(np.float64)
    found[at < 0] = np.nan
    return found
