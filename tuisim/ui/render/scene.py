"""The world from above: mat, obstacles, pen trace, rays, robot and ghost in one picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tuisim.core.geometry import Pose, world_point
from tuisim.core.spec import Obstacle, RobotSpec
from tuisim.ui.render.lines import FloatArray, draw_obstacles, draw_rays, trace_pixels
from tuisim.ui.render.mat import MatPictures, Pixels
from tuisim.ui.render.robot import COLORED, GHOST, GREY, GREY_GHOST, RobotShape, draw_robot, shape_of
from tuisim.ui.render.viewport import Viewport

_GHOST_OPACITY = 0.75

PEN_RGB = {
    "red": (215, 0, 0),
    "orange": (255, 135, 0),
    "green": (0, 175, 0),
    "blue": (0, 0, 255),
    "black": (0, 0, 0),
    "white": (255, 255, 255),
    "yellow": (255, 215, 0),
    "purple": (135, 0, 175),
}
"""Pen colours by name; `#rrggbb` works too."""


@dataclass(frozen=True, slots=True)
class SceneState:
    """What is on the mat at one moment."""

    robot: RobotSpec
    pose: Pose
    obstacles: tuple[Obstacle, ...] = ()
    rays: tuple[tuple[float, float], ...] = ()
    """(world angle in degrees, length in mm); empty to draw none."""
    rays_from: Pose | None = None
    """Where the robot was when `rays` were cast; None for `pose`."""
    ghost: Pose | None = None
    """A second robot, shown where it was read."""


def pen_rgb(name: str) -> tuple[int, int, int]:
    """Return the colour of a pen: a name of `PEN_RGB` or `#rrggbb`; red for anything else."""
    if name.startswith("#") and len(name) == 7:
        try:
            value = int(name[1:], 16)
        except ValueError:
            return PEN_RGB["red"]
        return value >> 16, value >> 8 & 255, value & 255
    return PEN_RGB.get(name.lower(), PEN_RGB["red"])


class ScenePainter:
    """Draws one field. What stays from frame to frame is drawn once and kept.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat.
        grey: Draw the robot for a terminal without colours.
    """

    def __init__(self, mat: Pixels, outside_rgb: tuple[int, int, int], grey: bool = False) -> None:
        self._mat = MatPictures(mat, outside_rgb)
        self._robot_colors = GREY if grey else COLORED
        self._ghost_colors = GREY_GHOST if grey else GHOST
        self._trace: list[tuple[FloatArray, FloatArray]] = []
        self._ground: Pixels | None = None
        self._ground_key: object = None
        self._traces_drawn = 0
        self._shape: tuple[RobotSpec, RobotShape] | None = None

    def extend_trace(self, xs_mm: FloatArray, ys_mm: FloatArray) -> None:
        """Add points that the pen has drawn, joined to the last ones; NaN lifts the pen."""
        if self._trace and len(xs_mm):
            last_x, last_y = self._trace[-1]
            xs_mm, ys_mm = np.concatenate((last_x[-1:], xs_mm)), np.concatenate((last_y[-1:], ys_mm))
        if len(xs_mm):
            self._trace.append((xs_mm, ys_mm))

    def clear_trace(self) -> None:
        """Forget what the pen has drawn."""
        self._trace.clear()
        self._ground_key = None

    def paint(self, view: Viewport, scene: SceneState) -> Pixels:
        """Return the picture, shape (view.height_px, view.width_px, 3)."""
        picture = self._ground_picture(view, scene).copy()
        shape = self._shape_of(scene.robot)
        if scene.rays and scene.robot.ultrasonic is not None:
            sonar = scene.robot.ultrasonic
            x_mm, y_mm = world_point(scene.rays_from or scene.pose, sonar.x_mm, sonar.y_mm)
            draw_rays(picture, view, x_mm, y_mm, scene.rays)
        if scene.ghost is not None:
            draw_robot(picture, view, scene.ghost, shape, self._ghost_colors, _GHOST_OPACITY)
        draw_robot(picture, view, scene.pose, shape, self._robot_colors)
        return picture

    def _ground_picture(self, view: Viewport, scene: SceneState) -> Pixels:
        """Return mat, obstacles and trace."""
        pen = scene.robot.pen
        key = (view, scene.obstacles, pen.color, pen.width_mm)
        if self._ground is None or self._ground_key != key:
            self._ground = self._mat.picture(view).copy()
            draw_obstacles(self._ground, view, scene.obstacles)
            self._ground_key = key
            self._traces_drawn = 0
            self._join_trace()
        for xs_mm, ys_mm in self._trace[self._traces_drawn :]:
            rows, cols = trace_pixels(view, xs_mm, ys_mm, pen.width_mm)
            self._ground[rows, cols] = pen_rgb(pen.color)
        self._traces_drawn = len(self._trace)
        return self._ground

    def _join_trace(self) -> None:
        """Make one piece of the trace, so that drawing it anew is one step."""
        if len(self._trace) > 1:
            xs, ys = zip(*self._trace, strict=True)
            self._trace = [(np.concatenate(xs), np.concatenate(ys))]

    def _shape_of(self, robot: RobotSpec) -> RobotShape:
        if self._shape is None or self._shape[0] is not robot:
            self._shape = robot, shape_of(robot)
        return self._shape[1]
