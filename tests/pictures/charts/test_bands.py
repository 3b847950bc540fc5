"""Bands as spans of a chart."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.logs.levels import Light
from tuisim.pictures.charts.bands import MAX_SAMPLES, SHADES, find_spans, place_names
from tuisim.pictures.charts.plot_image import PlotInks
from tuisim.pictures.charts.text_chart import ChartPainter, ChartState
from tuisim.pictures.charts.traces import Traces

LEVELS = [100.0] * 20 + [60.0] * 20 + [0.0] * 20
GROUND = (10, 20, 30)
AXIS = (200, 200, 200)
WHITE = (255, 255, 255)
SHADED = ((40, 50, 60), (30, 40, 50))


def chart(values: list[float]) -> tuple[Traces, ChartState]:
    traces = Traces()
    traces.append("Colour", (np.arange(len(values)) / 10).tolist(), values)
    return traces, ChartState(spans=find_spans(next(iter(traces)), Light()))


def test_each_band_is_named_by_its_level_and_grey() -> None:
    _, state = chart(LEVELS)

    assert [span.texts for span in state.spans] == [
        ("100 white", "100"),
        ("60", "60"),
        ("0 black", "0"),
    ]
    assert [(span.start, span.stop) for span in state.spans] == [(0.0, 1.9), (2.0, 3.9), (4.0, 5.9)]


def test_the_steps_of_a_slope_are_no_bands() -> None:
    slope = [level for level in (80.0, 65.0, 50.0, 35.0, 20.0) for _ in range(3)]
    _, state = chart([100.0] * 40 + slope + [0.0] * 3)
    assert [span.texts[1] for span in state.spans] == ["100", "0"]


def test_names_are_all_long_or_all_short_and_never_touch() -> None:
    spans = find_spans(next(iter(chart([86.2745] * 9 + [82.745] * 9 + [0.0])[0])), Light())

    wide = place_names(spans, [range(20), range(20, 40), range(40, 41)], 4, 41, lambda *_: True)
    narrow = place_names(spans, [range(3), range(3, 6), range(6, 7)], 4, 7, lambda *_: True)

    assert [text for _, _, text in wide] == ["86.27 pale grey", "82.75 light grey"]
    assert narrow == [(3, 0, "86.27"), (2, 2, "82.75")]


def test_band_names_with_room_between_them_are_in_the_lowest_row() -> None:
    spans = find_spans(next(iter(chart(LEVELS)[0])), Light())
    places = [range(20), range(20, 40), range(40, 60)]
    assert [row for row, _, _ in place_names(spans, places, 4, 60, lambda *_: True)] == [3, 3, 3]


@pytest.mark.parametrize("values", [LEVELS, LEVELS[::-1]], ids=["white first", "white last"])
def test_a_bands_name_stands_beside_a_cursor_and_within_the_chart(values: list[float]) -> None:
    spans = find_spans(next(iter(chart(values)[0])), Light())
    places = [range(5), range(5, 10), range(10, 15)]

    def put(cursors: list[int]) -> list[tuple[int, int, str]]:
        return place_names(spans, places, 4, 15, lambda *_: True, cursors)

    for cursor in range(15):
        names = put([cursor])
        assert all(not at <= cursor < at + len(text) for _, at, text in names), cursor
        assert all(0 <= at <= 15 - len(text) for _, at, text in names), cursor


@for_each(columns=range(16, 40))
def test_a_bands_name_at_the_edge_stands_within_the_chart(columns: int) -> None:
    spans = find_spans(next(iter(chart(LEVELS)[0])), Light())
    places = [range(4), range(4, columns - 4), range(columns - 4, columns)]
    names = place_names(spans, places, 4, columns, lambda *_: True)
    assert len(names) == 3
    assert all(0 <= at <= columns - len(text) for _, at, text in names)


def test_a_name_that_would_stand_beside_a_higher_part_of_the_curve_is_left_out() -> None:
    spans = find_spans(next(iter(chart(LEVELS)[0])), Light())
    places = [range(20), range(20, 40), range(40, 60)]

    def is_free(row: int, first: int, stop: int) -> bool:
        return row < 5 or stop < 40

    names = place_names(spans, places, 9, 60, is_free)
    assert [(row, text) for row, _, text in names] == [(8, "100 white"), (8, "60")]


def test_no_bands_are_drawn_in_a_chart_of_too_many_samples() -> None:
    assert not chart([1.0] * (MAX_SAMPLES + 1))[1].spans


@pytest.mark.parametrize("width, name", [(80, "100 white"), (30, "100"), (12, "")])
def test_a_band_in_cells_is_shaded_and_named_where_nothing_is_drawn(width: int, name: str) -> None:
    traces, state = chart(LEVELS)
    picture = ChartPainter().paint(traces, state, width, 12)
    rows = picture.lines[picture.top : picture.top + picture.rows]

    texts = ["".join(text for text, _ in row)[picture.left :] for row in rows]
    assert {sum(map(len, (text for text, _ in row))) for row in rows} == {width}
    assert name in texts[-1]
    # The last band is along the lowest row.
    assert "black" not in texts[-1]
    shades = {style.bgcolor for row in rows for _, style in row if style.bgcolor}
    assert shades == {shade.bgcolor for shade in SHADES}


def test_a_band_in_pixels_is_shaded_and_named_where_nothing_is_drawn() -> None:
    traces, state = chart(LEVELS)
    plot = ChartPainter().paint(traces, state, 80, 12, is_blank=True).plot
    assert plot is not None
    image = plot.draw((8, 16), PlotInks(GROUND, AXIS, WHITE, SHADED))

    first, second, third = np.array_split(image[:, 8 : 8 + plot.columns * 8], 3, axis=1)
    assert [
        bool((part == rgb).all(axis=2).any()) for part in (first, second) for rgb in SHADED
    ] == [1, 0, 0, 1]
    lowest = slice((plot.rows - 1) * 16, plot.rows * 16 - 2)
    named = [bool((part[lowest, 20:-20] == AXIS).all(axis=2).any()) for part in (first, third)]
    assert named == [True, False]
