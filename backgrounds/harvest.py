"""Harvest trail: a farm to drive through, with a line to follow, fields to tell by colour and a barn to reach."""

from __future__ import annotations

from lettering import write, write_middle
from shapes import BLACK, WHITE, Box, Canvas, Point, Rgb, blank, disc, ellipse, paint, rect
from strokes import bent, stroke

HEDGE: Rgb = (0, 110, 50)
WHEAT: Rgb = (255, 210, 0)
STUBBLE: Rgb = (225, 180, 0)
GRASS: Rgb = (0, 160, 60)
DARK_GRASS: Rgb = (0, 130, 45)
BERRY: Rgb = (215, 25, 35)
DARK_BERRY: Rgb = (180, 10, 25)
WATER: Rgb = (0, 100, 210)
YARD: Rgb = (205, 225, 255)
WOOD: Rgb = (140, 75, 20)

LINE_WIDTH = 20.0
HEDGE_WIDTH = 12
FURROW_WIDTH = 17
YARD_BOX: Box = (60, 830, 360, 1080)
BARN_BOX: Box = (2040, 430, 2300, 690)
FIELDS: tuple[tuple[str, float, Rgb, Rgb], ...] = (
    ("WHEAT", 480, WHEAT, STUBBLE),
    ("GRASS", 980, GRASS, DARK_GRASS),
    ("BERRIES", 1480, BERRY, DARK_BERRY),
)
"""Name, left edge and the two colours of its furrows."""
FIELD_TOP, FIELD_WIDTH, FIELD_HEIGHT = 60, 340, 272
TRAIL: tuple[Point, ...] = (
    (360, 955),
    (560, 955),
    (700, 900),
    (470, 700),
    (420, 560),
    (700, 560),
    (1100, 560),
    (1600, 560),
    (1900, 560),
    (2040, 560),
)
POND_ROAD: tuple[Point, ...] = (
    (1400, 560),
    (1400, 720),
    (1480, 900),
    (1290, 1060),
    (1060, 1060),
    (860, 960),
    (950, 720),
    (950, 560),
)
MILL: Point = (1800, 860)
MILL_RINGS: tuple[tuple[float, Rgb], ...] = ((150, BERRY), (110, WHITE), (70, WATER), (30, WHEAT))
SACKS: tuple[tuple[float, float], ...] = ((1520, 0), (1600, 64), (2000, 128), (2080, 192))
"""Column of each grey sack on the row of the mill, and its grey."""
SACK_RADIUS = 28


def _frame(canvas: Canvas, rgb: Rgb, box: Box, width: float, inside: Rgb) -> None:
    """A box with a border."""
    x0, y0, x1, y1 = box
    rect(canvas, rgb, box)
    rect(canvas, inside, (x0 + width, y0 + width, x1 - width, y1 - width))


def _field(canvas: Canvas, left: float, light: Rgb, dark: Rgb) -> None:
    for furrow in range(FIELD_HEIGHT // FURROW_WIDTH):
        top = FIELD_TOP + furrow * FURROW_WIDTH
        rect(
            canvas,
            dark if furrow % 2 else light,
            (left, top, left + FIELD_WIDTH, top + FURROW_WIDTH),
        )


def _trails(canvas: Canvas) -> None:
    for points in (TRAIL, POND_ROAD):
        paint(canvas, BLACK, stroke(bent(points, 24), LINE_WIDTH), smooth=True)
    for _, left, _, _ in FIELDS:
        middle = left + FIELD_WIDTH / 2
        rect(
            canvas,
            BLACK,
            (middle - LINE_WIDTH / 2, FIELD_TOP + FIELD_HEIGHT, middle + LINE_WIDTH / 2, 560),
        )
    rect(canvas, BLACK, (MILL[0] - LINE_WIDTH / 2, 560, MILL[0] + LINE_WIDTH / 2, MILL[1]))


def _buildings(canvas: Canvas) -> None:
    _frame(canvas, WATER, YARD_BOX, 10, YARD)
    _frame(canvas, WOOD, BARN_BOX, 24, BERRY)
    for radius, rgb in MILL_RINGS:
        paint(canvas, rgb, disc(MILL, radius), smooth=True)
    for column, grey in SACKS:
        paint(canvas, (grey, grey, grey), disc((column, MILL[1]), SACK_RADIUS), smooth=True)


def harvest_trail() -> Canvas:
    """The farm."""
    canvas = blank(HEDGE)
    rect(
        canvas,
        WHITE,
        (HEDGE_WIDTH, HEDGE_WIDTH, canvas.shape[1] - HEDGE_WIDTH, canvas.shape[0] - HEDGE_WIDTH),
    )
    _trails(canvas)
    for name, left, light, dark in FIELDS:
        _field(canvas, left, light, dark)
        write(canvas, name, (left + FIELD_WIDTH / 2 + 25, FIELD_TOP + FIELD_HEIGHT + 50), 38, BLACK)
    _buildings(canvas)
    paint(canvas, WATER, ellipse((1165, 820), 130, 90), smooth=True)
    for text, middle, size in (
        ("YARD", (210, 1045), 40.0),
        ("BARN", (2170, 730), 44.0),
        ("MILL", (MILL[0], 1045), 44.0),
        ("POND", (1165, 945), 40.0),
    ):
        write_middle(canvas, text, middle, size, BLACK)
    return canvas
