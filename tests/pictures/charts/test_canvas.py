"""Curves as rows of characters, and one variable against another."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.pictures.charts.canvas import Curve, draw_canvas, draw_xy_chart, drop_hidden_points

RED = (255, 0, 0)
BLUE = (0, 0, 255)


def curve(values: list[float], rgb: tuple[int, int, int] = RED, marker: str = "o") -> Curve:
    return Curve(np.arange(len(values), dtype=float), np.array(values), rgb, marker)


def text(rows: list[list[tuple[str, tuple[int, int, int] | None]]]) -> list[str]:
    return ["".join(part for part, _ in row) for row in rows]


def test_a_drawn_curve_has_its_points_at_their_times_and_heights() -> None:
    rows = text(draw_canvas([curve([0.0, 5.0, 10.0])], 9, 3, (0.0, 2.0), (0.0, 10.0)))
    assert rows == ["        o", "    o    ", "o        "]


def test_the_last_curve_is_drawn_on_top() -> None:
    level = [5.0] * 4
    (row,) = draw_canvas([curve(level), curve(level, BLUE)], 4, 1, (0.0, 3.0), (0.0, 10.0))
    assert {rgb for part, rgb in row if part.strip()} == {BLUE}


def test_a_chart_canvas_without_points_is_empty() -> None:
    assert text(draw_canvas([curve([])], 5, 2, (0.0, 1.0), (0.0, 1.0))) == [" " * 5] * 2


def test_a_braille_curve_is_drawn_without_gaps_between_its_points() -> None:
    rows = text(draw_canvas([curve([0.0, 10.0], marker="braille")], 10, 4, (0.0, 1.0), (0.0, 10.0)))
    assert all(any(char not in " ⠀" for char in row) for row in rows)


def test_of_points_at_the_same_dot_only_the_first_is_drawn() -> None:
    xs = np.array([0.0, 0.001, 10.0, 10.0])
    ys = np.array([0.0, 0.001, 10.0, 10.0])
    found = drop_hidden_points(xs, ys, ((0.0, 10.0), (0.0, 10.0)), 10, 5)
    assert [one.tolist() for one in found] == [[0.0, 10.0], [0.0, 10.0]]


def test_points_are_dropped_as_hidden_only_within_a_quarter_of_a_row() -> None:
    ys = np.linspace(0.0, 10.0, 1001)
    _, found = drop_hidden_points(np.zeros(1001), ys, ((0.0, 10.0), (0.0, 10.0)), 10, 5)
    assert len(found) == 20


def test_which_points_are_dropped_as_hidden_does_not_depend_on_unit_or_origin() -> None:
    turns = np.linspace(0.0, 9.0, 2000)
    x, y = np.sin(turns), np.cos(3 * turns)
    first, _ = drop_hidden_points(x, y, ((-1.0, 1.0), (-1.0, 1.0)), 20, 10)
    for scale, off in ((64.0, 0.0), (1.0, 512.3), (0.5, -4.0)):
        limits = (off - scale, off + scale)
        found, _ = drop_hidden_points(off + scale * x, off + scale * y, (limits, limits), 20, 10)
        assert found == pytest.approx(off + scale * first)


def test_a_path_that_goes_back_and_forth_keeps_each_visible_point_once() -> None:
    xs = np.tile([0.0, 10.0], 50)
    found, _ = drop_hidden_points(xs, np.zeros(100), ((0.0, 10.0), (-1.0, 1.0)), 4, 4)
    assert sorted(found.tolist()) == [0.0, 10.0]


def test_one_variable_against_another_has_a_title_and_marks_the_point() -> None:
    values = np.array([0.0, 1.0, 2.0, np.nan])
    lines = draw_xy_chart(values, values, 1, ("x", "y"), RED, "o", 20, 10)
    assert lines[0][0][0] == "y against x"
    here = [
        part for line in lines for part, style in line if style.bgcolor is not None and style.bold
    ]
    assert len(here) == 1
    assert not any(
        style.bgcolor
        for line in draw_xy_chart(values, values, None, ("x", "y"), RED, "o", 20, 10)
        for _, style in line
    )


@pytest.mark.parametrize(
    "ys", [np.full(3, np.nan), np.array([np.nan, 1.0, np.nan])], ids=["none", "not together"]
)
def test_an_xy_chart_without_common_samples_says_so(ys: np.ndarray) -> None:
    lines = draw_xy_chart(np.array([1.0, np.nan, 2.0]), ys, None, ("x", "y"), RED, "o", 20, 10)
    assert lines[1][0][0] == "no sample has both"


@pytest.mark.parametrize("value", [0.0, 1.0, 10.0, 50.0, 50.3, 99.0, 100.0])
def test_a_braille_line_over_time_is_two_dots_thick(value: float) -> None:
    curve = Curve(np.array([0.0, 10.0]), np.full(2, value), (255, 255, 0))
    rows = draw_canvas([curve], 20, 10, (0.0, 10.0), (0.0, 100.0))
    middle = ["".join(text for text, _ in row)[8] for row in rows]
    assert sum((ord(sign) - 0x2800).bit_count() for sign in middle if sign != " ") == 4


def test_a_braille_line_is_centred_on_its_value() -> None:
    def dots(value: float) -> list[int]:
        rows = draw_canvas(
            [curve([value, value], marker="braille")], 9, 11, (0.0, 1.0), (0.0, 100.0)
        )
        cells = [ord("".join(part for part, _ in row)[4]) for row in rows]
        return [
            4 * row + dot
            for row, cell in enumerate(cells)
            if cell > 0x2800
            for dot in range(3)
            if cell >> dot & 1
        ]

    # A row of ten per cent has four dots: the line at 50 is between those in the middle of its row.
    assert dots(50.0) == [21, 22]
    assert max(dots(56.0)) < min(dots(50.0))
    assert max(dots(50.0)) < min(dots(44.0))


def test_of_two_equal_curves_both_colours_are_seen_in_turns() -> None:
    level = [5.0] * 4
    (row,) = draw_canvas(
        [curve(level, marker="braille"), curve(level, BLUE, "braille")],
        12,
        1,
        (0.0, 3.0),
        (0.0, 10.0),
    )
    assert [(len(part), rgb) for part, rgb in row] == [(4, BLUE), (4, RED), (4, BLUE)]
