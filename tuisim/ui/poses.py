"""Saved poses: places of the robot by name, kept in the user's data folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from tuisim.atomic import make_private_folder
from tuisim.core.geometry import Pose
from tuisim.errors import ConfigError

FILE = "poses.toml"
MAX_POSES = 500
MAX_NAME = 40

_HEAD = "# Poses saved in tuisim: mm from the lower left corner, degrees counter-clockwise from +x."
_LIMITS = {"x_mm": 10_000.0, "y_mm": 10_000.0, "heading_deg": 36_000.0}


def poses_file() -> Path:
    """Return where poses are kept."""
    from tuisim.home import home_folder

    return home_folder() / FILE


def load_poses() -> dict[str, Pose]:
    """Return the saved poses by name, in the order in which they were saved.

    Raises:
        ConfigError: their file cannot be read or is wrong.
    """
    from tuisim.config.reading import Section, read_file

    path = poses_file()
    if not path.exists():
        return {}
    table = Section(read_file(path, ConfigError), str(path), ConfigError)
    table.allow(("poses",))
    poses = table.section("poses")
    found = {}
    for name in poses:
        place = poses.section(name)
        place.allow(_LIMITS)
        found[name] = Pose(*(place.number(key, -limit, limit) for key, limit in _LIMITS.items()))
    return found


def save_pose(name: str, pose: Pose) -> None:
    """Save a pose; one of that name is replaced.

    Raises:
        ConfigError: the name is no name, the file is wrong or cannot be written, or there are too many.
    """
    name = name.strip()
    if not name or len(name) > MAX_NAME or not name.isprintable():
        raise ConfigError(f"a pose needs a name of 1 to {MAX_NAME} characters")
    poses = {**load_poses(), name: pose}
    if len(poses) > MAX_POSES:
        raise ConfigError(f"{MAX_POSES} poses are saved already", "delete some first", file=str(poses_file()))
    _write(poses)


def delete_pose(name: str) -> None:
    """Delete a saved pose.

    Raises:
        ConfigError: the file is wrong or cannot be written.
    """
    _write({other: pose for other, pose in load_poses().items() if other != name})


def _write(poses: Mapping[str, Pose]) -> None:
    from tuisim.config.writing import toml_key, toml_lines, write_toml

    path = poses_file()
    lines = [_HEAD, "", "[poses]"]
    for name, pose in poses.items():
        lines += ["", f"[poses.{toml_key(name)}]", *toml_lines(asdict(pose))]
    try:
        make_private_folder(path.parent)
    except OSError as error:
        raise ConfigError(f"cannot be made: {error.strerror or error}", file=str(path.parent)) from None
    write_toml(path, lines, ConfigError, owner_only=True)
