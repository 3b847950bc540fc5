"""Fewer points for the same picture: the least and the greatest value of every column."""

from __future__ import annotations

import numpy as np

from tuisim.datalog.arrays import FloatArray


def min_max(
    times_s: FloatArray, values: FloatArray, x_limits: tuple[float, float], columns: int
) -> tuple[FloatArray, FloatArray]:
    """Return the points of a trace that a chart of that width can tell apart.

    Args:
        times_s: Rising times, shape (n,).
        values: Shape (n,).
        x_limits: First and last time shown; of what lies outside, one point on each side stays,
            so that lines run out of the picture.
        columns: Width of the chart, at least 1.

    Returns:
        Times and values, each shape (m,), m at most 2 * columns + 2; all points if they are no more.
    """
    low, high = x_limits
    first = max(int(np.searchsorted(times_s, low, "left")) - 1, 0)
    last = min(int(np.searchsorted(times_s, high, "right")) + 1, len(times_s))
    times_s, values = times_s[first:last], values[first:last]
    if len(times_s) <= 2 * columns:
        return times_s, values
    edges = np.searchsorted(times_s, low + (high - low) * np.arange(1, columns) / columns)
    starts = np.unique(np.concatenate(([0], edges)))
    starts = starts[starts < len(times_s)]
    ends = np.concatenate((starts[1:], [len(times_s)])) - 1
    least, greatest = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    rising = values[starts] <= values[ends]
    reduced = np.empty(2 * len(starts))
    reduced[0::2] = np.where(rising, least, greatest)
    reduced[1::2] = np.where(rising, greatest, least)
    when = np.empty(2 * len(starts))
    when[0::2], when[1::2] = times_s[starts], times_s[ends]
    return when, reduced
