"""Build the frozen specification of a run from settings."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any

from tuisim.config.mats import Background, find_mat, spec_name
from tuisim.config.obstacles import load_obstacles
from tuisim.config.options import RobotChoice, Settings
from tuisim.config.profiles import load_profile
from tuisim.config.reader import errors_at
from tuisim.config.robots import choose_robot
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.profile import ProfileSpec
from tuisim.core.spec import (
    BACKGROUND_FITS,
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    WorldSpec,
)


def robot_on_mat(choice: RobotChoice, mat: Background) -> RobotSpec:
    """Return the robot with its colour sensors at the mat's positions, unless its file sets their positions."""
    if choice.own_places:
        return choice.spec
    moved = tuple(
        replace(sensor, x_mm=mat.sensor_x_mm.get(sensor.name, sensor.x_mm)) for sensor in choice.spec.color_sensors
    )
    return replace(choice.spec, color_sensors=moved)


def _start(settings: Settings, mat: Background, robot: RobotSpec, walled: bool) -> Pose:
    """Return the mat's start pose, overridden by the settings; with solid walls, moved so the robot can turn."""
    start = mat.start
    if walled:
        margin_mm = outline_of(robot).reach_mm
        start = replace(
            start,
            x_mm=_inside(start.x_mm, margin_mm, FIELD_WIDTH_MM),
            y_mm=_inside(start.y_mm, margin_mm, FIELD_HEIGHT_MM),
        )
    chosen = {"x_mm": settings.x_mm, "y_mm": settings.y_mm, "heading_deg": settings.heading_deg}
    return replace(start, **{key: value for key, value in chosen.items() if value is not None})


def _inside(at_mm: float, margin_mm: float, size_mm: float) -> float:
    """Clamp a coordinate to whole mm inside the margins of a side of the field; the middle if the margins overlap."""
    least, most = math.ceil(margin_mm), math.floor(size_mm - margin_mm)
    return min(max(at_mm, least), most) if least <= most else size_mm / 2


def _with_pen(robot: RobotSpec, settings: Settings) -> RobotSpec:
    given = {"color": settings.pen_color, "width_mm": settings.pen_width_mm, "down": settings.pen_down}
    chosen: dict[str, Any] = {key: value for key, value in given.items() if value is not None}
    return replace(robot, pen=replace(robot.pen, **chosen)) if chosen else robot


def _obstacles(settings: Settings, mat: Background) -> tuple[Obstacle, ...]:
    match settings.obstacles:
        case None:
            return mat.obstacles
        case str(word):
            return load_obstacles(word, "-o")
        case boxes:
            return boxes


def _profile(settings: Settings) -> ProfileSpec:
    chosen = settings.profile
    return chosen if isinstance(chosen, ProfileSpec) else load_profile(chosen, "--profile")


def build_run_spec(settings: Settings) -> RunSpec:
    """Return the run specification of the settings; unset ones are decided by mat, robot and profile.

    Raises:
        BackgroundError, RobotError, ObstacleError, ProfileError: an unknown mat, robot, set of obstacles or
            profile, or an invalid file.
    """
    with errors_at("", "-b"):
        mat = find_mat(os.path.expanduser(settings.background), settings.mats)
    chosen = settings.robot
    choice = chosen if isinstance(chosen, RobotChoice) else choose_robot(chosen, "-r")
    profile = _profile(settings)
    solid = profile.solid if settings.solid is None else settings.solid
    robot = _with_pen(robot_on_mat(choice, mat), settings)
    motor = settings.motor_noise if settings.motor_noise is not None else choice.motor_noise or 0
    light = settings.light_noise if settings.light_noise is not None else choice.light_noise or 0
    return RunSpec(
        robot=robot,
        world=WorldSpec(
            background=spec_name(mat),
            obstacles=_obstacles(settings, mat),
            walls=settings.walls,
            solid=solid,
            background_fit=settings.background_fit or mat.fit or BACKGROUND_FITS[0],
            pen_marks=settings.pen_marks,
            start=_start(settings, mat, robot, walled=solid and settings.walls),
            noise=NoiseSpec(light=light, motor=motor),
            beacon=settings.beacon,
            remote=settings.remote,
        ),
        profile=profile,
        seed=settings.seed,
    )
