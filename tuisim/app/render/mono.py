"""Pictures without colours: darkness as dots or as signs, so that greys which have to be told apart look different."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from tuisim.charts.glyphs import BRAILLE_FROM, Covered, GlyphSet, nearest_signs, sign_number
from tuisim.charts.world_image import CLEARED, draw_robot
from tuisim.config.picture_options import CellSet

if TYPE_CHECKING:
    from tuisim.charts.fitted_cells import CellIndex, Cells
    from tuisim.charts.world_image import Pixels, Viewport
    from tuisim.core.geometry import Pose
    from tuisim.core.outline import RobotOutline

_LUMA = np.array([0.299, 0.587, 0.114], np.float32)
_GREYS, _DARKNESS = (0, 128, 211, 220, 255), (1.0, 0.5, 0.25, 0.125, 0.0)
"""Two, four and eight times the ink for the darker greys of the mats, which are hardly darker than each other."""
_THRESHOLDS = (np.array([0, 4, 6, 2, 1, 5, 7, 3], np.float32) + 0.5) / 8
"""The order in which the points of a cell get dots: each dot far from the last one."""
_RAMP = " .:-+xoO8@"
_EVEN = 0.13
"""Points whose darkness differs by less than this are shown by a sign for their mean."""
_INK_ON_PAPER = 0xFFFFFF << 24
"""Light dots on black where a picture needs colours after all, as in a screenshot."""


def darkness(points: npt.NDArray[np.uint8]) -> Covered:
    """Return how dark colours are, shape (…, 3), from 0 for white to 1 for black."""
    found: Covered = np.interp(points @ _LUMA, _GREYS, _DARKNESS).astype(np.float32)
    return found


def mono_cells(picture: Pixels, glyphs: GlyphSet, at: CellIndex, cell_set: CellSet) -> Cells:
    """Return some cells of a picture as dots or signs, shape (n,)."""
    rows, cols = len(picture) // glyphs.rows, picture.shape[1] // glyphs.cols
    points = picture.reshape(rows, glyphs.rows, cols, glyphs.cols, 3).transpose(0, 2, 1, 3, 4)[at]
    ink = darkness(points.reshape(len(points), glyphs.rows * glyphs.cols, 3))
    if cell_set is CellSet.BRAILLE:
        dots = ink > _THRESHOLDS
        patterns = (dots << np.arange(dots.shape[1])).sum(axis=1)
        numbers = np.where(patterns == 0, sign_number(" "), BRAILLE_FROM + patterns)
    else:
        ramp = np.array([sign_number(sign) for sign in _RAMP])
        even = np.ptp(ink, axis=1) < _EVEN
        steps = np.rint(ink.mean(axis=1) * (len(_RAMP) - 1)).astype(np.intp)
        numbers = np.where(even, ramp[steps], nearest_signs(ink))
    cells: Cells = numbers.astype(np.int64) << 48 | _INK_ON_PAPER
    return cells


_BODY = "&"
"""The sign of a robot's cells: neither a mat has it, see `charts.glyphs.SIGNS`, nor a frame."""


def body(view: Viewport, pose: Pose, outline: RobotOutline) -> dict[tuple[int, int], int]:
    """Return signs for the cells that a robot covers, at least half of each, as cells by row and column."""
    empty = np.zeros((view.height_px, view.width_px, 3), np.uint8)
    draw_robot(empty, view, pose, outline, CLEARED)
    rows, cols = view.height_px // view.cell.rows, view.width_px // view.cell.cols
    covered = empty[..., 0].reshape(rows, view.cell.rows, cols, view.cell.cols).mean(axis=(1, 3)) >= 128
    found = np.argwhere(covered).tolist()
    return {(row, col): sign_number(_BODY) << 48 | _INK_ON_PAPER for row, col in found}


_LINES, _TIPS = "-/|\\", {0: ">", 2: "^", 4: "<", 6: "v"}
"""Signs for the eight directions, counter-clockwise from the right; a line looks the same backwards."""
_STEPS_PER_CELL = 4
_AHEAD_CELLS = 2.0


def pointer(view: Viewport, pose: Pose, reach_mm: float, pivot: str) -> dict[tuple[int, int], int]:
    """Return signs for the place and the heading of a robot, as cells by row and column.

    Args:
        view: The visible part of the field.
        pose: Where the robot is.
        reach_mm: How far it reaches ahead, as it is drawn; the pointer is longer.
        pivot: The sign of its place.
    """
    width_mm, height_mm = view.mm_per_px * view.cell.cols, view.mm_per_row * view.cell.rows
    heading = math.radians(pose.heading_deg)
    # From the middle of a cell, so that it does not change while the robot drives on straight.
    col = math.floor((pose.x_mm - view.left_mm) / width_mm) + 0.5
    row = math.floor((view.top_mm - pose.y_mm) / height_mm) + 0.5
    length = reach_mm / width_mm + _AHEAD_CELLS
    direction = round(math.degrees(heading) / 45) % 8
    steps = (step / _STEPS_PER_CELL for step in range(1, math.ceil(length * _STEPS_PER_CELL) + 1))
    down = width_mm / height_mm
    path = [(math.floor(row - step * math.sin(heading) * down), math.floor(col + step * math.cos(heading)))
            for step in steps]  # fmt: skip
    signs = dict.fromkeys(path, _LINES[direction % 4])
    signs[path[-1]] = _TIPS.get(direction, _LINES[direction % 4])
    signs[math.floor(row), math.floor(col)] = pivot
    return {at: sign_number(sign) << 48 | _INK_ON_PAPER for at, sign in signs.items()}
