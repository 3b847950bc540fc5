"""The robot from above, turned and with smooth edges: in the app, and in every picture."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from tuisim.core.geometry import Pose
from tuisim.core.parts import TouchSpec
from tuisim.core.spec import RobotSpec, UltrasonicSpec

Rgb: TypeAlias = tuple[int, int, int]
"""A colour, 0 to 255 each."""

Pixels = npt.NDArray[np.uint8]
"""Shape (height, width, 3): red, green, blue."""

_SAMPLES = 4
"""Samples along each side of a pixel."""

_MIN_PX = 6.0
"""A robot narrower than this many pixels is drawn enlarged, or it could not be told from a dot."""

_BUMPER_MM = 8.0
"""How thick the bar of a touch sensor is drawn."""

_SPOT_MM = 10.0
"""Radius of a further sensor."""

_NONE, _EDGE, _BODY, _WHEEL, _SENSOR, _MARKER, _BUMPER, _PRESSED, _SPOT = range(9)


class View(Protocol):
    """Which part of the field a picture shows, and how large."""

    @property
    def width_px(self) -> int:
        """Width of the picture."""

    @property
    def height_px(self) -> int:
        """Height of the picture."""

    @property
    def mm_per_px(self) -> float:
        """Scale."""

    def to_px(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Return the picture column and row of a point of the world; whole numbers are pixel corners."""


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


COLORED = RobotColors()
GREY = RobotColors(
    body=(48, 48, 48), wheel=(0, 0, 0), sensor=(188, 188, 188), marker=(255, 255, 255),
    bumper=(108, 108, 108), pressed=(0, 0, 0), spot=(128, 128, 128),
)  # fmt: skip
"""For a terminal without colours: dark body, white edge and marker, to stand out on any grey."""
GHOST = RobotColors(edge=(255, 255, 255), body=(175, 0, 175), wheel=(95, 0, 95), marker=(255, 215, 255))
"""For a robot that is shown where it was."""
GREY_GHOST = RobotColors(body=(158, 158, 158), wheel=(88, 88, 88), sensor=(88, 88, 88), marker=(0, 0, 0))


@dataclass(frozen=True, slots=True)
class RobotShape:
    """Outline of a robot in its own frame: mm, x to its right, y forward of the axle."""

    half_width_mm: float
    """To the middle of a wheel."""
    wheel_half_width_mm: float
    wheel_radius_mm: float
    back_mm: float
    front_mm: float
    eyes_mm: tuple[tuple[float, float, float], ...] = field(default=())
    """Colour sensors as x, y, radius."""
    bumpers_mm: tuple[tuple[float, float, float], ...] = field(default=())
    """Touch sensors as x, y, half the width of the bar."""
    spots_mm: tuple[tuple[float, float], ...] = field(default=())
    """Where further sensors are, as x, y."""

    @property
    def reach_mm(self) -> float:
        """Radius about the pose of a circle that holds everything that is drawn."""
        side = self.half_width_mm + self.wheel_half_width_mm
        body_mm = math.hypot(side, max(-self.back_mm, self.tip_mm, self.wheel_radius_mm))
        bars_mm = (math.hypot(abs(x) + half, abs(y) + _BUMPER_MM) for x, y, half in self.bumpers_mm)
        spots_mm = (math.hypot(*spot) + _SPOT_MM for spot in self.spots_mm)
        return max((body_mm, *spots_mm, *bars_mm))

    @property
    def tip_mm(self) -> float:
        """How far the heading marker reaches ahead of the axle."""
        return self.front_mm + 0.25 * self.half_width_mm


def shape_of(robot: RobotSpec) -> RobotShape:
    """Return the outline that a robot's description implies."""
    eyes = tuple((eye.x_mm, eye.y_mm, eye.diameter_mm / 2) for eye in robot.color_sensors)
    ends = [y + radius for _, y, radius in eyes] + [robot.wheel_diameter_mm / 2]
    if robot.ultrasonic is not None:
        ends.append(robot.ultrasonic.y_mm)
    return RobotShape(
        half_width_mm=robot.wheel_spacing_mm / 2,
        wheel_half_width_mm=robot.wheel_width_mm / 2,
        wheel_radius_mm=robot.wheel_diameter_mm / 2,
        back_mm=min(robot.back_mm, -robot.wheel_diameter_mm / 2),
        front_mm=max(ends) + 0.05 * robot.wheel_spacing_mm,
        eyes_mm=eyes,
        bumpers_mm=tuple((touch.x_mm, touch.y_mm, touch.width_mm / 2) for touch in robot.touch_sensors),
        spots_mm=tuple(_spots(robot)),
    )


def _spots(robot: RobotSpec) -> Iterator[tuple[float, float]]:
    """Where sensors are that have a place but no form of their own; ultrasonic ones are told by their rays."""
    for sensor in robot.further_sensors:
        if not isinstance(sensor, TouchSpec | UltrasonicSpec) and hasattr(sensor, "x_mm") and hasattr(sensor, "y_mm"):
            yield sensor.x_mm, sensor.y_mm


def drawn_scale(shape: RobotShape, view: View) -> float:
    """Return how much larger than life a robot is drawn, at least 1."""
    return max(1.0, _MIN_PX * view.mm_per_px / (2 * (shape.half_width_mm + shape.wheel_half_width_mm)))


def draw_robot(
    picture: Pixels,
    view: View,
    pose: Pose,
    shape: RobotShape,
    colors: RobotColors,
    opacity: float = 1.0,
    pressed: tuple[bool, ...] = (),
) -> None:
    """Paint a robot into a picture; what lies outside it is left out.

    Args:
        picture: Written in place, shape (view.height_px, view.width_px, 3).
        view: What the picture shows.
        pose: Where the robot is.
        shape: Its outline.
        colors: Colours of its parts.
        opacity: 0 … 1.
        pressed: Which of its bumpers are; empty for none.
    """
    scale = drawn_scale(shape, view)
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    reach = shape.reach_mm * scale / view.mm_per_px + 2
    left, right = max(math.floor(col - reach), 0), min(math.ceil(col + reach), view.width_px)
    top, bottom = max(math.floor(row - reach), 0), min(math.ceil(row + reach), view.height_px)
    if left >= right or top >= bottom:
        return
    step_mm = view.mm_per_px / scale
    fine = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    east = ((np.arange(left, right)[:, None] + fine).ravel() - col)[None, :] * step_mm
    north = (row - (np.arange(top, bottom)[:, None] + fine).ravel())[:, None] * step_mm
    heading = math.radians(pose.heading_deg)
    cos, sin = math.cos(heading), math.sin(heading)
    side, ahead = east * sin - north * cos, east * cos + north * sin
    parts = _parts(shape, side, ahead, step_mm)
    _mount(parts, shape, side, ahead, step_mm, pressed)
    _blend(picture[top:bottom, left:right], parts, colors, opacity)


def _parts(
    shape: RobotShape, side: npt.NDArray[np.float64], ahead: npt.NDArray[np.float64], px_mm: float
) -> npt.NDArray[np.intp]:
    """Return which part covers each sample, given by its distance to the right and ahead in mm."""
    across = np.abs(side)
    parts = np.zeros(side.shape, np.intp)
    half = shape.half_width_mm - shape.wheel_half_width_mm
    corner = min(20.0, half / 3)
    middle, length = (shape.front_mm + shape.back_mm) / 2, (shape.front_mm - shape.back_mm) / 2
    past_side, past_end = across - (half - corner), np.abs(ahead - middle) - (length - corner)
    body = np.hypot(np.maximum(past_side, 0), np.maximum(past_end, 0)) + np.minimum(np.maximum(past_side, past_end), 0)
    edge = min(0.35 * px_mm, 12.0)
    parts[body <= corner + edge] = _EDGE
    parts[body <= corner] = _BODY
    wheel_half = max(shape.wheel_half_width_mm, 0.6 * px_mm)
    wheel = (np.abs(across - shape.half_width_mm) <= wheel_half) & (np.abs(ahead) <= shape.wheel_radius_mm)
    parts[wheel] = _WHEEL
    tip, base = max(shape.tip_mm, shape.front_mm + 1.2 * px_mm), shape.back_mm * 0.55
    # The nose stays half a pixel wide to its end, so that the heading can be told from few pixels.
    flank = np.maximum(0.62 * half * (tip - ahead) / (tip - base), 0.4 * px_mm)
    marker = (ahead >= base) & (ahead <= tip) & (across <= flank)
    parts[marker] = _MARKER
    # Below about three pixels an eye would only blur the marker.
    for x_mm, y_mm, radius in shape.eyes_mm:
        if 2 * radius >= 1.5 * px_mm:
            parts[np.hypot(side - x_mm, ahead - y_mm) <= radius] = _SENSOR
    return parts


def _mount(
    parts: npt.NDArray[np.intp],
    shape: RobotShape,
    side: npt.NDArray[np.float64],
    ahead: npt.NDArray[np.float64],
    px_mm: float,
    pressed: tuple[bool, ...],
) -> None:
    """Put on what not every robot has; the heading marker stays on top of it."""
    free = parts != _MARKER
    for at, (x_mm, y_mm, half) in enumerate(shape.bumpers_mm):
        # A bar is never so thin, nor so short, that it would be lost.
        bar = np.abs(ahead - y_mm) <= max(_BUMPER_MM / 2, 0.5 * px_mm)
        bar = bar & (np.abs(side - x_mm) <= max(half, 0.5 * px_mm))
        parts[bar & free] = _PRESSED if at < len(pressed) and pressed[at] else _BUMPER
    for x_mm, y_mm in shape.spots_mm if 2 * _SPOT_MM >= 1.5 * px_mm else ():
        parts[np.hypot(side - x_mm, ahead - y_mm) <= _SPOT_MM] = _SPOT


def _blend(target: Pixels, parts: npt.NDArray[np.intp], colors: RobotColors, opacity: float) -> None:
    drawn = (colors.edge, colors.body, colors.wheel, colors.sensor, colors.marker)
    table = np.array([(0, 0, 0), *drawn, colors.bumper, colors.pressed, colors.spot], np.float32)
    rows, cols = target.shape[:2]
    blocks = parts.reshape(rows, _SAMPLES, cols, _SAMPLES)
    total = table[blocks].sum(axis=(1, 3))
    covered = (blocks != _NONE).sum(axis=(1, 3))[..., None] / _SAMPLES**2
    mixed = target * (1 - opacity * covered) + total * (opacity / _SAMPLES**2)
    target[:] = np.rint(mixed).astype(np.uint8)
