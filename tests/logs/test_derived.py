"""Variables that are reckoned from others: in the chart, the statistics and the table like any other."""

from __future__ import annotations

import math

import numpy as np
import pyarrow as pa
import pytest
from numpy.testing import assert_allclose

from tests.app.analyser.logs import long_log, model_of, wide_log
from tests.cases import for_rows
from tests.logs.test_signals import column
from tuisim.app.analyser.panes import PANES
from tuisim.base.errors import LogError
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.runs.frames import compute_dead_reckoning
from tuisim.logs.columns import choose_columns
from tuisim.logs.derived import (
    NEEDED,
    build_reckoned_series,
    parse_definition,
)
from tuisim.logs.log import Log

FALLING = 90.0 - 10.0 * np.arange(10)
DEFINED = {
    "slope": ("v = slope(Colour)", np.full(10, -10.0)),
    "integral": ("v = integral(Left)", np.arange(10) ** 2 / 2),
    "average": ("v = average(Colour, 3)", np.array([85.0, *FALLING[1:-1], 5.0])),
    "columns": ("v = Colour + x_mm", FALLING + 100.0 * np.arange(10)),
    "two variables": ("v = Colour - 2 * Left", FALLING - 2 * np.arange(10)),
    "nested": ("v = abs(slope(Colour)) > 5", np.ones(10)),
    "time": ("v = Colour * 0 + time", np.arange(10.0)),
    "resample": ("v = resample(Colour, 2)", FALLING[::2]),
    "no variable": ("v = 5", np.full(10, 5.0)),
}


@for_rows("text, values", DEFINED)
def test_a_derived_variable_has_the_values_of_its_expression(text: str, values: np.ndarray) -> None:
    model = model_of(long_log())
    model.derive(text)
    assert model.log.series("v").values.tolist() == pytest.approx(values.tolist())
    assert model.selected == "v" and model.trace.on


REFUSED = {
    "nothing": ("", "nothing to compute"),
    "an unknown name": ("v = Colur", "no variable 'Colur'"),
    "an unknown function": ("v = open(Colour)", "no function 'open'"),
    "a name that is taken": ("x_mm = Colour", "a column 'x_mm' already"),
    "resample within": ("v = 2 * resample(Colour, 1)", "the outermost function"),
    "no period": ("v = resample(Colour, 0)", "period must be above 0"),
    "a period below nothing": ("v = resample(Colour, -1)", "period must be above 0"),
    "half a sample": ("v = average(Colour, 2.5)", "whole number"),
    "an even number of samples": ("v = average(Colour, 4)", "odd number"),
    "what was never derived": ("w =", "no derived variable 'w'"),
    "no wheels": ("reckoning", "no column 'left_position_deg'"),
}


def test_dead_reckoning_from_text_columns_is_refused() -> None:
    table = pa.table(
        {"time": [0.0, 1.0], "value": [1.0, 2.0], **{name: ["a", "b"] for name in NEEDED}}
    )
    with pytest.raises(LogError, match="no column 'left_position_deg' with numbers"):
        build_reckoned_series(Log("test", table, choose_columns(table)))


@for_rows("text, said", REFUSED)
def test_a_faulty_derived_variable_is_refused_and_leaves_the_log_unchanged(
    text: str, said: str
) -> None:
    model = model_of(long_log())
    before = model.log
    with pytest.raises(LogError, match=said):
        model.derive(text)
    assert model.log is before


def test_a_derived_variable_is_computed_for_each_run_by_itself() -> None:
    log = long_log(runs=2)
    first, second = parse_definition("slope(Colour)").compute(log, "Left #1")
    assert (first.name, second.name) == ("slope(Colour) #1", "slope(Colour) #2")
    assert (first.values[0], second.values[0]) == (-10.0, -5.0)
    (apart,) = parse_definition("`Colour #1` - `Colour #2`").compute(log, "Left #1")
    assert apart.values.tolist() == [
        0.0,
        -10.0,
        -10.0,
        -20.0,
        -20.0,
        -30.0,
        -30.0,
        -40.0,
        -40.0,
        -50.0,
    ]


def test_a_derived_variable_is_in_every_pane() -> None:
    model = model_of(long_log())
    model.derive("v = slope(Colour)")
    assert [row[0] for row in PANES["statistics"].rows(model)] == ["Colour", "Left", "v"]
    assert model.rows.columns[-1] == "v"
    assert model.rows.text(0, "v") == "-10" and model.rows.text(1, "v") == ""
    assert model.rows.shown().column_names[-1] == "v"
    model.find_bands(["v"])
    assert [band.level for band in model.bands()] == [-10.0]


def test_a_derived_variable_is_replaced_removed_and_kept_when_the_log_grows() -> None:
    model = model_of(wide_log(100))
    model.derive("v = wave + 1")
    model.derive("v = wave + 2")
    assert model.trace.find_value(0.0) == pytest.approx(3.0)
    grown = model_of(wide_log(200))
    grown.restore(model)
    assert len(grown.log.series("v").values) == 200
    other = model_of(long_log())
    other.restore(model)
    assert [trace.name for trace in other.traces] == ["Colour", "Left"]
    model.rows.view = model.rows.build_sorted_view("v", True)
    model.derive("v =")
    assert [trace.name for trace in model.traces] == ["wave"] and model.rows.columns == [
        "time",
        "wave",
    ]
    assert model.selected == "wave" and len(model.rows) == 100


class TestReckoning:
    def test_dead_reckoning_drives_straight_and_turns(self) -> None:
        robot = RobotSpec()
        per_degree = math.pi * robot.wheel_diameter_mm / 360
        quarter = math.pi / 2 * robot.wheel_spacing_mm / 2 / per_degree
        left = column(0, 100 / per_degree, 100 / per_degree - quarter)
        right = column(0, 100 / per_degree, 100 / per_degree + quarter)
        got = compute_dead_reckoning(left, right, Pose(10, 20, 0), robot)
        assert_allclose(got.x_mm, [10, 110, 110], atol=1e-9)
        assert_allclose(got.y_mm, [20, 20, 20], atol=1e-9)
        assert_allclose(got.heading_deg, [0, 0, 90])

    def test_dead_reckoning_uses_gear_and_direction_of_the_motors(self) -> None:
        usual = RobotSpec()
        geared = RobotSpec(left_reversed=True, gear_ratio=0.5)
        left, right = column(0, 100, 130), column(0, 120, 160)
        expected = compute_dead_reckoning(left, right, Pose(0, 0, 0), usual)
        got = compute_dead_reckoning(left * -0.5, right * 0.5, Pose(0, 0, 0), geared)
        assert_allclose(
            [got.x_mm, got.y_mm, got.heading_deg],
            [expected.x_mm, expected.y_mm, expected.heading_deg],
        )

    def test_dead_reckoning_of_an_arc_ends_where_a_circle_would(self) -> None:
        robot = RobotSpec()
        per_degree = math.pi * robot.wheel_diameter_mm / 360
        radius = 200.0
        inner = math.pi / 2 * (radius - robot.wheel_spacing_mm / 2) / per_degree
        outer = math.pi / 2 * (radius + robot.wheel_spacing_mm / 2) / per_degree
        got = compute_dead_reckoning(column(0, inner), column(0, outer), Pose(0, 0, 0), robot)
        assert_allclose([got.x_mm[1], got.y_mm[1], got.heading_deg[1]], [radius, radius, 90])

    def test_dead_reckoning_has_an_error(self) -> None:
        got = compute_dead_reckoning(column(0, 0), column(0, 0), Pose(0, 0, 0), RobotSpec())
        assert_allclose(got.compute_error_mm(column(0, 3), column(0, 4)), [0, 5])
