"""The variables of a log as traces of a chart: loaded on first use, aligned, decimated for drawing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tuisim.analysis.events import THRESHOLD_FORM, parse_threshold
from tuisim.base.errors import LogError
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.signals import sample_signal
from tuisim.pictures.charts.axes import Limits, widen_times
from tuisim.pictures.charts.traces import Pyramid, Trace, Traces, sample_and_hold

if TYPE_CHECKING:
    from tuisim.logs.log import Log, Series

MAX_VISIBLE = 4
"""Maximum number of variables that are visible when a log is opened."""
_LIGHT = "_red"
"""Ending of the names of columns with the reflected red light of a colour sensor."""
_MAX_SPAN_RATIO = 5.0
"""Variables share a scale only if it spans at most so many times what each of them spans; else one looks flat."""


class LogTrace(Trace):
    """A variable of one run of a log, in a chart: its name is in `Log.names`; its number selects colour and mark."""

    def __init__(self, log: Log, name: str, number: int) -> None:
        super().__init__(name, number)
        self.number = number
        self.on = number < MAX_VISIBLE
        self._places: FloatArray | None = None
        self._log = log
        self._pyramid: Pyramid | None = None
        self._shown: tuple[FloatArray, FloatArray] = (np.empty(0), np.empty(0))

    @cached_property
    def series(self) -> Series:
        """All samples of the variable."""
        return self._log.series(self.name)

    @property
    def pyramid(self) -> Pyramid:
        """The finite samples of the variable, sorted by their position on the x axis."""
        if self._pyramid is None:
            self._pyramid = Pyramid(self.places, self.series.values)
        return self._pyramid

    @property
    def places(self) -> FloatArray:
        """The positions of the samples on the x axis, shape (n,): times in s, or distances driven.

        They are distances, in mm, if runs are aligned by distance.
        """
        return self.series.time_s if self._places is None else self._places

    def is_derived_otherwise(self, log: Log) -> bool:
        """Return whether another version of the log has a derived variable of this name with other samples."""
        return self.name in log.derived and log.derived[self.name] is not self.series

    def is_legible(self, others: Sequence[LogTrace]) -> bool:
        """Return whether this trace and the others can be drawn to one scale without one of them looking flat."""
        own = self._find_extremes()
        left = [other._find_extremes() for other in others if not other.scale]
        low, high = (
            min((extremes[0] for extremes in left), default=0.0),
            max((extremes[1] for extremes in left), default=0.0),
        )
        lowest, highest = min(low, own[0]), max(high, own[1])
        return min(high - low, own[1] - own[0]) * _MAX_SPAN_RATIO >= highest - lowest

    def _find_extremes(self) -> Limits:
        values = self.pyramid.values
        return (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)

    def align(self, places: FloatArray | None) -> None:
        """Set the positions of the samples on the x axis; None stands for their times."""
        self._places = places
        self._pyramid = None

    def prepare(self, x_limits: Limits, columns: int, hold: bool) -> None:
        """Select the points to draw in a chart.

        Args:
            x_limits: Visible range of the x axis.
            columns: Width of the chart.
            hold: Whether the chart draws a step line, which keeps each value until the next sample.
        """
        times_s, values = self.pyramid.select_points(x_limits, columns)
        self._shown = sample_and_hold(times_s, values) if hold else (times_s, values)

    @property
    def times_s(self) -> FloatArray:
        """The positions on the x axis of the points to draw, shape (n,): times in s, or distances driven.

        They are distances, in mm, if runs are aligned by distance.
        """
        return self._shown[0]

    @property
    def values(self) -> FloatArray:
        """The values of the points to draw, shape (n,)."""
        return self._shown[1]

    def find_value(self, time_s: float) -> float | None:
        """Return the value of the last sample at or before a position on the x axis; None before the first sample."""
        pyramid = self.pyramid
        if not len(pyramid.times_s) or time_s < pyramid.times_s[0]:
            return None
        return float(sample_signal(pyramid.times_s, pyramid.values, np.array([time_s]))[0])


class LogTraces(Traces):
    """The traces of all variables of a log, in the order of the log."""

    def __init__(self, log: Log) -> None:
        super().__init__()
        # If a row has no variable, there is a name without samples.
        names = (
            name for name in log.names if not log.layout.variable or len(log.series(name).rows)
        )
        self._by_log_name = {name: LogTrace(log, name, number) for number, name in enumerate(names)}
        self._show_light_columns()

    def set_log(self, log: Log) -> None:
        """Replace the log by the same log with other derived variables; new variables become visible."""
        remaining = [
            trace
            for trace in self
            if trace.name in log.names and not trace.is_derived_otherwise(log)
        ]
        known = {trace.name for trace in remaining}
        number = max((trace.number for trace in remaining), default=-1)
        added = [name for name in log.derived if name not in known]
        new = [LogTrace(log, name, number + offset) for offset, name in enumerate(added, 1)]
        visible = [trace for trace in remaining if trace.on]
        for trace in new:
            trace.on = True
            if not trace.scale and visible and not trace.is_legible(visible):
                trace.scale = trace.name
        self._by_log_name = {trace.name: trace for trace in (*remaining, *new)}

    def _show_light_columns(self) -> None:
        """If columns of telemetry have the red light of colour sensors, show only these columns.

        Otherwise, change nothing.
        """
        light = [trace for trace in self if trace.name.endswith(_LIGHT)]
        for trace in self:
            trace.on = trace in light[:MAX_VISIBLE] if light else trace.on

    def __iter__(self) -> Iterator[LogTrace]:
        return iter(self._by_log_name.values())

    def __len__(self) -> int:
        return len(self._by_log_name)

    def __contains__(self, name: object) -> bool:
        return name in self._by_log_name

    def find_trace(self, name: str) -> LogTrace:
        """Return the trace of a variable, given by its name.

        Raises:
            KeyError: there is no trace of this name.
        """
        return self._by_log_name[name]

    def list_ticked(self) -> list[LogTrace]:
        """Return the ticked traces, including those without points."""
        return [trace for trace in self if trace.on]

    def find_span_s(self) -> Limits:
        """Return the first and the last time of the visible traces in s; if these are equal, a range around them."""
        ends = [
            trace.pyramid.times_s[[0, -1]]
            for trace in self.list_ticked()
            if len(trace.pyramid.times_s)
        ]
        if not ends:
            return 0.0, 1.0
        low, high = float(min(end[0] for end in ends)), float(max(end[1] for end in ends))
        return widen_times(low, high)


TIME = "time"
DISTANCE = "distance"
FORM = f"time, distance, or an event: {THRESHOLD_FORM}"


def align_series(log: Log, series: Sequence[Series], way: str) -> list[FloatArray | None]:
    """Return the positions on the x axis of the samples of each series; None for a series stands for its times.

    Args:
        log: The log.
        series: The variables.
        way: How runs are aligned: by time, by distance, or by an event, see `FORM`.

    Raises:
        LogError: `way` is invalid, or the log cannot be aligned like that.
    """
    if way == TIME:
        return [None] * len(series)
    if way == DISTANCE:
        driven = [log.compute_driven_mm(variable) for variable in series]
        if any(places is None for places in driven):
            raise LogError("no distances: the log has no x_mm and y_mm in each row", FORM)
        return driven
    event = parse_threshold(way)
    if event is None:
        raise LogError(f"cannot align by {way!r}", FORM)
    start_by_run = {
        variable.run: there[0].time_s
        for variable in event.select_series(series)
        if (there := event.find_crossings(variable))
    }
    if not start_by_run:
        raise LogError(f"no run reaches {way}", FORM)
    # A run without the event is aligned at the earliest time at which another run has it.
    return [
        variable.time_s - start_by_run.get(variable.run, min(start_by_run.values()))
        for variable in series
    ]
