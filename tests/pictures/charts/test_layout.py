"""Charts of awkward logs: whatever the values and names, every format is whole and nothing stands outside of it."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pyarrow as pa
import pytest
from rich.cells import cell_len

from tests.app.analyser.logs import long_log, model_of
from tests.cases import cases, for_each
from tuisim.analysis.chart import View, build_chart
from tuisim.analysis.model import AnalysisModel
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.files import draw_image, draw_svg
from tuisim.pictures.charts.layout import (
    COLORS,
    LETTER_PX,
    LINE_PX,
    ChartData,
    Drawing,
    Line,
    Rule,
    Shade,
    Span,
    Stroke,
    Words,
    cut_drawing,
    move_shapes,
)
from tuisim.pictures.charts.scales import Scales
from tuisim.pictures.charts.text_chart import ChartPainter, ChartState, draw_text

RAMP = np.arange(50.0)
COLUMNS: dict[str, dict[str, object]] = {
    "one sample": {"time": [1.0], "a": [5.0]},
    "one of many digits": {"time": [1.0], "a": [1e149]},
    "beyond measure": {"time": RAMP, "a": RAMP * 1e300, "b": RAMP * 1e-300},
    "no number": {"time": RAMP, "a": RAMP, "b": RAMP * np.nan},
    "at one time": {"time": RAMP * 0, "a": RAMP},
    "backwards": {"time": RAMP[::-1], "a": RAMP},
    "infinite now and then": {"time": RAMP, "a": np.where(RAMP % 7, RAMP, np.inf)},
    "hostile names": {
        "time": RAMP,
        "new\nline": RAMP,
        "\x1b[31mred": RAMP,
        "<b>&\u202e": RAMP,
        "日本語" * 30: RAMP,
    },
    "two scales": {"time": RAMP, "red": RAMP, "way_mm": RAMP * 1e6, "turn_deg": -RAMP},
}
VIEWS = {
    "one chart": View(),
    "facets": View(facets=True, hold=True),
    "points": View(marks=True),
    "a path": View(against=("time", "time")),
}


def log_of(columns: dict[str, object]) -> AnalysisModel:
    table = pa.table(columns)
    return model_of(Log("title\x1b]0;\n<title>", table, choose_columns(table)))


@pytest.mark.quick_cases("two scales-*", "no number-*")
@cases("view", VIEWS)
@cases("columns", COLUMNS)
def test_a_chart_in_svg_png_and_text_stays_within_its_size(
    columns: dict[str, object], view: View
) -> None:
    model = log_of(columns)
    for width, height in ((200, 150), (960, 420)):
        drawing = build_chart(model, view, width, height).lay_out(width, height)
        text = draw_svg(drawing)
        assert ElementTree.fromstring(text).attrib["width"] == str(width)
        assert not re.search(r'="[^"]*(nan|inf)', text)
        # One pixel for rounding.
        strokes = [shape.points for shape in drawing.shapes if isinstance(shape, Stroke)]
        assert all(
            (-1 <= points).all() and (points <= (width + 1, height + 1)).all() for points in strokes
        )
    assert draw_image(drawing).size == (960, 420)
    for width, height in ((20, 8), (80, 24)):
        lines = draw_text(
            build_chart(model, view, 2 * width, 4 * height), width, height
        ).plain.split("\n")
        assert max(map(cell_len, lines)) <= width
        assert not re.search(r"[\x00-\x1f\x7f]", "".join(lines))


@cases("columns", COLUMNS)
def test_a_chart_has_the_same_scales_on_screen_and_in_a_file(columns: dict[str, object]) -> None:
    model = log_of(columns)
    drawing = build_chart(model, View(), 960, 420).lay_out(960, 420)
    for trace in model.traces.list_ticked():
        trace.prepare(model.find_x_limits(), 960, False)

    picture = ChartPainter().paint(
        model.traces, ChartState(x_limits=model.find_x_limits()), 400, 24
    )

    if picture.plot is None:
        assert not model.traces.list_drawn()
        return
    (frame,) = drawing.plots
    drawn_traces = model.traces.list_drawn()
    scales = Scales.group(
        [(trace.name, trace.values, trace.scale) for trace in drawn_traces], False
    )
    assert (picture.plot.x_limits, picture.plot.y_limits) == (
        frame.x,
        axes.extend_limits(scales.left.ends, picture.rows),
    )
    drawn = sum(
        isinstance(shape, Stroke) and len(shape.points) and shape.points[0, 1] >= frame.top - 1
        for shape in drawing.shapes
    )
    assert drawn == len(picture.plot.curves)


def test_a_chart_is_cut_off_at_its_limits() -> None:
    model = log_of({"time": [0.0, 10.0], "a": [0.0, 100.0]})
    model.limits = 2.0, 4.0
    (line,) = build_chart(model, View(), 800, 400).lines
    assert (line.xs.tolist(), line.ys.tolist()) == ([2.0, 4.0], [20.0, 40.0])


def test_lines_of_held_values_are_drawn_as_steps() -> None:
    (line,) = build_chart(
        log_of({"time": [0.0, 1.0], "a": [3.0, 5.0]}), View(hold=True), 800, 400
    ).lines
    assert (line.xs.tolist(), line.ys.tolist()) == ([0.0, 1.0, 1.0], [3.0, 3.0, 5.0])


@pytest.mark.parametrize("rows", [10, 1_000_000])
def test_points_too_close_to_be_seen_are_left_out_of_a_chart_file(rows: int) -> None:
    time_s = np.arange(rows) / 1000.0
    model = log_of({"time": time_s, "a": np.sin(time_s) + 9.0 * (np.arange(rows) == rows // 3)})
    (line,) = build_chart(model, View(), 800, 400).lines
    assert len(line.xs) == min(rows, len(line.xs)) <= 1602
    assert line.ys.max() > 8.0


def test_the_axis_of_aligned_runs_names_what_they_are_aligned_by() -> None:
    model = model_of(long_log(runs=2))
    assert build_chart(model, View(), 800, 400).x_label == "time (s)"
    model.align("distance")
    chart = build_chart(model, View(), 800, 400)
    assert chart.x_label == "distance driven (mm)"
    assert [line.name for line in chart.lines] == ["Colour #1", "Left #1", "Colour #2", "Left #2"]


def test_charts_drawn_as_facets_stand_below_each_other() -> None:
    drawing = build_chart(model_of(long_log()), View(facets=True), 800, 400).lay_out(800, 400)
    first, second = (shape.points[:, 1] for shape in drawing.shapes if isinstance(shape, Stroke))
    assert first.max() < second.min()
    assert any(isinstance(shape, Rule) and shape.faint for shape in drawing.shapes)
    names = [shape for shape in drawing.shapes if isinstance(shape, Words) and shape.strong]
    above = (-math.inf, drawing.plots[0].bottom)
    for name, upper, plot in zip(names[-2:], above, drawing.plots, strict=True):
        assert upper <= name.y - LINE_PX / 2 and name.y + LINE_PX / 2 <= plot.top


@pytest.mark.parametrize(
    "view", [View(), View(facets=True), View(against=("x_mm", "Colour"))], ids=str
)
def test_a_printed_chart_colours_only_its_data(view: View) -> None:
    text = draw_text(build_chart(model_of(long_log()), view, 160, 96), 80, 24, colors=True)
    styles = {str(span.style) for span in text.spans}
    assert {f"#{bytes(rgb).hex()}" for rgb in COLORS[: 1 if view.against else 2]} <= styles
    assert styles <= {"none", "bold", *(f"#{bytes(rgb).hex()}" for rgb in COLORS)}


def test_a_chart_of_a_path_on_the_field_has_equal_scales() -> None:
    path = Line("y_mm", np.array([200.0, 1200.0]), np.array([100.0, 400.0]), 0)
    chart = ChartData("", (path,), (200.0, 1200.0), "x_mm (mm)", path=True)
    for width, height in ((960, 420), (400, 900), (2000, 300)):
        (frame,) = chart.lay_out(width, height).plots
        mm_per_px = (frame.x[1] - frame.x[0]) / (frame.right - frame.left)
        assert mm_per_px == pytest.approx((frame.y[1] - frame.y[0]) / (frame.bottom - frame.top))
        assert [sum(frame.x), sum(frame.y)] == pytest.approx([1400, 500])
        assert frame.x == pytest.approx((200, 1200)) or frame.y == pytest.approx((100, 400), abs=20)


@pytest.mark.parametrize(
    "greatest, is_flat", [(0.0, False), (12.4, True), (12.5, False), (800.0, False), (801.0, True)]
)
def test_a_variable_that_would_look_flat_gets_a_scale_of_its_own(
    greatest: float, is_flat: bool
) -> None:
    variables = [
        (name, np.array([-0.3 * most, most]), "") for name, most in (("a", 100.0), ("b", greatest))
    ]
    scales = Scales.group(variables, zoomed=False)
    assert [scale.names for scale in scales.right] == ([("b",)] if is_flat else [])
    for scale in (scales.left, *scales.right):
        ends = scales.on_left(np.array(scale.limits), scale)
        assert ends.tolist() == pytest.approx(scales.left.limits)


@for_each(width=range(250, 700, 15))
def test_names_of_lines_stand_within_the_chart(width: int) -> None:
    names = ["short", "a name that is longer", *("x" * size for size in range(20, 40, 3))]
    lines = tuple(Line(name, RAMP, RAMP, at) for at, name in enumerate(names))
    drawing = ChartData("", lines, (0.0, 49.0), "time (s)").lay_out(width, 400)
    words = [
        one
        for one in drawing.shapes
        if isinstance(one, Words) and one.text.startswith(("s", "a", "x"))
    ]
    assert len(words) == len(names)
    assert all(one.x + LETTER_PX * len(one.text) <= width for one in words)


def test_facets_without_room_are_not_upside_down() -> None:
    lines = tuple(Line(name, RAMP, RAMP, at) for at, name in enumerate("abcdef"))
    chart = ChartData("", lines, (0.0, 49.0), "time (s)", facets=True)
    for height in (40, 100, 200):
        assert all(plot.top < plot.bottom for plot in chart.lay_out(60, height).plots)


def test_a_chart_without_samples_says_so_in_its_middle() -> None:
    line = Line("a", RAMP[:0], RAMP[:0], 0)
    drawing = ChartData("", (line,), (0.0, 49.0), "time (s)").lay_out(400, 300)
    (frame,), (words,) = (
        drawing.plots,
        [one for one in drawing.shapes if isinstance(one, Words) and one.text == "no samples here"],
    )
    assert (words.x - frame.left, words.y - frame.top) == pytest.approx(
        (frame.right - words.x, frame.bottom - words.y)
    )


def two_facets() -> Drawing:
    lines = tuple(Line(name, RAMP, RAMP * 2, at) for at, name in enumerate("ab"))
    return ChartData("", lines, (0.0, 49.0), "time (s)", facets=True).lay_out(400, 300)


def test_a_chart_cut_at_an_instant_ends_there_with_a_rule() -> None:
    whole = two_facets()
    for time_s, count in ((20.0, 21), (0.0, 1), (49.0, 50)):
        part = cut_drawing(whole, time_s)
        strokes = [shape for shape in part.shapes if isinstance(shape, Stroke)]
        assert [(len(stroke.points), stroke.dots) for stroke in strokes] == [
            (count, count == 1)
        ] * 2
        rules = [shape for shape in part.shapes[-2:] if isinstance(shape, Rule)]
        assert [(rule.x1, rule.y1, rule.x2, rule.y2) for rule in rules] == [
            (x := float(plot.find_xs(time_s)), plot.top, x, plot.bottom) for plot in whole.plots
        ]


def test_moving_a_drawing_moves_all_its_shapes() -> None:
    whole = two_facets()
    for before, after in zip(whole.shapes, move_shapes(whole, 10.0, -5.0), strict=True):
        match before, after:
            case Stroke(), Stroke():
                assert np.allclose(after.points - before.points, (10.0, -5.0))
            case Rule(), Rule():
                assert (after.x1 - before.x1, after.y1 - before.y1) == pytest.approx((10.0, -5.0))
                assert (after.x2 - before.x2, after.y2 - before.y2) == pytest.approx((10.0, -5.0))
            case Words(), Words():
                assert (after.x - before.x, after.y - before.y) == pytest.approx((10.0, -5.0))


def test_a_span_is_shaded_in_proportion_to_its_length() -> None:
    chart = build_chart(log_of({"time": [0.0, 10.0], "a": [1.0, 2.0]}), View(), 800, 400)
    whole = Span(0.0, 10.0, ("all",), "a")
    part = Span(2.0, 4.0, ("part",), "a")
    drawing = replace(chart, spans=(whole, part)).lay_out(800, 400)
    wide, narrow = (shape.width for shape in drawing.shapes if isinstance(shape, Shade))
    assert narrow == pytest.approx(wide / 5, rel=0.05)


@cases(
    "columns, title",
    {
        "one": ({"time": RAMP, "a_mm": RAMP}, "a_mm (mm)"),
        "several": ({"time": RAMP, "a_mm": RAMP, "b_mm": RAMP + 1}, "mm"),
        "no unit": ({"time": RAMP, "a": RAMP, "b": RAMP + 1}, "value"),
    },
)
def test_the_vertical_axis_of_a_file_has_a_title(columns: dict[str, object], title: str) -> None:
    drawing = build_chart(log_of(columns), View(), 960, 420).lay_out(960, 420)

    (frame,) = drawing.plots
    titles = [
        shape.text
        for shape in drawing.shapes
        if isinstance(shape, Words) and frame.top - 2 * LINE_PX < shape.y < frame.top - 8
    ]
    assert titles[-1] == title
