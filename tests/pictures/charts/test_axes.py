"""Axes and reduction of points."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cases import cases, for_each
from tuisim.app.panels import time_bar
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.traces import reduce_points


@cases(
    "low, high, limits",
    {
        "percent": (0.0, 100.0, (0.0, 100.0)),
        "part of it": (50.2, 100.0, (40.0, 100.0)),
        "one value": (5.0, 5.0, (3.0, 7.0)),
        "negative": (-90.0, 3.0, (-100.0, 25.0)),
        "millimetres": (0.0, 2550.0, (0.0, 3000.0)),
    },
)
def test_limits_of_a_value_axis_are_round_numbers(
    low: float, high: float, limits: tuple[float, float]
) -> None:
    assert axes.choose_limits(low, high) == pytest.approx(limits)


def test_the_axis_of_a_constant_whole_number_has_no_decimals() -> None:
    assert axes.label_rows(axes.choose_limits(360.0, 360.0), 5) == {4: "358", 0: "362"}


@given(st.floats(-1e6, 1e6), st.floats(0, 1e6))
def test_limits_of_a_value_axis_include_the_values(low: float, span: float) -> None:
    bottom, top = axes.choose_limits(low, low + span)

    slack = 1e-6 * max(abs(low), span, 1)
    assert bottom <= low + slack
    assert top >= low + span - slack
    assert bottom < top


@pytest.mark.parametrize("value", [1e16, -1e17, 1e149, 5e-324])
def test_limits_of_a_constant_value_lie_around_it_whatever_its_size(value: float) -> None:
    bottom, top = axes.choose_limits(value, value)
    assert bottom < value < top


@pytest.mark.parametrize(
    "end_s, upper_s", [(0, 5), (5, 5), (5.1, 10), (45, 60), (61, 120), (600, 600), (700, 720)]
)
def test_limits_of_the_time_axis_grow_in_steps(end_s: float, upper_s: float) -> None:
    assert time_bar.time_limits(end_s) == (0, upper_s)


@given(st.integers(4, 300), st.floats(0.1, 5000))
def test_a_drawn_time_axis_is_as_wide_as_asked_for(columns: int, end_s: float) -> None:
    line, below = axes.draw_time_axis(time_bar.time_limits(end_s), columns)

    assert len(line) == len(below) == columns


@pytest.mark.parametrize("columns", [2, 40, 117])
def test_converting_a_column_of_the_chart_to_time_and_back_gives_the_column(columns: int) -> None:
    limits = (0.0, 30.0)

    back = [
        axes.find_column(axes.find_column_value(column, limits, columns), limits, columns)
        for column in range(columns)
    ]

    assert back == list(range(columns))


@pytest.mark.parametrize(
    "value, step, text",
    [
        (2.5, 2.5, "2.5"),
        (10.0, 5.0, "10"),
        (0.25, 0.05, "0.25"),
        (0.75, 0.25, "0.75"),
        (0.5, 0.25, "0.50"),
        (-0.0, 1.0, "0"),
        (5e8 + 0.1, (5e8 + 0.1) - 5e8, "500000000.1"),
    ],
)
def test_an_axis_label_has_as_many_digits_as_its_step_needs(
    value: float, step: float, text: str
) -> None:
    assert axes.label(value, step) == text


@cases(
    "limits, rows, labels",
    {
        "few rows": ((40.0, 100.0), 4, {0: "100", 3: "40"}),
        "one row": ((0.0, 100.0), 1, {0: "100"}),
        "many rows": ((0.0, 100.0), 12, {0: "100", 2: "80", 4: "60", 7: "40", 9: "20", 11: "0"}),
        "fractions": ((-1.0, 1.0), 4, {0: "1.0", 3: "-1.0"}),
    },
)
def test_labels_of_a_value_axis_stand_on_evenly_spaced_rows(
    limits: tuple[float, float], rows: int, labels: dict[int, str]
) -> None:
    assert axes.label_rows(limits, rows) == labels


@for_each(
    limits=[(0.0, 100.0), (0.0, 60.0), (-2.0, 1.0), (85.0, 100.0), (0.0, 0.25)], rows=range(7, 60)
)
def test_extended_axis_limits_put_ticks_in_the_middle_of_evenly_spaced_rows(
    limits: tuple[float, float], rows: int
) -> None:
    extended = axes.extend_limits(limits, rows)

    positions = axes.find_row_ticks(extended, rows)
    at = [axes.measure_row(position, extended, rows) - 0.5 for position in positions]

    assert at == pytest.approx([round(one) for one in at], abs=1e-6)
    assert len({round(one) for one in np.diff(at)}) == 1
    assert 3 <= len(positions) <= 7
    assert extended[0] <= limits[0] + 1e-9
    assert limits[1] <= extended[1] + 1e-9
    assert extended[1] - extended[0] < 1.7 * (limits[1] - limits[0])
    assert [*axes.label_rows(extended, rows)] == [round(one) for one in at]


def test_axis_limits_are_extended_as_little_as_possible() -> None:
    assert axes.extend_limits((50.0, 100.0), 15) == (50.0, 100.0)
    assert axes.extend_limits((86.0, 91.0), 7) == (86.0, 92.0)


@for_each(rows=[*range(4, 8), 9, 10, 12, 13, 14, *range(16, 40)])
def test_the_axis_of_light_from_0_to_255_is_at_most_a_fifth_empty(rows: int) -> None:
    assert axes.extend_limits((0.0, 255.0), rows)[1] <= 255 / 0.8


@for_each(rows=range(7, 40))
def test_extended_axis_limits_do_not_depend_on_the_unit(rows: int) -> None:
    for low, high in ((0.0, 60.0), (-2.0, 1.0), (85.0, 97.0)):
        extended = axes.extend_limits((low, high), rows)
        for unit in (0.001, 1000.0):
            limits = axes.extend_limits((low * unit, high * unit), rows)
            assert [end / unit for end in limits] == pytest.approx(extended)


def test_reducing_points_for_drawing_keeps_extremes_and_order() -> None:
    times = np.linspace(0, 60, 100_000)
    values = np.sin(times)
    values[54_321] = 9.0
    values[12_345] = -7.0

    when, reduced = reduce_points(times, values, (0.0, 60.0), 100)

    assert len(when) <= 202
    assert (np.diff(when) >= 0).all()
    assert (reduced.max(), reduced.min()) == (9.0, -7.0)


def test_reducing_few_points_keeps_those_in_the_window_and_their_neighbours() -> None:
    times = np.arange(10.0)

    when, _ = reduce_points(times, times, (3.5, 6.5), 50)

    assert when.tolist() == [3.0, 4.0, 5.0, 6.0, 7.0]


def test_reducing_no_points_gives_no_points() -> None:
    when, values = reduce_points(np.empty(0), np.empty(0), (0.0, 1.0), 10)

    assert len(when) == len(values) == 0


@pytest.mark.parametrize("low, high", [(0.0, 5.51), (8.3, 12.9), (99.9, 100.4), (0.0, 1e-6)])
@pytest.mark.parametrize("columns", [4, 12, 19, 40])
def test_an_axis_never_has_a_single_tick(low: float, high: float, columns: int) -> None:
    positions = axes.time_ticks((low, high), columns)
    assert len(positions) >= 2
    assert all(low - 1e-9 <= at <= high + 1e-9 for at in positions)
