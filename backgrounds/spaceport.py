"""Space port: pale lines on a dark ground, an orbit with coloured docks, craters in greys and a launch pad."""

from __future__ import annotations

import numpy as np
from lettering import write_middle
from shapes import (
    BLACK,
    HEIGHT,
    WHITE,
    WIDTH,
    Box,
    Canvas,
    Point,
    Rgb,
    blank,
    disc,
    ellipse,
    paint,
    rect,
    ring,
    without,
)
from strokes import bent, stroke

SPACE: Rgb = (18, 22, 48)
STAR: Rgb = (150, 160, 190)
HANGAR: Rgb = (70, 78, 110)
RED: Rgb = (230, 30, 30)
GREEN: Rgb = (0, 190, 70)
BLUE: Rgb = (30, 110, 255)
YELLOW: Rgb = (255, 215, 0)

LINE_WIDTH = 20.0
STAR_COUNT, STAR_SEED, STAR_RADIUS = 160, 4, 2.2
ORBIT_MIDDLE: Point = (1080, 560)
ORBIT_X, ORBIT_Y = 620.0, 380.0
"""Half the width and the height of the middle of the orbit's line."""
PLANET_RADIUS = 150
DOCKS: tuple[tuple[str, Box, Rgb], ...] = (
    ("A", (980, 20, 1180, 130), RED),
    ("B", (230, 480, 400, 640), GREEN),
    ("C", (1780, 480, 1950, 640), BLUE),
)
"""Letter, box and colour; each lies at the end of a short line from the orbit."""
HANGAR_BOX: Box = (50, 840, 330, 1090)
TAXIWAY: tuple[Point, ...] = (
    (330, 965),
    (520, 965),
    (760, 1090),
    (900, 1010),
    (960, 960),
    (1080, 940),
)
CRATERS: tuple[tuple[float, float, float, int], ...] = (
    (180, 160, 75, 60),
    (400, 250, 60, 110),
    (210, 350, 50, 160),
    (480, 100, 45, 210),
)
"""Column, row, radius and grey."""
PAD: Point = (2100, 880)
PAD_RINGS: tuple[tuple[float, Rgb], ...] = (
    (190, YELLOW),
    (150, BLACK),
    (110, YELLOW),
    (70, BLACK),
    (30, RED),
)
PAD_ROAD: tuple[Point, ...] = ((1540, 820), (1640, 900), (1760, 980), (1860, 880), (1920, 880))
RUNWAY: Box = (1640, 60, 2310, 230)
RUNWAY_GREY: Rgb = (120, 120, 120)


def _stars(canvas: Canvas) -> None:
    # Raw draws: unlike numpy's distributions they never change between versions.
    drawn = np.random.PCG64(STAR_SEED).random_raw(2 * STAR_COUNT) >> np.uint64(40)
    for x, y in zip(drawn[::2] % WIDTH, drawn[1::2] % HEIGHT, strict=True):
        paint(canvas, STAR, disc((float(x), float(y)), STAR_RADIUS), smooth=True)


def _orbit(canvas: Canvas) -> None:
    half = LINE_WIDTH / 2
    outer, inner = (
        ellipse(ORBIT_MIDDLE, ORBIT_X + side * half, ORBIT_Y + side * half) for side in (1, -1)
    )
    paint(canvas, WHITE, without(outer, inner), smooth=True)
    x, y = ORBIT_MIDDLE
    rect(canvas, WHITE, (x - half, 130, x + half, y - ORBIT_Y))
    rect(canvas, WHITE, (400, y - half, x - ORBIT_X, y + half))
    rect(canvas, WHITE, (x + ORBIT_X, y - half, 1780, y + half))
    paint(canvas, HANGAR, disc(ORBIT_MIDDLE, PLANET_RADIUS), smooth=True)
    paint(canvas, BLUE, ring(ORBIT_MIDDLE, PLANET_RADIUS + 45, PLANET_RADIUS + 20), smooth=True)


def _runway(canvas: Canvas) -> None:
    x0, y0, x1, y1 = RUNWAY
    rect(canvas, RUNWAY_GREY, RUNWAY)
    middle = (y0 + y1) / 2
    for left in range(int(x0) + 90, int(x1) - 60, 100):
        rect(canvas, WHITE, (left, middle - 8, left + 60, middle + 8))
    for stripe in range(5):
        top = y0 + 15 + 30 * stripe
        rect(canvas, WHITE, (x0 + 15, top, x0 + 70, top + 18))


def space_port() -> Canvas:
    """The port."""
    canvas = blank(SPACE)
    _stars(canvas)
    for points in (TAXIWAY, PAD_ROAD):
        paint(canvas, WHITE, stroke(bent(points, 24), LINE_WIDTH), smooth=True)
    _orbit(canvas)
    _runway(canvas)
    rect(canvas, HANGAR, HANGAR_BOX)
    for radius, rgb in PAD_RINGS:
        paint(canvas, rgb, disc(PAD, radius), smooth=True)
    for column, row, radius, grey in CRATERS:
        paint(canvas, (grey, grey, grey), disc((column, row), radius), smooth=True)
    for letter, box, rgb in DOCKS:
        rect(canvas, rgb, box)
        write_middle(canvas, letter, (box[0] + 30, box[1] + 30), 48, BLACK)
    for text, middle in (
        ("HANGAR", (190, 1060)),
        ("RUNWAY", (1975, 265)),
        ("LAUNCH", (PAD[0], 1105)),
    ):
        write_middle(canvas, text, middle, 40, WHITE)
    return canvas
