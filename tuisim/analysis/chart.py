"""The chart of an analysis as data: which points of which variables, and how they are to be drawn."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tuisim.analysis.traces import DISTANCE
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, printable
from tuisim.pictures.charts.layout import ChartData, Span
from tuisim.pictures.charts.sample_chart import build_line, build_path_chart

if TYPE_CHECKING:
    from tuisim.analysis.model import AnalysisModel
    from tuisim.logs.bands import Band


@dataclass(frozen=True, slots=True)
class View:
    """The user's settings of a chart, besides its variables and its time range."""

    facets: bool = False
    """Whether each ticked variable has a chart of its own, above each other; else one chart shows all."""
    marks: bool = False
    """Whether the samples are drawn as points instead of lines."""
    hold: bool = False
    """Whether each line keeps the value of a sample until the next sample (steps), instead of going straight there."""
    against: tuple[str, str] | None = None
    """Names of the variables on the x and y axis of a path; None for a chart of all ticked variables over time."""


def build_chart(model: AnalysisModel, view: View, columns: int, rows: int) -> ChartData:
    """Return the chart of a model's visible variables in its visible time range.

    Of points that are drawn at the same place, only those are kept that can be seen.

    Args:
        model: The model.
        view: The user's settings of the chart.
        columns, rows: The size of the picture, in pixels or in the parts of characters that are drawn as pixels.

    Raises:
        LogError: the user wants to see a variable against another one, and one of these does not exist.
    """
    x_limits = model.find_x_limits()
    if view.against:
        return _build_path_chart(model, view.against, view.marks, columns, rows)
    lines = []
    for number, trace in enumerate(model.traces.list_ticked()):
        trace.prepare(x_limits, columns, False)
        lines.append(
            build_line(
                trace.name,
                (trace.times_s, trace.values),
                number,
                trace.scale,
                x_limits,
                columns,
                hold=view.hold,
            )
        )
    x_label = "time (s)" if model.log.layout.time else "row"
    if model.alignment == DISTANCE:
        x_label = "distance driven (mm)"
    return ChartData(
        printable(model.log.title),
        tuple(lines),
        x_limits,
        x_label,
        view.facets and len(lines) > 1,
        view.marks,
        zoomed=model.limits is not None,
    )


def _build_path_chart(
    model: AnalysisModel, names: tuple[str, str], marks: bool, columns: int, rows: int
) -> ChartData:
    xs, ys = (model.sample_variable(name) for name in names)
    places = model.trace.places
    good = np.isfinite(xs) & np.isfinite(ys)
    if model.limits:
        good &= (places >= model.limits[0]) & (places <= model.limits[1])
    if not good.any():
        raise LogError(f"no sample has both {names[0]} and {names[1]}", file=model.log.title)
    return build_path_chart(
        printable(model.log.title), names, xs[good], ys[good], (columns, rows), marks=marks
    )


def build_spans(bands: Iterable[Band]) -> tuple[Span, ...]:
    """Return bands as shaded ranges of a chart over time."""
    return tuple(
        Span.of_band(band.variable, band.start_s, band.stop_s, band.level, band.grey)
        for band in bands
    )
