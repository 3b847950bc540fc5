"""Robots by name or from a file: read, and written so that they read back the same."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from tuisim.config.options import RobotChoice, nearest
from tuisim.config.presets import ROBOTS
from tuisim.config.reader import Section, means_file, name_of, parse_toml, read_file
from tuisim.config.robot_json import robot_from_json
from tuisim.config.robot_table import DEFAULT_ROBOT, LENGTH_KEYS, PEN_KEYS, PORT_KEYS, keys_of, robot_from_table
from tuisim.config.toml_writer import Scalar, toml_key, toml_lines, write_toml
from tuisim.core.parts import TouchSpec
from tuisim.core.spec import MOUNTS, ROBOT_WEIGHTS, RobotSpec
from tuisim.errors import RobotError

COMMENTS = {
    "wheel_spacing_mm": "between the centres of the wheels",
    "back_mm": "how far the body reaches behind the axle, as a negative y",
    "weight": f"{', '.join(ROBOT_WEIGHTS)}, or a number",
    "left_port": "outA … outD",
    "port": "in1 … in4",
    "x_mm": "to the right of the robot's centre",
    "y_mm": "forward of the axle",
    "diameter_mm": "of the visible disc, whole mm",
    "strategy": "weights of the disc's pixels: mean, gaussian or centre",
    "angle_deg": "counter-clockwise from straight ahead",
    "max_range_mm": "reported when no echo returns",
    "noise_mm": "uniform, plus or minus this value",
    "ray_angles_deg": "directions of the rays; the nearest echo counts",
    "color": "a CSS colour name, or #rrggbb",
}
_FURTHER_COMMENTS: Mapping[type, Mapping[str, str]] = {TouchSpec: {"width_mm": "of the bumper, across the robot"}}
"""Comments on keys in sensors of one class only."""

_HEAD = (
    "# A robot for tuisim. Lengths in mm, angles in degrees; x to the right of the midpoint between the wheels,",
    "# y forward of it.",
)


def load_robot(word: str, key: str = "") -> RobotSpec:
    """Return a robot by name, or from a TOML or JSON file.

    Args:
        word: The name or the path.
        key: The switch to name in errors about an unknown name, such as `-r`.

    Raises:
        RobotError: the name is unknown, or the file is wrong.
    """
    return choose_robot(word, key).spec


def choose_robot(word: str, key: str = "") -> RobotChoice:
    """Like `load_robot`, with the other settings in the file.

    Raises:
        RobotError: the name is unknown, or the file is wrong.
    """
    if word in ROBOTS:
        return RobotChoice(ROBOTS[word], own_places=False)
    if not means_file(word):
        hint = f"{nearest(word, ROBOTS)}; or a .toml or .json file"
        raise RobotError(f"no such robot {word!r}", hint, key=key)
    path = Path(word).expanduser()
    data = read_file(path, RobotError)
    if path.suffix.lower() == ".json":
        return robot_from_json(Section(data, str(path), RobotError), name_of(path))
    return robot_from_table(Section(data, str(path), RobotError), name_of(path))


def save_robot(spec: RobotSpec, path: Path | str) -> None:
    """Write a robot atomically to a TOML file; `load_robot` returns an equal one.

    Raises:
        RobotError: the file cannot be written, or cannot represent the robot, such as a name of two lines.
    """
    path = Path(path)
    lines = robot_file(spec)
    table = Section(parse_toml("\n".join(lines), str(path), RobotError), str(path), RobotError)
    if robot_from_table(table, name_of(path)).spec != spec:
        raise RobotError("a file cannot represent this robot", file=str(path))
    write_toml(path, lines, RobotError)


def robot_file(spec: RobotSpec) -> list[str]:
    """Return the lines of a robot file."""
    return [*_HEAD, "", *robot_lines(spec)]


def robot_lines(spec: RobotSpec, parent: str = "", pen_keys: Iterable[str] = PEN_KEYS) -> list[str]:
    """Return a robot as TOML lines, with every value.

    Args:
        spec: The robot.
        parent: The name of its table; empty for a file of its own.
        pen_keys: The keys to write of its pen.
    """
    under = f"{parent}." if parent else ""
    lines = [f"[{parent}]"] if parent else []
    values = _values(spec, ("name", *LENGTH_KEYS, "weight", *PORT_KEYS))
    values["weight"] = next((name for name, weight in ROBOT_WEIGHTS.items() if weight == spec.weight), spec.weight)
    lines += toml_lines(values, COMMENTS)
    names = [sensor.name for sensor in spec.color_sensors]
    if gone := [sensor.name for sensor in ROBOTS[DEFAULT_ROBOT].color_sensors if sensor.name not in names]:
        lines += ["", f"[{under}color_sensors]", *(f"{toml_key(name)} = false" for name in gone)]
    for mount in MOUNTS:
        if mount.usual and not mount.many and not spec.sensors_in(mount):
            # Keys of the robot itself must precede its first table.
            lines.insert(1 if parent else 0, f"{mount.key} = false")
    for mount in MOUNTS:
        for sensor in spec.sensors_in(mount):
            place = f"{mount.key}.{toml_key(sensor.name)}" if mount.many else mount.key
            comments = {**COMMENTS, **_FURTHER_COMMENTS.get(mount.spec, {})}
            lines += ["", f"[{under}{place}]", *toml_lines(_values(sensor, keys_of(mount.spec)), comments)]
    wheels = [motor for motor in spec.wheel_motors if motor.kind != "large"]
    if wheels or spec.extra_motors:
        motors: dict[str, Scalar] = {motor.port: motor.kind for motor in (*wheels, *spec.extra_motors)}
        lines += ["", f"[{under}motors]", *toml_lines(motors)]
    return [*lines, "", f"[{under}pen]", *toml_lines(_values(spec.pen, pen_keys), COMMENTS)]


def _values(spec: object, keys: Iterable[str]) -> dict[str, Scalar]:
    values = {key: getattr(spec, key) for key in keys}
    return {key: list(value) if isinstance(value, tuple) else value for key, value in values.items()}
