"""Robots, obstacles and mats by name, made into the frozen specification of a run.

To add a robot or a set of obstacles: add an entry to `ROBOTS` or `OBSTACLES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tuisim.assets import Background, background
from tuisim.core.geometry import Pose
from tuisim.core.profile import PROFILES
from tuisim.core.spec import (
    ROBOT_WEIGHTS,
    ColorSensorSpec,
    NoiseSpec,
    Obstacle,
    PenSpec,
    RobotSpec,
    RunSpec,
    UltrasonicSpec,
    WorldSpec,
)
from tuisim.errors import ObstacleError, ProfileError, RobotError
from tuisim.switches import Settings, nearest


def _eyes(x_mm: float, y_mm: float, left_diameter_mm: int, right_diameter_mm: int) -> tuple[ColorSensorSpec, ...]:
    """Two colour sensors, as far to the left as to the right."""
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
    color_sensors=_eyes(10.0, 15.0, 10, 10),
    ultrasonic=UltrasonicSpec(y_mm=10.0),
)

ROBOTS: Mapping[str, RobotSpec] = {
    robot.name: robot
    for robot in (
        RobotSpec(),
        _SMALL,
        replace(_SMALL, name="Small_Robot_Wide_Eyes", color_sensors=_eyes(30.0, 15.0, 10, 10)),
        RobotSpec(name="Sensor_Diameter_Config", color_sensors=_eyes(20.0, 30.0, 30, 10)),
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


def robot(name: str) -> RobotSpec:
    """Return a robot by name.

    Raises:
        RobotError: there is none of that name.
    """
    if name not in ROBOTS:
        raise RobotError(f"no such robot {name!r}", nearest(name, ROBOTS), key="-r")
    return ROBOTS[name]


def obstacles(name: str) -> tuple[Obstacle, ...]:
    """Return a set of obstacles by name.

    Raises:
        ObstacleError: there is none of that name.
    """
    if name not in OBSTACLES:
        raise ObstacleError(f"no such obstacles {name!r}", nearest(name, OBSTACLES), key="-o")
    return OBSTACLES[name]


def _on_mat(robot_spec: RobotSpec, mat: Background) -> RobotSpec:
    """The robot with its sensors where the mat wants them."""
    moved = tuple(
        replace(sensor, x_mm=mat.sensor_x_mm.get(sensor.name, sensor.x_mm)) for sensor in robot_spec.color_sensors
    )
    return replace(robot_spec, color_sensors=moved)


def _start(settings: Settings, mat: Background) -> Pose:
    chosen = {"x_mm": settings.x_mm, "y_mm": settings.y_mm, "heading_deg": settings.heading_deg}
    return replace(mat.start, **{key: value for key, value in chosen.items() if value is not None})


def build_run_spec(settings: Settings) -> RunSpec:
    """Return the run that the settings describe, on the mat's own start pose where they say nothing.

    Raises:
        BackgroundError, RobotError, ObstacleError, ProfileError: there is no such mat, robot, set of
            obstacles or profile.
    """
    mat = background(settings.background)
    if settings.profile not in PROFILES:
        raise ProfileError(f"no such profile {settings.profile!r}", nearest(settings.profile, PROFILES))
    pen = PenSpec(color=settings.pen_color, down=settings.pen_down)
    return RunSpec(
        robot=replace(_on_mat(robot(settings.robot), mat), pen=pen),
        world=WorldSpec(
            background=mat.name,
            obstacles=mat.obstacles if settings.obstacles is None else obstacles(settings.obstacles),
            start=_start(settings, mat),
            noise=NoiseSpec(light=settings.light_noise, motor=settings.motor_noise),
        ),
        profile=PROFILES[settings.profile],
        seed=settings.seed,
    )
