"""The robot in pictures without colours: signs for its body, its place and its heading."""

from __future__ import annotations

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
    """Return the signs that show a robot, by the row and column of their cells.

    Each cell of which the robot covers at least half has a sign. A sign is the number that `sign_cell` returns for a
    character.
    """
    empty = np.zeros((view.height_px, view.width_px, 3), np.uint8)
    draw_robot(empty, view, pose, outline, CLEARED)
    rows = view.height_px // view.cell.rows
    cols = view.width_px // view.cell.cols
    covered = (
        empty[..., 0].reshape(rows, view.cell.rows, cols, view.cell.cols).mean(axis=(1, 3)) >= 128
    )
    cells = np.argwhere(covered).tolist()
    return {(row, col): sign_cell(_BODY) for row, col in cells}


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
    """Paint a robot into a picture in place, as `draw_robot` does, for a terminal of two colours.

    Each point is black or white: mixed colours would become a pattern, as the greys of the mat do. A white rim
    separates the robot from its surroundings.
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
