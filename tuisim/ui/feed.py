"""What the chart and the pen trace are fed: the part of a recording not yet shown, thinned."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec
from tuisim.core.state import FLAG_PEN_DOWN
from tuisim.datalog.records import OutputRow
from tuisim.datalog.samples import samples_of
from tuisim.ui.readings import telemetry_traces

if TYPE_CHECKING:
    from tuisim.core.marks import PenMarks
    from tuisim.datalog.views import TickRecord
    from tuisim.host import RunHandle
    from tuisim.ui.mat import Mat

Series = dict[str, tuple[list[float], list[float]]]
"""By trace name: times in s, values."""

POINTS_A_FEED = 60
"""Most telemetry moments that one call measures; each costs a reading of every sensor."""
TRACE_POINTS_A_FEED = 4000
_JUMP_MM = 25.0
"""No wheel carries the pen so far in a tick: the robot was put somewhere else."""


def sample_series(rows: Iterable[OutputRow]) -> Series:
    """Return the samples among printed lines, at the simulated time of the print or the time they carry."""
    series: Series = {}
    for sample in samples_of(rows):
        times, values = series.setdefault(sample.name, ([], []))
        times.append(sample.time_s)
        values.append(sample.value)
    return series


@dataclass(slots=True)
class Feed:
    """Reading positions in one run's telemetry."""

    run: RunHandle
    noise_at: Callable[[TickRecord], NoiseSpec]
    """The noise at the tick of a record."""
    _charted: int = field(default=0, init=False)
    _traced: int = field(default=0, init=False)
    _lifted: bool = field(default=False, init=False)
    """Whether the pen was up in the last record that was traced."""
    _last_xy_mm: tuple[float, float] | None = field(default=None, init=False)
    """Where the robot was in the last record that was traced."""
    _marks: PenMarks | None = field(default=None, init=False)

    def pose_at(self, time_s: float | None) -> Pose | None:
        """Return where the robot was at a time of the run, None if that is not recorded."""
        if time_s is None:
            return None
        tick = int(time_s * self.run.spec.profile.tick_hz + 1e-6)
        return self.run.telemetry.record(tick).pose if 0 <= tick < self.run.telemetry.count else None

    def chart_series(self, mat: Mat) -> Series:
        """Return telemetry traces of the ticks since the last call."""
        from tuisim.datalog.views import instant_of

        count = self.run.telemetry.count
        spec, hz = self.run.spec, self.run.spec.profile.tick_hz
        if spec.world.pen_marks and self._marks is None:
            from tuisim.core.marks import PenMarks

            self._marks = PenMarks(mat.field, spec)
        series: Series = {}
        for at in _thinned(self._charted, count, POINTS_A_FEED):
            record = self.run.telemetry.record(at)
            instant = instant_of(record, spec, self.noise_at(record))
            for name, value in telemetry_traces(instant, spec, self._mat_at(at, mat.field)).items():
                times, values = series.setdefault(name, ([], []))
                times.append(record.tick / hz)
                values.append(value)
        self._charted = count
        return series

    def _mat_at(self, at: int, mat: Field) -> Field:
        """The mat as it was at a record, with what the pen had drawn if the sensors see it."""
        if self._marks is None:
            return mat
        self._marks.take_in(self.run.telemetry.array()[self._marks.records : at + 1].tolist())
        return self._marks.field

    def trace_points(self) -> tuple[list[float], list[float]]:
        """Return where the pen drew since the last call: x and y in mm; NaN where it was lifted."""
        import numpy as np

        records = self.run.telemetry.array()[self._traced :]
        if not len(records):
            return [], []
        self._traced += len(records)
        before_x, before_y = self._last_xy_mm or (np.nan, np.nan)
        way = np.hypot(np.diff(records["x_mm"], prepend=before_x), np.diff(records["y_mm"], prepend=before_y))
        # NaN, before the first record, counts as a jump: the traces of two runs are not joined.
        jumps = np.cumsum(~(way < _JUMP_MM))
        self._last_xy_mm = float(records["x_mm"][-1]), float(records["y_mm"][-1])
        kept_at = _thinned(0, len(records), TRACE_POINTS_A_FEED)
        records, jumps = records[kept_at], jumps[kept_at]
        pen = self.run.spec.robot.pen
        turn = np.radians(records["heading_deg"] - 90.0)
        xs = records["x_mm"] + np.cos(turn) * pen.x_mm - np.sin(turn) * pen.y_mm
        ys = records["y_mm"] + np.sin(turn) * pen.x_mm + np.cos(turn) * pen.y_mm
        lifted = (records["flags"] & FLAG_PEN_DOWN) == 0
        xs[lifted] = ys[lifted] = np.nan
        # Of a stretch with the pen up one gap is enough.
        kept = ~(lifted & np.concatenate(([self._lifted], lifted[:-1])))
        self._lifted = bool(lifted[-1])
        xs, ys, jumps = xs[kept], ys[kept], jumps[kept]
        gaps = np.flatnonzero(np.diff(jumps, prepend=0))
        return np.insert(xs, gaps, np.nan).tolist(), np.insert(ys, gaps, np.nan).tolist()


def _thinned(start: int, end: int, most: int) -> list[int]:
    """Return at most `most` evenly spread positions from start to end, the last one among them."""
    span = end - start
    if span <= most:
        return list(range(start, end))
    return [start + (step + 1) * span // most - 1 for step in range(most)]
