from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest

from tuisim.logs.signals import compute_summary
from tuisim.pictures.charts.canvas import draw_xy_chart, drop_hidden_points
from tuisim.pictures.charts.traces import MAX_POINTS, TRACE_COLORS, Pyramid, Trace, Traces

TIMES = np.arange(200_000) / 1000.0


@pytest.mark.parametrize(
    "limits", [(0.0, 200.0), (50.0, 150.0), (10.0, 10.05), (-5.0, 500.0)], ids=str
)
def test_points_thinned_for_drawing_keep_the_extremes(limits: tuple[float, float]) -> None:
    values = np.sin(TIMES)
    values[123_456] = 9.0
    times_s, drawn = Pyramid(TIMES, values).select_points(limits, 100)
    inside = (limits[0] <= TIMES) & (limits[1] >= TIMES)
    assert len(times_s) <= 2 * 16 * 4 * 100 + 4
    assert drawn.max() >= values[inside].max()
    assert drawn.min() <= values[inside].min()
    assert (np.diff(times_s) >= 0).all()


@pytest.mark.parametrize("sign", [1, -1])
def test_thinned_points_of_a_ramp_keep_rising_or_falling(sign: int) -> None:
    _, drawn = Pyramid(TIMES, sign * TIMES).select_points((0.0, 200.0), 100)
    assert (sign * np.diff(drawn) >= 0).all()


def test_a_pyramid_of_samples_drops_missing_values_and_sorts_by_time() -> None:
    pyramid = Pyramid(np.array([3.0, 1.0, 2.0, 5.0]), np.array([30.0, 10.0, np.nan, 50.0]))
    assert pyramid.times_s.tolist() == [1.0, 3.0, 5.0]
    assert [pyramid.find_nearest(time_s) for time_s in (-9.0, 1.9, 2.1, 4.1, 99.0)] == [
        1,
        1,
        0,
        3,
        3,
    ]
    assert pyramid.select_range(1.0, 3.0)[1].tolist() == [10.0, 30.0]


@pytest.mark.parametrize(
    "span", [(0.0, 200.0), (3.0011, 171.9), (5.008, 5.02), (90.0, 80.0)], ids=str
)
def test_statistics_of_a_span_of_a_trace_equal_those_of_its_points(
    span: tuple[float, float],
) -> None:
    values = 1e6 + np.sin(TIMES) * np.random.default_rng(1).random(len(TIMES))
    inside = values[(span[0] <= TIMES) & (span[1] >= TIMES)]
    found = Pyramid(TIMES, values).compute_summary(*span)
    expected = compute_summary(inside, quantiles=())
    assert astuple(found)[:6] == pytest.approx(astuple(expected)[:6], rel=1e-9, nan_ok=True)


def test_the_spread_of_equal_values_in_a_trace_is_zero() -> None:
    found = Pyramid(TIMES, np.full(len(TIMES), 0.1)).compute_summary(0.0, 150.0)
    assert (found.mean, found.std) == (0.1, 0.0)


def test_the_end_of_several_traces_is_that_of_the_longest() -> None:
    traces = Traces()
    assert traces.end_s() == 0
    traces.append("a", [0.0, 1.0, 2.0], [5.0, 5.0, 5.0])
    traces.append("b", [0.0, 7.0, 9.0, 12.0], [1.0, 2.0, 3.0, 4.0])
    assert traces.end_s() == 12


def test_a_pyramid_without_valid_points_selects_none() -> None:
    assert not len(Pyramid(np.array([np.nan]), np.array([1.0])).select_points((0.0, 1.0), 10)[0])


def test_an_xy_chart_marks_the_point_at_the_cursor() -> None:
    xs = np.array([0.0, 5.0, 10.0])
    ys = np.array([0.0, 5.0, 10.0])
    lines = draw_xy_chart(xs, ys, 2, ("x", "y"), (255, 0, 0), "braille", 40, 12)
    text = ["".join(part for part, _ in line) for line in lines]
    assert len(text) == 12
    assert "●" in text[1]
    assert text[0].endswith("x 10  y 10")


def test_a_trace_without_end_keeps_its_extremes_in_bounded_memory() -> None:
    trace = Trace("Colour", 0)
    values = np.sin(TIMES)
    values[[1_234, 150_001]] = 9.0, -9.0
    for at in range(0, len(TIMES), 100):
        trace.add(TIMES[at : at + 100].tolist(), values[at : at + 100].tolist())
    assert len(trace.times_s) == len(trace.values) <= MAX_POINTS < len(TIMES)
    assert (trace.find_value(TIMES[1_234]), trace.find_value(TIMES[150_001])) == (9.0, -9.0)
    assert (trace.times_s[0], trace.times_s[-1]) == (TIMES[0], TIMES[-1])
    assert (np.diff(trace.times_s) >= 0).all()
    # What came last is there as it came.
    assert trace.values[-1000:].tolist() == values[-1000:].tolist()


@pytest.mark.parametrize(
    "name, scale",
    [
        ("front_mm", "mm"),
        ("turn_deg #2", "°"),
        ("speed_mm_s", "mm/s"),
        ("eye_red_pc", ""),
        ("Gyro", "gyro"),
        ("Left", ""),
    ],
)
def test_traces_with_one_unit_share_a_scale(name: str, scale: str) -> None:
    assert Trace(name, 0).scale == scale


def test_each_trace_keeps_its_colour() -> None:
    traces = Traces()
    for name, is_logged in (("a", True), ("x_mm", False), ("b", True), ("y_mm", False)):
        traces.append(name, [0.0], [1.0], is_logged)
    colors = {trace.name: trace.rgb for trace in traces}
    first, second, *_, last = TRACE_COLORS
    assert colors == {"a": first, "b": second, "x_mm": last, "y_mm": TRACE_COLORS[-2]}
    traces.append("x_mm", [1.0], [5.0], True)
    traces.append("x_mm", [2.0], [6.0], False)
    assert [(trace.name, len(trace.times_s)) for trace in traces][-1] == ("y_mm", 1)
    traces.clear()
    assert len(traces) == 0
    for name, is_logged in (("c", True), ("b", True), ("z", False)):
        traces.append(name, [0.0], [1.0], is_logged)
    colors = {trace.name: trace.rgb for trace in traces}
    assert colors == {"b": second, "c": TRACE_COLORS[3], "z": TRACE_COLORS[-2]}


def test_points_of_a_path_at_its_limits_are_kept() -> None:
    xs = np.array([10.0, 10.1, 12.0, 14.0])
    ys = np.array([100.0, 100.1, 108.0, 100.0])
    seen = drop_hidden_points(xs, ys, [(10.0, 14.0), (100.0, 108.0)], 2, 2)
    assert np.array(seen).tolist() == [[10.0, 12.0, 14.0], [100.0, 108.0, 100.0]]
