"""The floor around a mat: its colour, and a faint grid on which one sees a robot move."""

from __future__ import annotations

import math

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.field import find_floor_rgb
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

GRID_MM = (100, 200, 500, 1000, 2000, 5000)
"""Distances of the lines of the grid."""
_MIN_CELLS = 8
"""The lines are at least so many cells apart."""
_FAINT = 0.07
"""The difference of the lines from the floor."""


def find_mat_floor_rgb(mat: Pixels) -> Rgb:
    """Return the colour of the floor around a mat.

    Args:
        mat: Shape (height, width, 3).
    """
    height_px, width_px = mat.shape[:2]
    return find_floor_rgb(width_px, height_px, memoryview(mat.tobytes()))


def find_grid_rgb(floor_rgb: Rgb) -> Rgb:
    """Return the colour of the grid on a floor: a little darker, on a dark floor a little lighter."""
    towards = 0 if sum(floor_rgb) > 3 * 127 else 255
    red, green, blue = (round(value + (towards - value) * _FAINT) for value in floor_rgb)
    return red, green, blue


def find_field_pixels(view: Viewport) -> tuple[int, int, int, int]:
    """Return the left, top, right and lower edge of the field in a picture; negative ones become 0."""
    left, top = (max(round(edge), 0) for edge in view.to_px(0.0, FIELD_HEIGHT_MM))
    right, low = (max(int(edge), 0) for edge in view.to_px(FIELD_WIDTH_MM, 0.0))
    return left, top, right, low


def draw_grid(picture: Pixels, view: Viewport, rgb: Rgb) -> None:
    """Paint the lines of a grid around the field into a picture, in place."""
    left, top, right, low = find_field_pixels(view)
    mat = picture[top:low, left:right].copy()
    least_mm = _MIN_CELLS * view.cell.cols * view.mm_per_px
    step_mm = next((step for step in GRID_MM if step >= least_mm), GRID_MM[-1])
    right_mm, lower_mm = view.to_mm(view.width_px, view.height_px)
    for number in range(math.ceil(view.left_mm / step_mm), math.ceil(right_mm / step_mm)):
        picture[:, int(view.to_px(number * step_mm, 0.0)[0])] = rgb
    for number in range(math.floor(lower_mm / step_mm) + 1, math.floor(view.top_mm / step_mm) + 1):
        picture[int(view.to_px(0.0, number * step_mm)[1])] = rgb
    picture[top:low, left:right] = mat
