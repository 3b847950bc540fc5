"""A robot alone, from above."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import ColorSensorSpec, RobotSpec, SensorSpec, TouchSpec
from tuisim.pictures.scene.mono_robot import draw_mono_robot
from tuisim.pictures.scene.robot import COLORED, GREY, MONO, draw_robot
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import CellPoints, Pixels

_PAPER_RGB: Rgb = (232, 234, 238)
_RIM_MM = 12.0
"""Width of the paper around a robot."""


def draw_portrait(
    robot: RobotSpec,
    size_px: tuple[int, int],
    cell: CellPoints,
    *,
    mono: bool = False,
    grey: bool = False,
) -> Pixels:
    """Return a picture that a robot, heading up, fills; all sensors that have a position are on it.

    Args:
        robot: The robot.
        size_px: Width and height of the picture.
        cell: The points of a cell.
        mono: Whether there is only black and white.
        grey: Whether there are only greys.
    """
    view = _fit_view(robot, *size_px, cell)
    picture = np.empty((view.height_px, view.width_px, 3), np.uint8)
    picture[:] = (255, 255, 255) if mono else _PAPER_RGB
    outline = build_outline(robot)
    if (sonar := robot.ultrasonic) is not None:
        # The outline lacks this sensor, which the world shows by its rays: add it here.
        outline = replace(
            outline, other_sensors_mm=(*outline.other_sensors_mm, (sonar.x_mm, sonar.y_mm))
        )
    pose = Pose(0.0, 0.0, 90.0)
    if mono:
        draw_mono_robot(picture, view, pose, outline, replace(MONO, nose_cells=0.0))
    else:
        # It always heads up, and a nose would cover the sensors at its front.
        draw_robot(picture, view, pose, outline, replace(GREY if grey else COLORED, nose_cells=0.0))
    return picture


def find_part_rgb(sensor: SensorSpec) -> Rgb | None:
    """Return the colour of a sensor in the picture of a robot; None if the picture does not show the sensor."""
    if isinstance(sensor, ColorSensorSpec):
        return COLORED.sensor
    if isinstance(sensor, TouchSpec):
        return COLORED.bumper
    return COLORED.spot if hasattr(sensor, "x_mm") else None


def _fit_view(robot: RobotSpec, width_px: int, height_px: int, cell: CellPoints) -> Viewport:
    """Return the view in which a robot, heading up, fills a picture except for a rim."""
    outline = build_outline(robot)
    bumpers_mm = [y_mm + _RIM_MM for _, y_mm, _ in outline.bumpers_mm]
    front_mm, back_mm = max([outline.front_mm, *bumpers_mm]) + _RIM_MM, outline.back_mm - _RIM_MM
    mm_per_px = max(
        2 * (outline.half_width_mm + _RIM_MM) / width_px,
        (front_mm - back_mm) / (height_px * cell.tall),
    )
    top_mm = (front_mm + back_mm + height_px * mm_per_px * cell.tall) / 2
    return Viewport(width_px, height_px, mm_per_px, -width_px * mm_per_px / 2, top_mm, cell)
