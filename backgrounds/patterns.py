"""Small patterns to look at with a sensor: tiny shapes, and lines of growing thickness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from shapes import BLACK, HEIGHT, WIDTH, Canvas, Rgb, blank, rect

RED: Rgb = (255, 0, 0)
BLUE: Rgb = (0, 0, 255)

SQUARE = ("#######",) * 7
RIGHT = (
    "#........",
    "###......",
    "####.....",
    "######...",
    "#######..",
    "#########",
    "#######..",
    "######...",
    "####.....",
    "###......",
    "#........",
)
LEFT = tuple(row[::-1] for row in RIGHT)
DOWN = (
    "###########",
    ".#########.",
    ".#########.",
    "..#######..",
    "...#####...",
    "...#####...",
    "....###....",
    "....###....",
    ".....#.....",
)
UP = (
    ".....#.....",
    "....###....",
    "....###....",
    "...#####...",
    "...#####...",
    "..#######..",
    "..#######..",
    ".#########.",
    ".#########.",
    "###########",
)
DIAMOND = (
    "....#....",
    "...###...",
    "..#####..",
    "..#####..",
    ".#######.",
    "#########",
    ".#######.",
    "..#####..",
    "..#####..",
    "...###...",
    "....#....",
)
CODED: tuple[tuple[int, int, tuple[str, ...]], ...] = (
    (227, 220, SQUARE),
    (307, 218, RIGHT),
    (385, 218, LEFT),
    (465, 220, DOWN),
    (545, 218, UP),
    (625, 218, DIAMOND),
)
"""Left, top and pixels of the shapes that have a code, in the order of their codes."""
UNCODED: tuple[tuple[int, int, tuple[str, ...]], ...] = (
    (227, 418, RIGHT),
    (305, 418, DIAMOND),
    (387, 420, SQUARE),
    (465, 418, LEFT),
)
PATCH_LEFT, PATCH_TOP, PATCH_WIDTH, PATCH_HEIGHT, PATCH_PITCH = 221, 251, 19, 25, 80

OUTLINE = (
    "...##.##...",
    ".###...###.",
    ".#.......#.",
    "##.......##",
    "#.........#",
    "...........",
    "#.........#",
    "##.......##",
    ".#.......#.",
    ".###...###.",
    "...##.##...",
)
"""A thin circle with gaps where the lines cross it."""
OUTLINE_CORNERS = ((195, 195), (235, 195))

THICKNESSES = (1, 3, 5, 7, 9)
"""Pixels; each thickness has two upright lines of a colour and one flat one."""
LINE_PITCH, PAIR_PITCH = 40, 78
FIRST_LINES: Mapping[Rgb, tuple[int, int]] = {BLACK: (200, 200), RED: (1000, 640)}
"""Left edge of a colour's first upright line, and top of its first flat one."""


def _bitmap(canvas: Canvas, rgb: Rgb, left: int, top: int, rows: Sequence[str]) -> None:
    marked = np.array([[mark != "." for mark in row] for row in rows])
    canvas[top : top + marked.shape[0], left : left + marked.shape[1]][marked] = rgb


def simple_shapes() -> Canvas:
    """Six tiny shapes, each above the grey patch that is its code, and four without codes."""
    canvas = blank()
    for left, top, rows in CODED + UNCODED:
        _bitmap(canvas, BLACK, left, top, rows)
    for code in range(len(CODED)):
        grey = 85 * code // 2
        left = PATCH_LEFT + code * PATCH_PITCH
        rect(
            canvas,
            (grey, grey, grey),
            (left, PATCH_TOP, left + PATCH_WIDTH, PATCH_TOP + PATCH_HEIGHT),
        )
    return canvas


def sensor_diameter_test() -> Canvas:
    """Black and red lines from 1 to 9 pixels thick across the mat, and two tiny blue circles."""
    canvas = blank()
    for left, top in OUTLINE_CORNERS:
        _bitmap(canvas, BLUE, left, top, OUTLINE)
    for rgb, (first_left, first_top) in FIRST_LINES.items():
        for at, thickness in enumerate(THICKNESSES):
            for left in (first_left + at * PAIR_PITCH, first_left + at * PAIR_PITCH + LINE_PITCH):
                rect(canvas, rgb, (left, 0, left + thickness, HEIGHT))
        for at, thickness in enumerate(THICKNESSES):
            top = first_top + at * LINE_PITCH
            rect(canvas, rgb, (0, top, WIDTH, top + thickness))
    return canvas
