"""Redraw the mats on which lessons try programs again: `python backgrounds/lesson_mats.py`.

Nobody drives on them by hand, so they are not in the catalogue. One row of pixels is enough: it is stretched.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from mats import BAND_COLUMNS, BLUE, GREEN, LIGHT_GREY, MID_GREY, RED, VERY_LIGHT_GREY, YELLOW
from PIL import Image
from shapes import BLACK, WIDTH, Rgb

FOLDER = Path(__file__).resolve().parent.parent / "tuisim" / "lessons" / "mats"
FIVE_COLUMNS = (*BAND_COLUMNS, (1850, 2051))
BANDS: dict[str, tuple[Rgb, ...]] = {
    "other_greys": ((225, 225, 225), (207, 207, 207), (124, 124, 124), BLACK),
    "two_pale": (VERY_LIGHT_GREY, VERY_LIGHT_GREY, LIGHT_GREY, MID_GREY, BLACK),
    "yellow_first": (YELLOW, RED, GREEN, BLUE, BLACK),
}
"""The bands of each mat from left to right, on white."""


def draw(name: str) -> Image.Image:
    """Draw the row of one mat."""
    row = np.full((1, WIDTH, 3), 255, np.uint8)
    for (left, right), rgb in zip(FIVE_COLUMNS, BANDS[name], strict=False):
        row[:, left:right] = rgb
    return Image.fromarray(row)


if __name__ == "__main__":
    for mat in BANDS:
        draw(mat).save(FOLDER / f"{mat}.png", "PNG", optimize=True)
