"""The world from above: the robot in every picture, and whole pictures for files, notebooks and reports."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tuisim.core.css_colors import Rgb, css_rgb
from tuisim.core.field import disc_mask
from tuisim.core.geometry import Pose, world_point
from tuisim.core.outline import RobotOutline, outline_of
from tuisim.core.sensors.ultrasonic import rays_mm
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, ColorSensorSpec, RobotSpec, RunSpec
from tuisim.core.tick_record import FLAG_PEN_DOWN
from tuisim.runs.arrays import FloatArray, world_points_mm
from tuisim.terminal.pixels import SQUARE, CellPoints, Pixels

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

    from tuisim.runs.run_folder import StoredRun
    from tuisim.runs.views import TickRecord

_SAMPLES = (4, 8)
"""Samples across and down a character cell."""

_MIN_CELLS = 6.0
"""A robot narrower than this many cells is drawn enlarged, to be recognisable."""

_FEW_PX = {1: 8.0, 2: 18.0}
"""By the pixels across a cell: in a robot narrower than this many pixels the heading marker needs to project beyond
the body."""
_NOSE_PX = {1: 1.2, 2: 2.5}
"""How far it projects."""
_THIN_PX = {1: 0.4, 2: 0.7}
"""Half of its width at the tip: in two colours a cell, less of it is lost in what is behind."""

_BUMPER_MM = 8.0
"""Thickness of the bar of a touch sensor."""

_SPOT_MM = 10.0
"""Radius of a further sensor."""

_NONE, _EDGE, _BODY, _WHEEL, _SENSOR, _MARKER, _BUMPER, _PRESSED, _SPOT = range(9)


@dataclass(frozen=True, slots=True)
class Viewport:
    """A picture of part of the field, in the app of character cells."""

    width_px: int
    height_px: int
    mm_per_px: float
    left_mm: float
    """World x of the left edge of the picture."""
    top_mm: float
    """World y of the top edge of the picture."""
    cell: CellPoints = SQUARE

    @property
    def mm_per_row(self) -> float:
        """The height of a pixel."""
        return self.mm_per_px * self.cell.tall

    def to_px(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Return the picture column and row of a world point; whole numbers are pixel corners."""
        return (x_mm - self.left_mm) / self.mm_per_px, (self.top_mm - y_mm) / self.mm_per_row

    def to_mm(self, col_px: float, row_px: float) -> tuple[float, float]:
        """Return the world point of a picture position."""
        return self.left_mm + col_px * self.mm_per_px, self.top_mm - row_px * self.mm_per_row


@dataclass(frozen=True, slots=True)
class RobotColors:
    """Colours of the parts; the defaults are in every 256-colour palette."""

    edge: Rgb = (255, 255, 255)
    body: Rgb = (0, 95, 215)
    wheel: Rgb = (28, 28, 28)
    sensor: Rgb = (255, 95, 95)
    marker: Rgb = (255, 215, 0)
    bumper: Rgb = (0, 135, 95)
    pressed: Rgb = (255, 0, 0)
    spot: Rgb = (135, 0, 95)
    edge_cells: float = 0.35
    """Width of the edge, as a share of a cell's width."""
    edge_mm: float = 12.0
    """Largest width of the edge."""
    has_marker: bool = True


COLORED = RobotColors()
GREY = RobotColors(
    body=(48, 48, 48), wheel=(0, 0, 0), sensor=(188, 188, 188), marker=(255, 255, 255),
    bumper=(108, 108, 108), pressed=(0, 0, 0), spot=(128, 128, 128),
)  # fmt: skip
"""For a terminal without colours: dark body, white edge and marker, to stand out on any grey."""
MONO = RobotColors(
    edge=(0, 0, 0), body=(255, 255, 255), wheel=(0, 0, 0), sensor=(0, 0, 0), marker=(0, 0, 0), edge_cells=0.6,
    edge_mm=100.0,
)  # fmt: skip
"""For a terminal of two colours: a black arrow on white within a black edge."""
CLEARED = RobotColors((255,) * 3, (255,) * 3, (255,) * 3, (255,) * 3, has_marker=False)
"""For a terminal of two colours and of signs only: a white place for the signs of the robot."""
GHOST = RobotColors(edge=(255, 255, 255), body=(175, 0, 175), wheel=(95, 0, 95), marker=(255, 215, 255))
"""For a robot at an earlier pose."""
GREY_GHOST = RobotColors(body=(158, 158, 158), wheel=(88, 88, 88), sensor=(88, 88, 88), marker=(0, 0, 0))


def drawn_reach_mm(outline: RobotOutline) -> float:
    """Return the radius about a robot's pose of a circle that holds everything that is drawn of it."""
    wheels_mm = math.hypot(outline.half_width_mm, outline.wheel_radius_mm)
    bars_mm = (math.hypot(abs(x) + half, abs(y) + _BUMPER_MM) for x, y, half in outline.bumpers_mm)
    spots_mm = (math.hypot(*spot) + _SPOT_MM for spot in outline.other_sensors_mm)
    return max((outline.reach_mm, wheels_mm, *spots_mm, *bars_mm))


def drawn_scale(outline: RobotOutline, view: Viewport) -> float:
    """Return the factor by which a robot is drawn enlarged, at least 1."""
    return max(1.0, _MIN_CELLS * view.cell.cols * view.mm_per_px / (2 * outline.half_width_mm))


def draw_robot(
    picture: Pixels,
    view: Viewport,
    pose: Pose,
    outline: RobotOutline,
    colors: RobotColors,
    opacity: float = 1.0,
    pressed: tuple[bool, ...] = (),
    detail_cols: int | None = None,
) -> None:
    """Paint a robot into a picture, clipped to it.

    Args:
        picture: Written in place, shape (view.height_px, view.width_px, 3).
        opacity: 0 … 1.
        pressed: Whether each bumper is pressed; empty for none.
        detail_cols: Details are drawn for so many pixels across a cell, 1 or 2; None: for those of the view.
    """
    detail_cols = detail_cols or min(view.cell.cols, 2)
    scale = drawn_scale(outline, view)
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    step_mm, row_mm = view.mm_per_px / scale, view.mm_per_row / scale
    reach_mm = drawn_reach_mm(outline)
    left, right = _around(col, reach_mm / step_mm + 2, view.width_px)
    top, bottom = _around(row, reach_mm / row_mm + 2, view.height_px)
    if left >= right or top >= bottom:
        return
    across, down = (-(-samples // points) for samples, points in zip(_SAMPLES, view.cell[:2], strict=True))
    east = (_sampled(left, right, across) - col)[None, :] * step_mm
    north = (row - _sampled(top, bottom, down))[:, None] * row_mm
    heading = math.radians(pose.heading_deg)
    cos, sin = math.cos(heading), math.sin(heading)
    side, ahead = east * sin - north * cos, east * cos + north * sin
    detail_mm = step_mm * view.cell.cols / detail_cols
    # Fine pixels are too small for a part of one to be seen.
    edge_mm = min(colors.edge_cells * detail_cols * detail_mm, colors.edge_mm)
    parts = _parts(outline, side, ahead, detail_mm, detail_cols, edge_mm, has_marker=colors.has_marker)
    _mount(parts, outline, side, ahead, detail_mm, pressed)
    _blend(picture[top:bottom, left:right], parts.reshape(bottom - top, down, right - left, across), colors, opacity)


def _around(middle_px: float, reach_px: float, size_px: int) -> tuple[int, int]:
    return max(math.floor(middle_px - reach_px), 0), min(math.ceil(middle_px + reach_px), size_px)


def _sampled(first_px: int, end_px: int, samples: int) -> FloatArray:
    fine = (np.arange(samples) + 0.5) / samples
    return (np.arange(first_px, end_px)[:, None] + fine).ravel()


def _parts(
    outline: RobotOutline,
    side: FloatArray,
    ahead: FloatArray,
    px_mm: float,
    cell_cols: int,
    edge_mm: float,
    *,
    has_marker: bool,
) -> npt.NDArray[np.intp]:
    """Return which part covers each sample, given by its distance to the right and ahead in mm."""
    across = np.abs(side)
    parts = np.zeros(side.shape, np.intp)
    front_mm, back_mm = outline.front_mm, outline.back_mm
    inside_mm = np.minimum(outline.half_width_mm - across, np.minimum(ahead - back_mm, front_mm - ahead))
    parts[inside_mm >= 0] = _EDGE
    parts[inside_mm >= edge_mm] = _BODY
    wheel_mm = max(outline.wheel_width_mm, 1.2 * px_mm)
    beside = np.abs(across - outline.half_width_mm + wheel_mm / 2) <= wheel_mm / 2
    if outline.has_wheels:
        parts[beside & (np.abs(ahead) <= outline.wheel_radius_mm)] = _WHEEL
    # In few pixels the nose sticks out by one, and it is never thinner than that, so that the heading can be seen.
    is_small = 2 * outline.half_width_mm < _FEW_PX[cell_cols] * px_mm
    nose_mm = _NOSE_PX[cell_cols] * px_mm if is_small else 0.0
    tip = front_mm + nose_mm
    base = back_mm * 0.55
    # Longer than wide: in an even triangle of few pixels any corner could be the tip.
    widest_mm = min(0.62 * (outline.half_width_mm - outline.wheel_width_mm), 0.28 * (tip - base))
    thinnest_mm = (_THIN_PX[cell_cols] if is_small else 0.4) * px_mm
    flank = np.maximum(widest_mm * (tip - ahead) / (tip - base), thinnest_mm)
    if has_marker:
        parts[(ahead >= base) & (ahead <= tip) & (across <= flank)] = _MARKER
    for x_mm, y_mm, radius in outline.color_sensors_mm:
        # In pixels of a whole cell a small sensor would only blur the marker.
        if 2 * radius >= 1.5 * px_mm or cell_cols > 1:
            parts[np.hypot(side - x_mm, ahead - y_mm) <= max(radius, 0.7 * px_mm)] = _SENSOR
    return parts


def _mount(
    parts: npt.NDArray[np.intp],
    outline: RobotOutline,
    side: FloatArray,
    ahead: FloatArray,
    px_mm: float,
    pressed: tuple[bool, ...],
) -> None:
    """Add bumpers and other sensors; the heading marker stays on top."""
    free = parts != _MARKER
    for at, (x_mm, y_mm, half) in enumerate(outline.bumpers_mm):
        # A bar is at least half a pixel thick and long, to stay visible.
        bar = np.abs(ahead - y_mm) <= max(_BUMPER_MM / 2, 0.5 * px_mm)
        bar = bar & (np.abs(side - x_mm) <= max(half, 0.5 * px_mm))
        parts[bar & free] = _PRESSED if at < len(pressed) and pressed[at] else _BUMPER
    for x_mm, y_mm in outline.other_sensors_mm if 2 * _SPOT_MM >= 1.5 * px_mm else ():
        parts[np.hypot(side - x_mm, ahead - y_mm) <= _SPOT_MM] = _SPOT


def _blend(target: Pixels, blocks: npt.NDArray[np.intp], colors: RobotColors, opacity: float) -> None:
    drawn = (colors.edge, colors.body, colors.wheel, colors.sensor, colors.marker)
    table = np.array([(0, 0, 0), *drawn, colors.bumper, colors.pressed, colors.spot], np.int64)
    # The sums of the three channels and the number of covered samples are added up together, in 16 bits each.
    packed = table[:, 0] | table[:, 1] << 16 | table[:, 2] << 32 | (np.arange(len(table)) != _NONE) << 48
    _, down, _, across = blocks.shape
    samples = packed[blocks]
    total = sum(samples[:, row, :, col] for row in range(down) for col in range(across))
    red, green, blue, covered = (np.right_shift(total, 16 * field) & 0xFFFF for field in range(4))
    share = opacity / (down * across)
    mixed = target * (1 - share * covered)[..., None] + share * np.stack((red, green, blue), axis=-1)
    target[:] = np.rint(mixed).astype(np.uint8)


MM_PER_PX = 3
"""Scale of the world's picture."""

ARRAY_PX = 6
"""Side of one sensor pixel in the arrays' picture."""

CORNER_RGB = (58, 70, 88)
"""Outside the disc of a sensor: neither black, white nor a colour of a mat, so that its outline is seen on any of them.
"""

_OBSTACLE, _OBSTACLE_EDGE, _RAY = (150, 150, 160), (20, 20, 20), (230, 120, 0)
_RIM, _FRAME = (232, 234, 238), (70, 74, 82)
_FRAME_PX = 2

Point = tuple[float, float]


def world_view(robot: RobotSpec, mm_per_px: float = MM_PER_PX) -> Viewport:
    """Return an area in which a robot is completely visible while its axle is on the field."""
    width_px, height_px = _field_px(mm_per_px)
    rim_px = math.ceil(drawn_reach_mm(outline_of(robot)) / mm_per_px) + _FRAME_PX
    rim_mm = rim_px * mm_per_px
    return Viewport(width_px + 2 * rim_px, height_px + 2 * rim_px, mm_per_px, -rim_mm, FIELD_HEIGHT_MM + rim_mm)


def _field_px(mm_per_px: float) -> tuple[int, int]:
    # The field is no multiple of three mm wide: the rest of the last column is left out.
    return max(int(FIELD_WIDTH_MM / mm_per_px), 1), max(int(FIELD_HEIGHT_MM / mm_per_px), 1)


def fitting_view(robot: RobotSpec, width_px: int, height_px: int) -> Viewport:
    """Return the view of `world_view` in the largest scale that fits a size."""
    reach_mm = drawn_reach_mm(outline_of(robot))
    # The rim is rounded up to whole pixels on both sides.
    sides = ((FIELD_WIDTH_MM, width_px), (FIELD_HEIGHT_MM, height_px))
    mm_per_px = max((side_mm + 2 * reach_mm) / max(side_px - 2 * (_FRAME_PX + 1), 1) for side_mm, side_px in sides)
    return world_view(robot, mm_per_px)


_FAR_MM = 1e5
"""Pen traces farther from the field are not drawn: the time for a line grows with its length."""


@dataclass(frozen=True, slots=True)
class PenLines:
    """The pen trace of a run."""

    color: str
    width_mm: float
    lines: tuple[tuple[Point, ...], ...]
    """In mm from the upper left corner of the field."""


def pen_points_mm(robot: RobotSpec, telemetry: npt.NDArray[Any]) -> tuple[FloatArray, FloatArray]:
    """Return x and y of the pen in the world at each record of telemetry, up or down, each of shape (n,)."""
    return world_points_mm(telemetry, robot.pen.x_mm, robot.pen.y_mm)


def pen_trace(spec: RunSpec, telemetry: npt.NDArray[Any]) -> PenLines:
    """Return the pen trace of a run, from the records of `runs.views.TelemetryView.array`."""
    pen = spec.robot.pen
    x_mm, y_mm = pen_points_mm(spec.robot, telemetry)
    points = np.stack([x_mm, FIELD_HEIGHT_MM - y_mm], axis=1)
    # Damaged records may have no valid pose. Also false for NaN.
    near = (np.abs(points) < _FAR_MM).all(axis=1)
    down = np.concatenate([[False], near & ((telemetry["flags"] & FLAG_PEN_DOWN) != 0), [False]])
    starts, ends = np.flatnonzero(down[1:] & ~down[:-1]), np.flatnonzero(~down[1:] & down[:-1])
    lines = []
    for start, end in zip(starts, ends, strict=True):
        line = points[start:end]
        moved = np.any(np.diff(np.round(line / MM_PER_PX * 2), axis=0) != 0, axis=1)
        # In most ticks the pen moves less than half a pixel.
        lines.append(tuple(map(tuple, line[np.concatenate([[True], moved])].tolist())))
    return PenLines(pen.color, pen.width_mm, tuple(line for line in lines if len(line) > 1))


def _scaled(mat: Pixels, mm_per_px: float) -> Image:
    """Return a mat in a scale; each pixel is the mean of those below it."""
    from PIL import Image

    sides_px = _field_px(mm_per_px)
    width_mm, height_mm = (side_px * mm_per_px for side_px in sides_px)
    if mm_per_px == MM_PER_PX:
        # Means of whole pixels, which `resize` would round differently.
        return Image.fromarray(mat).reduce(MM_PER_PX, box=(0, 0, int(width_mm), int(height_mm)))
    return Image.fromarray(mat).resize(sides_px, Image.Resampling.BOX, (0.0, 0.0, width_mm, height_mm))


class WorldPainter:
    """Draws the world of a run in one scale: mat and obstacles once, pen traces as they grow, the robot at any pose.

    Args:
        spec: The specification of the run.
        mat: Shape (height, width, 3), rows from the top.
        view: From `world_view` or `fitting_view`.
    """

    def __init__(self, spec: RunSpec, mat: Pixels, view: Viewport) -> None:
        from PIL import Image, ImageDraw

        self._spec, self.view, self._scale = spec, view, view.mm_per_px
        self._field = _scaled(mat, self._scale)
        draw = ImageDraw.Draw(self._field)
        for obstacle in spec.world.obstacles:
            low = self._at(obstacle.x_mm, obstacle.y_mm)
            high = self._at(obstacle.x_mm + obstacle.width_mm, obstacle.y_mm + obstacle.height_mm)
            draw.rectangle((low[0], high[1], high[0], low[1]), fill=_OBSTACLE, outline=_OBSTACLE_EDGE)
        col, row = view.to_px(0, FIELD_HEIGHT_MM)
        left_px, top_px = self._corner = round(col), round(row)
        self._around = Image.new("RGB", (view.width_px, view.height_px), _RIM)
        right_px, low_px = left_px + self._field.width + _FRAME_PX - 1, top_px + self._field.height + _FRAME_PX - 1
        corners = (left_px - _FRAME_PX, top_px - _FRAME_PX, right_px, low_px)
        ImageDraw.Draw(self._around).rectangle(corners, fill=_FRAME)

    def _at(self, x_mm: float, y_mm: float) -> Point:
        return x_mm / self._scale, (FIELD_HEIGHT_MM - y_mm) / self._scale

    def add_trace(self, trace: PenLines) -> None:
        """Add a pen trace to every later picture."""
        from PIL import ImageDraw

        draw = ImageDraw.Draw(self._field)
        width_px = max(1, round(trace.width_mm / self._scale))
        for line in trace.lines:
            draw.line([(x / self._scale, y / self._scale) for x, y in line], fill=css_rgb(trace.color), width=width_px)

    def picture(self, pose: Pose | None, *, rays: bool = False) -> Image:
        """Return the world with the robot at a pose; without a robot if it is None."""
        from PIL import Image, ImageDraw

        field = self._field
        if rays and pose is not None and self._spec.robot.ultrasonic is not None:
            field = field.copy()
            self._draw_rays(ImageDraw.Draw(field), pose)
        picture = self._around.copy()
        picture.paste(field, self._corner)
        if pose is None:
            return picture
        pixels = np.array(picture)
        draw_robot(pixels, self.view, pose, outline_of(self._spec.robot), COLORED)
        return Image.fromarray(pixels)

    def _draw_rays(self, draw: ImageDraw, pose: Pose) -> None:
        sensor = self._spec.robot.ultrasonic
        assert sensor is not None
        x_mm, y_mm = world_point(pose, sensor.x_mm, sensor.y_mm)
        for angle_deg, length_mm in rays_mm(pose, sensor, self._spec.world):
            turn = math.radians(angle_deg)
            end = self._at(x_mm + math.cos(turn) * length_mm, y_mm + math.sin(turn) * length_mm)
            draw.line([self._at(x_mm, y_mm), end], fill=_RAY)


def world_picture(
    spec: RunSpec, mat: Pixels, pose: Pose | None = None, traces: Sequence[PenLines] = (), *,
    rays: bool = False,
) -> Image:  # fmt: skip
    """Return mat, obstacles, pen traces and robot.

    Args:
        mat: Shape (height, width, 3), rows from the top.
        pose: Where the robot is, by default at its start.
        rays: Whether to draw the rays of the ultrasonic sensor.

    Returns:
        The picture, in the size of `world_view`.
    """
    painter = WorldPainter(spec, mat, world_view(spec.robot))
    for trace in traces:
        painter.add_trace(trace)
    return painter.picture(pose or spec.world.start, rays=rays)


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


def disc_in_box(box: bytes, corner_rgb: Rgb) -> Pixels:
    """Return the pixels of a square around a disc, d × d, three bytes a pixel, with the corners in one colour."""
    diameter = round((len(box) / 3) ** 0.5)
    pixels = np.frombuffer(box, np.uint8).reshape(diameter, diameter, 3).copy()
    pixels[~np.array(disc_mask(diameter))] = corner_rgb
    return pixels


def arrays_picture(arrays: Sequence[tuple[ColorSensorSpec, bytes]]) -> Image:
    """Return side by side the discs that sensors see, each given as RGB bytes, d × d pixels, row by row."""
    from PIL import Image

    tiles = [
        Image.fromarray(disc_in_box(pixels, CORNER_RGB)).resize(
            (sensor.diameter_mm * ARRAY_PX,) * 2, Image.Resampling.NEAREST
        )
        for sensor, pixels in arrays
    ]
    whole = Image.new(
        "RGB", (sum(t.width + 12 for t in tiles) or 1, max((t.height for t in tiles), default=1)), "white"
    )
    left = 0
    for tile in tiles:
        whole.paste(tile, (left, 0))
        left += tile.width + 12
    return whole
