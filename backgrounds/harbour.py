"""Harbour: a mat for missions, with a home, marks to drive to, lines to follow and crates to sort by colour."""

from __future__ import annotations

from lettering import write_middle
from shapes import BLACK, WHITE, Box, Canvas, Point, Rgb, blank, disc, paint, polygon, rect
from strokes import bent, stroke

SEA: Rgb = (205, 228, 255)
SAND: Rgb = (250, 240, 205)
BLUE: Rgb = (0, 90, 200)
RED: Rgb = (215, 25, 35)
YELLOW: Rgb = (255, 205, 0)
GREEN: Rgb = (0, 150, 60)

LINE_WIDTH = 20.0
HOME: Point = (0, 1143)
HOME_RADIUS, HOME_EDGE = 400, 10
SHORE: tuple[Point, ...] = (
    (2362, 260),
    (2230, 300),
    (2150, 420),
    (2150, 720),
    (2230, 830),
    (2362, 880),
)
QUAY: tuple[Point, ...] = (
    (500, 953),
    (800, 953),
    (1000, 920),
    (1130, 760),
    (1260, 600),
    (1460, 571),
    (1600, 571),
    (1900, 571),
)
DOCK: Box = (1900, 491, 1960, 651)
RAILS: tuple[tuple[Rgb, tuple[Point, ...]], ...] = (
    (GREEN, ((420, 340), (420, 130), (720, 130))),
    (BLUE, ((1500, 571), (1500, 880), (1700, 980), (2050, 980))),
)
MARKS: tuple[tuple[str, Point, Rgb], ...] = (
    ("LIGHTHOUSE", (420, 420), RED),
    ("BUOY", (2140, 980), BLUE),
    ("MARKET", (950, 420), YELLOW),
)
"""Name, middle and colour of each mark."""
MARK_RINGS = (80, 55, 28)
CRATES: tuple[Rgb, ...] = (RED, GREEN, YELLOW, BLUE, GREEN, RED)
CRATE_LEFT, CRATE_TOP, CRATE_SIZE, CRATE_PERIOD = 800, 80, 100, 180


def _draw_mark(canvas: Canvas, name: str, middle: Point, rgb: Rgb) -> None:
    for radius, ring_rgb in zip(MARK_RINGS, (rgb, WHITE, rgb), strict=True):
        paint(canvas, ring_rgb, disc(middle, radius), smooth=True)
    write_middle(canvas, name, (middle[0], middle[1] + 130), 38, BLACK)


def harbour() -> Canvas:
    """The harbour."""
    canvas = blank()
    paint(canvas, SEA, polygon(bent(SHORE, 24)), smooth=True)
    paint(canvas, BLUE, disc(HOME, HOME_RADIUS), smooth=True)
    paint(canvas, SAND, disc(HOME, HOME_RADIUS - HOME_EDGE), smooth=True)
    for rgb, points in RAILS:
        paint(canvas, rgb, stroke(points, LINE_WIDTH, "miter"), smooth=True)
    paint(canvas, BLACK, stroke(bent(QUAY, 24), LINE_WIDTH), smooth=True)
    rect(canvas, RED, DOCK)
    for name, middle, rgb in MARKS:
        _draw_mark(canvas, name, middle, rgb)
    for place, rgb in enumerate(CRATES):
        left = CRATE_LEFT + place * CRATE_PERIOD
        rect(canvas, rgb, (left, CRATE_TOP, left + CRATE_SIZE, CRATE_TOP + CRATE_SIZE))
    for text, middle in (("HOME", (150, 1090)), ("DOCK", (1930, 700)), ("CRATES", (1300, 240))):
        write_middle(canvas, text, middle, 44, BLACK)
    return canvas
