"""Build the frozen specification of a run from settings, and the settings that give a specification."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any

from tuisim.engine.core import tree
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.profile import PROFILES, ProfileSpec
from tuisim.engine.core.spec import (
    BACKGROUND_FITS,
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    WorldSpec,
)
from tuisim.engine.core.values import list_values
from tuisim.engine.files import errors_at
from tuisim.engine.mats import Background, find_mat, mat_of_spec
from tuisim.engine.obstacles import OBSTACLES, load_obstacles
from tuisim.settings.options import RUN_VALUES, START, Settings
from tuisim.settings.profiles import load_profile
from tuisim.settings.robots import DEFAULT_ROBOT, ROBOTS, RobotChoice

_NEEDS_MEASURED = {"weight": False, "mass_kg": True, "battery_v": True}
"""Values of a robot that only some profiles use, and whether those are the ones with motors as measured on bricks."""


def place_robot(choice: RobotChoice, mat: Background) -> RobotSpec:
    """Return a robot with its colour sensors at the positions that the mat sets, unless the robot's file sets them.

    Args:
        choice: The robot, with the settings in its file.
        mat: The mat.
    """
    if choice.own_places or not mat.sensor_x_mm:
        return choice.spec
    moved = tuple(
        replace(sensor, x_mm=mat.sensor_x_mm.get(sensor.name, sensor.x_mm))
        for sensor in choice.spec.color_sensors
    )
    return replace(choice.spec, color_sensors=moved)


def _start(settings: Settings, mat: Background, robot: RobotSpec, walled: bool) -> Pose:
    """Return the pose at which the robot starts: the mat's, changed by the coordinates and the heading in the settings.

    Within solid walls, the mat's start is moved away from walls that are too close for the robot to turn there.

    Args:
        settings: The settings.
        mat: The mat.
        robot: The robot.
        walled: Whether there are solid walls.
    """
    start = (settings["for_brick"] and mat.brick_start) or mat.start
    if walled:
        margin_mm = build_outline(robot).reach_mm
        start = replace(
            start,
            x_mm=_clamp_inside(start.x_mm, margin_mm, FIELD_WIDTH_MM),
            y_mm=_clamp_inside(start.y_mm, margin_mm, FIELD_HEIGHT_MM),
        )
    chosen = {path: value for path in START if (value := settings[path]) is not None}
    return replace(start, **{path.removeprefix("start."): value for path, value in chosen.items()})


def _clamp_inside(at_mm: float, margin_mm: float, size_mm: float) -> float:
    """Return a coordinate, moved to at least a margin from the edges of the field if it is closer to one.

    The result is the middle of the field if the margins overlap.

    Args:
        at_mm: The coordinate.
        margin_mm: The margin; a moved coordinate is in whole mm.
        size_mm: Length of the field along this axis.
    """
    low, high = math.ceil(margin_mm), math.floor(size_mm - margin_mm)
    return min(max(at_mm, low), high) if low <= high else size_mm / 2


def _place_obstacles(settings: Settings, mat: Background) -> tuple[Obstacle, ...]:
    chosen: str | tuple[Obstacle, ...] | None = settings["obstacles"]
    match chosen:
        case None:
            return mat.obstacles
        case str(word):
            return load_obstacles(word, "-o")
        case boxes:
            return boxes


def _drop_scale_of_ev3(drift: DriftSpec) -> DriftSpec:
    """Return the drift of a robot with a hub: `typical` gets a `gyro_scale_pc` of 0, any other drift is unchanged.

    The typical value of `gyro_scale_pc` comes from measurements of the EV3's gyro.
    """
    text = list_values(WorldSpec)["drift"].format_text(drift)
    is_of_ev3 = text.startswith("typical") and "gyro_scale_pc" not in text
    return replace(drift, gyro_scale_pc=0.0) if is_of_ev3 else drift


def build_run_spec(settings: Settings) -> RunSpec:
    """Return the run specification of the settings; mat, robot and profile decide those that are not set.

    Raises:
        BackgroundError, RobotError, ObstacleError, ProfileError: an unknown mat, robot, set of obstacles or profile, or
            an invalid file.
    """
    with errors_at("", "-b"):
        mat = find_mat(os.path.expanduser(settings["background"]), settings["mats"])
    choice = RobotChoice.load(settings["robot"], "-r")
    named = settings["profile"]
    profile = named if isinstance(named, ProfileSpec) else load_profile(named, "--profile")
    world = WorldSpec(
        background=mat.find_spec_name(),
        obstacles=_place_obstacles(settings, mat),
        solid=profile.solid,
        background_fit=mat.fit or BACKGROUND_FITS[0],
        noise=NoiseSpec(light=choice.light_noise or 0, motor=choice.motor_noise or 0),
        beacon=settings["beacon"],
        remote=settings["remote"],
    )
    spec_values = {
        option.spec_path: value
        for path, option in RUN_VALUES.items()
        if (value := settings[path]) is not None
    }
    spec = tree.put_all(RunSpec(place_robot(choice, mat), world, profile), spec_values)
    if spec.robot.hub:
        spec = tree.put(spec, "world.drift", _drop_scale_of_ev3(spec.world.drift))
    world = spec.world
    return tree.put(
        spec, "world.start", _start(settings, mat, spec.robot, walled=world.solid and world.walls)
    )


def list_ineffective(spec: RunSpec) -> list[str]:
    """Return a sentence for each value of a run's robot that was changed, but has no effect under the run's profile."""
    usual = ROBOTS.get(spec.robot.name, ROBOTS[DEFAULT_ROBOT])
    law = spec.profile.motor_law
    sentences = []
    for key, needs_measured in _NEEDS_MEASURED.items():
        if law.is_measured is not needs_measured and getattr(spec.robot, key) != getattr(
            usual, key
        ):
            names = [
                name
                for name, profile in PROFILES.items()
                if profile.motor_law.is_measured is needs_measured
            ]
            sentences.append(
                f"{key} has no effect under profile {spec.profile.name} (only {', '.join(names)})"
            )
    return sentences


def extract_settings(spec: RunSpec) -> dict[str, Any]:
    """Return the settings from which `build_run_spec` builds an equal specification, by path such as `start.x_mm`.

    A robot, a profile or obstacles that equal a preset are given by its name. If the world is as solid as the profile
    makes it, `solid` is None.

    Raises:
        ConfigError: the mat of the run no longer exists.
    """
    world = spec.world
    word, mat = mat_of_spec(world.background)
    settings = {path: tree.get_value(spec, option.spec_path) for path, option in RUN_VALUES.items()}
    return settings | {
        "background": word,
        "robot": _name_robot(spec.robot, mat),
        "obstacles": next(
            (name for name, boxes in OBSTACLES.items() if boxes == world.obstacles), world.obstacles
        ),
        "solid": None if world.solid == spec.profile.solid else world.solid,
        "profile": spec.profile.name
        if PROFILES.get(spec.profile.name) == spec.profile
        else spec.profile,
        "beacon": world.beacon,
        "remote": world.remote,
        "for_brick": world.start == mat.brick_start,
    }


def _name_robot(robot: RobotSpec, mat: Background) -> str | RobotChoice:
    """Return the name of the preset that is equal to a robot on a mat; the robot itself if there is no such preset.

    The mat sets the positions of the preset's sensors. The position of the pen is not compared.
    """
    for preset in ROBOTS.values():
        on_mat = place_robot(RobotChoice(preset, own_places=False), mat)
        place = replace(robot.pen, x_mm=on_mat.pen.x_mm, y_mm=on_mat.pen.y_mm)
        if replace(on_mat, pen=place) == robot:
            return preset.name
    return RobotChoice(robot)
