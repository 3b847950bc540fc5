"""Poses of the robot: saved ones, stored in the user's data folder, and random ones clear of obstacles."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from tuisim.base.atomic import make_private_folder
from tuisim.base.errors import ConfigError
from tuisim.base.folders import home_folder
from tuisim.engine import files
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, START_VALUES, RunSpec
from tuisim.engine.files import (
    Location,
    read_file,
    required,
    save_toml,
    table,
    toml_key,
    toml_lines,
)

MAX_TRIES = 2000

Corners = Sequence[tuple[float, float]]


def choose_random_pose(spec: RunSpec, chance: random.Random) -> Pose | None:
    """Return a random pose in whole mm and degrees at which the robot is on the field and touches no solid obstacle.

    Args:
        spec: Robot and world.
        chance: The random number generator.

    Returns:
        None if no such pose was found.
    """
    for _ in range(MAX_TRIES):
        x_mm, y_mm = chance.randint(0, FIELD_WIDTH_MM), chance.randint(0, FIELD_HEIGHT_MM)
        pose = Pose(float(x_mm), float(y_mm), float(chance.randint(-179, 180)))
        if has_room(spec, pose):
            return pose
    return None


def has_room(spec: RunSpec, pose: Pose) -> bool:
    """Return whether the whole robot is on the field at a pose, and touches no solid obstacle."""
    corners = [world_point(pose, x, y) for x, y in build_outline(spec.robot).corners_mm]
    if not all(0 <= x <= FIELD_WIDTH_MM and 0 <= y <= FIELD_HEIGHT_MM for x, y in corners):
        return False
    if not spec.world.solid:
        return True
    boxes = (
        (
            (o.x_mm, o.y_mm),
            (o.x_mm + o.width_mm, o.y_mm),
            (o.x_mm, o.y_mm + o.height_mm),
            (o.x_mm + o.width_mm, o.y_mm + o.height_mm),
        )
        for o in spec.world.obstacles
    )
    return not any(_overlap(corners, box, pose.heading_deg) for box in boxes)


def _overlap(first: Corners, other: Corners, heading_deg: float) -> bool:
    """Return whether two rectangles overlap.

    Args:
        first: The corners of a rectangle whose sides are parallel to the axes.
        other: The corners of a rectangle that is turned.
        heading_deg: By how much the rectangle `other` is turned, in degrees.
    """
    heading = math.radians(heading_deg)
    axes = (
        (1.0, 0.0),
        (0.0, 1.0),
        (math.cos(heading), math.sin(heading)),
        (-math.sin(heading), math.cos(heading)),
    )
    for across, up in axes:
        ours, theirs = ([x * across + y * up for x, y in corners] for corners in (first, other))
        if max(ours) <= min(theirs) or max(theirs) <= min(ours):
            return False
    return True


FILE = "poses.toml"
MAX_POSES = 500
MAX_NAME = 40

_HEAD = "# Poses saved in tuisim: mm from the lower left corner, degrees counter-clockwise from +x."


def find_poses_file() -> Path:
    """Return the path of the file with the saved poses; the file need not exist."""
    return home_folder() / FILE


def load_poses() -> dict[str, Pose]:
    """Return the saved poses by name, in the order in which they were saved.

    Raises:
        ConfigError: the file of the poses cannot be read or is invalid.
    """
    path = find_poses_file()
    return _parse_poses(read_file(path, ConfigError)) if path.exists() else {}


def _parse_poses(data: object) -> dict[str, Pose]:
    location = Location(str(find_poses_file()))
    poses = required(table(data, location, ("poses",)), "poses", location)
    return {
        name: parse_pose(pose, location.at(f"poses.{name}"))
        for name, pose in table(poses, location.at("poses")).items()
    }


def save_pose(name: str, pose: Pose) -> None:
    """Save a pose under a name; a saved pose with the same name is replaced.

    Raises:
        ConfigError: the name is invalid, the file is invalid or cannot be written, or there are too many poses.
    """
    name = name.strip()
    if not name or len(name) > MAX_NAME or not name.isprintable():
        raise ConfigError(f"a pose needs a name of 1 to {MAX_NAME} characters")
    poses = {**load_poses(), name: pose}
    if len(poses) > MAX_POSES:
        raise ConfigError(
            f"{MAX_POSES} poses are saved already", "delete some first", file=str(find_poses_file())
        )
    _write(poses)


def delete_pose(name: str) -> None:
    """Delete a saved pose, given by its name.

    Raises:
        ConfigError: the file is invalid or cannot be written.
    """
    _write({other: pose for other, pose in load_poses().items() if other != name})


def _write(poses: Mapping[str, Pose]) -> None:
    path = find_poses_file()
    lines = [_HEAD, "", "[poses]"]
    for name, pose in poses.items():
        lines += ["", f"[poses.{toml_key(name)}]", *toml_lines(asdict(pose))]
    try:
        make_private_folder(path.parent)
    except OSError as error:
        raise ConfigError(
            f"cannot be made: {error.strerror or error}", file=str(path.parent)
        ) from None
    save_toml(path, lines, Location(str(path)), _parse_poses, poses, owner_only=True)


def parse_pose(data: object, location: Location) -> Pose:
    """Return the pose in a table of the file; all of its keys are required.

    Args:
        data: The table.
        location: File and place of the table, for errors.

    Raises:
        ConfigError: a key is missing or unknown, or a value is wrong.
    """
    entries = files.table(data, location, START_VALUES)
    coordinates = {
        key: files.read_value(value, START_VALUES[key], location.at(key))
        for key, value in entries.items()
    }
    for key in START_VALUES:
        files.required(coordinates, key, location)
    return Pose(**coordinates)
