"""Traces of a chart: the points logged and measured so far, and their decimation for any width and zoom."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.magnitude import find_scale
from tuisim.logs.signals import Summary, compute_summary
from tuisim.logs.units import drop_run, parse_unit
from tuisim.pictures.charts.axes import MAX_DRAWN, limit_drawn

TRACE_COLORS: tuple[Rgb, ...] = (
    (240, 228, 66),
    (86, 180, 233),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (255, 255, 255),
    (180, 255, 165),
    (60, 110, 220),
)
"""Those of Okabe and Ito, with a lighter blue and white for a dark ground, and a light green in place of a second
orange: they stay apart for people who see fewer colours. Source: https://jfly.uni-koeln.de/color/."""
MARKS = "o+x*#%=~&@"
"""Marks of traces for terminals without colours; more than there are colours, so that many traces differ in one or
the other."""

_OTHER_READINGS = ("ultrasonic", "gyro", "wheel")
"""Names that begin so are distances and angles, whose unit a program may choose."""

MAX_POINTS = 1 << 16
"""A trace with more points keeps the least and the greatest of each few, so that a run without end needs a bounded
memory: what was recorded long ago is drawn as before, unless one zooms in."""
_THINNED = 4


def find_scale_name(name: str) -> str:
    """Return the name of the scale to which a variable is drawn: its unit, or the word for what it measures.

    The result is empty for light in any unit, and for variables without a known unit.
    """
    name = drop_run(name)
    sign = parse_unit(name).sign
    if sign:
        return "" if sign == "%" else sign
    return next((reading for reading in _OTHER_READINGS if name.lower().startswith(reading)), "")


class Trace:
    """A variable as points in order of time, with a colour; ticked traces are drawn.

    Args:
        name: The name that was logged, or the name of a column of telemetry.
        number: Chooses colour and mark.
        logged: Whether the program has printed the values; else the app measured them.
    """

    def __init__(self, name: str, number: int, logged: bool = True) -> None:
        self.name = name
        self.on = self.logged = logged
        self.rgb = TRACE_COLORS[number % len(TRACE_COLORS)]
        self.mark = MARKS[number % len(MARKS)]
        self.scale = find_scale_name(name)
        """Name of the scale to which the trace is drawn; traces of one scale have the same text."""
        self._times_s = np.empty(256)
        self._values = np.empty(256)
        self._count = 0

    @property
    def times_s(self) -> FloatArray:
        """Simulated times of the points in s, shape (n,)."""
        return self._times_s[: self._count]

    @property
    def values(self) -> FloatArray:
        """Values of the points, limited to what can be drawn, shape (n,)."""
        return limit_drawn(self._values[: self._count])

    def add(self, times_s: Sequence[float], values: Sequence[float]) -> None:
        """Append points to the trace, except those that are not finite, or whose times are beyond `MAX_DRAWN`."""
        new_times, new_values = np.array(times_s, float), np.array(values, float)
        good = (np.abs(new_times) < MAX_DRAWN) & np.isfinite(new_values)
        new_times, new_values = new_times[good], new_values[good]
        end = self._count + len(new_times)
        if end > len(self._times_s):
            room = max(end, 2 * len(self._times_s)) - self._count
            self._times_s = np.concatenate((self.times_s, np.empty(room)))
            self._values = np.concatenate((self._values[: self._count], np.empty(room)))
        self._times_s[self._count : end], self._values[self._count : end] = new_times, new_values
        late = self._count and len(new_times) and new_times[0] < self._times_s[self._count - 1]
        self._count = end
        if late or (np.diff(new_times) < 0).any():
            # A program may log its own times; lookups need them sorted.
            order = np.argsort(self.times_s, kind="stable")
            self._times_s[:end], self._values[:end] = self.times_s[order], self._values[order]
        if end > MAX_POINTS:
            self._drop_points()

    def _drop_points(self) -> None:
        """Of every four successive points, keep only those with the least and the greatest value, in their order."""
        whole = self._count // _THINNED * _THINNED
        values = self._values[:whole].reshape(-1, _THINNED)
        offsets = np.sort(
            np.stack(
                (values.argmin(axis=1), _THINNED - 1 - values[:, ::-1].argmax(axis=1)), axis=1
            ),
            axis=1,
        )
        indices = (offsets + np.arange(0, whole, _THINNED)[:, np.newaxis]).ravel()
        indices = np.concatenate((indices, np.arange(whole, self._count)))
        self._times_s, self._values, self._count = (
            self._times_s[indices],
            self._values[indices],
            len(indices),
        )

    def find_value(self, time_s: float) -> float | None:
        """Return the value of the last point at or before a time in s; None before the first point."""
        index = int(np.searchsorted(self.times_s, time_s, "right")) - 1
        return float(self._values[index]) if index >= 0 else None

    def find_nearest_s(self, time_s: float) -> float:
        """Return the time in s of the point nearest to a time; the trace must have a point."""
        return float(self.times_s[np.abs(self.times_s - time_s).argmin()])

    def clear(self) -> None:
        """Remove the points of the trace; it keeps its colour, and is drawn or hidden as before."""
        self._count = 0


class Traces:
    """The traces of a chart; the traces that the program has logged come first.

    Args:
        traces: The traces at first, by name.
    """

    def __init__(self, traces: Mapping[str, Trace] | None = None) -> None:
        self._by_name = dict(traces or {})
        self._cleared: dict[str, Trace] = {}
        """Traces without points since `clear`: each gets its tick and its colour again with its next points."""

    def __iter__(self) -> Iterator[Trace]:
        return iter(sorted(self._by_name.values(), key=lambda trace: not trace.logged))

    def __len__(self) -> int:
        return len(self._by_name)

    def append(
        self, name: str, times_s: Sequence[float], values: Sequence[float], logged: bool = True
    ) -> None:
        """Add points to a trace, which is made if it does not exist.

        If a program logs a variable with the name of a column of telemetry, the trace shows the program's values.
        """
        trace = self._by_name.get(name) or self._cleared.pop(name, None)
        if trace is not None and trace.logged and not logged:
            self._by_name[name] = trace
            return
        if trace is None or trace.logged != logged:
            # Logged traces use colours from the front of the list, telemetry from the back.
            alike = sum(
                known.logged == logged
                for known in (*self._by_name.values(), *self._cleared.values())
            )
            trace = Trace(name, alike if logged else -1 - alike, logged)
        self._by_name[name] = trace
        trace.add(times_s, values)

    def clear(self) -> None:
        """Remove all traces.

        If points are added to a trace later, it has the same colour as before, and is drawn or hidden as before.
        """
        for trace in self._by_name.values():
            trace.clear()
        self._cleared.update(self._by_name)
        self._by_name.clear()

    def list_drawn(self) -> list[Trace]:
        """Return the ticked traces that have points."""
        return [trace for trace in self if trace.on and len(trace.times_s)]

    def end_s(self) -> float:
        """Return the latest time of all points in s; 0 if there are none."""
        return max((float(trace.times_s[-1]) for trace in self if len(trace.times_s)), default=0.0)


def reduce_points(
    times_s: FloatArray, values: FloatArray, x_limits: tuple[float, float], columns: int
) -> tuple[FloatArray, FloatArray]:
    """Return the times and values of a trace to draw in a chart: in each column, the least and the greatest value.

    Args:
        times_s: Rising times, shape (n,).
        values: Shape (n,).
        x_limits: First and last time shown; one point beyond each is kept, so that lines extend to the edges.
        columns: Width of the chart, at least 1.

    Returns:
        Times and values, each shape (m,), m at most 2 * columns + 2; all points if there are no more.
    """
    low, high = x_limits
    first, last = _find_visible(times_s, x_limits)
    times_s = times_s[first:last]
    values = values[first:last]
    if len(times_s) <= 2 * columns:
        return times_s, values
    edges = np.searchsorted(times_s, low + (high - low) * np.arange(1, columns) / columns)
    starts = np.unique(np.concatenate(([0], edges)))
    starts = starts[starts < len(times_s)]
    ends = np.concatenate((starts[1:], [len(times_s)])) - 1
    lowest, highest = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    return _join_pairs(times_s[starts], times_s[ends]), _order_extremes(
        values[starts] <= values[ends], lowest, highest
    )


def clip_line(
    xs: FloatArray, ys: FloatArray, limits: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Return the part of a line between two positions on the x axis, with interpolated points at both ends.

    Args:
        xs: Positions of the points on the x axis, which do not decrease, shape (n,).
        ys: Values, shape (n,).
        limits: The first and the last position shown.
    """
    inside = (xs >= limits[0]) & (xs <= limits[1])
    if inside.all():
        return xs, ys
    crossed = [edge for edge in limits if xs[0] < edge < xs[-1]]
    indices = np.searchsorted(xs[inside], crossed)
    return np.insert(xs[inside], indices, crossed), np.insert(
        ys[inside], indices, np.interp(crossed, xs, ys)
    )


def sample_and_hold(times_s: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the times and values of a step line, which keeps each value until the next point."""
    if len(times_s) < 2:
        return times_s, values
    return np.repeat(times_s, 2)[1:], np.repeat(values, 2)[:-1]


def _find_visible(times_s: FloatArray, x_limits: tuple[float, float]) -> tuple[int, int]:
    first = max(int(np.searchsorted(times_s, x_limits[0], "left")) - 1, 0)
    return first, min(int(np.searchsorted(times_s, x_limits[1], "right")) + 1, len(times_s))


def _join_pairs(firsts: FloatArray, seconds: FloatArray) -> FloatArray:
    return np.stack((firsts, seconds), axis=1).ravel().astype(np.float64, copy=False)


def _order_extremes(
    rising: npt.NDArray[np.bool_], lowest: FloatArray, highest: FloatArray
) -> FloatArray:
    return _join_pairs(np.where(rising, lowest, highest), np.where(rising, highest, lowest))


_BLOCK = 16
"""Each level has this many times fewer blocks than the one below."""
_ENOUGH = 4
"""Blocks per column of the chart: with fewer, edges would appear at the wrong column."""

_SUMMED_AT_ONCE = 10_000
"""Up to this number of points, statistics are computed directly."""


class Pyramid:
    """The finite points of a series, sorted by time, for drawing long series quickly.

    It also has the least and the greatest value of each block of successive points.

    Args:
        times_s: Shape (n,).
        values: Shape (n,); points with values that are not finite, or times beyond `MAX_DRAWN`, are left out.
    """

    def __init__(self, times_s: FloatArray, values: FloatArray) -> None:
        self._index: npt.NDArray[np.intp] | None = None
        """Index of each point in the input; None if the order is unchanged."""
        if not (_is_below(values, np.inf) and _is_below(times_s, MAX_DRAWN)):
            good = (np.abs(values) < np.inf) & (np.abs(times_s) < MAX_DRAWN)
            self._index = np.flatnonzero(good)
            times_s = times_s[good]
            values = values[good]
        if len(times_s) > 1 and (times_s[1:] < times_s[:-1]).any():
            order = np.argsort(times_s, kind="stable")
            times_s = times_s[order]
            values = values[order]
            self._index = order if self._index is None else self._index[order]
        self.times_s = times_s
        self.values = values
        self._sums: tuple[FloatArray, FloatArray] | None = None
        self._levels: list[tuple[FloatArray, FloatArray]] = []
        while len(self._levels[-1][0] if self._levels else values) > _BLOCK:
            self._add_level()

    def select_points(
        self, x_limits: tuple[float, float], columns: int
    ) -> tuple[FloatArray, FloatArray]:
        """Return the times and values to draw: at most a few thousand points, which look like all points in a chart.

        Args:
            x_limits: First and last time shown; one point beyond each is kept.
            columns: Width of the chart, at least 1.
        """
        first, last = _find_visible(self.times_s, x_limits)
        level = -1
        size = 1
        while (last - first) // (size * _BLOCK) >= _ENOUGH * columns:
            level = level + 1
            size = size * _BLOCK
        if level < 0:
            return self.times_s[first:last], limit_drawn(self.values[first:last])
        lowest, highest = self._levels[level]
        blocks = np.arange(first // size, (last - 1) // size + 1)
        starts = blocks * size
        ends = np.minimum((blocks + 1) * size, len(self.times_s)) - 1
        rising = self.values[starts] <= self.values[ends]
        values = _order_extremes(rising, lowest[blocks], highest[blocks])
        return _join_pairs(self.times_s[starts], self.times_s[ends]), limit_drawn(values)

    def _add_level(self) -> None:
        lowest, highest = self._levels[-1] if self._levels else (self.values, self.values)
        starts = np.arange(0, len(lowest), _BLOCK)
        self._levels.append(
            (np.minimum.reduceat(lowest, starts), np.maximum.reduceat(highest, starts))
        )

    def find_nearest(self, time_s: float) -> int:
        """Return the index of the finite point nearest to a time, in the arrays from which the pyramid was built.

        There must be a finite point.
        """
        index = int(np.searchsorted(self.times_s, time_s))
        if index == len(self.times_s) or (
            index and time_s - self.times_s[index - 1] <= self.times_s[index] - time_s
        ):
            index -= 1
        return index if self._index is None else int(self._index[index])

    def select_range(self, start_s: float, stop_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the times and values of the points in a time range, with both ends included."""
        first, last = self._find_range(start_s, stop_s)
        return self.times_s[first:last], self.values[first:last]

    def _find_range(self, start_s: float, stop_s: float) -> tuple[int, int]:
        first, last = (
            np.searchsorted(self.times_s, start_s, "left"),
            np.searchsorted(self.times_s, stop_s, "right"),
        )
        return int(first), int(last)

    def compute_summary(self, start_s: float, stop_s: float) -> Summary:
        """Return the statistics of the points in a time range, with both ends included, without quantiles."""
        first, last = self._find_range(start_s, stop_s)
        if last - first <= _SUMMED_AT_ONCE or find_scale(*self._find_ends()) != 1.0:
            return compute_summary(self.values[first:last], quantiles=())
        # Whole blocks are cached; only the partial blocks at both ends are computed.
        begin, end = -(-first // _BLOCK), last // _BLOCK
        ends = np.concatenate(
            (self.values[first : begin * _BLOCK], self.values[end * _BLOCK : last])
        )
        means, squares = (part[begin:end] for part in self._compute_moments())
        lowest, highest = (part[begin:end] for part in self._levels[0])
        low = float(np.minimum.reduce(ends, initial=float(lowest.min())))
        high = float(np.maximum.reduce(ends, initial=float(highest.max())))
        count = last - first
        mean = low if low == high else float(means.sum() * _BLOCK + ends.sum()) / count
        off = squares.sum() + _BLOCK * np.square(means - mean).sum() + np.square(ends - mean).sum()
        return Summary(
            count, 0, low, mean, high, float(np.sqrt(off / (count - 1))) if low != high else 0.0, ()
        )

    def _find_ends(self) -> tuple[float, float]:
        lowest, highest = self._levels[-1]
        return float(lowest.min()), float(highest.max())

    def _compute_moments(self) -> tuple[FloatArray, FloatArray]:
        """Return the mean and the sum of squared deviations of each whole block; they are computed once."""
        if self._sums is None:
            whole = self.values[: len(self.values) // _BLOCK * _BLOCK].reshape(-1, _BLOCK)
            means = np.empty(len(whole))
            squares = np.empty(len(whole))
            # The blocks are computed in parts, so that a long log is not copied as a whole.
            for start in range(0, len(whole), _SUMMED_AT_ONCE):
                part = slice(start, start + _SUMMED_AT_ONCE)
                means[part] = whole[part].mean(axis=1)
                squares[part] = np.square(whole[part] - means[part, np.newaxis]).sum(axis=1)
            self._sums = means, squares
        return self._sums


def _is_below(numbers: FloatArray, limit: float) -> bool:
    """Return whether the absolute value of all numbers is below a limit, without a copy of them."""
    # One NaN makes minimum and maximum NaN, and all comparisons false.
    return not len(numbers) or bool(numbers.min() > -limit and numbers.max() < limit)
