"""Decimation of traces: a pyramid of block minima and maxima, for any zoom."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuisim.logs.statistics import Summary, summary_of
from tuisim.runs.arrays import FloatArray


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


_BLOCK = 16
"""Each level has this many times fewer blocks than the one below."""
_ENOUGH = 4
"""Blocks for each column of the chart: with fewer, edges would be seen at the wrong column."""

_SUMMED_AT_ONCE = 10_000
"""Up to this number of points, statistics are computed directly."""

_MOST = 1e150
"""Values beyond this limit are dropped: the difference of two such numbers may overflow."""


class Pyramid:
    """The finite points of a series, sorted by time.

    Args:
        times_s: Shape (n,).
        values: Shape (n,); what is not finite, or beyond all measure, is left out.
    """

    def __init__(self, times_s: FloatArray, values: FloatArray) -> None:
        self._index: npt.NDArray[np.intp] | None = None
        """Index of each point in the input; None if the order is unchanged."""
        if not (_measurable(values) and _measurable(times_s)):
            good = (np.abs(values) < _MOST) & (np.abs(times_s) < _MOST)
            self._index = np.flatnonzero(good)
            times_s, values = times_s[good], values[good]
        if len(times_s) > 1 and (times_s[1:] < times_s[:-1]).any():
            order = np.argsort(times_s, kind="stable")
            times_s, values = times_s[order], values[order]
            self._index = order if self._index is None else self._index[order]
        self.times_s, self.values = times_s, values
        self._sums: tuple[FloatArray, FloatArray] | None = None
        self._levels: list[tuple[FloatArray, FloatArray]] = []
        while len(self._levels[-1][0] if self._levels else values) > _BLOCK:
            self._add_level()

    def points(self, x_limits: tuple[float, float], columns: int) -> tuple[FloatArray, FloatArray]:
        """Return times and values of at most a few thousand points that give the same drawing as all points.

        Args:
            x_limits: First and last time shown; the neighbours of what lies between stay as well.
            columns: Width of the chart, at least 1.
        """
        first = max(int(np.searchsorted(self.times_s, x_limits[0], "left")) - 1, 0)
        last = min(int(np.searchsorted(self.times_s, x_limits[1], "right")) + 1, len(self.times_s))
        level, size = -1, 1
        while (last - first) // (size * _BLOCK) >= _ENOUGH * columns:
            level, size = level + 1, size * _BLOCK
        if level < 0:
            return self.times_s[first:last], self.values[first:last]
        least, greatest = self._levels[level]
        blocks = np.arange(first // size, (last - 1) // size + 1)
        starts, ends = blocks * size, np.minimum((blocks + 1) * size, len(self.times_s)) - 1
        low, high = least[blocks], greatest[blocks]
        rising = self.values[starts] <= self.values[ends]
        times_s, values = np.empty(2 * len(blocks)), np.empty(2 * len(blocks))
        times_s[0::2], times_s[1::2] = self.times_s[starts], self.times_s[ends]
        values[0::2], values[1::2] = np.where(rising, low, high), np.where(rising, high, low)
        return times_s, values

    def _add_level(self) -> None:
        least, greatest = self._levels[-1] if self._levels else (self.values, self.values)
        starts = np.arange(0, len(least), _BLOCK)
        self._levels.append((np.minimum.reduceat(least, starts), np.maximum.reduceat(greatest, starts)))

    def nearest(self, time_s: float) -> int:
        """Return the index of the input point nearest to a time; there must be a finite one."""
        at = int(np.searchsorted(self.times_s, time_s))
        if at == len(self.times_s) or (at and time_s - self.times_s[at - 1] <= self.times_s[at] - time_s):
            at -= 1
        return at if self._index is None else int(self._index[at])

    def between(self, start_s: float, stop_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the points in a time range, both ends included."""
        first, last = self._span(start_s, stop_s)
        return self.times_s[first:last], self.values[first:last]

    def _span(self, start_s: float, stop_s: float) -> tuple[int, int]:
        first, last = np.searchsorted(self.times_s, start_s, "left"), np.searchsorted(self.times_s, stop_s, "right")
        return int(first), int(last)

    def figures(self, start_s: float, stop_s: float) -> Summary:
        """Return the statistics of a time range, both ends included, without quantiles."""
        first, last = self._span(start_s, stop_s)
        if last - first <= _SUMMED_AT_ONCE:
            return summary_of(self.values[first:last], quantiles=())
        # Whole blocks are cached; only the partial blocks at both ends are computed.
        begin, end = -(-first // _BLOCK), last // _BLOCK
        ends = np.concatenate((self.values[first : begin * _BLOCK], self.values[end * _BLOCK : last]))
        means, squares = (part[begin:end] for part in self._moments())
        least, greatest = (part[begin:end] for part in self._levels[0])
        low = float(np.minimum.reduce(ends, initial=float(least.min())))
        high = float(np.maximum.reduce(ends, initial=float(greatest.max())))
        count = last - first
        mean = low if low == high else float(means.sum() * _BLOCK + ends.sum()) / count
        off = squares.sum() + _BLOCK * np.square(means - mean).sum() + np.square(ends - mean).sum()
        return Summary(count, 0, low, mean, high, float(np.sqrt(off / (count - 1))) if low != high else 0.0, ())

    def _moments(self) -> tuple[FloatArray, FloatArray]:
        """Mean and sum of squared deviations of each whole block; cached."""
        if self._sums is None:
            whole = self.values[: len(self.values) // _BLOCK * _BLOCK].reshape(-1, _BLOCK)
            means, squares = np.empty(len(whole)), np.empty(len(whole))
            # Bit by bit, so that a long log needs no second place for all its values.
            for at in range(0, len(whole), _SUMMED_AT_ONCE):
                part = slice(at, at + _SUMMED_AT_ONCE)
                means[part] = whole[part].mean(axis=1)
                squares[part] = np.square(whole[part] - means[part, np.newaxis]).sum(axis=1)
            self._sums = means, squares
        return self._sums


def _measurable(numbers: FloatArray) -> bool:
    """Return whether all numbers are within the limit, without a copy."""
    # A single one that is not a number makes least and greatest none, and all comparisons false.
    return not len(numbers) or bool(numbers.min() > -_MOST and numbers.max() < _MOST)
