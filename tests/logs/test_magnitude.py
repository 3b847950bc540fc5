"""Every number that there is, through charts, summaries and bands: nothing overflows, and nothing ends."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.samples import Sample
from tuisim.logs.export import EXPORTERS, export_frame
from tuisim.logs.frames import read_log
from tuisim.logs.levels import Light, measure_levels
from tuisim.logs.magnitude import find_scale
from tuisim.logs.signals import compute_summary
from tuisim.pictures.charts.axes import MAX_DRAWN, limit_drawn
from tuisim.pictures.charts.canvas import draw_xy_chart
from tuisim.pictures.charts.files import CHART_FORMATS
from tuisim.pictures.charts.sample_chart import build_sample_chart
from tuisim.pictures.charts.text_chart import ChartPainter, ChartState
from tuisim.pictures.charts.traces import Pyramid, Traces
from tuisim.tasks.execute import compute_statistics

HUGE = sys.float_info.max
EVERY = st.lists(
    st.floats() | st.sampled_from([0.0, 5e-324, -5e-324, 1e155, 1e308, -1e308, HUGE, -HUGE]),
    min_size=1,
    max_size=40,
)
ODD = ([1e155, 0.0], [1e308, -1e308], [HUGE, -HUGE], [5e-324, 0.0], [HUGE] * 20 + [0.0] * 20)


def _printed(values: Sequence[float]) -> list[OutputRow]:
    return [OutputRow(f"A: {value!r}", 0, 0, 0, Stream.STDOUT) for value in values]


def _are_equal(found: float, expected: float) -> bool:
    return found == pytest.approx(expected, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("low, high", ODD[:4], ids=str)
def test_mean_and_spread_of_two_extreme_numbers_are_exact(low: float, high: float) -> None:
    mean = low / 2 + high / 2
    half = abs(high / 2 - low / 2)
    printed = compute_statistics(_printed([low, high]))["A"]
    for statistics in (compute_summary(np.array([low, high])), printed):
        assert _are_equal(statistics.mean, mean)
        # Of the sample: it may be more than the largest number.
        assert statistics.std == pytest.approx(half * math.sqrt(2), rel=1e-9, abs=5e-324)


@pytest.mark.parametrize("values", ODD, ids=lambda values: f"{values[0]:g} {values[-1]:g}")
def test_levels_of_huge_numbers_are_found(values: Sequence[float]) -> None:
    found = measure_levels("Light", np.tile(values, 10 if len(values) == 2 else 1), Light())
    assert all(value in found.level for value in values) or len(values) == 2
    assert np.isfinite(found.level).all() and np.isfinite(found.spread).all()


def test_numbers_of_usual_size_are_not_scaled() -> None:
    assert find_scale(-1e100, 1e100) == find_scale(0.0, 0.0) == find_scale(1e-100, 1e-90) == 1.0
    drawn = limit_drawn(np.array([-HUGE, math.nan, -math.inf, 1.0]))
    assert np.array_equal(drawn, [-MAX_DRAWN, math.nan, -math.inf, 1.0], equal_nan=True)


@pytest.mark.filterwarnings("error")
@settings(max_examples=40, deadline=None)
@given(values=EVERY, times_s=st.lists(st.floats(0.0), min_size=40, max_size=40))
@example(values=[1e308, -1e308], times_s=[float(at) for at in range(40)])
@example(values=[HUGE, -HUGE, 1.0], times_s=[float(at) for at in range(40)])
@example(values=[5e-324, 0.0, math.nan], times_s=[5e-324 * at for at in range(40)])
def test_charts_can_draw_every_finite_or_infinite_number(
    values: Sequence[float], times_s: Sequence[float]
) -> None:
    times_s = times_s[: len(values)]
    traces = Traces()
    traces.append("A", times_s, values)
    for state in (ChartState("A"), ChartState("A", cursor_s=1.0)):
        rows = ChartPainter().paint(traces, state, 60, 12).lines
        assert all(sum(len(text) for text, _ in row) <= 60 for row in rows)
    points = np.array(times_s), np.array(values)
    assert draw_xy_chart(
        limit_drawn(points[0]),
        limit_drawn(points[1]),
        None,
        ("t", "A"),
        (0, 0, 0),
        "braille",
        60,
        12,
    )
    chart = build_sample_chart(
        [Sample("A", *pair[::-1], 0, 0, 0) for pair in zip(*points, strict=True)], 80
    )
    for suffix, size in ((".svg", (200, 150)), (".txt", (40, 8))):
        assert CHART_FORMATS[suffix].write(chart, size)


@pytest.mark.parametrize("suffix", EXPORTERS)
def test_every_number_is_exported_and_read_back_equal(tmp_path: Path, suffix: str) -> None:
    of = compute_statistics(_printed([HUGE, -HUGE, 5e-324, 1e155]))["A"]
    columns = {"values": [math.nan, math.inf, -math.inf, HUGE, -HUGE, 5e-324, of.mean, of.std]}
    path = tmp_path / f"every{suffix}"
    export_frame(pd.DataFrame(columns), path, {})
    found = pd.read_csv(path) if suffix == ".csv" else read_log(path)
    assert np.array_equal(found["values"], columns["values"], equal_nan=True)


@pytest.mark.filterwarnings("error")
@given(values=EVERY)
@example(values=[HUGE, -HUGE])
@example(values=[4.90790065654301e16] * 3)
@example(values=[4.907900656543009e16, 4.90790065654301e16, 4.90790065654301e16])
def test_statistics_of_any_numbers_are_finite_and_ordered(values: Sequence[float]) -> None:
    samples = np.array(values, np.float64)
    for found in (
        compute_summary(samples),
        Pyramid(np.arange(len(values), dtype=np.float64), samples).compute_summary(0, 99),
    ):
        if found.count:
            assert found.min <= found.mean <= found.max and found.std >= 0.0
            assert list(found.quantiles) == sorted(found.quantiles)
    levels = measure_levels("Light", samples, Light())
    assert np.isfinite(levels.level).all()
    for of in compute_statistics(_printed(values)).values():
        assert of.min <= of.mean <= of.max and of.std >= 0.0
