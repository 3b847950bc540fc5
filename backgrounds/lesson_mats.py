"""Redraw the mats on which lessons try programs again: `python backgrounds/lesson_mats.py`.

Nobody drives on them by hand, so they are not in the catalogue. One row of pixels is enough: it is stretched.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from mats import BLUE, GREEN, LIGHT_GREY, MID_GREY, RED, VERY_LIGHT_GREY, YELLOW
from PIL import Image
from shapes import BLACK, WIDTH, Rgb

FOLDER = Path(__file__).resolve().parent.parent / "tuisim" / "tasks" / "lessons" / "mats"
WIDTH_OF_BAND = 201
BANDS: dict[str, dict[int, Rgb]] = {
    "other_greys": {250: (225, 225, 225), 650: (207, 207, 207), 1050: (124, 124, 124), 1450: BLACK},
    "lighter_dark": {250: VERY_LIGHT_GREY, 650: LIGHT_GREY, 1050: (129, 129, 129), 1450: BLACK},
    "other_places": {450: (190, 190, 190), 850: (150, 150, 150), 1250: (96, 96, 96), 1650: BLACK},
    "mid_first": {
        250: LIGHT_GREY,
        650: VERY_LIGHT_GREY,
        1050: LIGHT_GREY,
        1450: MID_GREY,
        1850: BLACK,
    },
    "colours_elsewhere": {330: RED, 790: GREEN, 1130: BLUE, 1610: BLACK},
    "more_colours": {250: YELLOW, 580: RED, 930: GREEN, 1290: RED, 1630: BLUE, 1990: BLACK},
}
"""The bands of each mat by their left edges, on white."""


def draw(name: str) -> Image.Image:
    """Draw the row of one mat."""
    row = np.full((1, WIDTH, 3), 255, np.uint8)
    for left, rgb in BANDS[name].items():
        row[:, left : left + WIDTH_OF_BAND] = rgb
    return Image.fromarray(row)


if __name__ == "__main__":
    for mat in BANDS:
        draw(mat).save(FOLDER / f"{mat}.png", "PNG", optimize=True)
