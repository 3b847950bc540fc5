"""The world from above: mat, obstacles, pen trace, rays, robots in one picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.field import find_floor_rgb
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.remote_spec import BeaconSpec
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle, RobotSpec
from tuisim.pictures.scene.mat import MatPictures
from tuisim.pictures.scene.mono_robot import draw_mono_robot
from tuisim.pictures.scene.off_field import draw_arrow
from tuisim.pictures.scene.pen import PenTrace, choose_pen_rgb, trace_pixels
from tuisim.pictures.scene.robot import (
    CLEARED,
    COLORED,
    EARLIER,
    GHOST,
    GREY,
    GREY_GHOST,
    MONO,
    choose_scale,
    draw_robot,
    measure_reach_mm,
)
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

GRID_MM = (100, 200, 500, 1000, 2000, 5000)
"""Distances of the lines of the grid."""
_MIN_CELLS = 8
"""Minimum distance of the lines of the grid, in cells."""
_FAINT = 0.07
"""Share by which the lines of the grid are nearer to black or white than the floor is."""


def find_mat_floor_rgb(mat: Pixels) -> Rgb:
    """Return the colour of the floor around a mat, which is the colour of the mat's edges.

    Args:
        mat: Shape (height, width, 3).
    """
    height_px, width_px = mat.shape[:2]
    return find_floor_rgb(width_px, height_px, memoryview(mat.tobytes()))


def find_grid_rgb(floor_rgb: Rgb) -> Rgb:
    """Return the colour of the grid on a floor: a little darker than the floor, or lighter on a dark floor."""
    towards = 0 if sum(floor_rgb) > 3 * 127 else 255
    red, green, blue = (round(value + (towards - value) * _FAINT) for value in floor_rgb)
    return red, green, blue


def find_field_pixels(view: Viewport) -> tuple[int, int, int, int]:
    """Return the left, upper, right and lower edge of the field in pixels of a picture; a negative edge becomes 0."""
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


_GHOST_OPACITY, _EARLIER_OPACITY = 0.75, 0.6


class Faint(StrEnum):
    """Why a robot is drawn translucently: it is that of another run, or this robot at another time."""

    BESIDE = "beside"
    """The robot of another run, which is shown beside this one."""
    NOW = "now"
    """Where the robot is now, while a past instant is in view."""


@dataclass(frozen=True, slots=True)
class SceneState:
    """The objects on the mat at one instant, in the form in which they are drawn."""

    robot: RobotSpec
    pose: Pose
    obstacles: tuple[Obstacle, ...] = ()
    rays: tuple[tuple[float, float], ...] = ()
    """The ultrasonic rays, as (world angle in degrees, length in mm); empty to draw none."""
    rays_from: Pose | None = None
    """Pose of the robot when `rays` were cast; None for `pose`."""
    faint: tuple[tuple[Faint, Pose], ...] = ()
    """Translucent robots below the robot, the lowest first."""
    marked: int | None = None
    """Index of the selected obstacle."""
    pressed: tuple[bool, ...] = ()
    """Whether each touch sensor is pressed; empty for none."""
    beacon: BeaconSpec | None = None
    """The infrared beacon on the field."""
    has_robot: bool = True
    """Whether the robot is drawn; a damaged recording may have no valid pose."""


class ScenePainter:
    """Draws the field with all objects on it; stores the parts that stay the same from frame to frame.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat, unless `has_floor`.
        trace: The pen trace; it may grow, and be replaced.
        grey: Draw for a terminal with greys only.
        mono: Draw for a terminal without any colours.
        coarse: Draw the robot with few details, for glyphs that show less than the points of their cells.
        whole_cells: End the mat where a cell ends, for glyphs that do not fill their cells.
        for_file: Draw for a file: the mat unchanged, and a frame around it.
        has_floor: Whether the mat lies on a floor in the colour of its edges.
    """

    def __init__(
        self,
        mat: Pixels,
        outside_rgb: Rgb,
        trace: PenTrace,
        grey: bool = False,
        mono: bool = False,
        coarse: bool = False,
        whole_cells: bool = False,
        for_file: bool = False,
        has_floor: bool = False,
    ) -> None:
        self.trace = trace
        self._grid_rgb = None
        if has_floor:
            outside_rgb = find_mat_floor_rgb(mat)
            self._grid_rgb = None if mono else find_grid_rgb(outside_rgb)
        self._mat = MatPictures(mat, outside_rgb, whole_cells, exact=for_file)
        self._is_for_file = for_file
        self._has_frame = for_file or (not mono and min(outside_rgb) >= _LIGHT)
        without_colors = CLEARED if coarse else MONO
        if mono:
            self._robot_colors = without_colors
        elif grey:
            self._robot_colors = GREY
        else:
            self._robot_colors = COLORED
        self._grey = grey or mono
        self._mono = mono
        self._detail_cols = 1 if coarse else None
        self._faint = {
            Faint.BESIDE: (EARLIER, _EARLIER_OPACITY),
            Faint.NOW: (GREY_GHOST if grey else GHOST, _GHOST_OPACITY),
        }
        self._ground: Pixels | None = None
        self._ground_key: object = None
        self._pieces_drawn = 0

    def paint(self, view: Viewport, scene: SceneState) -> Pixels:
        """Return the picture of the field in a view, shape (view.height_px, view.width_px, 3)."""
        picture = self._draw_ground(view, scene).copy()
        outline = build_outline(scene.robot)
        if scene.rays and scene.robot.ultrasonic is not None:
            ultrasonic = scene.robot.ultrasonic
            x_mm, y_mm = world_point(
                scene.rays_from or scene.pose, ultrasonic.x_mm, ultrasonic.y_mm
            )
            draw_rays(picture, view, x_mm, y_mm, scene.rays, self._grey, is_solid=self._is_for_file)
        for kind, pose in scene.faint:
            colors, opacity = self._faint[kind]
            draw_robot(picture, view, pose, outline, colors, opacity, detail_cols=self._detail_cols)
        draw = draw_mono_robot if self._mono else draw_robot
        if scene.has_robot:
            draw(
                picture,
                view,
                scene.pose,
                outline,
                self._robot_colors,
                pressed=scene.pressed,
                detail_cols=self._detail_cols,
            )
            reach_px = measure_reach_mm(outline) * choose_scale(outline, view) / view.mm_per_px
            draw_arrow(
                picture,
                view,
                scene.pose,
                reach_px,
                (0, 0, 0) if self._mono else self._robot_colors.body,
            )
        return picture

    def _draw_ground(self, view: Viewport, scene: SceneState) -> Pixels:
        key = (view, scene.obstacles, scene.marked, scene.beacon, self.trace, self.trace.clears)
        if self._ground is None or self._ground_key != key:
            self._ground = self._mat.picture(view).copy()
            if self._grid_rgb is not None:
                draw_grid(self._ground, view, self._grid_rgb)
            if self._has_frame:
                if self._is_for_file:
                    draw_frame(self._ground, view)
                else:
                    draw_frame(self._ground, view, 1, _SOFT_FRAME_RGB)
            draw_obstacles(self._ground, view, scene.obstacles, scene.marked)
            if scene.beacon is not None:
                draw_beacon(self._ground, view, scene.beacon.x_mm, scene.beacon.y_mm)
            self._ground_key = key
            self._pieces_drawn = 0
            self.trace.join()
        for piece in self.trace.iterate_pieces(self._pieces_drawn):
            rows, cols = trace_pixels(view, piece.xs_mm, piece.ys_mm, piece.width_mm)
            self._ground[rows, cols] = choose_pen_rgb(
                self._find_pen_ground(view)[rows, cols], piece.rgb, self._grey
            )
        self._pieces_drawn = len(self.trace)
        return self._ground

    def _find_pen_ground(self, view: Viewport) -> Pixels:
        """Return the picture of the mat without the pen trace, on which the whole trace can be drawn again."""
        return self._mat.picture(view)


OBSTACLE_RGB = (175, 95, 0)
OBSTACLE_EDGE_RGB = (135, 0, 0)
MARKED_RGB = (255, 215, 0)
"""Edge of the selected obstacle."""
RAY_RGB = (0, 175, 175)
_RAY_OPACITY = 0.55
BEACON_RGB = (215, 0, 135)
BEACON_CORE_RGB = (255, 255, 255)
_BEACON_MM = 25.0
"""Radius of a beacon."""

FRAME_PX = 2
_LIGHT = 180
"""Brightness of a ground from which on the edge of a white mat would not be visible without a frame."""
_FRAME_RGB = (70, 74, 82)
_SOFT_FRAME_RGB = (168, 172, 178)
"""In the cells of a screen, where a dark line of one cell looks like a wall."""


def draw_frame(
    picture: Pixels, view: Viewport, width_px: int = FRAME_PX, rgb: Rgb = _FRAME_RGB
) -> None:
    """Paint a frame around the field into a picture, in place."""
    left, top, right, low = find_field_pixels(view)
    if not (right and low):
        # The field is not in view: the view has followed a robot off it.
        return
    rows = slice(max(top - width_px, 0), low + width_px)
    cols = slice(max(left - width_px, 0), right + width_px)
    inside = picture[top:low, left:right].copy()
    picture[rows, cols] = rgb
    picture[top:low, left:right] = inside


def draw_rays(
    picture: Pixels,
    view: Viewport,
    x_mm: float,
    y_mm: float,
    rays: Sequence[tuple[float, float]],
    grey: bool = False,
    *,
    is_solid: bool = False,
) -> None:
    """Paint the part of ultrasonic rays that is on the field into a picture.

    Args:
        picture: Modified in place.
        view: The visible part of the field.
        x_mm: World x of the sensor.
        y_mm: World y of the sensor.
        rays: (world angle in degrees, length in mm) each.
        grey: Whether the terminal shows only brightness.
        is_solid: Whether the rays hide the picture below them: the thin lines of a file would hardly be visible on
            white.
    """
    col, row = view.to_px(x_mm, y_mm)
    low_col, low_row = (round(edge) for edge in view.to_px(0.0, FIELD_HEIGHT_MM))
    high_col, high_row = (round(edge) for edge in view.to_px(FIELD_WIDTH_MM, 0.0))
    low_col, low_row = max(low_col, 0), max(low_row, 0)
    high_col, high_row = min(high_col, view.width_px), min(high_row, view.height_px)
    angles = np.radians([angle for angle, _ in rays])
    lengths_mm = np.array([length for _, length in rays])
    across = np.cos(angles) / view.mm_per_px
    down = np.sin(angles) / view.mm_per_row
    # One sample for each step along the longer axis: an even line without doubled pixels.
    step_mm = 1 / np.maximum(np.abs(across), np.abs(down))
    along_mm = np.arange(math.ceil((lengths_mm / step_mm).max())) * step_mm[:, None]
    cols = np.floor(col + along_mm * across[:, None]).astype(np.intp)
    rows = np.floor(row - along_mm * down[:, None]).astype(np.intp)
    inside = (cols >= low_col) & (cols < high_col) & (rows >= low_row) & (rows < high_row)
    inside &= along_mm < lengths_mm[:, None]
    covered = np.zeros(picture.shape[0] * picture.shape[1], bool)
    covered[rows[inside] * picture.shape[1] + cols[inside]] = True
    covered_at = np.flatnonzero(covered)
    pixels = picture.reshape(-1, 3)
    below = pixels[covered_at]
    opacity = 1.0 if grey or is_solid else _RAY_OPACITY
    mixed = below * (1 - opacity) + choose_pen_rgb(below, RAY_RGB, grey) * opacity
    pixels[covered_at] = np.rint(mixed).astype(np.uint8)


def draw_obstacles(
    picture: Pixels, view: Viewport, obstacles: Sequence[Obstacle], marked: int | None = None
) -> None:
    """Paint obstacles into a picture, each at least one pixel wide and high.

    Args:
        picture: Modified in place.
        view: The visible part of the field.
        obstacles: The boxes.
        marked: Index of the selected one.
    """
    for index, box in enumerate(obstacles):
        left, bottom = view.to_px(box.x_mm, box.y_mm)
        right, top = view.to_px(box.x_mm + box.width_mm, box.y_mm + box.height_mm)
        rows = _find_span(top, bottom, view.height_px)
        cols = _find_span(left, right, view.width_px)
        picture[rows, cols] = MARKED_RGB if index == marked else OBSTACLE_EDGE_RGB
        if rows.stop - rows.start > 2 and cols.stop - cols.start > 2:
            picture[rows.start + 1 : rows.stop - 1, cols.start + 1 : cols.stop - 1] = OBSTACLE_RGB


def draw_beacon(picture: Pixels, view: Viewport, x_mm: float, y_mm: float) -> None:
    """Paint an infrared beacon into a picture: a disc with a light core, at least three pixels wide.

    Args:
        picture: Modified in place.
        view: The visible part of the field.
        x_mm: World x of its centre.
        y_mm: World y of its centre.
    """
    col, row = (math.floor(position) for position in view.to_px(x_mm, y_mm))
    radius = max(1, round(_BEACON_MM / view.mm_per_px))
    tall = view.mm_per_row / view.mm_per_px
    aside = np.arange(-radius, radius + 1)
    away = np.hypot(aside[:, None] * tall, aside[None, :])
    rows, cols = np.nonzero(away <= radius + 0.5)
    light = away[rows, cols] <= radius / 3
    rows = rows + row - radius
    cols = cols + col - radius
    inside = (rows >= 0) & (rows < view.height_px) & (cols >= 0) & (cols < view.width_px)
    shades = np.where(
        light[:, None], np.array(BEACON_CORE_RGB, np.uint8), np.array(BEACON_RGB, np.uint8)
    )
    picture[rows[inside], cols[inside]] = shades[inside]


def _find_span(low: float, high: float, size_px: int) -> slice:
    first = round(low)
    return slice(min(max(first, 0), size_px), min(max(round(high), first + 1, 0), size_px))
