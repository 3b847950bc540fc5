"""Writes a run specification as a world file that gives the same run."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.config.build import build_run_spec, robot_on_mat
from tuisim.config.mats import Background, mat_of_spec
from tuisim.config.obstacles import obstacle_lines
from tuisim.config.options import RobotChoice, settings_of
from tuisim.config.presets import OBSTACLES, ROBOTS
from tuisim.config.profiles import profile_lines
from tuisim.config.reader import Section, parse_toml
from tuisim.config.robots import robot_lines
from tuisim.config.toml_writer import Scalar, toml_lines, write_toml
from tuisim.config.worlds import infrared_lines, world_from_table
from tuisim.core.profile import PROFILES, ProfileSpec
from tuisim.core.spec import RobotSpec, RunSpec
from tuisim.errors import ConfigError

_HEAD = "# A world for tuisim. Lengths in mm, angles in degrees counter-clockwise from +x; y up from the bottom edge."
_COMMENTS = {
    "program": "relative to this file",
    "arguments": "the program's sys.argv[1:]",
    "background": "a mat's name, or an image relative to this file",
    "background_fit": "for an image: stretch, fit, centre or corner",
    "walls": "on the four edges of the field",
    "solid": "whether obstacles and walls stop the robot",
    "pen_marks": "whether the sensors see what the pen draws",
    "light": "0 … 128, steps of 255",
    "motor": "0 … 500, degrees per second",
    "color": "a CSS colour name, or #rrggbb",
}


def settings_from(spec: RunSpec) -> dict[str, Any]:
    """Return the settings that give this run, keyed by field of `Settings`; presets are given by name.

    `solid` is None where it equals the profile's default.

    Raises:
        ConfigError: its mat no longer exists.
    """
    world, pen = spec.world, spec.robot.pen
    word, mat = mat_of_spec(world.background)
    return {
        "background": word,
        "background_fit": world.background_fit,
        "robot": _robot(spec.robot, mat),
        "obstacles": next((name for name, boxes in OBSTACLES.items() if boxes == world.obstacles), world.obstacles),
        "walls": world.walls,
        "solid": None if world.solid == spec.profile.solid else world.solid,
        "x_mm": world.start.x_mm,
        "y_mm": world.start.y_mm,
        "heading_deg": world.start.heading_deg,
        "light_noise": world.noise.light,
        "motor_noise": world.noise.motor,
        "pen_down": pen.down,
        "pen_color": pen.color,
        "pen_width_mm": pen.width_mm,
        "pen_marks": world.pen_marks,
        "profile": spec.profile.name if PROFILES.get(spec.profile.name) == spec.profile else spec.profile,
        "seed": spec.seed,
        "beacon": world.beacon,
        "remote": world.remote,
    }


def _robot(robot: RobotSpec, mat: Background) -> str | RobotChoice:
    """Return the name of the preset that equals the robot except for its pen, else the robot itself."""
    for preset in ROBOTS.values():
        on_mat = robot_on_mat(RobotChoice(preset, own_places=False), mat)
        place = replace(robot.pen, x_mm=on_mat.pen.x_mm, y_mm=on_mat.pen.y_mm)
        if replace(on_mat, pen=place) == robot:
            return preset.name
    return RobotChoice(robot)


def save_world(spec: RunSpec, path: Path | str, program: str | None = None, arguments: Sequence[str] = ()) -> None:
    """Write a run atomically to a world file from which an equal run is built.

    Args:
        spec: The run.
        path: The file; an image and a program are written relative to its folder.
        program: The program to run in it, as a path or as the name of an example.
        arguments: The program's arguments.

    Raises:
        ConfigError: the file cannot be written, or cannot represent the run.
    """
    path = Path(path)
    lines = world_lines(spec, path.parent, program, arguments)
    table = Section(parse_toml("\n".join(lines), str(path), ConfigError), str(path), ConfigError)
    if build_run_spec(settings_of(world_from_table(table, path).settings)) != spec:
        raise ConfigError("a file cannot represent this world", file=str(path))
    write_toml(path, lines, ConfigError)


def world_lines(spec: RunSpec, folder: Path, program: str | None = None, arguments: Sequence[str] = ()) -> list[str]:
    """Return a run as TOML lines.

    Args:
        spec: The run.
        folder: Where the file will be; paths are relative to it.
        program, arguments: As for `save_world`.
    """
    settings = settings_from(spec)
    top: dict[str, Scalar] = {}
    if program is not None:
        top["program"] = _relative(program, folder) if Path(program).exists() else program
    if arguments:
        top["arguments"] = list(arguments)
    mat = settings["background"]
    top["background"] = _relative(mat, folder) if os.sep in mat else mat
    settings["solid"] = spec.world.solid
    for key in ("background_fit", "walls", "solid", "pen_marks", "robot", "obstacles", "profile", "seed"):
        if isinstance(settings[key], str | int):
            top[key] = settings[key]
    lines = [_HEAD, "", *toml_lines(top, _COMMENTS)]
    lines += _table("start", {key: settings[key] for key in ("x_mm", "y_mm", "heading_deg")})
    lines += _table("noise", {key: settings[f"{key}_noise"] for key in ("light", "motor")})
    pen = {"down": "pen_down", "color": "pen_color", "width_mm": "pen_width_mm"}
    lines += _table("pen", {key: settings[field] for key, field in pen.items()})
    if isinstance(settings["robot"], RobotChoice):
        lines += ["", *robot_lines(spec.robot, "robot", ("x_mm", "y_mm"))]
    if isinstance(settings["profile"], ProfileSpec):
        lines += ["", *profile_lines(spec.profile, "profile")]
    if not isinstance(settings["obstacles"], str):
        lines += ["", *obstacle_lines(spec.world.obstacles)]
    return [*lines, *infrared_lines(spec.world.beacon, spec.world.remote)]


def _table(name: str, values: Mapping[str, Scalar]) -> list[str]:
    return ["", f"[{name}]", *toml_lines(values, _COMMENTS)]


def _relative(path: str, folder: Path) -> str:
    """Return a path relative to a folder, in a form that cannot be mistaken for a name."""
    found = os.path.relpath(os.path.expanduser(path), folder)
    return found if os.sep in found or Path(found).suffix else f".{os.sep}{found}"
