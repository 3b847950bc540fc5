"""The robot in pictures without colours: signs for its body, its place and its heading."""

from __future__ import annotations

import math

import numpy as np

from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import RobotOutline
from tuisim.pictures.scene.robot import CLEARED, RobotColors, draw_robot
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.cells import sign_cell
from tuisim.terminal.pixels import Pixels

_BODY = "&"
"""The sign of a robot's cells: neither a mat has it, see `terminal.glyphs.SIGNS`, nor a frame."""


def draw_body(view: Viewport, pose: Pose, outline: RobotOutline) -> dict[tuple[int, int], int]:
    """Return the signs of the cells at least half of which a robot covers, by row and column."""
    empty = np.zeros((view.height_px, view.width_px, 3), np.uint8)
    draw_robot(empty, view, pose, outline, CLEARED)
    rows = view.height_px // view.cell.rows
    cols = view.width_px // view.cell.cols
    covered = (
        empty[..., 0].reshape(rows, view.cell.rows, cols, view.cell.cols).mean(axis=(1, 3)) >= 128
    )
    cells = np.argwhere(covered).tolist()
    return {(row, col): sign_cell(_BODY) for row, col in cells}


_LINES = "-/|\\"
_TIPS = {0: ">", 2: "^", 4: "<", 6: "v"}
"""Signs for the eight directions, counter-clockwise from the right; a line looks the same backwards."""
_STEPS_PER_CELL = 4
_AHEAD_CELLS = 2.0


def draw_pointer(
    view: Viewport, pose: Pose, reach_mm: float, pivot: str
) -> dict[tuple[int, int], int]:
    """Return signs that show place and heading of a robot, by row and column of their cells.

    Args:
        view: The visible part of the field.
        pose: Where the robot is.
        reach_mm: How far the drawn robot reaches ahead; the pointer is longer.
        pivot: The sign for the place of the robot.
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
    path = [
        (
            math.floor(row - step * math.sin(heading) * down),
            math.floor(col + step * math.cos(heading)),
        )
        for step in steps
    ]
    signs = dict.fromkeys(path, _LINES[direction % 4])
    signs[path[-1]] = _TIPS.get(direction, _LINES[direction % 4])
    signs[math.floor(row), math.floor(col)] = pivot
    return {cell: sign_cell(sign) for cell, sign in signs.items()}


def draw_mono_robot(
    picture: Pixels,
    view: Viewport,
    pose: Pose,
    outline: RobotOutline,
    colors: RobotColors,
    *,
    pressed: tuple[bool, ...] = (),
    detail_cols: int | None = None,
) -> None:
    """Paint a robot as `draw_robot` does, for a terminal of two colours.

    Each point is black or white: mixed colours would become a pattern, as the greys of the mat do. A white rim keeps
    the robot apart from what is around it.
    """
    on_white, on_black = np.full_like(picture, 255), np.zeros_like(picture)
    for canvas in (on_white, on_black):
        draw_robot(canvas, view, pose, outline, colors, pressed=pressed, detail_cols=detail_cols)
    white = on_white[..., 0].astype(np.intp)
    black = on_black[..., 0].astype(np.intp)
    # Where the robot does not cover the canvases, one is still white and the other black.
    covered = white - black <= 128
    around = np.pad(covered, 1)
    rim = np.logical_or.reduce([np.roll(around, shift, (0, 1)) for shift in _BESIDE])[1:-1, 1:-1]
    picture[rim | covered] = 255
    picture[covered & (white <= 128)] = 0


_BESIDE = ((-1, 0), (1, 0), (0, -1), (0, 1))
