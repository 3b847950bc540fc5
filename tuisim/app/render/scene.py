"""The world from above: mat, obstacles, pen trace, rays, robot and ghost in one picture."""

from __future__ import annotations

from dataclasses import dataclass

from tuisim.app.render.field import draw_beacon, draw_obstacles, draw_rays, trace_pixels
from tuisim.app.render.mat import MatPictures, Pixels
from tuisim.app.render.pen_trace import PenTrace
from tuisim.app.render.viewport import Viewport
from tuisim.charts.world_image import COLORED, GHOST, GREY, GREY_GHOST, draw_robot
from tuisim.core.css_colors import Rgb
from tuisim.core.geometry import Pose, world_point
from tuisim.core.outline import outline_of
from tuisim.core.parts import BeaconSpec
from tuisim.core.spec import Obstacle, RobotSpec

_GHOST_OPACITY = 0.75


@dataclass(frozen=True, slots=True)
class SceneState:
    """The objects on the mat at one moment."""

    robot: RobotSpec
    pose: Pose
    obstacles: tuple[Obstacle, ...] = ()
    rays: tuple[tuple[float, float], ...] = ()
    """(world angle in degrees, length in mm); empty to draw none."""
    rays_from: Pose | None = None
    """Pose of the robot when `rays` were cast; None for `pose`."""
    ghost: Pose | None = None
    """Pose of a second, translucent robot."""
    marked: int | None = None
    """Index of the selected obstacle."""
    pressed: tuple[bool, ...] = ()
    """Whether each touch sensor is pressed; empty for none."""
    beacon: BeaconSpec | None = None
    """The infrared beacon on the field."""


class ScenePainter:
    """Draws one field. Caches what stays the same from frame to frame.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat.
        trace: The pen trace; it may grow, and be replaced.
        grey: Draw the robot for a terminal without colours.
    """

    def __init__(self, mat: Pixels, outside_rgb: Rgb, trace: PenTrace, grey: bool = False) -> None:
        self.trace = trace
        self._mat = MatPictures(mat, outside_rgb)
        self._robot_colors = GREY if grey else COLORED
        self._ghost_colors = GREY_GHOST if grey else GHOST
        self._ground: Pixels | None = None
        self._ground_key: object = None
        self._pieces_drawn = 0

    def paint(self, view: Viewport, scene: SceneState) -> Pixels:
        """Return the picture, shape (view.height_px, view.width_px, 3)."""
        picture = self._ground_picture(view, scene).copy()
        outline = outline_of(scene.robot)
        if scene.rays and scene.robot.ultrasonic is not None:
            ultrasonic = scene.robot.ultrasonic
            x_mm, y_mm = world_point(scene.rays_from or scene.pose, ultrasonic.x_mm, ultrasonic.y_mm)
            draw_rays(picture, view, x_mm, y_mm, scene.rays)
        if scene.ghost is not None:
            draw_robot(picture, view, scene.ghost, outline, self._ghost_colors, _GHOST_OPACITY)
        draw_robot(picture, view, scene.pose, outline, self._robot_colors, pressed=scene.pressed)
        return picture

    def _ground_picture(self, view: Viewport, scene: SceneState) -> Pixels:
        """Return mat, obstacles, beacon and trace."""
        key = (view, scene.obstacles, scene.marked, scene.beacon, self.trace, self.trace.wiped)
        if self._ground is None or self._ground_key != key:
            self._ground = self._mat.picture(view).copy()
            draw_obstacles(self._ground, view, scene.obstacles, scene.marked)
            if scene.beacon is not None:
                draw_beacon(self._ground, view, scene.beacon.x_mm, scene.beacon.y_mm)
            self._ground_key = key
            self._pieces_drawn = 0
            self.trace.join()
        for piece in self.trace.pieces(self._pieces_drawn):
            rows, cols = trace_pixels(view, piece.xs_mm, piece.ys_mm, piece.width_mm)
            self._ground[rows, cols] = piece.rgb
        self._pieces_drawn = len(self.trace)
        return self._ground
