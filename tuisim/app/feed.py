"""The data for the chart and the pen trace, and what panels show of a past instant."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tuisim.app.snapshot import CHART_PERIOD_S, RunPhase
from tuisim.base.data_class import dataclass
from tuisim.engine.core.field import Field
from tuisim.engine.core.sensors import list_columns
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN
from tuisim.engine.runs.frames import compute_column_values
from tuisim.engine.runs.records import OutputRow
from tuisim.engine.runs.samples import list_samples
from tuisim.pictures.scene.pen import place_drawn_mm

if TYPE_CHECKING:
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.engine.runs.recorded_run import Recording

Series = dict[str, tuple[list[float], list[float]]]
"""Times in s and values, by the name of the trace."""

Points = tuple[list[float], list[float]]
"""x and y in mm of the points of the pen's trace, NaN where the pen was lifted."""

POINTS_A_FEED = 60
"""Maximum number of telemetry moments for which one call reads every sensor, so that the call stays short."""
POINTS_OF_A_RUN = 1500
"""A chart that is shown when a run has long begun gets about so many moments of the earlier telemetry."""
TRACE_POINTS_A_FEED = 4000
_MIN_LAG_S = 0.3
"""If the chart lags less than so many seconds behind the printed samples, the app does not say so: nobody sees it."""
_JUMP_MM = 25.0
"""If the pen moves at least this far in one tick, the robot was placed elsewhere: no wheel is so fast."""


def sample_series(rows: Iterable[OutputRow]) -> Series:
    """Return the samples among printed lines as times in s and values, by the name of the variable.

    A sample can contain its own time; otherwise, its time is that of the print.
    """
    series: Series = {}
    for sample in list_samples(rows):
        times, values = series.setdefault(sample.name, ([], []))
        times.append(sample.time_s)
        values.append(sample.value)
    return series


@dataclass(slots=True)
class Feed:
    """Reads the new telemetry of a run at each call, for the chart and the pen trace."""

    recording: Recording
    _parts: int = field(default=0, init=False)
    """Number of plugged-in parts for which the chart has columns; if more are plugged in, the chart begins again."""
    _charted: int = field(default=0, init=False)
    _traced: int = field(default=0, init=False)
    _lifted: bool = field(default=False, init=False)
    """Whether the pen was up in the last tick record whose position was added to the trace."""
    _last_xy_mm: tuple[float, float] | None = field(default=None, init=False)
    """Position of the robot in the last tick record that was added to the trace; None before the first."""

    @property
    def is_behind(self) -> bool:
        """Whether some ticks of the run have not been returned by `chart_series` yet."""
        return self._charted < self.recording.telemetry.count

    @property
    def is_far_behind(self) -> bool:
        """Whether it takes more than one call of `chart_series` to return the rest of the run."""
        return self._charted + POINTS_A_FEED < self.recording.telemetry.count

    def describe_lag(self) -> str:
        """Return up to which time the chart shows the printed samples, such as `drawn to 3.0 of 9.5 s`.

        The chart lags behind while the program prints faster than the app reads. The text is empty if it lags by less
        than `_MIN_LAG_S`.
        """
        hz = self.recording.spec.profile.tick_hz
        tick = self.recording.rows.find_unread_tick()
        end = self.recording.telemetry.count
        if tick is None or end - tick < _MIN_LAG_S * hz:
            return ""
        return f"drawn to {tick / hz:.1f} of {end / hz:.1f} s"

    def begin_again(self) -> bool:
        """If a part was plugged in since the last call, which adds columns, restart the chart at the first tick.

        Returns:
            Whether a part was plugged in.
        """
        if self._parts == len(self.recording.plugged):
            return False
        self._parts = len(self.recording.plugged)
        self._charted = 0
        return True

    def restart_chart(self) -> None:
        """Let the next call of `chart_series` begin with the first tick of the run."""
        self._charted = 0

    def chart_series(self, mat: Field) -> Series:
        """Return the telemetry of the ticks since the last call: times in s and values, by column.

        If there are many new ticks, a call returns only the first part of them, and not every tick.

        Args:
            mat: The mat that the sensors read.
        """
        run = self.recording
        count = run.telemetry.count
        stride = max(1, (count - self._charted) // POINTS_OF_A_RUN)
        end = min(count, self._charted + stride * POINTS_A_FEED)
        if end == self._charted:
            return {}
        records = run.telemetry.array(self._charted)[
            _thin_positions(0, end - self._charted, POINTS_A_FEED)
        ]
        names = [column.name for column in list_columns(run.spec) if column.is_traced]
        values = compute_column_values(
            names,
            records,
            run,
            run.actions(),
            mat,
            lambda record: run.find_field(int(record[0]), mat),
        )
        times_s = (records["tick"] / run.spec.profile.tick_hz).tolist()
        self._charted = end
        return {name: (times_s, values[name].tolist()) for name in values}

    def trace_points(self) -> Points:
        """Return x and y, in mm, of the points at which the pen drew since the last call; NaN where it was lifted."""
        records = self.recording.telemetry.array(self._traced)
        if not len(records):
            return [], []
        self._traced += len(records)
        jumps = _count_jumps(records, self._last_xy_mm)
        self._last_xy_mm = float(records["x_mm"][-1]), float(records["y_mm"][-1])
        if self._lifted and not (records["flags"] & FLAG_PEN_DOWN).any():
            return [], []
        kept_at = _thin_positions(0, len(records), TRACE_POINTS_A_FEED)
        records = records[kept_at]
        jumps = jumps[kept_at]
        xs, ys, lifted = place_drawn_mm(self.recording.spec.robot, records)
        # Of consecutive points with the pen up, only the first is kept: one gap is enough.
        is_kept = ~(lifted & np.concatenate(([self._lifted], lifted[:-1])))
        self._lifted = bool(lifted[-1])
        return _insert_gaps(xs[is_kept], ys[is_kept], jumps[is_kept])


def trace_run(run: Recording, tick: int) -> Points:
    """Return x and y, in mm, of the points at which the pen of a run has drawn up to a tick; NaN where it was lifted.

    Of a long run every n-th point is returned, with the same n for all ticks.
    """
    records = run.telemetry.array()
    stride = max(1, len(records) // TRACE_POINTS_A_FEED)
    records = records[: tick + 1]
    if not (records["flags"] & FLAG_PEN_DOWN).any():
        return [], []
    kept_at = np.append(np.arange(0, tick, stride), tick)
    jumps = _count_jumps(records, None)[kept_at]
    xs, ys, lifted = place_drawn_mm(run.spec.robot, records[kept_at])
    is_kept = ~(lifted & np.concatenate(([False], lifted[:-1])))
    return _insert_gaps(xs[is_kept], ys[is_kept], jumps[is_kept])


def _count_jumps(
    records: np.ndarray[Any, Any], before_mm: tuple[float, float] | None
) -> npt.NDArray[np.int64]:
    """Return how often the robot was moved by hand up to each record, as an array with shape (n,).

    Args:
        records: Consecutive records; each has the state of the robot at one tick.
        before_mm: The position in the record before the first of `records`. None if there is no such record: the first
            one then counts as a move.
    """
    before_x, before_y = before_mm or (np.nan, np.nan)
    way = np.hypot(
        np.diff(records["x_mm"], prepend=before_x), np.diff(records["y_mm"], prepend=before_y)
    )
    # NaN, before the first record, counts as a jump, so that the traces of two runs are not joined.
    return np.cumsum(~(way < _JUMP_MM))


def _insert_gaps(
    xs: npt.NDArray[np.float64], ys: npt.NDArray[np.float64], jumps: npt.NDArray[np.int64]
) -> Points:
    gaps = np.flatnonzero(np.diff(jumps, prepend=0))
    return np.insert(xs, gaps, np.nan).tolist(), np.insert(ys, gaps, np.nan).tolist()


def _thin_positions(start: int, end: int, max_count: int) -> list[int]:
    """Return at most `max_count` evenly spread positions from start to end, including the last one."""
    span = end - start
    if span <= max_count:
        return list(range(start, end))
    return [start + (step + 1) * span // max_count - 1 for step in range(max_count)]


PAST_ROWS = 200
"""Maximum number of output rows that are shown while a past instant is in view."""


class PanelFeed:
    """Passes the output of a run on to the output panel, its data to the chart, and its pen trace to the world.

    Args:
        panel_area: The panels.
        runs: Has the run in view, and the instant in view.
    """

    def __init__(self, panel_area: PanelArea, runs: RunController) -> None:
        self._panel_area = panel_area
        self._runs = runs
        self._feed: Feed | None = None
        self._uncharted: list[OutputRow] = []
        """Output rows that have not been passed to the chart, because the chart is not on the screen."""
        self._charted_s = 0.0
        """Time on the monotonic clock at which telemetry was last passed to the chart."""
        self._shows_past = False
        self._traced: object = None
        self._printed: object = None
        self._newest: object = None

    def run_changed(self) -> None:
        """Begin to pass on the output of the run that is now in view; pass on nothing if no run is in view."""
        recording = self._runs.timeline.recording
        self._feed = Feed(recording) if recording else None
        self._uncharted.clear()
        self._panel_area.clear_log()

    def begin_again(self) -> None:
        """Pass on the output and telemetry of the run in view again, from its start; the pen trace is not changed."""
        recording = self._runs.timeline.recording
        if recording is not None and self._feed is not None:
            self._feed.restart_chart()
            self._uncharted.clear()
            self._panel_area.clear_log()
            self.add_rows([*recording.rows.rows(0)])

    def add_rows(self, rows: list[OutputRow]) -> None:
        """Pass new output rows of the program to the output panel, and to the chart if that is on the screen."""
        if output := self._panel_area.output:
            output.add(rows)
        self._uncharted += rows
        self._send_rows()
        if self._feed is not None and self._panel_area.chart:
            self._panel_area.chart.show_lag(self._feed.describe_lag())

    def _send_rows(self) -> None:
        """Pass the waiting output rows to the chart, if that is on the screen."""
        if self._uncharted and self._panel_area.is_shown("chart"):
            self._append(sample_series(self._uncharted), logged=True)
            self._uncharted.clear()

    def _append(self, series: Series, logged: bool) -> None:
        if chart := self._panel_area.chart:
            for name, (times, values) in series.items():
                chart.append(name, times, values, logged)

    @property
    def is_behind(self) -> bool:
        """Whether the chart is on the screen and does not show the whole run yet."""
        return (
            self._feed is not None
            and self._feed.is_behind
            and self._find_mat(self._feed) is not None
        )

    def _find_mat(self, feed: Feed) -> Field | None:
        """Return the mat of the run, for the readings in the chart; None if the chart is hidden or there is no mat."""
        return (
            self._runs.find_mat(feed.recording.spec) if self._panel_area.is_shown("chart") else None
        )

    def _send_telemetry(self, feed: Feed) -> None:
        """Send new telemetry to the chart, at most as often as the chart is drawn.

        If the run does not go on, or if much telemetry waits, it is sent without a delay.
        """
        now_s = time.monotonic()
        is_soon = now_s < self._charted_s + CHART_PERIOD_S and not feed.is_far_behind
        if is_soon and self._runs.state is RunPhase.RUNNING:
            return
        if (mat := self._find_mat(feed)) is not None:
            self._charted_s = now_s
            self._append(feed.chart_series(mat), logged=False)

    def _name_output(self) -> None:
        """Give the output panel the name of the program that has printed.

        Before the first run, this is the name of the open program.
        """
        if output := self._panel_area.output:
            program = (self._runs.timeline.recording or self._runs).program
            output.set_program(program.name if program else "")

    def show(self) -> None:
        """Pass on the telemetry since the last call; show trace and output up to the instant in view."""
        self._name_output()
        self._send_rows()
        if self._feed is not None:
            if self._feed.begin_again() and self._panel_area.chart:
                self._panel_area.chart.clear()
                self._uncharted = [*self._feed.recording.rows.rows(0)]
                self._send_rows()
            if world := self._panel_area.world:
                xs, ys = self._feed.trace_points()
                if xs:
                    world.extend_trace(xs, ys, self._feed.recording.spec.robot.pen)
            self._send_telemetry(self._feed)
        recording, count = self._runs.timeline.recording, self._count_rows()
        if recording is not None:
            self._show_newest_line(recording, count)
        if count is not None or self._shows_past:
            self._shows_past = count is not None
            self._show_past_trace(recording, self._runs.timeline.at)
            self._show_past_rows(recording, count)

    def _count_rows(self) -> int | None:
        """Return the number of output rows up to the past instant in view; None at the newest instant.

        A past instant can also be in the newest tick: a line of the program before the last line that has run.
        """
        timeline = self._runs.timeline
        if (recording := timeline.recording) is None:
            return None
        pause = self._runs.shown_pause
        if pause and pause.past and pause.paused.tick == timeline.tick:
            return min(pause.inspected.rows, recording.rows.until(timeline.tick))
        return None if timeline.at is None else recording.rows.until(timeline.at)

    def _show_newest_line(self, recording: Recording, count: int | None) -> None:
        """Show the newest line of the output in the debug panel if the output panel is hidden."""
        debug = self._panel_area.debug
        if debug is None or not debug.display:
            return
        is_hidden = not self._panel_area.is_shown("output")
        rows = recording.rows
        count = len(rows) if count is None else count
        if (key := (rows, count, debug, is_hidden)) != self._newest:
            self._newest = key
            newest, _ = rows.list_texts(count, 1) if is_hidden else ([], 0)
            debug.show_printed(newest[0].format_line() if newest else "")

    def _show_past_trace(self, recording: Recording | None, tick: int | None) -> None:
        if world := self._panel_area.world:
            key = None if tick is None or recording is None else (recording, tick, world)
            if key != self._traced:
                self._traced = key
                if tick is None or recording is None:
                    world.show_past_trace(None)
                else:
                    world.show_past_trace(trace_run(recording, tick), recording.spec.robot.pen)

    def _show_past_rows(self, recording: Recording | None, count: int | None) -> None:
        output, chart = self._panel_area.output, self._panel_area.chart
        printed = None if count is None else (recording, count, output, chart)
        if printed == self._printed:
            return
        self._printed = printed
        if count is None or recording is None:
            if output:
                output.show_past(None)
            return
        rows, before = recording.rows.list_texts(count, PAST_ROWS)
        if output:
            output.show_past(rows, before)
        if chart:
            chart.show_printed(rows[-1].time_ns / 1e9 if rows else 0.0)
