"""A robot that has left the field: words for where it is, and an arrow at the edge of the picture towards it."""

from __future__ import annotations

import math

import numpy as np

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

_ARROW_CELLS = 4.0
"""Length of the arrow, in widths of a cell."""


def describe_off_field(pose: Pose, width: int = 80) -> str:
    """Return in words how far a robot's middle is off the field, and on which side; empty if it is on the field.

    Args:
        pose: Pose of the robot.
        width: Letters that there is room for.
    """
    sides = (
        (-pose.x_mm, "to the left"),
        (pose.x_mm - FIELD_WIDTH_MM, "to the right"),
        (pose.y_mm - FIELD_HEIGHT_MM, "above"),
        (-pose.y_mm, "below"),
    )
    words = ", ".join(f"{away_mm:.0f} mm {side}" for away_mm, side in sides if away_mm > 0)
    if not words:
        return ""
    brief = words.replace("to the ", "")
    tellings = (
        f"robot off the mat: {words}",
        f"robot off the mat: {brief}",
        f"off the mat: {brief}",
        brief,
    )
    return next((telling for telling in tellings if len(telling) <= width), brief)


def draw_arrow(picture: Pixels, view: Viewport, pose: Pose, reach_px: float, rgb: Rgb) -> None:
    """Paint an arrow at the edge of a picture that points to a robot, if no part of the robot is in the picture.

    Args:
        picture: Written in place, shape (view.height_px, view.width_px, 3).
        view: What the picture shows.
        pose: Pose of the robot.
        reach_px: How far the robot reaches around its pose, in widths of a pixel.
        rgb: Colour of the arrow.
    """
    at_col, at_row = view.to_px(pose.x_mm, pose.y_mm)
    tip_col, tip_row = min(max(at_col, 0), view.width_px), min(max(at_row, 0), view.height_px)
    # Pixels may be taller than wide.
    right = at_col - tip_col
    down = (at_row - tip_row) * view.cell.tall
    away = math.hypot(right, down)
    if away <= reach_px:
        return
    length = _ARROW_CELLS * view.cell.cols
    cols = tip_col - (np.arange(view.width_px) + 0.5)[None, :]
    rows = (tip_row - (np.arange(view.height_px) + 0.5)[:, None]) * view.cell.tall
    behind = (cols * right + rows * down) / away
    aside = np.abs(cols * down - rows * right) / away
    picture[(behind >= 0) & (behind <= length) & (aside <= behind * 0.6 + 0.5)] = rgb
