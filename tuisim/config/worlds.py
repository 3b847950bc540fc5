"""World files: TOML with mat, obstacles, robot, noise, start pose, pen, profile and infrared beacon."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from tuisim.config.folders import programs_folder
from tuisim.config.mats import find_mat
from tuisim.config.obstacles import load_obstacles, obstacles_from_table
from tuisim.config.options import MAX_ANGLE_DEG, MAX_PEN_MM, MAX_POSITION_MM, MAX_SEED, MIN_PEN_MM, PANELS, pen_color
from tuisim.config.profiles import load_profile, profile_from_table
from tuisim.config.reader import Section, means_file, name_of, read_file, shown
from tuisim.config.robot_table import robot_from_table
from tuisim.config.robots import load_robot
from tuisim.config.toml_writer import Scalar, toml_lines
from tuisim.core.parts import REMOTE_BUTTONS, BeaconSpec, RemotePress
from tuisim.core.spec import BACKGROUND_FITS, MAX_LIGHT_NOISE, MAX_MOTOR_NOISE
from tuisim.errors import ConfigError, ObstacleError, ProfileError, RobotError

WORLD_SUFFIX = ".toml"
FLAGS = {"walls": "walls", "solid": "solid", "pen_marks": "pen_marks", "rays": "rays", "autorun": "autorun"}
START_LIMITS = {"x_mm": MAX_POSITION_MM, "y_mm": MAX_POSITION_MM, "heading_deg": MAX_ANGLE_DEG}
NOISE_LIMITS = {"light": MAX_LIGHT_NOISE, "motor": MAX_MOTOR_NOISE}
PANEL_KEYS = {"panels": "panels_on", "hidden_panels": "panels_off"}
PEN_KEYS = ("down", "color", "width_mm")
TOP_KEYS = (
    "program", "arguments", "background", "mats", "background_fit", "robot", "obstacles", "obstacle", "profile", "seed",
    *FLAGS, *PANEL_KEYS, "start", "noise", "pen", "beacon", "remote",
)  # fmt: skip


Resolver = Callable[[str], str]
"""Resolves a path in the file."""


@dataclass(frozen=True, slots=True)
class WorldFile:
    """The contents of a world file."""

    path: Path
    settings: Mapping[str, Any]
    """By field of `Settings`; in precedence between a program's magic line and the command line."""
    program: str | None = None
    """The program to run in it: a path, or the name of an example."""
    files: tuple[Path, ...] = ()
    """The file itself, and the files that it refers to."""


def means_world(word: str) -> bool:
    """Return whether a word of the command line names a world file, not a program."""
    return Path(word).suffix.lower() == WORLD_SUFFIX


def load_world(path: Path | str, mats: str | None = None) -> WorldFile:
    """Read a world file. Paths in it are relative to its folder.

    Args:
        path: The file.
        mats: A folder of the user's own mats, used if the file names none.

    Raises:
        ConfigError: the file, or a file that it refers to, cannot be read or is wrong.
    """
    path = Path(path).expanduser()
    if not means_world(path.name):
        raise ConfigError(f"is not a {WORLD_SUFFIX} file", "a world file is TOML", file=str(path))
    return world_from_table(Section(read_file(path, ConfigError), str(path), ConfigError), path, mats)


def world_from_table(table: Section, path: Path, mats: str | None = None) -> WorldFile:
    """Return the world in a table.

    Args:
        table: The table.
        path: The path of the file, which may not exist yet.
        mats: As for `load_world`.

    Raises:
        ConfigError: a key or a value is wrong.
    """
    table.allow(TOP_KEYS)
    referred: list[Path] = []
    resolve = partial(_resolved, path.parent, referred)
    found: dict[str, Any] = _mat(table, resolve, mats)
    found |= {field: table.flag(key) for key, field in FLAGS.items() if key in table}
    for key, choose in (("robot", _robot), ("obstacles", _obstacles), ("profile", _profile)):
        if key in table:
            found[key] = choose(table, resolve, path)
    if "obstacle" in table:
        if "obstacles" in table:
            raise table.wrong("obstacle", "is given together with obstacles", "give only one of them")
        found["obstacles"] = obstacles_from_table(table)
    if "seed" in table:
        found["seed"] = table.whole("seed", 0, MAX_SEED)
    found |= _noise(table) | _pen(table) | _panels(table) | infrared_from_table(table)
    if "arguments" in table:
        found["arguments"] = tuple(_argument(table, at, word) for at, word in enumerate(table.items("arguments"), 1))
    program = _program(table.text("program"), path.parent, resolve) if "program" in table else None
    return WorldFile(path, found, program, (path, *referred))


def _argument(table: Section, at: int, word: object) -> str:
    if not isinstance(word, str):
        raise table.wrong(f"arguments[{at}]", f"must be text, got {shown(word)}", 'in quotes, such as "5"')
    if "\0" in word:
        raise table.wrong(f"arguments[{at}]", "must be text without null characters")
    return word


def _program(word: str, folder: Path, resolve: Resolver) -> str:
    """Resolve the path of a program; an example's name stays a name if there is no such file beside the world."""
    known = os.sep not in word and not (folder / word).exists()
    if known and any((programs_folder() / name).is_file() for name in (word, f"{word}.py")):
        return word
    return resolve(word)


def _resolved(folder: Path, referred: list[Path], word: str) -> str:
    """Resolve a path in the file, and append it to `referred`."""
    found = Path(os.path.normpath(folder / os.path.expanduser(word)))
    referred.append(found)
    return str(found)


def _mat(table: Section, resolve: Resolver, mats: str | None) -> dict[str, Any]:
    """Return mat, fit and start pose. A mat has its own start pose, so it also discards the magic line's."""
    found: dict[str, Any] = {}
    if "background_fit" in table:
        found["background_fit"] = table.one_of("background_fit", BACKGROUND_FITS)
    if "mats" in table:
        found["mats"] = resolve(table.text("mats"))
    if "background" in table:
        word = table.text("background")
        found |= dict.fromkeys(START_LIMITS)
        found["background"] = resolve(word) if os.sep in word or Path(word).suffix else word
        with table.telling("background"):
            find_mat(found["background"], found.get("mats", mats))
    if "start" in table:
        start = table.section("start")
        start.allow(START_LIMITS)
        found |= {key: start.number(key, -high, high) for key, high in START_LIMITS.items() if key in start}
    return found


def _robot(table: Section, resolve: Resolver, path: Path) -> Any:
    if not isinstance(table.raw("robot"), str):
        return robot_from_table(table.section("robot", RobotError), name_of(path))
    return _named(table, "robot", resolve, load_robot)


def _obstacles(table: Section, resolve: Resolver, path: Path) -> Any:
    return _named(table, "obstacles", resolve, load_obstacles)


def _profile(table: Section, resolve: Resolver, path: Path) -> Any:
    if not isinstance(table.raw("profile"), str):
        return profile_from_table(table.section("profile", ProfileError), name_of(path))
    return _named(table, "profile", resolve, load_profile)


def _named(table: Section, key: str, resolve: Resolver, load: Callable[[str], object]) -> str:
    """Return the name or file in a key; it is loaded once, so that errors name this file and key."""
    word = table.text(key)
    if means_file(word):
        word = resolve(word)
    with table.telling(key):
        load(word)
    return word


def _noise(table: Section) -> dict[str, Any]:
    if "noise" not in table:
        return {}
    noise = table.section("noise")
    noise.allow(NOISE_LIMITS)
    return {f"{key}_noise": noise.whole(key, 0, high) for key, high in NOISE_LIMITS.items() if key in noise}


def _pen(table: Section) -> dict[str, Any]:
    if "pen" not in table:
        return {}
    pen = table.section("pen")
    pen.allow(PEN_KEYS)
    found: dict[str, Any] = {}
    if "down" in pen:
        found["pen_down"] = pen.flag("down")
    if "color" in pen:
        found["pen_color"] = pen.converted("color", pen_color)
    if "width_mm" in pen:
        found["pen_width_mm"] = pen.number("width_mm", MIN_PEN_MM, MAX_PEN_MM)
    return found


def _panels(table: Section) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, field in PANEL_KEYS.items():
        if key in table:
            named = table.instead({f"{key}[{at}]": panel for at, panel in enumerate(table.items(key), start=1)})
            found[field] = tuple(named.one_of(each, PANELS) for each in named)
    return found


MAX_PRESSES = 10_000

_COMMENTS = {
    "channel": "1 to 4",
    "buttons": f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
    "from_s": "simulated seconds",
}


def infrared_from_table(table: Section) -> dict[str, Any]:
    """Return beacon and remote control of a world file, keyed by field of `Settings`.

    Raises:
        ObstacleError: a key or a value is wrong.
    """
    found: dict[str, Any] = {}
    if "beacon" in table:
        beacon = table.section("beacon", ObstacleError)
        beacon.allow(("x_mm", "y_mm", "channel"))
        with table.telling(""):
            found["beacon"] = BeaconSpec(beacon.number("x_mm"), beacon.number("y_mm"), _channel(beacon))
    if "remote" in table:
        entries = table.entries("remote", ObstacleError)
        if len(entries) > MAX_PRESSES:
            raise table.wrong("remote", f"{len(entries)} presses are too many", f"at most {MAX_PRESSES}")
        found["remote"] = tuple(_press(entry) for entry in entries)
    return found


def _channel(table: Section) -> int:
    return table.whole("channel", 1, 4) if "channel" in table else 1


def _press(table: Section) -> RemotePress:
    table.allow(("buttons", "from_s", "until_s", "channel"))
    named = table.instead({f"buttons[{at}]": name for at, name in enumerate(table.items("buttons"), start=1)})
    buttons = tuple(named.one_of(key, REMOTE_BUTTONS) for key in named)
    times = {key: table.number(key, 0.0, 1e9) for key in ("from_s", "until_s") if key in table}
    with table.telling(table.key):
        return RemotePress(buttons, channel=_channel(table), **times)


def infrared_lines(beacon: BeaconSpec | None, remote: Iterable[RemotePress]) -> list[str]:
    """Return beacon and button presses as lines of a world file."""
    lines: list[str] = []
    if beacon is not None:
        lines += ["", "[beacon]", *toml_lines(asdict(beacon), _COMMENTS)]
    for press in remote:
        values: dict[str, Scalar] = {**asdict(press), "buttons": list(press.buttons)}
        lines += ["", "[[remote]]", *toml_lines(values, _COMMENTS)]
    return lines
