"""The scales of a chart in cells, and the last values beside it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from tests.cases import cases
from tuisim.pictures.charts.canvas import AXIS, build_style
from tuisim.pictures.charts.cell_scales import CellScales
from tuisim.pictures.charts.text_chart import ChartPainter, ChartPicture, ChartState
from tuisim.pictures.charts.traces import Traces


def traces(values: dict[str, list[float]]) -> Traces:
    made = Traces()
    for name, of_name in values.items():
        made.append(name, [0.0, 1.0, 2.0, 3.0][: len(of_name)], of_name)
    return made


def text(picture: ChartPicture) -> list[str]:
    return ["".join(part for part, _ in line) for line in picture.lines]


def test_a_charts_second_scale_stands_at_the_right() -> None:
    made = traces({"Colour": [0.0, 100.0], "Ultrasonic": [2000.0, 0.0]})

    rows = text(ChartPainter().paint(made, ChartState(), 80, 16))

    assert any(row.startswith("100┤") and row.rstrip().endswith("├2000") for row in rows)


@pytest.mark.parametrize("width, has_ends", [(34, False), (44, True), (60, True)])
def test_a_narrow_chart_has_both_scales_before_the_last_values(width: int, has_ends: bool) -> None:
    made = traces({"Colour": [0.0, 100.0], "front_mm": [2000.0, 886.0]})
    rows = text(ChartPainter().paint(made, ChartState(), width, 16))
    assert any(row.startswith("100┤") for row in rows) and any(
        row.rstrip().endswith("├2000mm") for row in rows
    )
    assert any("886mm" in row for row in rows) is has_ends


def test_a_chart_has_one_scale_for_percent_millimetres_and_degrees_each() -> None:
    made = traces(
        {
            "Colour": [0.0, 100.0],
            "front_mm": [2000.0, 100.0],
            "turn_deg": [0.0, 35.0],
            "error": [0.0, 0.5],
        }
    )

    picture = ChartPainter().paint(made, ChartState(), 80, 16)
    rows = text(picture)

    top = next(row for row in rows if row.startswith("100┤"))
    assert re.search("├2000mm *├40° *├0.50$", top.rstrip())
    assert picture.plot is not None
    # Each line reaches from one edge of its scale to the other.
    assert [np.ptp(curve.values).round(1) for curve in picture.plot.curves] == [
        100.0,
        95.0,
        87.5,
        100.0,
    ]


@pytest.mark.parametrize(
    "names, own", [("Left", ""), ("Left Right", ""), ("Left way_mm", "Left way_mm")]
)
def test_a_scale_of_a_single_variable_has_that_variables_colour(names: str, own: str) -> None:
    made = traces({name: [0.0, 100.0] for name in names.split()})
    styles = CellScales.build([*made], 80, 12, (0.0, 1.0), zoomed=False).styles
    colors = {trace.name: build_style(trace.rgb) for trace in made}
    assert styles == (tuple(colors[name] for name in own.split()) or (AXIS,))


@cases(
    "values, last",
    {
        "rounded": ({"Colour": [0.0, 86.27]}, ["86.27"]),
        "with its unit": ({"front_mm": [0.0, 1250.0]}, ["1250mm"]),
        "at one place": ({"Left": [0.0, 100.0], "Right": [0.0, 100.0]}, ["100"]),
        "at the lower edge": ({"Left": [9.0, 0.0], "Right": [9.0, 0.0]}, ["0"]),
        "beside each other": ({"Left": [9.0, 1.0], "Right": [9.0, 1.1]}, ["1", "1.1"]),
    },
)
def test_each_lines_last_value_stands_at_its_end(
    values: dict[str, list[float]], last: list[str]
) -> None:
    made = traces(values)

    picture = ChartPainter().paint(made, ChartState(), 80, 14)
    ends = [
        row[-1]
        for row in picture.lines[picture.top : picture.top + picture.rows]
        if row[-1][0].strip()
    ]

    assert [end.strip() for end, _ in ends] == last
    own = [trace.rgb for trace in made]
    # A value of several traces has the colour of none.
    assert len(ends) < len(own) or [style.color and style.color.triplet for _, style in ends] == own


@pytest.mark.parametrize("value", [99.5, 100.0])
def test_the_chart_keeps_its_columns_when_labels_get_longer(value: float) -> None:
    made = traces({"Colour": [0.0, 100.0, value]})
    assert ChartPainter().paint(made, ChartState(), 80, 14).columns == 69


def test_a_blank_keeps_the_last_value_apart_from_the_end_of_its_line() -> None:
    rows = text(ChartPainter().paint(traces({"darkest": [0.0]}), ChartState(), 80, 14))

    assert any(row.rstrip().endswith(" 0") for row in rows)
