"""A map of hilly land in steps of colour: a made-up height field, a sum of smooth hills and hollows."""

from __future__ import annotations

import numpy as np
from shapes import Canvas, Floats, Rgb, blank, pixel_centres

MAP_BOX = (295, 137, 2126, 1000)
"""Where the land is; around it the mat is white."""

# fmt: off
PALETTE: tuple[Rgb, ...] = (
    (30, 17, 73), (39, 18, 88), (47, 17, 99), (56, 16, 108), (64, 15, 116), (74, 16, 121), (82, 19, 124),
    (90, 22, 126), (98, 25, 128), (106, 28, 129), (115, 32, 129), (123, 35, 130), (131, 38, 129), (139, 41, 129),
    (148, 44, 128), (156, 46, 127), (165, 49, 126), (173, 52, 124), (183, 55, 121), (191, 58, 119), (199, 61, 115),
    (207, 64, 112), (214, 69, 108), (223, 74, 104), (229, 80, 100), (235, 87, 96),
)
"""One colour for each step, from the lowest land to the highest."""

HILLS: tuple[tuple[float, float, float, float, float], ...] = (
    (690, 330, 260, 190, 1.0), (905, 455, 200, 260, 0.55), (1290, 300, 330, 170, 0.8), (1640, 420, 180, 220, 0.95),
    (1905, 270, 230, 160, 0.6), (2040, 640, 190, 260, 0.75), (1480, 760, 300, 180, 0.7), (1130, 830, 210, 150, 0.85),
    (760, 760, 240, 210, 0.65), (420, 560, 170, 240, 0.5), (500, 900, 200, 140, 0.45), (1800, 900, 220, 150, 0.55),
    (1060, 590, 150, 120, -0.75), (1420, 540, 260, 130, -0.7), (560, 480, 140, 200, -0.35), (880, 960, 260, 120, -0.5),
    (1840, 640, 170, 240, -0.8), (1620, 180, 220, 130, -0.55), (350, 250, 200, 220, -0.6), (1010, 190, 170, 130, -0.5),
    (615, 250, 60, 50, 0.22), (745, 400, 70, 60, 0.2), (1365, 250, 80, 55, 0.18), (1690, 350, 60, 80, 0.22),
    (1120, 760, 60, 50, 0.2), (1550, 720, 80, 60, 0.2), (1980, 560, 60, 90, 0.2), (790, 830, 70, 60, -0.2),
    (1240, 420, 70, 60, -0.2), (470, 640, 60, 80, 0.2), (1750, 520, 60, 60, -0.18), (2060, 380, 70, 70, 0.2),
)
# fmt: on
"""Column and row of the middle, reach across and down, height; a negative height is a hollow."""

SLOPE_ACROSS, SLOPE_DOWN = 0.00012, -0.00025
"""How much the land rises with every pixel to the right and down."""


def height_field() -> Floats:
    """Return the height of the land at each pixel of MAP_BOX, 0 … 1, shape (h, w)."""
    x, y = pixel_centres(MAP_BOX)
    land = SLOPE_ACROSS * x + SLOPE_DOWN * y
    for column, row, across, down, height in HILLS:
        # Only products and quotients, so that every machine finds the same number.
        land = land + height / (1.0 + ((x - column) / across) ** 2 + ((y - row) / down) ** 2)
    low, high = land.min(), land.max()
    scaled: Floats = (land - low) / (high - low)
    return scaled


def topo_map() -> Canvas:
    """Hilly land from dark purple hollows to orange tops."""
    canvas = blank()
    x0, y0, x1, y1 = MAP_BOX
    steps = np.minimum((height_field() * len(PALETTE)).astype(np.intp), len(PALETTE) - 1)
    canvas[y0:y1, x0:x1] = np.asarray(PALETTE, np.float32)[steps]
    return canvas
