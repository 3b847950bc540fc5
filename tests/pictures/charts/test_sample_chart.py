"""The chart of samples."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.engine.runs.samples import Sample
from tuisim.pictures.charts.axes import Limits
from tuisim.pictures.charts.layout import Stroke
from tuisim.pictures.charts.sample_chart import build_sample_chart


@pytest.mark.parametrize(
    "times_s, limits",
    [([], (0.0, 1.0)), ([2.0], (1.5, 2.5)), ([1.0, 4.0], (1.0, 4.0)), ([3.0, 3.0], (2.5, 3.5))],
)
def test_a_sample_chart_reaches_from_the_first_sample_to_the_last(
    times_s: list[float], limits: Limits
) -> None:
    samples = [Sample("a", 5.0, time_s, 0, 0, 1) for time_s in times_s]
    chart = build_sample_chart(samples, 100)
    assert chart.x_limits == limits
    assert [list(line.xs) for line in chart.lines] == [times_s] * bool(times_s)
    assert build_sample_chart(samples, 100, (0.0, 9.0)).x_limits == (0.0, 9.0)


@for_each(
    limits=[(2.5, 7.5), (3.2, 3.4), (-2.0, 0.5), (9.5, 12.0), (20.0, 30.0)], samples=[1, 10, 1000]
)
def test_the_line_of_a_sample_chart_stays_between_its_axes(limits: Limits, samples: int) -> None:
    times_s = np.linspace(0.0, 10.0, samples)
    chart = build_sample_chart(
        [Sample("a", 5.0 * time_s, time_s, 0, 0, 1) for time_s in times_s.tolist()], 100, limits
    )
    (line,) = chart.lines
    assert np.all((line.xs >= limits[0]) & (line.xs <= limits[1]))
    assert line.ys == pytest.approx(5.0 * line.xs)
    drawing = chart.lay_out(600, 190)
    (plot,) = drawing.plots
    for stroke in drawing.shapes:
        if isinstance(stroke, Stroke) and stroke.points[0, 1] >= plot.top:
            assert np.all(stroke.points >= np.array([plot.left, plot.top]) - 0.5)
            assert np.all(stroke.points <= np.array([plot.right, plot.bottom]) + 0.5)
