"""Whole pictures of the world of a run for files, notebooks and reports: as the app draws it, in a frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.sensors.touch import pressed
from tuisim.engine.core.sensors.ultrasonic import measure_rays_mm
from tuisim.engine.core.spec import PenSpec, RobotSpec, RunSpec
from tuisim.pictures.scene.painter import FRAME_PX, ScenePainter, SceneState
from tuisim.pictures.scene.pen import PenTrace, Piece
from tuisim.pictures.scene.robot import measure_reach_mm
from tuisim.pictures.scene.view import FIELD, Area, Viewport
from tuisim.terminal.pixels import Pixels

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PIL.Image import Image

    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.engine.runs.views import TickRecord

MM_PER_PX = 3
"""Scale of the picture of a run."""
_MAX_OFF_MM = 2 * FIELD.size_mm[0]
"""What is farther from the field is not shown: the field would be too small."""

RIM_RGB: Rgb = (232, 234, 238)
"""Colour around the field."""


def find_area(records: NDArray[Any]) -> Area:
    """Return the area that a picture of a run shows: the field, extended to where the robot has been.

    The area ends at most `_MAX_OFF_MM` beyond the field.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`.
    """
    if not len(records):
        return FIELD
    xs_mm, ys_mm = (
        np.clip(np.nan_to_num(records[key]), -_MAX_OFF_MM, side_mm + _MAX_OFF_MM)
        for key, side_mm in zip(("x_mm", "y_mm"), FIELD.size_mm, strict=True)
    )
    return Area(
        min(FIELD.left, float(xs_mm.min())),
        min(FIELD.lower, float(ys_mm.min())),
        max(FIELD.right, float(xs_mm.max())),
        max(FIELD.upper, float(ys_mm.max())),
    )


def build_world_view(
    robot: RobotSpec, mm_per_px: float = MM_PER_PX, area: Area = FIELD
) -> Viewport:
    """Return a view of an area that shows the whole robot wherever its axle is inside the area."""
    # The field is no multiple of three mm wide: the rest of the last column is left out.
    width_px, height_px = (max(int(side_mm / mm_per_px), 1) for side_mm in area.size_mm)
    rim_px = math.ceil(measure_reach_mm(build_outline(robot)) / mm_per_px) + FRAME_PX
    left_mm, top_mm = area.left - rim_px * mm_per_px, area.upper + rim_px * mm_per_px
    return Viewport(width_px + 2 * rim_px, height_px + 2 * rim_px, mm_per_px, left_mm, top_mm)


def find_view(spec: RunSpec, area: Area = FIELD) -> Viewport:
    """Return the view of the picture that `draw_world` makes.

    A larger area has a smaller scale, so that pictures have similar sizes.
    """
    larger = max(
        side_mm / field_mm for side_mm, field_mm in zip(area.size_mm, FIELD.size_mm, strict=True)
    )
    return build_world_view(spec.robot, MM_PER_PX * larger, area)


def find_end_view(run: StoredRun) -> Viewport:
    """Return the view of the picture that `draw_end` makes."""
    return find_view(run.spec, find_area(run.telemetry.array()))


def fit_view(robot: RobotSpec, width_px: int, height_px: int, area: Area = FIELD) -> Viewport:
    """Return the view of an area that `build_world_view` returns, as large as fits into a picture of a given size."""
    reach_mm = measure_reach_mm(build_outline(robot))
    # The rim is rounded up to whole pixels on both sides.
    sides = zip(area.size_mm, (width_px, height_px), strict=True)
    mm_per_px = max(
        (side_mm + 2 * reach_mm) / max(side_px - 2 * (FRAME_PX + 1), 1)
        for side_mm, side_px in sides
    )
    return build_world_view(robot, mm_per_px, area)


def build_scene(spec: RunSpec, pose: Pose | None, *, rays: bool = False) -> SceneState:
    """Return the objects on the field of a run, in the form in which they are drawn.

    Args:
        spec: The run.
        pose: Where the robot is; None for no robot.
        rays: Whether to draw the rays of the ultrasonic sensor.
    """
    robot = spec.robot
    world = spec.world
    start = pose or spec.world.start
    sensor = robot.ultrasonic if rays and pose else None
    return SceneState(
        robot,
        start,
        world.obstacles,
        tuple(measure_rays_mm(start, sensor, world)) if sensor else (),
        pressed=tuple(
            not touch.pressed_by and pressed(start, touch, world) for touch in robot.touch_sensors
        ),
        beacon=world.beacon,
        has_robot=pose is not None,
    )


def build_painter(
    mat: Pixels, traces: Sequence[Piece] = (), *, has_floor: bool = False
) -> ScenePainter:
    """Return a painter that draws a field with pen traces on it, for pictures in files."""
    trace = PenTrace()
    for piece in traces:
        trace.add(piece.lift())
    return ScenePainter(mat, RIM_RGB, trace, for_file=True, has_floor=has_floor)


def draw_world(
    spec: RunSpec,
    mat: Pixels,
    pose: Pose | None = None,
    traces: Sequence[Piece] = (),
    *,
    rays: bool = False,
    area: Area = FIELD,
) -> Image:
    """Return a picture of mat, obstacles, pen traces and robot.

    Args:
        spec: The run.
        mat: Shape (height, width, 3), rows from the top.
        pose: Where the robot is, by default at its start.
        traces: The pen traces.
        rays: Whether to draw the rays of the ultrasonic sensor.
        area: The part of the world to show.

    Returns:
        The picture, in the size of `find_view`; `info["extent_mm"]` has its edges.
    """
    from PIL import Image

    scene = build_scene(spec, pose or spec.world.start, rays=rays)
    painter = build_painter(mat, traces, has_floor=spec.world.is_open)
    view = find_view(spec, area)
    image = Image.fromarray(painter.paint(view, scene))
    image.info["extent_mm"] = view.extent_mm
    return image


def read_pose(record: TickRecord | None) -> Pose | None:
    """Return the robot's pose in a record; None for no record, or a damaged one without a valid pose."""
    valid = record is not None and math.isfinite(record.x_mm + record.y_mm + record.heading_deg)
    return record.pose if record is not None and valid else None


def draw_end(run: StoredRun) -> Image:
    """Return the picture of the world at the end of a run, or at the latest tick of a run that goes on.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """

    last = run.telemetry.last()
    records = run.telemetry.array()
    mat = run.find_mat_files().read_pixels()
    trace = Piece.from_run(run.spec, records)
    return draw_world(run.spec, mat, read_pose(last), (trace,), area=find_area(records))


_PATH = PenSpec(color="red", width_mm=12.0)
_MAX_PATH_POINTS = 2000


def draw_path(run: StoredRun, port: Viewport, outside_rgb: Rgb) -> Pixels:
    """Return a small picture of the path of a run on its mat, in the size of a view.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """

    records = run.telemetry.array()
    some = records[:: max(1, len(records) // _MAX_PATH_POINTS)]
    trace = PenTrace()
    trace.add(Piece.from_points(some["x_mm"].astype(float), some["y_mm"].astype(float), _PATH))
    mat = run.find_mat_files().read_pixels()
    has_floor = run.spec.world.is_open
    painter = ScenePainter(mat, outside_rgb, trace, has_floor=has_floor)
    area = find_area(records)
    if area != FIELD:
        port = Viewport.fit_field(port.width_px, port.height_px, port.cell, area)
    return painter.paint(port, build_scene(run.spec, None))
