"""Shapes cover what they should, also between pixels."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapes
import strokes
from shapes import BLACK, Box, Shape

from tests.cases import cases

INK = 255.0
"""What one fully covered pixel of black on white takes away from a channel."""


def area(shape: Shape, *, smooth: bool = False) -> float:
    """Pixels that a black shape covers on white."""
    canvas = shapes.blank()
    shapes.paint(canvas, BLACK, shape, smooth=smooth)
    return float((INK - canvas[:, :, 0].astype(np.float64)).sum() / INK)


@cases(
    "box, covered",
    {
        "whole pixels": ((10, 20, 13, 22), {(20, 10): 1, (21, 12): 1, (22, 10): 0, (20, 13): 0}),
        "left edge inside": ((10.25, 20, 12, 21), {(20, 10): 0.75, (20, 11): 1, (20, 9): 0}),
        "within one pixel": ((10.25, 20.5, 10.5, 20.75), {(20, 10): 0.0625}),
        "partly off the mat": ((-5, -5, 1, 1), {(0, 0): 1, (0, 1): 0}),
        "last pixel": ((2361, 1142, 2400, 1200), {(1142, 2361): 1, (1142, 2360): 0}),
    },
)
def test_rect_blends_by_share(box: Box, covered: dict[tuple[int, int], float]) -> None:
    canvas = shapes.blank()
    shapes.rect(canvas, BLACK, box)
    for (row, column), share in covered.items():
        assert canvas[row, column, 0] == pytest.approx(INK * (1 - share))


def test_rect_off_the_mat_paints_nothing() -> None:
    canvas = shapes.blank()
    shapes.rect(canvas, BLACK, (-50, -50, -10, -10))
    shapes.rect(canvas, BLACK, (3000, 10, 3010, 20))
    assert canvas.min() == INK


@pytest.mark.quick_cases("hard-*")
@cases(
    "shape, expected",
    {
        "disc": (shapes.disc((500, 500), 40), math.pi * 40**2),
        "ellipse": (shapes.ellipse((500, 500), 60, 30), math.pi * 60 * 30),
        "ring": (shapes.ring((500, 500), 50, 30), math.pi * (50**2 - 30**2)),
        "rounded_rect": (
            shapes.rounded_rect((100, 100, 300, 200), 30),
            20_000 - (4 - math.pi) * 900,
        ),
        "triangle": (shapes.polygon([(100, 100), (200, 100), (100, 180)]), 4000),
        "polygon with a hole": (
            shapes.polygon(
                [
                    (0, 0),
                    (60, 0),
                    (60, 60),
                    (0, 60),
                    (0, 0),
                    (20, 20),
                    (40, 20),
                    (40, 40),
                    (20, 40),
                    (20, 20),
                ]
            ),
            3200,
        ),
        "stroke": (strokes.stroke([(100, 100), (160, 180)], 10), 1000),
        "stroke, mitred": (strokes.stroke([(100, 100), (200, 100), (200, 200)], 20, "miter"), 4000),
        "mitred, other way": (
            strokes.stroke([(200, 200), (200, 100), (100, 100)], 20, "miter"),
            4000,
        ),
        "rounded": (strokes.stroke([(100, 100), (200, 100), (200, 200)], 20), 3900 + math.pi * 25),
        "union": (
            shapes.union(
                [
                    shapes.rounded_rect((100, 100, 200, 150), 0),
                    shapes.rounded_rect((150, 100, 250, 150), 0),
                ]
            ),
            7500,
        ),
        "closed line": (
            strokes.closed_line([(100, 100, 20), (300, 100, 20), (300, 300, 20), (100, 300, 20)]),
            16_000 - 400 + 100 * math.pi,
        ),
        "pen line": (strokes.pen_line([(100, 100), (200, 100)], 30, 20), 2000 + 150 * math.pi),
        "pen dot": (strokes.pen_line([(100, 100), (100, 100)], 90, 60), 1350 * math.pi),
    },
)
@pytest.mark.parametrize("smooth", [False, True], ids=["hard", "smooth"])
def test_area(shape: Shape, expected: float, smooth: bool) -> None:
    assert area(shape, smooth=smooth) == pytest.approx(expected, rel=0.003 if smooth else 0.01)


def test_hard_shapes_paint_pixels_whose_centre_is_inside() -> None:
    assert area(shapes.disc((10.5, 10.5), 1.0)) == 5
    assert area(shapes.disc((10.0, 10.0), 0.7)) == 0
    assert area(shapes.disc((10.0, 10.0), 0.71)) == 4


def test_smooth_edge_has_shades_and_hard_edge_has_none() -> None:
    hard, smooth = shapes.blank(), shapes.blank()
    shapes.paint(hard, BLACK, shapes.disc((100, 100), 20))
    shapes.paint(smooth, BLACK, shapes.disc((100, 100), 20), smooth=True)
    assert set(np.unique(hard)) == {0, 255}
    assert len(np.unique(shapes.finished(smooth))) > 10


def test_shade_takes_a_colour_for_each_pixel() -> None:
    canvas = shapes.blank()
    colors = np.arange(2 * 3 * 3, dtype=float).reshape(2, 3, 3)
    shapes.shade(canvas, (5, 7, 8, 9), colors)
    assert np.array_equal(canvas[7:9, 5:8], colors)


def test_bent_line_goes_from_end_to_end_and_keeps_within_its_points() -> None:
    line = strokes.bent([(0, 0), (100, 0), (100, 100), (200, 100)], steps=4)
    assert (line[0], line[-1]) == ((0, 0), (200, 100))
    assert (100, 50) in line
    assert len(line) == 1 + 2 * 4
    assert all(0 <= x <= 200 and 0 <= y <= 100 for x, y in line)
