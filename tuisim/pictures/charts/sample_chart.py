"""The chart of samples over simulated time."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tuisim.engine.runs.samples import Sample
from tuisim.logs.magnitude import limit_drawn
from tuisim.pictures.charts.axes import Limits, widen_times
from tuisim.pictures.charts.layout import ChartData, Line
from tuisim.pictures.charts.traces import Pyramid, clip_line, find_scale_name, reduce_points


def build_sample_chart(
    samples: Iterable[Sample], columns: int, limits: Limits | None = None
) -> ChartData:
    """Return the samples over simulated time as `tuisim log plot` draws them, one line per name.

    Args:
        columns: Width in pixels; points that it could not show apart are left out.
        limits: Range of time; None for that of the samples.
    """
    points: dict[str, list[tuple[float, float]]] = {}
    for sample in samples:
        points.setdefault(sample.name, []).append((sample.time_s, sample.value))
    series = {name: Pyramid(*np.array(rows).T) for name, rows in points.items()}
    ends = [trace.times_s[[0, -1]] for trace in series.values() if len(trace.times_s)]
    low, high = (min(end[0] for end in ends), max(end[1] for end in ends)) if ends else (0.0, 1.0)
    limits = limits or widen_times(float(low), float(high))
    lines = tuple(
        Line(
            name,
            *clip_line(
                *reduce_points(trace.times_s, limit_drawn(trace.values), limits, columns), limits
            ),
            number,
            find_scale_name(name),
        )
        for number, (name, trace) in enumerate(series.items())
    )
    return ChartData("", lines, limits, "time (s)")
