"""Where on a robot an additional sensor is, given the side of the robot, and what name it gets."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    RobotSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)

BUMPER_MM = 60.0
"""How far a bumper is ahead of the axle, before the front of the robot."""
LOOKS: Mapping[str, tuple[float, float, float]] = {
    "front": (0.0, 20.0, 0.0),
    "left": (-60.0, 0.0, 90.0),
    "right": (60.0, 0.0, -90.0),
    "back": (0.0, -100.0, 180.0),
    "middle": (0.0, 20.0, 0.0),
}
"""x and y in mm, and direction in degrees, of a sensor that looks along the field, by its side of the robot."""
DOWN: Mapping[str, tuple[float, float]] = {
    "middle": (0.0, 30.0),
    "front": (0.0, 60.0),
    "left": (-50.0, 30.0),
    "right": (50.0, 30.0),
    "back": (0.0, -60.0),
}
"""x and y in mm of a colour sensor, which looks down, by its side of the robot."""
ORDERS: Mapping[type[SensorSpec], tuple[str, ...]] = {
    ColorSensorSpec: ("middle", "front", "left", "right"),
    UltrasonicSpec: ("front", "right", "left", "back"),
    InfraredSpec: ("front", "right", "left", "back"),
    TouchSpec: ("left", "right", "back", "front"),
    GyroSpec: ("middle",),
}
"""Sides of the robot on which sensors of a class are placed, one after another, unless the side is given."""


@dataclass(frozen=True, slots=True)
class Body:
    """How far a robot's body extends from the midpoint between its wheels, in mm."""

    half_width_mm: float
    """How far the body extends to either side of its middle."""
    back_mm: float
    """How far the body extends behind the axle, as a negative y."""


def measure_body(robot: RobotSpec) -> Body:
    """Return how far a robot's body extends from the midpoint between its wheels."""
    return Body((robot.wheel_spacing_mm + robot.wheel_width_mm) / 2, robot.back_mm)


def _choose_name(base: str, side: str, names: Collection[str]) -> str:
    """Return a name for a new sensor that is not in `names`: `base`, or else `base` with the side, or with a number."""
    choices = [base, f"{base}_{side}", *(f"{base}{number}" for number in range(2, 6))]
    return next(name for name in choices if name not in names)


def place_sensor(
    kind: type[SensorSpec], port: str, side: str, names: Collection[str], body: Body
) -> SensorSpec:
    """Return a sensor on a side of a robot.

    Args:
        kind: Its class.
        port: Its port.
        side: The side.
        names: The names of the other sensors.
        body: The robot's body.
    """
    if kind is ColorSensorSpec and side not in names:
        return ColorSensorSpec(str(side), port, *DOWN[side])
    name = _choose_name(_NAMES[kind], side, names)
    if kind is GyroSpec:
        return GyroSpec(name, port)
    if kind is TouchSpec:
        # The bumper is as wide as the robot, or half as wide on one side: with a narrow bumper, a corner of the robot
        # would meet a wall first.
        half_mm = body.half_width_mm
        x_mm = {"left": -half_mm / 2, "right": half_mm / 2}.get(side, 0.0)
        y_mm = body.back_mm - 15.0 if side == "back" else BUMPER_MM
        return TouchSpec(name, port, x_mm, y_mm, half_mm if x_mm else 2 * half_mm)
    return kind(name, port, *(DOWN if kind is ColorSensorSpec else LOOKS)[side])


_NAMES: Mapping[type[SensorSpec], str] = {
    ColorSensorSpec: "color",
    UltrasonicSpec: "ultrasonic",
    GyroSpec: "gyro",
    TouchSpec: "touch",
    InfraredSpec: "infrared",
}
"""Usual names of sensors, by their class."""
