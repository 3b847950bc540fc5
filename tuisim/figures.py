"""Pictures of runs for notebooks and scripts: the world, what the colour sensors see, the chart. Pillow only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, radians, sin
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from tuisim.core.css import css_rgb
from tuisim.core.geometry import Pose, world_point
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, ColorSensorSpec, RunSpec
from tuisim.core.state import FLAG_PEN_DOWN
from tuisim.datalog.samples import Sample

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

MM_PER_PX = 3
"""Scale of the world's picture."""

CHART_SIZE = (760, 300)
"""Width and height of the chart in pixels."""

ARRAY_PX = 6
"""Side of one sensor pixel in the arrays' picture."""

_TRACE_COLORS = ((31, 119, 180), (255, 127, 14), (44, 160, 44), (214, 39, 40), (148, 103, 189), (140, 86, 75))
_BODY, _WHEEL, _OBSTACLE, _RAY = (70, 110, 170), (20, 20, 20), (150, 150, 160), (230, 120, 0)
_MARGIN_LEFT, _MARGIN = 56, 24

Point = tuple[float, float]


def _at(x_mm: float, y_mm: float) -> Point:
    return x_mm / MM_PER_PX, (FIELD_HEIGHT_MM - y_mm) / MM_PER_PX


def _box(pose: Pose, left: float, back: float, right: float, front: float) -> list[Point]:
    corners = ((left, back), (right, back), (right, front), (left, front))
    return [_at(*world_point(pose, x_mm, y_mm)) for x_mm, y_mm in corners]


@dataclass(frozen=True, slots=True)
class PenTrace:
    """What the pen of a run has drawn."""

    color: str
    width_px: int
    lines: tuple[tuple[Point, ...], ...]
    """In pixels of the world's picture."""


def pen_trace(spec: RunSpec, telemetry: NDArray[Any]) -> PenTrace:
    """Return what the pen has drawn.

    Args:
        spec: What the run is made of.
        telemetry: As from `datalog.views.TelemetryView.array`.
    """
    import numpy as np

    pen = spec.robot.pen
    # As `core.geometry.world_point`, for all ticks at once.
    turn = np.radians(telemetry["heading_deg"] - 90.0)
    x_mm = telemetry["x_mm"] + np.cos(turn) * pen.x_mm - np.sin(turn) * pen.y_mm
    y_mm = telemetry["y_mm"] + np.sin(turn) * pen.x_mm + np.cos(turn) * pen.y_mm
    points = np.stack([x_mm, FIELD_HEIGHT_MM - y_mm], axis=1) / MM_PER_PX
    down = np.concatenate([[False], (telemetry["flags"] & FLAG_PEN_DOWN) != 0, [False]])
    starts, ends = np.flatnonzero(down[1:] & ~down[:-1]), np.flatnonzero(~down[1:] & down[:-1])
    lines = []
    for start, end in zip(starts, ends, strict=True):
        line = points[start:end]
        moved = np.any(np.diff(np.round(line * 2), axis=0) != 0, axis=1)
        # Most ticks bring the pen less than half a pixel on.
        lines.append(tuple(map(tuple, line[np.concatenate([[True], moved])].tolist())))
    width_px = max(1, round(pen.width_mm / MM_PER_PX))
    return PenTrace(pen.color, width_px, tuple(line for line in lines if len(line) > 1))


def world_picture(
    spec: RunSpec, mat: NDArray[np.uint8], pose: Pose | None = None, traces: Sequence[PenTrace] = (), *,
    rays: bool = False,
) -> Image:  # fmt: skip
    """Return mat, obstacles, pen traces and robot.

    Args:
        spec: What the run is made of.
        mat: Shape (height, width, 3), rows from the top.
        pose: Where the robot is, by default at its start.
        traces: What pens have drawn.
        rays: Whether the ultrasonic sensor's rays are drawn.
    """
    from PIL import Image, ImageDraw

    size = (round(FIELD_WIDTH_MM / MM_PER_PX), round(FIELD_HEIGHT_MM / MM_PER_PX))
    picture = Image.fromarray(mat).resize(size, Image.Resampling.BOX)
    draw = ImageDraw.Draw(picture)
    for box in spec.world.obstacles:
        low = _at(box.x_mm, box.y_mm)
        high = _at(box.x_mm + box.width_mm, box.y_mm + box.height_mm)
        draw.rectangle((low[0], high[1], high[0], low[1]), fill=_OBSTACLE, outline=_WHEEL)
    for trace in traces:
        for line in trace.lines:
            draw.line(line, fill=css_rgb(trace.color), width=trace.width_px)
    pose = pose or spec.world.start
    if rays and spec.robot.ultrasonic is not None:
        _draw_rays(draw, spec, pose)
    _draw_robot(draw, spec, pose)
    return picture


def _draw_rays(draw: ImageDraw, spec: RunSpec, pose: Pose) -> None:
    sensor = spec.robot.ultrasonic
    assert sensor is not None
    x_mm, y_mm = world_point(pose, sensor.x_mm, sensor.y_mm)
    for angle in sensor.ray_angles_deg:
        turn = radians(pose.heading_deg + sensor.angle_deg + angle)
        end = _at(x_mm + cos(turn) * sensor.max_range_mm, y_mm + sin(turn) * sensor.max_range_mm)
        draw.line([_at(x_mm, y_mm), end], fill=_RAY)


def _draw_robot(draw: ImageDraw, spec: RunSpec, pose: Pose) -> None:
    robot = spec.robot
    half, radius, tyre = robot.wheel_spacing_mm / 2, robot.wheel_diameter_mm / 2, robot.wheel_width_mm / 2
    front = max((sensor.y_mm + sensor.diameter_mm / 2 for sensor in robot.color_sensors), default=radius)
    draw.polygon(_box(pose, -half + tyre, robot.back_mm, half - tyre, front), outline=_BODY, width=3)
    for side in (-half, half):
        draw.polygon(_box(pose, side - tyre, -radius, side + tyre, radius), fill=_WHEEL)
    for sensor in robot.color_sensors:
        x_px, y_px = _at(*world_point(pose, sensor.x_mm, sensor.y_mm))
        reach = max(2.0, sensor.diameter_mm / 2 / MM_PER_PX)
        draw.ellipse((x_px - reach, y_px - reach, x_px + reach, y_px + reach), outline=(255, 0, 255), width=2)


def arrays_picture(arrays: Sequence[tuple[ColorSensorSpec, bytes]]) -> Image:
    """Return the sensors' pixel arrays side by side.

    Args:
        arrays: Sensor and its RGB bytes, d × d pixels, row by row.
    """
    from PIL import Image

    tiles = [
        Image.frombytes("RGB", (sensor.diameter_mm,) * 2, pixels).resize(
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


def chart_picture(samples: Iterable[Sample]) -> Image:
    """Return the samples over simulated time, one line a name."""
    from PIL import Image, ImageDraw

    traces: dict[str, list[Point]] = {}
    for sample in samples:
        traces.setdefault(sample.name, []).append((sample.time_s, sample.value))
    picture = Image.new("RGB", CHART_SIZE, "white")
    draw = ImageDraw.Draw(picture)
    width, height = CHART_SIZE
    draw.rectangle((_MARGIN_LEFT, _MARGIN, width - _MARGIN, height - _MARGIN), outline="black")
    if not traces:
        draw.text((_MARGIN_LEFT + 8, _MARGIN + 8), "no samples", fill="black")
        return picture
    traces = {name: _thinned(trace) for name, trace in traces.items()}
    points = [point for trace in traces.values() for point in trace]
    lows, highs = [min(axis) for axis in zip(*points, strict=True)], [max(axis) for axis in zip(*points, strict=True)]
    for low, high, place in ((lows[1], highs[1], "y"), (lows[0], highs[0], "x")):
        ends = ((6, height - _MARGIN - 10), (6, _MARGIN)) if place == "y" else (
            (_MARGIN_LEFT, height - _MARGIN + 4), (width - _MARGIN - 40, height - _MARGIN + 4))  # fmt: skip
        unit = " s" if place == "x" else ""
        draw.text(ends[0], f"{low:.4g}{unit}", fill="black")
        draw.text(ends[1], f"{high:.4g}{unit}", fill="black")
    _draw_traces(draw, traces, lows, highs)
    return picture


def _thinned(trace: list[Point]) -> list[Point]:
    """Return what there is to see of a trace: of each stretch narrower than a pixel its lowest and highest point."""
    step = len(trace) // (2 * CHART_SIZE[0])
    if step < 2:
        return trace
    kept = trace[:1]
    for at in range(0, len(trace), step):
        stretch = sorted(trace[at : at + step], key=itemgetter(1))
        kept += sorted((stretch[0], stretch[-1]))
    return [*kept, trace[-1]]


def _draw_traces(draw: ImageDraw, traces: Mapping[str, list[Point]], lows: list[float], highs: list[float]) -> None:
    width, height = CHART_SIZE
    spans = [high - low or 1.0 for low, high in zip(lows, highs, strict=True)]
    inner_width, inner_height = width - _MARGIN - _MARGIN_LEFT, height - 2 * _MARGIN
    for order, (name, trace) in enumerate(traces.items()):
        color = _TRACE_COLORS[order % len(_TRACE_COLORS)]
        line = [
            (_MARGIN_LEFT + (x - lows[0]) / spans[0] * inner_width,
             height - _MARGIN - (y - lows[1]) / spans[1] * inner_height)
            for x, y in trace
        ]  # fmt: skip
        draw.line(line, fill=color, width=2)
        for x_px, y_px in line[:: max(1, len(line) // 200)]:
            draw.ellipse((x_px - 2, y_px - 2, x_px + 2, y_px + 2), fill=color)
        draw.text((_MARGIN_LEFT + 8 + 120 * order, 6), name, fill=color)
