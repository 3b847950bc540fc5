"""A log and the place in it that one looks at: cursor, zoom, runs laid over each other."""

from __future__ import annotations

import pyarrow as pa
import pytest

from tests.app.analyser.logs import long_log, model_of, wide_log
from tuisim.errors import LogError
from tuisim.logs.columns import Layout
from tuisim.logs.log import Log
from tuisim.logs.plateaus import Plateau


def test_the_cursor_goes_along_the_selected_variable() -> None:
    model = model_of(long_log())
    model.go_to_time(3.2)
    assert (model.row, model.time_of(model.row)) == (6, 3.0)
    model.select(1)
    model.step(1)
    assert (model.row, model.trace_of_row(model.row).name) == (7, "Left")
    model.step(1)
    assert (model.row, model.time_of(model.row)) == (9, 4.0)


def test_a_row_belongs_to_its_own_run() -> None:
    model = model_of(long_log(runs=2))
    assert (model.trace_of_row(0).name, model.run_of(0)) == ("Colour #1", 0)
    assert (model.trace_of_row(39).name, model.run_of(39), model.time_of(39)) == (
        "Left #2",
        1,
        18.0,
    )


def test_zoom_keeps_the_cursor_and_pan_stays_inside() -> None:
    model = model_of(wide_log(10_001))
    model.go_to_time(8.0)
    model.zoom(0.5)
    low, high = model.x_limits()
    assert (high - low, low <= 8.0 <= high) == (5.0, True)
    for _ in range(20):
        model.pan(0.25)
    assert model.x_limits() == (5.0, 10.0)
    model.go_to_time(1.0)
    model.follow_cursor()
    assert model.x_limits() == (0.0, 5.0)
    model.zoom(2.0)
    assert model.limits is None


@pytest.mark.parametrize(
    ("way", "place"),
    [("time", 18.0), ("distance", 900.0), ("Colour < 45", 9.0)],
    ids=["time", "distance", "event"],
)
def test_runs_are_laid_over_each_other(way: str, place: float) -> None:
    model = model_of(long_log(runs=2))
    model.go_to_row(38)
    model.align(way)
    assert model.cursor_s == pytest.approx(place)
    model.selected = "Colour #2"
    model.go_to_time(place)
    assert model.row == 38
    assert model.time_of(38) == 18.0


@pytest.mark.parametrize("way", ["speed", "Colour < -5", "Nothing > 1"])
def test_what_runs_cannot_be_aligned_by_is_said(way: str) -> None:
    with pytest.raises(LogError):
        model_of(long_log(runs=2)).align(way)


def test_a_variable_along_another() -> None:
    model = model_of(long_log())
    assert model.along("x_mm").tolist() == [100.0 * at for at in range(10)]
    assert model.along("Left").tolist() == [float(at) for at in range(10)]
    with pytest.raises(LogError, match="no variable 'z_mm'"):
        model.along("z_mm")


def test_a_log_without_numbers_is_refused() -> None:
    table = pa.table({"a": ["x", "y"]})
    with pytest.raises(LogError, match="no numeric column"):
        model_of(Log("test", table, Layout()))


# The table


# Panes


# Notes


def test_bands_are_those_of_the_variables_in_view() -> None:
    model = model_of(long_log())
    assert (model.unsearched(), list(model.bands())) == (["Colour", "Left"], [])
    model.find_bands(["Colour"], lambda _: [Plateau(0, 5, 2.0, 0.0, 0.0)])
    (report,) = model.reports()
    assert list(model.bands()) == list(report.bands) != []
    assert (model.unsearched(), len(model.bands_in_words())) == (["Left"], 1)


@pytest.mark.parametrize(
    ("time_s", "moves"), [(4.0, False), (5.0, False), (6.0, False), (1.0, True)]
)
def test_the_view_follows_the_cursor(time_s: float, moves: bool) -> None:
    model = model_of(long_log())
    model.limits = 4.0, 6.0
    model.go_to_time(time_s)
    model.follow_cursor()
    assert model.limits == ((0.0, 2.0) if moves else (4.0, 6.0))
