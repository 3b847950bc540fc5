"""A log and the place in it that one looks at: cursor, zoom, runs laid over each other."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from tests.app.analyser.logs import long_log, model_of, wide_log
from tuisim.analysis.chart import View, build_chart
from tuisim.base.errors import LogError
from tuisim.logs.columns import Layout
from tuisim.logs.log import Log
from tuisim.logs.stillness import FIELDS


def test_cursor_keys_step_along_samples_of_the_selected_variable() -> None:
    model = model_of(long_log())
    model.go_to_time(3.2)
    assert (model.row, model.find_time_s(model.row)) == (6, 3.0)
    model.select(1)
    model.step(1)
    assert (model.row, model.trace_of_row(model.row).name) == (7, "Left")
    model.step(1)
    assert (model.row, model.find_time_s(model.row)) == (9, 4.0)


def test_a_row_belongs_to_its_own_run() -> None:
    model = model_of(long_log(runs=2))
    assert (model.trace_of_row(0).name, model.find_run(0)) == ("Colour #1", 0)
    assert (model.trace_of_row(39).name, model.find_run(39), model.find_time_s(39)) == (
        "Left #2",
        1,
        18.0,
    )


def test_zoom_keeps_the_cursor_and_pan_stays_inside() -> None:
    model = model_of(wide_log(10_001))
    model.go_to_time(8.0)
    model.zoom(0.5)
    low, high = model.find_x_limits()
    assert (high - low, low <= 8.0 <= high) == (5.0, True)
    for _ in range(20):
        model.pan(0.25)
    assert model.find_x_limits() == (5.0, 10.0)
    model.go_to_time(1.0)
    model.follow_cursor()
    assert model.find_x_limits() == (0.0, 5.0)
    model.zoom(2.0)
    assert model.limits is None


@pytest.mark.parametrize(
    "way, place",
    [("time", 18.0), ("distance", 900.0), ("Colour < 45", 9.0)],
    ids=["time", "distance", "event"],
)
def test_aligning_two_runs_moves_the_cursor_and_keeps_the_selected_row(
    way: str, place: float
) -> None:
    model = model_of(long_log(runs=2))
    model.go_to_row(38)
    model.align(way)
    assert model.cursor_s == pytest.approx(place)
    model.selected = "Colour #2"
    model.go_to_time(place)
    assert model.row == 38
    assert model.find_time_s(38) == 18.0


@pytest.mark.parametrize("way", ["speed", "Colour < -5", "Nothing > 1"])
def test_aligning_runs_by_an_unusable_word_says_why(way: str) -> None:
    with pytest.raises(LogError):
        model_of(long_log(runs=2)).align(way)


def test_sample_variable_gives_one_value_per_sample_and_refuses_unknown_names() -> None:
    model = model_of(long_log())
    assert model.sample_variable("x_mm").tolist() == [100.0 * at for at in range(10)]
    assert model.sample_variable("Left").tolist() == [float(at) for at in range(10)]
    with pytest.raises(LogError, match="no variable 'z_mm'"):
        model.sample_variable("z_mm")


def test_a_log_without_numbers_is_refused() -> None:
    table = pa.table({"a": ["x", "y"]})
    with pytest.raises(LogError, match="no numeric column"):
        model_of(Log("test", table, Layout()))


def test_bands_are_searched_for_only_the_variables_asked_for() -> None:
    model = model_of(long_log())
    assert (model.list_unsearched(), list(model.bands())) == (["Colour", "Left"], [])
    model.find_bands(["Colour"], lambda _: np.array([(0, 5, 2.0, 0.0, 0.0, 0)], FIELDS))
    (report,) = model.list_reports()
    assert list(model.bands()) == list(report.bands) != []
    assert (model.list_unsearched(), len(model.describe_bands())) == (["Left"], 1)


@pytest.mark.parametrize("time_s, moves", [(4.0, False), (5.0, False), (6.0, False), (1.0, True)])
def test_the_view_follows_the_cursor(time_s: float, moves: bool) -> None:
    model = model_of(long_log())
    model.limits = 4.0, 6.0
    model.go_to_time(time_s)
    model.follow_cursor()
    assert model.limits == ((0.0, 2.0) if moves else (4.0, 6.0))


@pytest.mark.parametrize(
    "view, xs, ys",
    [
        (View(), [2.5, 3, 4, 5, 6, 6.5], [65, 60, 50, 40, 30, 25]),
        (
            View(hold=True),
            [2.5, 3, 3, 4, 4, 5, 5, 6, 6, 6.5],
            [70, 70, 60, 60, 50, 50, 40, 40, 30, 30],
        ),
        (View(against=("x_mm", "Colour")), [300, 400, 500, 600], [60, 50, 40, 30]),
    ],
    ids=["lines", "steps", "a path"],
)
def test_a_zoomed_chart_has_only_the_points_inside_its_limits(
    view: View, xs: list[float], ys: list[float]
) -> None:
    model = model_of(long_log())
    model.limits = 2.5, 6.5
    chart = build_chart(model, view, 400, 100)
    assert (chart.lines[0].xs.tolist(), chart.lines[0].ys.tolist()) == (xs, ys)
    assert chart.path == bool(view.against) != chart.zoomed
    model.limits = 0.2, 0.4
    if view.against:
        with pytest.raises(LogError, match="no sample has both x_mm and Colour"):
            build_chart(model, view, 400, 100)


def test_a_reopened_log_keeps_derived_variables_cursor_mark_zoom_and_sorting() -> None:
    model = model_of(long_log())
    other = model_of(long_log())
    model.derive("Twice = Colour * 2")
    assert (model.selected, [trace.name for trace in model.traces]) == (
        "Twice",
        ["Colour", "Left", "Twice"],
    )
    assert (model.rows.columns[-1], all(trace.on for trace in model.traces)) == ("Twice", True)
    model.row = 19
    model.mark_s = 2.0
    model.limits = (1.0, 7.0)
    model.traces.find_trace("Left").on = False
    model.rows.view = model.rows.build_sorted_view("Twice", True)
    other.restore(model)
    assert (other.row, other.mark_s, other.limits) == (19, 2.0, (1.0, 7.0))
    assert (other.definitions, other.selected) == (model.definitions, "Twice")
    assert [trace.on for trace in other.traces] == [True, False, True]
    assert other.rows.view.sorted_by == "Twice"
    other.derive("Twice =")
    assert (other.definitions, other.selected, other.rows.view.sorted_by) == ({}, "Colour", "")
    assert "Twice" not in other.rows.columns
    with pytest.raises(LogError, match="no derived variable 'Twice'"):
        other.derive("Twice =")


def test_statistics_are_computed_from_samples_between_the_cursors() -> None:
    model = model_of(long_log())
    assert model.list_unsummed() == ["Colour", "Left"]
    assert (model.build_summary("Colour").mean, model.list_unsummed()) == (45.0, ["Left"])
    model.mark_s = 5.0
    model.go_to_time(2.0)
    assert (model.find_measured_span(), model.list_unsummed()) == ((2.0, 5.0), [])
    figures = model.build_summary("Colour")
    assert (figures.count, figures.min, figures.mean, figures.max) == (4, 40.0, 55.0, 70.0)
    model.go_to_moment(7.4)
    assert (model.row, model.sample, model.find_printed_line()) == (14, 7, 0)
