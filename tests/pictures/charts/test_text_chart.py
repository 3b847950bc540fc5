"""The chart as text."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

from tests.cases import cases, for_each, for_rows
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.canvas import TextRun, build_style, draw_canvas
from tuisim.pictures.charts.layout import Span
from tuisim.pictures.charts.text_chart import ChartPainter, ChartPicture, ChartState, format_values
from tuisim.pictures.charts.traces import Traces

TELEMETRY = ("left_red_pc", "gyro_deg")


def traces(*names: str) -> Traces:
    made = Traces()
    for at, name in enumerate(names):
        made.append(
            name,
            [0.0, 1.0, 2.0, 3.0],
            [at + 0.0, at + 100.0, at + 50.0, at + 50.0],
            name not in TELEMETRY,
        )
    return made


def text(picture: ChartPicture) -> list[str]:
    return ["".join(part for part, _ in line) for line in picture.lines]


SIZES = [(20, 6), (38, 8), (72, 16), (160, 20)]


@pytest.mark.parametrize("width, height", SIZES, ids=str)
@pytest.mark.parametrize("cursor_s", [None, 1.5], ids=["no cursor", "cursor"])
@pytest.mark.parametrize("grey", [False, True], ids=["colours", "grey"])
def test_a_chart_fits_its_width_and_height(
    width: int, height: int, cursor_s: float | None, grey: bool
) -> None:
    made = traces(
        "Colour",
        "Light_left",
        "Ultrasonic",
        "left_red_pc",
        "gyro_deg",
        "a_very_long_name_of_a_trace",
    )

    picture = ChartPainter().paint(made, ChartState("Colour", cursor_s, grey=grey), width, height)

    rows = text(picture)
    assert len(rows) <= height
    assert max(map(len, rows)) <= width
    assert any("0" in row for row in rows)
    for box in picture.boxes:
        assert rows[box.row][box.first] == "["


@pytest.mark.parametrize("width, height", SIZES, ids=str)
def test_an_empty_chart_says_how_to_log(width: int, height: int) -> None:
    rows = text(ChartPainter().paint(traces(), ChartState(), width, height))

    assert max(map(len, rows)) <= width
    assert len(rows) <= height
    assert "print('Colour: '" in "\n".join(rows)


def test_a_chart_without_a_ticked_trace_says_so() -> None:
    logged = traces("Colour")
    measured = traces("gyro_deg")
    for made in (logged, measured):
        for trace in made:
            trace.on = False
    said = [
        "\n".join(text(ChartPainter().paint(made, ChartState(), 80, 16)))
        for made in (logged, measured)
    ]
    assert ["No trace is ticked" in words for words in said] == [True, False]
    assert not any("space" in words for words in said)
    focused = ChartPainter().paint(logged, ChartState("Colour"), 80, 16)
    assert "v and space show a trace" in "\n".join(text(focused))
    assert ["Nothing logged yet" in words for words in said] == [False, True]


@for_rows(
    "name, values, state, lowest",
    [
        ("Colour", [60.0, 98.8], ChartState(), "0"),
        ("Light_left", [180.0, 255.0], ChartState(), "0"),
        ("left_red_pc", [60.0, 98.8], ChartState(), "0"),
        ("right_green #2", [180.0, 200.0], ChartState(), "0"),
        ("Colour", [60.0, 98.8], ChartState(zoomed=True), "60"),
        ("Light", [600.0, 980.0], ChartState(), "600"),
        ("Distance", [60.0, 98.8], ChartState(), "60"),
        ("Light_slope", [-20.0, 40.0], ChartState(), "-20"),
    ],
)
def test_the_axis_of_readings_with_a_known_range_begins_at_zero(
    name: str, values: list[float], state: ChartState, lowest: str
) -> None:
    made = Traces()
    made.append(name, [0.0, 1.0], values)
    next(iter(made)).on = True
    rows = text(ChartPainter().paint(made, state, 60, 8))
    assert [row.split("┤")[0].strip() for row in rows if "┤" in row][-1] == lowest


@for_each(end_s=[0.7, 5.41, 61.3, 723.0], grows=[False, True])
def test_the_horizontal_axis_ends_at_the_data(end_s: float, grows: bool) -> None:
    made = Traces()
    made.append("Colour", [0.0, end_s], [1.0, 2.0])
    limits = ChartPainter().paint(made, ChartState(grows=grows), 60, 12).x_limits
    # While more is to come, there is a little room for it.
    assert limits[0] == 0
    assert limits[1] == end_s if not grows else end_s <= limits[1] <= max(1.3 * end_s, 1)


@cases(
    "names, is_ascii, signs",
    {
        "one trace": (["Colour"], False, "braille"),
        "two traces": (["Colour", "Gyro"], False, "marks"),
        "one trace in ASCII": (["Colour"], True, "marks"),
    },
)
def test_without_colours_marks_are_drawn_only_where_they_are_needed(
    names: list[str], is_ascii: bool, signs: str
) -> None:
    picture = ChartPainter().paint(traces(*names), ChartState(grey=True, is_ascii=is_ascii), 40, 12)
    shown = "\n".join(text(picture))

    assert ("braille" if re.search("[\u2801-\u28ff]", shown) else "marks") == signs
    assert ("[x] Colour" in shown) is (signs == "braille")


@pytest.mark.parametrize(
    "width, row",
    [
        (68, "[x] a_long_name_0  [x] a_long_name_1  [x] a_long_name_2  [x] Light"),
        (65, "[x] a_long_name_0  [x] a_long_name_1  [x] a_long_name_2        +1"),
        (40, "[x] a_long_name_0  [x] a_long_name_1  +2"),
        (19, "[x] a_long_name… +3"),
        (12, "[x] a_lo… +3"),
    ],
)
def test_tick_boxes_are_one_row_that_counts_what_does_not_fit(width: int, row: str) -> None:
    made = traces(*(f"a_long_name_{at}" for at in range(3)), "Light")
    picture = ChartPainter().paint(made, ChartState(), width, 24)
    assert picture.top == 1
    assert text(picture)[0].rstrip() == row


def test_a_name_that_does_not_fit_ends_in_an_ellipsis() -> None:
    rows = text(ChartPainter().paint(traces("a_name_that_is_much_too_long"), ChartState(), 20, 8))
    assert rows[0].rstrip() == "[x] a_name_that_is_…"


def test_a_printed_variable_named_like_a_telemetry_column_shows_the_printed_values() -> None:
    made = Traces()
    for logged, value in ((False, 1.0), (True, 2.0), (False, 3.0)):
        made.append("gyro_deg", [value], [value], logged)
    (trace,) = made
    assert (trace.logged, trace.values.tolist()) == (True, [2.0])


def test_traces_of_telemetry_are_not_ticked_at_first() -> None:
    rows = text(ChartPainter().paint(traces("gyro_deg", "Colour"), ChartState(), 80, 16))

    assert rows[0].startswith("[x] Colour  [ ] gyro_deg")


def test_the_selected_tick_box_is_in_sight() -> None:
    names = [f"Trace_number_{number}" for number in range(9)]

    picture = ChartPainter().paint(traces(*names), ChartState("Trace_number_8"), 40, 8)

    assert "Trace_number_8" in [box.name for box in picture.boxes]


@pytest.mark.parametrize("ticked", [("a_long_name_0", "a_long_name_3"), ("a_long_name_3",)])
def test_the_chart_names_each_drawn_trace(ticked: tuple[str, ...]) -> None:
    made = traces(*(f"a_long_name_{number}" for number in range(9)))
    for trace in made:
        trace.on = trace.name in ticked

    rows = text(ChartPainter().paint(made, ChartState("a_long_name_0"), 60, 10))

    assert all(f"[x] {name}" in "\n".join(rows) for name in ticked)
    assert len(rows) == 10


@pytest.mark.parametrize("other", ["way_mm", ""])
def test_names_of_bands_have_the_colour_of_their_curve_beside_others(other: str) -> None:
    made = traces(*filter(None, ("Colour", other)))
    spans = (Span.of_band("Colour", 1.5, 3.0, 50.0, ""),)
    lines = ChartPainter().paint(made, ChartState(spans=spans), 80, 16).lines
    (color,) = {
        style.color for line in lines for part, style in line if part == "50" and style.bgcolor
    }
    assert (color == build_style(next(iter(made)).rgb).color) is bool(other)


def test_format_values_names_the_value_of_each_trace_at_the_cursor() -> None:
    assert (
        format_values(list(traces("Colour", "way_mm")), 1.25, "s", 80)
        == "1.25 s  Colour 100  way_mm 101mm"
    )


def test_values_at_the_cursor_that_do_not_fit_are_counted() -> None:
    drawn = list(traces("Colour", "Light_left", "Light_right"))

    assert format_values(drawn, 1.0, "s", 24) == "1.00 s  Colour 100 +2"


def test_a_text_chart_of_12_rows_uses_10_for_its_lines() -> None:
    assert (
        ChartPainter().paint(traces("Colour"), ChartState(cursor_s=1.0, grid=True), 78, 12).rows
        == 10
    )


def test_moving_the_charts_cursor_does_not_draw_the_lines_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls: list[object] = []

    def counted(*words: Any) -> list[list[TextRun]]:
        calls.append(words)
        return draw_canvas(*words)

    monkeypatch.setattr("tuisim.pictures.charts.text_chart.draw_canvas", counted)
    painter = ChartPainter()
    made = traces("Colour")
    state = ChartState(cursor_s=1.0)

    painter.paint(made, state, 80, 16)
    painter.paint(made, replace(state, cursor_s=2.0), 80, 16)
    made.append("Colour", [4.0], [7.0])
    painter.paint(made, state, 80, 16)

    assert len(calls) == 2


def test_limits_of_a_frozen_chart_stay_as_they_are() -> None:
    made = traces("Colour")
    made.append("Colour", [100.0], [1.0])

    assert ChartPainter().paint(made, ChartState(x_limits=(0.0, 5.0)), 80, 16).x_limits == (
        0.0,
        5.0,
    )
    assert ChartPainter().paint(made, ChartState(), 80, 16).x_limits == (0.0, 100.0)


def test_a_trace_sorts_its_points_and_drops_values_that_are_not_finite() -> None:
    made = Traces()
    made.append("t", [3.0, 1.0, float("nan")], [30.0, 10.0, 5.0])
    made.append("t", [2.0], [float("inf")])
    made.append("t", [2.0], [20.0])
    (trace,) = made

    assert trace.times_s.tolist() == [1.0, 2.0, 3.0]
    assert [trace.find_value(time_s) for time_s in (0.5, 1.0, 2.9)] == [None, 10.0, 20.0]


def test_the_charts_faint_grid_lies_at_labels_below_curves_and_cursors() -> None:
    traces = Traces()
    traces.append("Colour", [0.0, 10.0], [0.0, 100.0])
    state = ChartState(grid=True, cursor_s=2.5)
    picture = ChartPainter().paint(traces, state, 60, 16)
    rows = [
        "".join(text for text, _ in line)
        for line in picture.lines[picture.top : picture.top + picture.rows]
    ]
    for row in rows:
        assert ("┈" in row) is ("┤" in row)
    assert all(
        row[picture.left + axes.find_column(2.5, picture.x_limits, picture.columns)] != "┈"
        for row in rows
    )
