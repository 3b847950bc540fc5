"""What the chart and the pen trace are fed: the part of a recording not yet shown, thinned."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tuisim.core.geometry import Pose
from tuisim.core.state import FLAG_PEN_DOWN
from tuisim.datalog.records import OutputRow
from tuisim.datalog.samples import samples_of
from tuisim.ui.readings import telemetry_traces

if TYPE_CHECKING:
    from tuisim.host import RunHandle
    from tuisim.ui.mat import Mat

Series = dict[str, tuple[list[float], list[float]]]
"""By trace name: times in s, values."""

POINTS_A_FEED = 60
"""Most telemetry moments that one call measures; each costs a reading of every sensor."""
TRACE_POINTS_A_FEED = 4000


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
    _charted: int = field(default=0, init=False)
    _traced: int = field(default=0, init=False)
    _lifted: bool = field(default=False, init=False)
    """Whether the pen was up in the last record that was traced."""

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
        series: Series = {}
        for at in _thinned(self._charted, count, POINTS_A_FEED):
            record = self.run.telemetry.record(at)
            instant = instant_of(record, spec, spec.world.noise)
            for name, value in telemetry_traces(instant, spec, mat.field).items():
                times, values = series.setdefault(name, ([], []))
                times.append(record.tick / hz)
                values.append(value)
        self._charted = count
        return series

    def trace_points(self) -> tuple[list[float], list[float]]:
        """Return where the pen drew since the last call: x and y in mm; NaN where it was lifted."""
        import numpy as np

        records = self.run.telemetry.array()[self._traced :]
        if not len(records):
            return [], []
        self._traced += len(records)
        records = records[_thinned(0, len(records), TRACE_POINTS_A_FEED)]
        pen = self.run.spec.robot.pen
        turn = np.radians(records["heading_deg"] - 90.0)
        xs = records["x_mm"] + np.cos(turn) * pen.x_mm - np.sin(turn) * pen.y_mm
        ys = records["y_mm"] + np.sin(turn) * pen.x_mm + np.cos(turn) * pen.y_mm
        lifted = (records["flags"] & FLAG_PEN_DOWN) == 0
        xs[lifted] = ys[lifted] = np.nan
        # Of a stretch with the pen up one gap is enough.
        kept = ~(lifted & np.concatenate(([self._lifted], lifted[:-1])))
        self._lifted = bool(lifted[-1])
        return xs[kept].tolist(), ys[kept].tolist()


def _thinned(start: int, end: int, most: int) -> list[int]:
    """Return at most `most` evenly spread positions from start to end, the last one among them."""
    span = end - start
    if span <= most:
        return list(range(start, end))
    return [start + (step + 1) * span // most - 1 for step in range(most)]
