"""The robot from above."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import RobotOutline
from tuisim.engine.runs.arrays import FloatArray
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

_SAMPLES = (4, 8)
"""Samples across and down a character cell."""

_MIN_CELLS = 7.0
"""A robot narrower than this many cells is drawn enlarged, to be recognisable."""

_DISC_CELLS = 9.5
"""A crisp robot narrower than this many cells is a disc with a nose: a turned rectangle of few pixels has no shape."""
_NOSE_CELLS = 2.0
"""Cells by which the heading marker projects beyond a crisp robot: of few pixels, only a nose outside the body tells
the front from the back."""
_THIN_CELLS = 0.6
"""Half of its width at the tip of the nose."""
_DISC_WHEEL_CELLS = 1.2
"""Width of the wheels of a disc."""

_CRISP_PX = 40.0
"""A robot narrower than this many pixels has no mixed colours: each pixel shows the part that weighs most in it, and
its centre is that of a pixel, so that its shape stays the same while it drives straight on."""

_BUMPER_MM = 8.0
"""Thickness of the bar of a touch sensor."""

_SPOT_MM = 10.0
"""Radius of a further sensor."""

_NONE, _EDGE, _BODY, _WHEEL, _SENSOR, _MARKER, _BUMPER, _PRESSED, _SPOT = range(9)
_WEIGHTS = np.array([1.0, 1.5, 1.0, 2.0, 1.5, 2.0, 2.0, 2.0, 1.2])
"""Weight of each part where a pixel shows only one: parts that show place and heading win over the body."""


@dataclass(frozen=True, slots=True)
class RobotColors:
    """The colours of a robot's parts; the defaults are in every 256-colour palette."""

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
    nose_cells: float = _NOSE_CELLS
    """Cells by which the marker of a crisp robot that is no disc projects beyond its front."""
    has_small_edge: bool = False
    """Whether a robot of few pixels has an edge too: one without colours would not be seen without."""
    is_outline: bool = False
    """Whether only edge and marker are drawn, in a line without gaps, so that what is below is seen."""

    def choose_edge_mm(self, cell_mm: float, is_crisp: bool) -> float:
        """Return the width of the robot's edge in mm: `edge_cells` of a cell's width, at most `edge_mm`.

        Args:
            cell_mm: Width of a cell.
            is_crisp: Whether the robot is so small that it has an edge only if `has_small_edge` is true.
        """
        if is_crisp and not self.has_small_edge:
            return 0.0
        return min(self.edge_cells * cell_mm, self.edge_mm)

    def choose_parts(self, outline: RobotOutline) -> RobotOutline:
        """Return the outline of a robot with only those parts that are drawn in these colours.

        If `is_outline` is true, wheels and colour sensors are not drawn.
        """
        return (
            replace(outline, has_wheels=False, color_sensors_mm=()) if self.is_outline else outline
        )


COLORED = RobotColors()
GREY = RobotColors(
    body=(48, 48, 48),
    wheel=(0, 0, 0),
    sensor=(188, 188, 188),
    marker=(255, 255, 255),
    bumper=(108, 108, 108),
    pressed=(0, 0, 0),
    spot=(128, 128, 128),
    has_small_edge=True,
)
"""Colours for a terminal with greys only: dark body, white edge and marker, which stand out on any grey."""
MONO = RobotColors(
    edge=(0, 0, 0),
    body=(255, 255, 255),
    wheel=(0, 0, 0),
    sensor=(0, 0, 0),
    marker=(0, 0, 0),
    edge_cells=0.6,
    edge_mm=100.0,
    has_small_edge=True,
)
"""Colours for a terminal of two colours: a black arrow on white within a black edge."""
CLEARED = RobotColors((255,) * 3, (255,) * 3, (255,) * 3, (255,) * 3, has_marker=False)
"""Colours for a terminal of two colours and of signs only: a white area for the signs of the robot."""
GHOST = RobotColors(
    edge=(175, 0, 175),
    marker=(175, 0, 175),
    edge_cells=1.0,
    edge_mm=30.0,
    has_small_edge=True,
    is_outline=True,
)
"""Colours of the robot now, while an earlier instant is in view."""
GREY_GHOST = replace(GHOST, edge=(88, 88, 88), marker=(88, 88, 88))

EARLIER = RobotColors(
    body=(108, 108, 108), wheel=(68, 68, 68), sensor=(148, 148, 148), marker=(218, 218, 218)
)
"""Colours of the robot of an earlier run."""


def measure_reach_mm(outline: RobotOutline) -> float:
    """Return the radius of a circle around a robot's pose that contains the whole drawn robot."""
    wheels_mm = math.hypot(outline.half_width_mm, outline.wheel_radius_mm)
    bars_mm = (math.hypot(abs(x) + half, abs(y) + _BUMPER_MM) for x, y, half in outline.bumpers_mm)
    spots_mm = (math.hypot(*spot) + _SPOT_MM for spot in outline.other_sensors_mm)
    return max((outline.reach_mm, wheels_mm, *spots_mm, *bars_mm))


def choose_scale(outline: RobotOutline, view: Viewport) -> float:
    """Return the factor, at least 1, by which a robot is drawn larger, so that it is visible in a small picture."""
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
    """Paint the part of a robot that is inside a picture.

    Args:
        picture: Written in place, shape (view.height_px, view.width_px, 3).
        view: What the picture shows.
        pose: Pose of the robot.
        outline: Shape of the robot.
        colors: Colours of its parts.
        opacity: 0 … 1.
        pressed: Whether each bumper is pressed; empty for none.
        detail_cols: Draw details, such as sensors, as for a picture with this number of pixels across a cell, 1 or 2;
            None for the number in the view, at most 2.
    """
    detail_cols = detail_cols or min(view.cell.cols, 2)
    outline = colors.choose_parts(outline)
    scale = choose_scale(outline, view)
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    step_mm, row_mm = view.mm_per_px / scale, view.mm_per_row / scale
    is_crisp = 2 * outline.half_width_mm < _CRISP_PX * step_mm
    if is_crisp:
        col, row = math.floor(col) + 0.5, math.floor(row) + 0.5
    cell_mm = step_mm * view.cell.cols
    nose_mm = is_crisp * colors.nose_cells * cell_mm
    reach_mm = measure_reach_mm(outline) + nose_mm
    left, right = _find_range(col, reach_mm / step_mm + 2, view.width_px)
    top, bottom = _find_range(row, reach_mm / row_mm + 2, view.height_px)
    if left >= right or top >= bottom:
        return
    across, down = (
        -(-samples // points) for samples, points in zip(_SAMPLES, view.cell[:2], strict=True)
    )
    east = (_sample_places(left, right, across) - col)[None, :] * step_mm
    north = (row - _sample_places(top, bottom, down))[:, None] * row_mm
    side, ahead = _turn_places(east, north, pose.heading_deg)
    edge_mm = colors.choose_edge_mm(cell_mm, is_crisp)
    if is_crisp and 2 * outline.half_width_mm < _DISC_CELLS * cell_mm:
        parts = _classify_disc(outline, side, ahead, cell_mm, edge_mm, colors)
    else:
        parts = _classify_samples(
            outline, side, ahead, cell_mm, detail_cols, edge_mm, nose_mm, colors
        )
    if colors.is_outline:
        parts[(parts != _EDGE) & (parts != _MARKER)] = _NONE
    else:
        _mount(parts, outline, side, ahead, cell_mm / detail_cols, pressed)
    blocks = parts.reshape(bottom - top, down, right - left, across)
    _blend(
        picture[top:bottom, left:right], _pick_part(blocks) if is_crisp else blocks, colors, opacity
    )


def _find_range(middle_px: float, reach_px: float, size_px: int) -> tuple[int, int]:
    return max(math.floor(middle_px - reach_px), 0), min(math.ceil(middle_px + reach_px), size_px)


def _sample_places(first_px: int, end_px: int, samples: int) -> FloatArray:
    fine = (np.arange(samples) + 0.5) / samples
    return (np.arange(first_px, end_px)[:, None] + fine).ravel()


def _turn_places(
    east: FloatArray, north: FloatArray, heading_deg: float
) -> tuple[FloatArray, FloatArray]:
    """Return how far points are to the right of a robot's axis, and how far ahead.

    Args:
        east, north: How far they are east and north of the robot.
        heading_deg: The robot's heading, counter-clockwise from east.
    """
    cos, sin = math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg))
    return east * sin - north * cos, east * cos + north * sin


def _classify_samples(
    outline: RobotOutline,
    side: FloatArray,
    ahead: FloatArray,
    cell_mm: float,
    cell_cols: int,
    edge_mm: float,
    nose_mm: float,
    colors: RobotColors,
) -> npt.NDArray[np.intp]:
    """Return for each sample the number of the robot's part that covers it.

    Args:
        outline: Shape of the robot.
        side, ahead: Where the samples are: to the right of the robot's axis, and ahead, in mm.
        cell_mm: Width of a cell.
        cell_cols: Pixels across a cell.
        edge_mm: Width of the robot's edge.
        nose_mm: How far the heading marker of a small robot projects beyond the front; 0 for a large robot.
        colors: The colours of the parts, which say whether wheels and marker are drawn.
    """
    px_mm = cell_mm / cell_cols
    across = np.abs(side)
    parts = np.zeros(side.shape, np.intp)
    front_mm, back_mm = outline.front_mm, outline.back_mm
    inside_mm = np.minimum(
        outline.half_width_mm - across, np.minimum(ahead - back_mm, front_mm - ahead)
    )
    parts[inside_mm >= 0] = _EDGE
    parts[inside_mm >= edge_mm] = _BODY
    wheel_mm = max(outline.wheel_width_mm, 1.2 * px_mm)
    beside = np.abs(across - outline.half_width_mm + wheel_mm / 2) <= wheel_mm / 2
    if outline.has_wheels:
        parts[beside & (np.abs(ahead) <= outline.wheel_radius_mm)] = _WHEEL
    tip_mm = front_mm + nose_mm
    base_mm = back_mm * 0.55
    length_mm = tip_mm - base_mm
    # The marker is longer than wide: in an even triangle of few pixels any corner could be the tip.
    widest_mm = min(0.62 * (outline.half_width_mm - outline.wheel_width_mm), 0.28 * length_mm)
    thin_mm = _THIN_CELLS * cell_mm if nose_mm else 0.4 * px_mm
    flank = np.maximum(widest_mm * (tip_mm - ahead) / length_mm, thin_mm)
    if colors.has_marker:
        parts[(ahead >= base_mm) & (ahead <= tip_mm) & (across <= flank)] = _MARKER
    for x_mm, y_mm, radius in outline.color_sensors_mm:
        # In pixels of a whole cell a small sensor would only blur the marker.
        if 2 * radius >= 1.5 * px_mm or cell_cols > 1:
            parts[np.hypot(side - x_mm, ahead - y_mm) <= max(radius, 0.7 * px_mm)] = _SENSOR
    return parts


def _classify_disc(
    outline: RobotOutline,
    side: FloatArray,
    ahead: FloatArray,
    cell_mm: float,
    edge_mm: float,
    colors: RobotColors,
) -> npt.NDArray[np.intp]:
    """Return for each sample the number of the robot's part that covers it, for a robot drawn as a disc.

    The arguments are those of `_classify_samples`; `cell_mm` is the width of a cell.
    """
    radius_mm = outline.half_width_mm
    across = np.abs(side)
    inside_mm = radius_mm - np.hypot(side, ahead)
    parts = np.zeros(inside_mm.shape, np.intp)
    parts[inside_mm >= 0] = _EDGE
    parts[inside_mm >= edge_mm] = _BODY
    wheel = (across >= radius_mm - _DISC_WHEEL_CELLS * cell_mm) & (np.abs(ahead) <= radius_mm / 2)
    if outline.has_wheels:
        parts[wheel & (across <= radius_mm)] = _WHEEL
    for x_mm, y_mm, sensor_mm in outline.color_sensors_mm:
        parts[np.hypot(side - x_mm, ahead - y_mm) <= max(sensor_mm, cell_mm / 2)] = _SENSOR
    tip_mm = radius_mm + _NOSE_CELLS * cell_mm
    # A whole marker would fill a small outline.
    base_mm = radius_mm / 3 if colors.is_outline else -radius_mm / 2
    flank = np.maximum(0.28 * (tip_mm - ahead), _THIN_CELLS * cell_mm)
    if colors.has_marker:
        parts[(ahead >= base_mm) & (ahead <= tip_mm) & (across <= flank)] = _MARKER
    return parts


def _mount(
    parts: npt.NDArray[np.intp],
    outline: RobotOutline,
    side: FloatArray,
    ahead: FloatArray,
    px_mm: float,
    pressed: tuple[bool, ...],
) -> None:
    """Change `parts` where a bumper or another sensor covers a sample, except below the heading marker.

    Args:
        parts: The number of the robot's part at each sample; changed in place.
        outline: Shape of the robot.
        side, ahead: Where the samples are: to the right of the robot's axis, and ahead, in mm.
        px_mm: Width of a pixel.
        pressed: Whether each bumper is pressed.
    """
    free = parts != _MARKER
    for number, (x_mm, y_mm, half) in enumerate(outline.bumpers_mm):
        # A bar is at least half a pixel thick and long, to stay visible.
        bar = np.abs(ahead - y_mm) <= max(_BUMPER_MM / 2, 0.5 * px_mm)
        bar = bar & (np.abs(side - x_mm) <= max(half, 0.5 * px_mm))
        parts[bar & free] = _PRESSED if number < len(pressed) and pressed[number] else _BUMPER
    for x_mm, y_mm in outline.other_sensors_mm if 2 * _SPOT_MM >= 1.5 * px_mm else ():
        parts[np.hypot(side - x_mm, ahead - y_mm) <= _SPOT_MM] = _SPOT


def _pick_part(blocks: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Return for each pixel the part with the most weight among its samples.

    Args:
        blocks: The parts of the samples, in a block for each pixel.
    """
    weights = np.stack(
        [(blocks == part).sum(axis=(1, 3)) * weight for part, weight in enumerate(_WEIGHTS)]
    )
    strongest: npt.NDArray[np.intp] = weights.argmax(axis=0)[:, None, :, None]
    return strongest


def _blend(
    target: Pixels, blocks: npt.NDArray[np.intp], colors: RobotColors, opacity: float
) -> None:
    drawn = (colors.edge, colors.body, colors.wheel, colors.sensor, colors.marker)
    table = np.array([(0, 0, 0), *drawn, colors.bumper, colors.pressed, colors.spot], np.int64)
    # The sums of the three channels and the number of covered samples are added up together, in 16 bits each.
    packed = (
        table[:, 0] | table[:, 1] << 16 | table[:, 2] << 32 | (np.arange(len(table)) != _NONE) << 48
    )
    _, down, _, across = blocks.shape
    samples = packed[blocks]
    total = sum(samples[:, row, :, col] for row in range(down) for col in range(across))
    red, green, blue, covered = (np.right_shift(total, 16 * field) & 0xFFFF for field in range(4))
    share = opacity / (down * across)
    mixed = target * (1 - share * covered)[..., None] + share * np.stack(
        (red, green, blue), axis=-1
    )
    target[:] = np.rint(mixed).astype(np.uint8)
