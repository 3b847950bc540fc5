"""Charts as data: samples over simulated time, one variable over time, or against another."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tuisim.engine.runs.arrays import FloatArray
from tuisim.engine.runs.samples import Sample
from tuisim.pictures.charts.axes import Limits, choose_limits, limit_drawn, widen_times
from tuisim.pictures.charts.canvas import DOTS_X, DOTS_Y, drop_hidden_points
from tuisim.pictures.charts.layout import ChartData, Line
from tuisim.pictures.charts.scales import add_unit
from tuisim.pictures.charts.traces import (
    Pyramid,
    clip_line,
    find_scale_name,
    reduce_points,
    sample_and_hold,
)


def build_sample_chart(
    samples: Iterable[Sample], columns: int, limits: Limits | None = None
) -> ChartData:
    """Return the chart of samples over simulated time that `tuisim log plot` draws, with one line for each name.

    Args:
        samples: The samples.
        columns: Width in pixels; of the points in one pixel column, only the least and the greatest value are drawn.
        limits: Range of time in s; None for the time range of the samples.
    """
    points: dict[str, list[tuple[float, float]]] = {}
    for sample in samples:
        points.setdefault(sample.name, []).append((sample.time_s, sample.value))
    series = {name: Pyramid(*np.array(rows).T) for name, rows in points.items()}
    ends = [trace.times_s[[0, -1]] for trace in series.values() if len(trace.times_s)]
    low, high = (min(end[0] for end in ends), max(end[1] for end in ends)) if ends else (0.0, 1.0)
    limits = limits or widen_times(float(low), float(high))
    lines = tuple(
        build_line(
            name,
            (trace.times_s, limit_drawn(trace.values)),
            number,
            find_scale_name(name),
            limits,
            columns,
        )
        for number, (name, trace) in enumerate(series.items())
    )
    return ChartData("", lines, limits, "time (s)")


def build_line(
    name: str,
    points: tuple[FloatArray, FloatArray],
    number: int,
    scale: str,
    limits: Limits,
    columns: int,
    *,
    hold: bool = False,
) -> Line:
    """Return the line of a variable for a chart over time.

    Args:
        name: The variable.
        points: Rising times, and values, each of shape (n,).
        number: Index that selects colour and marker.
        scale: The name of its scale.
        limits: Range of time in s.
        columns: Width in pixels; of the points in one pixel column, only the least and the greatest value are drawn.
        hold: Whether to draw a step line.
    """
    xs, ys = reduce_points(*points, limits, columns)
    xs, ys = clip_line(*(sample_and_hold(xs, ys) if hold else (xs, ys)), limits)
    return Line(name, xs, ys, number, scale)


def build_path_chart(
    title: str,
    names: tuple[str, str],
    xs: FloatArray,
    ys: FloatArray,
    size: tuple[int, int],
    *,
    marks: bool,
) -> ChartData:
    """Return the chart of one variable against another.

    Args:
        title: Its title.
        names: The variables of the x and of the y axis.
        xs, ys: Their values, finite, shape (n,), n at least 1.
        size: Width and height in pixels; of successive points at the same place, only the first is drawn.
        marks: Whether points are drawn instead of lines.
    """
    xs, ys = limit_drawn(xs), limit_drawn(ys)
    limits = [choose_limits(float(values.min()), float(values.max())) for values in (xs, ys)]
    cells = max(size[0] // DOTS_X, 1), max(size[1] // DOTS_Y, 1)
    xs, ys = drop_hidden_points(xs, ys, limits, *cells)
    line = Line(names[1], xs, ys, 0)
    return ChartData(title, (line,), limits[0], add_unit(names[0]), marks=marks, path=True)
