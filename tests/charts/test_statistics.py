"""Histograms, results against a parameter, and heat maps: their figures, and what is drawn of them."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.charts.files import image_of, svg_of
from tuisim.charts.layout import Drawing, Fill, Words
from tuisim.charts.statistics import (
    Against,
    HeatMap,
    Histogram,
    drawing_of_against,
    drawing_of_heat_map,
    drawing_of_histogram,
    text_of_against,
    text_of_heat_map,
    text_of_histogram,
)

NAN = float("nan")
NOISE = [0, 20, 50] * 4
RESULTS = np.array([1.0, 2, 3, 1, 4, 9, 1, 6, 15, 1, 8, 21])
AGAINST = Against("y against x", "y", "x", tuple(NOISE), RESULTS)
MATS = Against("y against mat", "y", "background", ("Loop", "Lollipop") * 6, RESULTS)
MAP = HeatMap.of("y", "y", ("noise", NOISE), ("mat", ["Loop"] * 6 + ["Square"] * 6), RESULTS)
DRAWINGS = {
    "histogram": drawing_of_histogram(Histogram.of("title", "error_mm", RESULTS), 960, 600),
    "against": drawing_of_against(AGAINST, 960, 600),
    "against words": drawing_of_against(MATS, 960, 600),
    "heat map": drawing_of_heat_map(MAP, 960, 600),
    "no values": drawing_of_histogram(Histogram.of("title", "error_mm", np.array([NAN])), 960, 600),
    "tiny": drawing_of_heat_map(MAP, 60, 40),
}


@pytest.mark.parametrize(
    "values, edges, counts",
    [
        pytest.param([0.0, 1, 2, 3, 4, 5, 6, 7, 8, 10], [0, 2, 4, 6, 8, 10], (2, 2, 2, 2, 2), id="even"),
        pytest.param([1.0, NAN, 1.0], [0.995, 1.005], (2,), id="equal values"),
        pytest.param([NAN], [0, 1], (0,), id="no values"),
    ],
)
def test_a_histogram_counts_every_value_once(values: list[float], edges: list[float], counts: tuple[int, ...]) -> None:
    found = Histogram.of("", "x", np.array(values))
    assert (found.edges.tolist(), found.counts) == (pytest.approx(edges), counts)


def test_the_greatest_value_is_in_the_last_interval() -> None:
    values = np.random.default_rng(1).normal(size=500)
    found = Histogram.of("", "x", values)
    assert sum(found.counts) == 500
    assert found.edges[0] <= values.min() <= values.max() <= found.edges[-1]


def test_means_are_taken_at_each_value_of_the_parameter() -> None:
    xs, ys = AGAINST.means()
    assert (xs.tolist(), ys.tolist()) == ([0, 20, 50], [1, 5, 12])


def test_words_are_placed_in_order_of_appearance() -> None:
    at, names = MATS.positions()
    assert (at.tolist()[:3], names) == ([0, 1, 0], ("Loop", "Lollipop"))


def test_a_heat_map_holds_the_mean_of_each_pair() -> None:
    means = HeatMap.of("", "y", ("a", [1, 1, 2]), ("b", ["x", "x", "y"]), np.array([1.0, 3.0, 5.0])).means
    assert np.array_equal(means, [[2, NAN], [NAN, 5]], equal_nan=True)


@pytest.mark.parametrize("drawing", DRAWINGS.values(), ids=DRAWINGS)
def test_a_drawing_is_written_as_svg_and_png(drawing: Drawing) -> None:
    assert svg_of(drawing).endswith("</svg>\n")
    assert image_of(drawing).size == (drawing.width, drawing.height)


@pytest.mark.parametrize("name", ["histogram", "against", "against words", "heat map"])
def test_everything_is_drawn_inside_the_picture(name: str) -> None:
    drawing = DRAWINGS[name]
    for shape in drawing.shapes:
        if isinstance(shape, Fill):
            assert 0 <= shape.x <= shape.x + shape.width <= drawing.width
            assert 0 <= shape.y <= shape.y + shape.height <= drawing.height
        elif isinstance(shape, Words):
            room = {
                "start": drawing.width - shape.x,
                "end": shape.x,
                "middle": 2 * min(shape.x, drawing.width - shape.x),
            }
            assert len(shape.text) * 6.5 <= room[shape.anchor], shape.text


@pytest.mark.parametrize(
    "text, expected",
    [
        pytest.param(
            text_of_histogram(Histogram.of("title", "error_mm", RESULTS), 40, 12),
            ["title", "error_mm (mm)", " 0 … 5 │█", " 5 … 10 │", "10 … 15"],
            id="histogram",
        ),
        pytest.param(text_of_against(MATS, 60, 16, colors=False), ["y against background", "0: Loop", "1: Lollipop"],
                     id="against words"),
        pytest.param(text_of_heat_map(MAP, 60, 12, colors=False), ["Square│ 1   7   18", "  Loop│ 1   3   6"],
                     id="heat map"),
    ],
)  # fmt: skip
def test_text_shows_the_figures(text: object, expected: list[str]) -> None:
    assert [part for part in expected if part not in str(text)] == []


@pytest.mark.parametrize("width", [40, 80, 120])
def test_text_fits_the_terminal(width: int) -> None:
    texts = (
        text_of_histogram(Histogram.of("title", "error_mm", RESULTS), width, 20),
        text_of_against(AGAINST, width, 20, colors=True),
        text_of_heat_map(MAP, width, 20, colors=True),
    )
    for text in texts:
        lines = text.plain.split("\n")
        assert max(map(len, lines)) <= width
        assert len(lines) <= 20


def test_a_heat_map_says_what_does_not_fit() -> None:
    wide = HeatMap.of("", "y", ("a", list(range(50))), ("b", [1] * 50), np.arange(50.0))
    assert "50 × 1 cells do not fit" in text_of_heat_map(wide, 60, 12, colors=False).plain
