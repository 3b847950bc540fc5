"""Whole pictures of the world of a run for files, notebooks and reports: as the app draws it, in a frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tuisim.core.css_colors import Rgb
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.sensors.touch import pressed
from tuisim.core.sensors.ultrasonic import rays_mm
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, PenSpec, RobotSpec, RunSpec
from tuisim.scene.painter import FRAME_PX, ScenePainter, SceneState
from tuisim.scene.pen import PenTrace, Piece, pen_trace
from tuisim.scene.robot import drawn_reach_mm
from tuisim.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

    from tuisim.runs.run_folder import StoredRun
    from tuisim.runs.views import TickRecord

MM_PER_PX = 3
"""Scale of the picture of a run."""

RIM_RGB: Rgb = (232, 234, 238)
"""Around the field."""


def world_view(robot: RobotSpec, mm_per_px: float = MM_PER_PX) -> Viewport:
    """Return an area in which a robot is completely visible while its axle is on the field."""
    width_px, height_px = _field_px(mm_per_px)
    rim_px = math.ceil(drawn_reach_mm(outline_of(robot)) / mm_per_px) + FRAME_PX
    rim_mm = rim_px * mm_per_px
    return Viewport(
        width_px + 2 * rim_px, height_px + 2 * rim_px, mm_per_px, -rim_mm, FIELD_HEIGHT_MM + rim_mm
    )


def _field_px(mm_per_px: float) -> tuple[int, int]:
    # The field is no multiple of three mm wide: the rest of the last column is left out.
    return max(int(FIELD_WIDTH_MM / mm_per_px), 1), max(int(FIELD_HEIGHT_MM / mm_per_px), 1)


def fitting_view(robot: RobotSpec, width_px: int, height_px: int) -> Viewport:
    """Return the view of `world_view` in the largest scale that fits a size."""
    reach_mm = drawn_reach_mm(outline_of(robot))
    # The rim is rounded up to whole pixels on both sides.
    sides = ((FIELD_WIDTH_MM, width_px), (FIELD_HEIGHT_MM, height_px))
    mm_per_px = max(
        (side_mm + 2 * reach_mm) / max(side_px - 2 * (FRAME_PX + 1), 1)
        for side_mm, side_px in sides
    )
    return world_view(robot, mm_per_px)


def scene_of(spec: RunSpec, pose: Pose | None, *, rays: bool = False) -> SceneState:
    """Return what is on the field of a run.

    Args:
        pose: Where the robot is; None for no robot.
        rays: Whether the rays of the ultrasonic sensor are seen.
    """
    robot, world, at = spec.robot, spec.world, pose or spec.world.start
    sensor = robot.ultrasonic if rays and pose else None
    return SceneState(
        robot,
        at,
        world.obstacles,
        tuple(rays_mm(at, sensor, world)) if sensor else (),
        pressed=tuple(
            not touch.pressed_by and pressed(at, touch, world) for touch in robot.touch_sensors
        ),
        beacon=world.beacon,
        has_robot=pose is not None,
    )


def world_painter(mat: Pixels, traces: Sequence[Piece] = ()) -> ScenePainter:
    """Return what draws a field for files, with pen traces on it."""
    trace = PenTrace()
    for piece in traces:
        trace.add(piece.apart())
    return ScenePainter(mat, RIM_RGB, trace, for_file=True)


def world_picture(
    spec: RunSpec,
    mat: Pixels,
    pose: Pose | None = None,
    traces: Sequence[Piece] = (),
    *,
    rays: bool = False,
) -> Image:
    """Return mat, obstacles, pen traces and robot.

    Args:
        mat: Shape (height, width, 3), rows from the top.
        pose: Where the robot is, by default at its start.
        rays: Whether to draw the rays of the ultrasonic sensor.

    Returns:
        The picture, in the size of `world_view`.
    """
    from PIL import Image

    scene = scene_of(spec, pose or spec.world.start, rays=rays)
    return Image.fromarray(world_painter(mat, traces).paint(world_view(spec.robot), scene))


def sound_pose(record: TickRecord | None) -> Pose | None:
    """Return the pose of a record; None without one, and for a damaged record, which may have no valid pose."""
    valid = record is not None and math.isfinite(record.x_mm + record.y_mm + record.heading_deg)
    return record.pose if record is not None and valid else None


def world_at_end(run: StoredRun) -> Image:
    """Return the world at the end of a run, or at the latest tick of a running one, as a Pillow image.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """
    from tuisim.config.mat_cache import mat_pixels
    from tuisim.runs.run_folder import mat_files

    last, trace = run.telemetry.last(), pen_trace(run.spec, run.telemetry.array())
    return world_picture(run.spec, mat_pixels(mat_files(run)), sound_pose(last), (trace,))


_PATH = PenSpec(color="red", width_mm=12.0)
_MOST_PATH_POINTS = 2000


def path_picture(run: StoredRun, port: Viewport, outside_rgb: Rgb) -> Pixels:
    """Return a small picture of the way of a run on its mat, in the size of a view.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """
    from tuisim.config.mat_cache import mat_pixels
    from tuisim.runs.run_folder import mat_files

    records = run.telemetry.array()
    some = records[:: max(1, len(records) // _MOST_PATH_POINTS)]
    trace = PenTrace()
    trace.add(Piece.of(some["x_mm"].astype(float), some["y_mm"].astype(float), _PATH))
    painter = ScenePainter(mat_pixels(mat_files(run)), outside_rgb, trace)
    return painter.paint(port, scene_of(run.spec, None))
