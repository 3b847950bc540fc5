"""Courses for practice: line following, junctions, obstacles, a racing circuit."""

from __future__ import annotations

from collections.abc import Sequence

from bends import (
    BEND,
    HOOK_LOWER_LEFT,
    HOOK_LOWER_RIGHT,
    HOOK_UPPER_LEFT,
    HOOK_UPPER_RIGHT,
    WAVE,
    WIGGLE,
)
from circuit import CIRCUIT
from lettering import write
from shapes import BLACK, WHITE, Box, Canvas, Point, Rgb, blank, disc, paint, polygon, rect, ring
from snakes import SNAKE_1, SNAKE_2, SNAKE_3
from strokes import closed_line, stroke

LINE_WIDTH = 20.0
LABEL_SIZE = 22.57
MARKER_GREEN: Rgb = (0, 179, 0)
MARKER_SIZE = 25
BAND_GREY: Rgb = (192, 192, 192)
TIP_RED: Rgb = (255, 0, 0)

Label = tuple[float, float, str]
"""Where the pen starts on the base line, and the text."""

ZIGZAG: tuple[Point, ...] = (
    (1076.26, 1097.0),
    (1076.26, 870.19),
    (1257.65, 682.88),
    (1015.2, 443.93),
    (1264.31, 200.2),
    (1059.22, -8.0),
)
FOLLOWING_LABELS: tuple[Label, ...] = (
    (1359.3, 517.86, "x: 1453, y: 656"),
    (1714.81, 517.87, "x: 1821, y: 656"),
    (970.52, 1120.75, "x: 1076, y: 46"),
    (1385.61, 1121.29, "x: 1453, y: 46"),
    (1741.14, 1121.25, "x: 1821, y: 46"),
    (359.56, 1123.34, "x: 440, y: 46"),
    (688.8, 1122.64, "x: 771, y: 46"),
    (2051.98, 1123.33, "x: 2138, y: 46"),
    (58.18, 1126.83, "x: 141, y: 46"),
)

CIRCLES: tuple[Point, ...] = (
    (210.42, 178.67),
    (697.9, 178.66),
    (1186.15, 178.66),
    (1669.88, 178.66),
    (2155.29, 178.63),
)
CIRCLE_INNER, CIRCLE_OUTER = 82.74, 102.73
UPRIGHT_LEFTS = (200.64, 688.125, 1176.37, 1660.095, 2145.525)
UPRIGHT_TOP, UPRIGHT_BOTTOM = 262.0, 1043.65
CROSS_LINES: tuple[Box, ...] = (
    (0, 569.7, 2362, 589.7),
    (1910.68, 685.93, 2362, 705.93),
    (1910.68, 812.4, 2362, 832.4),
    (0, 170.75, 2362, 190.75),
)
MARKERS: tuple[tuple[float, tuple[float, ...]], ...] = (
    (190.7, (83.31, 312.48, 570.79, 799.96, 1059.04, 1288.21, 1542.77, 1771.94, 2028.19, 2257.36)),
    (280.93, (220.6, 708.1, 1151.3, 1635.01, 2120.45, 2165.5)),
    (544.6, (2120.5, 2165.5)),
    (589.7, (175.65, 220.64, 708.15, 1151.35)),
    (661.0, (2120.5,)),
    (787.4, (2165.5,)),
)
"""Turn markers: the top edge of a row of them, and their left edges."""
JUNCTION_LABELS: tuple[Label, ...] = (
    (10.06, 496.47, "y: 581"),
    (10.4, 1031.48, "y: 100"),
    (658.1, 1081.23, "x: 698"),
    (164.17, 1086.87, "x: 210"),
    (1141.35, 1090.23, "x: 1186"),
    (1631.2, 1090.26, "x: 1670"),
    (2115.5, 1092.5, "x: 2155"),
)

BLOCK: Box = (1036.32, 0, 1334.35, 1143)
STRAIGHT_LEFTS = (111.73, 917.75, 1439.295, 2191.97)
STRAIGHT_TOP, STRAIGHT_BOTTOM = 63.26, 1097.0
OBSTACLES_LABELS: tuple[Label, ...] = (
    (1746.49, 1121.41, "x: 1841, y: 656"),
    (407.0, 1121.71, "x: 488, y: 46"),
    (37.26, 1123.44, "x: 121, y: 46"),
    (843.25, 1123.36, "x: 928, y: 46"),
    (1364.86, 1123.38, "x: 1450, y: 46"),
    (2117.48, 1123.36, "x: 2202, y: 46"),
)

FINISH_BAND: tuple[Point, ...] = (
    (302.99, 896.69),
    (533.02, 777.23),
    (544.9, 799.48),
    (314.22, 919.28),
)
FLAG_TIPS: tuple[tuple[Point, ...], ...] = (
    ((202.65, 935.45), (237.22, 965.06), (221.34, 973.05)),
    ((535.75, 765.35), (565.99, 794.8), (552.05, 802.71)),
)
FLAG_COLUMNS = 13


def _labels(canvas: Canvas, labels: Sequence[Label]) -> None:
    for x, base, text in labels:
        write(canvas, text, (x, base), LABEL_SIZE, BLACK)


def line_following_test() -> Canvas:
    """Lines to follow, harder from left to right: snakes, a zigzag, hooks, a broken line."""
    canvas = blank()
    bent = (
        SNAKE_1,
        SNAKE_2,
        SNAKE_3,
        HOOK_UPPER_LEFT,
        HOOK_UPPER_RIGHT,
        HOOK_LOWER_LEFT,
        HOOK_LOWER_RIGHT,
        WIGGLE,
    )
    for points in bent:
        paint(canvas, BLACK, stroke(points, LINE_WIDTH), smooth=True)
    paint(canvas, BLACK, stroke([(2139.93, 163.75), (2139.93, -2.0)], LINE_WIDTH), smooth=True)
    paint(canvas, BLACK, stroke([(2136.5, 1097.01), (2136.5, 853.47)], 17.56), smooth=True)
    paint(canvas, BLACK, stroke(ZIGZAG, LINE_WIDTH, "miter"), smooth=True)
    _labels(canvas, FOLLOWING_LABELS)
    return canvas


def junction_handling_test() -> Canvas:
    """Lines with crossings and roundabouts; green squares say where to turn."""
    canvas = blank()
    *lower, top = CROSS_LINES
    uprights: list[Box] = [
        (left, UPRIGHT_TOP, left + LINE_WIDTH, UPRIGHT_BOTTOM) for left in UPRIGHT_LEFTS
    ]
    for box in (*lower, *uprights, top):
        rect(canvas, BLACK, box)
    for centre in CIRCLES:
        # A little larger than the hole of the ring, so that no line shines through its inner edge.
        paint(canvas, WHITE, disc(centre, CIRCLE_INNER + 0.5), smooth=True)
    for centre in CIRCLES:
        paint(canvas, BLACK, ring(centre, CIRCLE_OUTER, CIRCLE_INNER), smooth=True)
    for y, lefts in MARKERS:
        for x in lefts:
            rect(canvas, MARKER_GREEN, (x, y, x + MARKER_SIZE, y + MARKER_SIZE))
    _labels(canvas, JUNCTION_LABELS)
    return canvas


def obstacles_test() -> Canvas:
    """Six lines and a broad black block; the catalogue puts boxes on the lines."""
    canvas = blank()
    rect(canvas, BLACK, BLOCK)
    for left in STRAIGHT_LEFTS:
        rect(canvas, BLACK, (left, STRAIGHT_TOP, left + LINE_WIDTH, STRAIGHT_BOTTOM))
    for points in (WAVE, BEND):
        paint(canvas, BLACK, stroke(points, LINE_WIDTH), smooth=True)
    _labels(canvas, OBSTACLES_LABELS)
    return canvas


def _flag(
    canvas: Canvas,
    corners: tuple[Point, Point, Point],
    row_heights: Sequence[float],
    first_black: int,
) -> None:
    """A chequered flag: its top left, top right and bottom left corner."""
    (x0, y0), (x1, y1), (x2, y2) = corners

    def at(column: float, down: float) -> Point:
        across, along = column / FLAG_COLUMNS, down / sum(row_heights)
        return x0 + across * (x1 - x0) + along * (x2 - x0), y0 + across * (y1 - y0) + along * (
            y2 - y0
        )

    top = 0.0
    for row, height in enumerate(row_heights):
        for column in range(FLAG_COLUMNS):
            if (row + column) % 2 == first_black:
                cell = [
                    at(column, top),
                    at(column + 1, top),
                    at(column + 1, top + height),
                    at(column, top + height),
                ]
                paint(canvas, BLACK, polygon(cell), smooth=True)
        top += height
    edge = [
        (*at(column, down), 1.0)
        for column, down in ((0, 0), (FLAG_COLUMNS, 0), (FLAG_COLUMNS, top), (0, top))
    ]
    paint(canvas, BLACK, closed_line(edge), smooth=True)


def thruxton_circuit() -> Canvas:
    """A racing circuit: one closed line, a grey finish band, a flag at each of its ends."""
    canvas = blank()
    paint(canvas, BLACK, closed_line(CIRCUIT), smooth=True)
    paint(canvas, BAND_GREY, polygon(FINISH_BAND), smooth=True)
    _flag(canvas, ((222.18, 941.15), (297.65, 903.28), (233.43, 955.37)), (1, 1, 1), 1)
    _flag(canvas, ((552.64, 770.78), (618.82, 732.88), (562.53, 784.94)), (0.5, 1, 1, 0.5), 0)
    for tip in FLAG_TIPS:
        paint(canvas, TIP_RED, polygon(tip), smooth=True)
    return canvas
