"""The named robots and sets of obstacles.

To add a robot or a set of obstacles: add an entry to `ROBOTS` or `OBSTACLES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tuisim.core.parts import InfraredSpec, MotorSpec, TouchSpec
from tuisim.core.spec import ROBOT_WEIGHTS, ColorSensorSpec, Obstacle, RobotSpec, UltrasonicSpec


def _sensor_pair(
    x_mm: float, y_mm: float, left_diameter_mm: int, right_diameter_mm: int
) -> tuple[ColorSensorSpec, ...]:
    """Return two colour sensors, symmetric about the robot's axis."""
    return (
        ColorSensorSpec("left", "in2", -x_mm, y_mm, left_diameter_mm),
        ColorSensorSpec("right", "in3", x_mm, y_mm, right_diameter_mm),
    )


_SMALL = RobotSpec(
    name="Small_Robot",
    wheel_diameter_mm=28.0,
    wheel_spacing_mm=90.0,
    back_mm=-60.0,
    weight=ROBOT_WEIGHTS["weightless"],
    color_sensors=_sensor_pair(10.0, 15.0, 10, 10),
    ultrasonic=UltrasonicSpec(y_mm=10.0),
)

ROBOTS: Mapping[str, RobotSpec] = {
    robot.name: robot
    for robot in (
        RobotSpec(),
        _SMALL,
        replace(_SMALL, name="Small_Robot_Wide_Eyes", color_sensors=_sensor_pair(30.0, 15.0, 10, 10)),
        RobotSpec(name="Sensor_Diameter_Config", color_sensors=_sensor_pair(20.0, 30.0, 30, 10)),
        RobotSpec(
            name="Explorer",
            color_sensors=(ColorSensorSpec("left", "in2", 0.0, 30.0),),
            ultrasonic=None,
            extra_motors=(MotorSpec("outA", "medium"),),
            touch_sensors=(TouchSpec("bumper", "in1", 0.0, 60.0, 60.0),),
            infrared=InfraredSpec(port="in3"),
        ),
    )
}
"""Every robot by name."""

NO_OBSTACLES = "None"

OBSTACLES: Mapping[str, tuple[Obstacle, ...]] = {
    NO_OBSTACLES: (),
    "Central_post": (Obstacle(900, 500, 200, 200),),
    "Square_posts": tuple(Obstacle(x_mm, y_mm, 100, 100) for x_mm in (500, 1500) for y_mm in (200, 700)),
    "Wall": (Obstacle(1500, 200, 200, 800),),
}
"""Every set of obstacles by name."""
