"""What the chart and the pen trace are fed: the part of a recording not yet shown, thinned."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tuisim.core.geometry import world_point
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
TRACE_POINTS_A_FEED = 400


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
        count = self.run.telemetry.count
        pen = self.run.spec.robot.pen
        xs: list[float] = []
        ys: list[float] = []
        for at in _thinned(self._traced, count, TRACE_POINTS_A_FEED):
            record = self.run.telemetry.record(at)
            if record.flags & FLAG_PEN_DOWN:
                x_mm, y_mm = world_point(record.pose, pen.x_mm, pen.y_mm)
                xs.append(x_mm)
                ys.append(y_mm)
            elif xs and xs[-1] == xs[-1]:
                xs.append(float("nan"))
                ys.append(float("nan"))
        self._traced = count
        return xs, ys


def _thinned(start: int, end: int, most: int) -> list[int]:
    """Return at most `most` evenly spread positions from start to end, the last one among them."""
    span = end - start
    if span <= most:
        return list(range(start, end))
    return [start + (step + 1) * span // most - 1 for step in range(most)]
