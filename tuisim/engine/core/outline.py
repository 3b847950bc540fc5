"""The robot from above, in its own frame: x to the right, y forward of the midpoint between its wheels, in mm.

Collisions are computed with this outline, and every picture draws it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import field
from functools import lru_cache

from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import RobotSpec, TouchSpec, UltrasonicSpec

SENSOR_HOUSING_MM = 15.0
"""A sensor's housing extends this far from its centre, to every side."""

Point = tuple[float, float]
"""A point: x and y in mm."""


@dataclass(frozen=True, slots=True)
class RobotOutline:
    """The robot's body, a rectangle, and its sensors' places, in robot coordinates: x to the right, y forward."""

    half_width_mm: float
    """How far the body extends to either side: to the outer edge of its wheels."""
    back_mm: float
    """How far the body extends behind the axle, as a negative y."""
    front_mm: float
    """How far the body extends forward of the axle: to the front of its sensors."""
    wheel_width_mm: float
    """Width of each wheel; the wheels are at both sides, inside the body."""
    wheel_radius_mm: float
    has_wheels: bool
    color_sensors_mm: tuple[tuple[float, float, float], ...]
    """x, y and radius of the disc that each colour sensor sees."""
    bumpers_mm: tuple[tuple[float, float, float], ...]
    """x, y and half the width of each touch sensor."""
    other_sensors_mm: tuple[Point, ...]
    """x and y of all other sensors except ultrasonic ones."""
    reach_mm: float = field(init=False)
    """The largest distance of the body from the point about which it turns."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "reach_mm", max(math.hypot(x, y) for x, y in self.corners_mm))

    @property
    def corners_mm(self) -> tuple[Point, Point, Point, Point]:
        """The corners of the body in the robot's coordinates, counter-clockwise from the left rear."""
        side = self.half_width_mm
        return (
            (-side, self.back_mm),
            (side, self.back_mm),
            (side, self.front_mm),
            (-side, self.front_mm),
        )


@lru_cache(maxsize=16)
def build_outline(robot: RobotSpec) -> RobotOutline:
    """Return the outline of a robot seen from above, with the places of its sensors."""
    sensors = [sensor.y_mm for sensor in robot.color_sensors]
    return RobotOutline(
        half_width_mm=(robot.wheel_spacing_mm + robot.wheel_width_mm) / 2,
        back_mm=robot.back_mm,
        front_mm=max([0.0, robot.wheel_diameter_mm / 2, *(y + SENSOR_HOUSING_MM for y in sensors)]),
        wheel_width_mm=robot.wheel_width_mm,
        wheel_radius_mm=robot.wheel_diameter_mm / 2,
        has_wheels=robot.has_wheels,
        color_sensors_mm=tuple(
            (sensor.x_mm, sensor.y_mm, sensor.diameter_mm / 2) for sensor in robot.color_sensors
        ),
        bumpers_mm=tuple(
            (touch.x_mm, touch.y_mm, touch.width_mm / 2) for touch in robot.touch_sensors
        ),
        other_sensors_mm=tuple(_list_other_sensors(robot)),
    )


def _list_other_sensors(robot: RobotSpec) -> Iterator[Point]:
    for sensor in robot.further_sensors:
        if (
            not isinstance(sensor, TouchSpec | UltrasonicSpec)
            and hasattr(sensor, "x_mm")
            and hasattr(sensor, "y_mm")
        ):
            yield sensor.x_mm, sensor.y_mm
