"""World files: mat, obstacles, robot, noise, start pose, pen, profile and infrared beacon; read and written as TOML."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from msgspec import UNSET, Struct, UnsetType, structs

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, ObstacleError, ProfileError, RobotError
from tuisim.base.folders import programs_folder, user_path
from tuisim.engine import files
from tuisim.engine.core import tree
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.remote_spec import BeaconSpec, RemotePress
from tuisim.engine.core.spec import START_VALUES, RunSpec
from tuisim.engine.core.values import list_values, quote
from tuisim.engine.files import Location, Scalar
from tuisim.engine.mats import find_mat, spec_name
from tuisim.engine.obstacles import load_obstacles, obstacle_lines, obstacles_from_list
from tuisim.engine.presses import MAX_PRESSES
from tuisim.settings.build import build_run_spec, settings_from
from tuisim.settings.options import OPTION_PANELS, PRESSES, RUN_VALUES, names_world, settings_of
from tuisim.settings.profiles import load_profile, profile_from_table, profile_lines
from tuisim.settings.robots import RobotChoice, load_robot, robot_from_table, robot_lines

WORLD_SUFFIX = ".toml"
BATCH_KEY = "batch"
"""The table of a batch file, which may have the keys of a world beside it."""
MAX_INPUTS = 10_000

_Value = TypeVar("_Value")
Given: TypeAlias = _Value | UnsetType
"""A key that may be missing."""


class _World(Struct):
    """The keys of a world file that are no values of a run; `Any` where further functions check them."""

    world: Given[str] = UNSET
    program: Given[str] = UNSET
    arguments: Given[list[Any]] = UNSET
    background: Given[str] = UNSET
    mats: Given[str] = UNSET
    robot: Given[str | dict[str, Any]] = UNSET
    obstacles: Given[str] = UNSET
    obstacle: Given[list[Any]] = UNSET
    profile: Given[str | dict[str, Any]] = UNSET
    rays: Given[bool] = UNSET
    autorun: Given[bool] = UNSET
    panels: Given[list[Any]] = UNSET
    hidden_panels: Given[list[Any]] = UNSET
    beacon: Any = UNSET
    remote: Any = UNSET
    title: Any = UNSET
    press: Given[list[Any]] = UNSET
    inputs: Given[list[Any]] = UNSET
    goal: Any = UNSET
    also: Any = UNSET


_TABLES: Mapping[str, tuple[str, ...]] = {
    table: tuple(path.partition(".")[2] for path in RUN_VALUES if path.startswith(f"{table}."))
    for table in dict.fromkeys(path.partition(".")[0] for path in RUN_VALUES)
}
"""The keys of each table with values of a run; none for a value that is in no table."""

_DEFAULTS = {
    path: files.toml_form(one.value, one.default)
    for path, one in RUN_VALUES.items()
    if one.value.later
}
_OF_TASKS = ("title", "press", "inputs", "goal", "also")
_NOT_IN_A_RUN = ("world", "mats", "rays", "autorun", "panels", "hidden_panels", *_OF_TASKS)
"""Keys that stay as they are when a run is saved into a file that has them."""
_PANEL_FIELDS = {"panels": "panels_on", "hidden_panels": "panels_off"}


Resolver = Callable[[str], str]
"""Resolves a path in the file."""


@dataclass(frozen=True, slots=True)
class WorldFile:
    """The contents of a world file."""

    path: Path
    settings: Mapping[str, Any]
    """By path; in precedence between a program's magic line and the command line."""
    program: str | None = None
    """The program to run in it: a path, or the name of an example."""
    files: tuple[Path, ...] = ()
    """The file itself, and the files that it refers to."""
    inputs: tuple[str, ...] = ()
    """The answers to `input()` in a run."""


def means_world(word: str) -> bool:
    """Return whether a word of the command line names a world file, not a program."""
    return Path(word).suffix.lower() == WORLD_SUFFIX


def load_world(path: Path | str, mats: str | None = None) -> WorldFile:
    """Read a world file. Paths in it are relative to its folder; it may name a folder of mats instead of `mats`.

    Raises:
        ConfigError: the file, or a file that it refers to, cannot be read or is wrong.
    """
    return _load_world(user_path(path), mats, ())


def _load_world(path: Path, mats: str | None, above: tuple[Path, ...]) -> WorldFile:
    if not means_world(path.name):
        raise ConfigError(f"is not a {WORLD_SUFFIX} file", "a world file is TOML", file=str(path))
    data = files.read_file(path, ConfigError)
    if BATCH_KEY in data:
        raise ConfigError("is a batch", f"tuisim batch {path}", file=str(path))
    return world_from_table(data, path, mats, above)


def world_from_table(
    data: object,
    path: Path,
    mats: str | None = None,
    above: tuple[Path, ...] = (),
    *,
    changes: bool = False,
) -> WorldFile:
    """Return the world in a table; keys of goals files are left to `tuisim.tasks.goals`.

    Args:
        path: The path of the file, which may not exist yet.
        mats: As for `load_world`.
        above: The world files that are based on this one.
        changes: Whether it only changes another world; else it has no floor unless it says so.

    Raises:
        ConfigError: a key or a value is wrong.
    """
    at = Location(str(path))
    found, world = _parted(data, at)
    referred: list[Path] = []
    resolve = partial(_resolved, path.parent, referred)
    found |= {key: world[key] for key in ("rays", "autorun") if key in world} | _mat(
        world, at, resolve, mats
    )
    for key, load, read, error in (
        ("robot", load_robot, robot_from_table, RobotError),
        ("obstacles", load_obstacles, None, ObstacleError),
        ("profile", load_profile, profile_from_table, ProfileError),
    ):
        match world.get(key):
            case str(word):
                found[key] = _named(word, at.at(key), resolve, load)
            case dict(inside) if read:
                found[key] = read(inside, files.name_of(path), at.at(key, error))
    if "obstacle" in world:
        if "obstacles" in world:
            raise at.at("obstacle").wrong(
                "cannot be combined with obstacles", "give only one of them"
            )
        found["obstacles"] = obstacles_from_list(
            world["obstacle"], at.at("obstacle", ObstacleError)
        )
    found |= _infrared(world, at)
    for key, field in _PANEL_FIELDS.items():
        if key in world:
            listed = files.entries(world[key], at.at(key), len(OPTION_PANELS), "panels")
            found[field] = tuple(
                files.one_of(panel, place, OPTION_PANELS) for panel, place in listed
            )
    if "arguments" in world:
        words = enumerate(world["arguments"], start=1)
        found["arguments"] = tuple(
            _argument(word, at.at(f"arguments[{number}]")) for number, word in words
        )
    program = _program(world["program"], path.parent, resolve) if "program" in world else None
    if "press" in world:
        found["press"] = files.read_value(world["press"], PRESSES, at.at("press"))
    inputs = _inputs(world, at)
    if "world" in world:
        base = _base(world["world"], at.at("world"), resolve, mats, (*above, path))
    else:
        base = WorldFile(path, {"floor": False} if names_world(found) and not changes else {})
    return WorldFile(
        path,
        {**base.settings, **found},
        program or base.program,
        (path, *referred, *base.files),
        inputs or base.inputs,
    )


def _inputs(world: Mapping[str, Any], at: Location) -> tuple[str, ...]:
    listed = files.entries(world.get("inputs", []), at.at("inputs"), MAX_INPUTS, "inputs")
    return tuple(files.convert(text, str, place) for text, place in listed)


def _base(
    word: str, at: Location, resolve: Resolver, mats: str | None, above: tuple[Path, ...]
) -> WorldFile:
    """Load the world that another one is based on."""
    path = Path(resolve(word))
    if any(os.path.normpath(path) == os.path.normpath(other) for other in above):
        raise at.wrong(f"{path} is based on itself")
    if not os.path.exists(path):
        # Names the file and the key: the user may not know that this file names another.
        raise at.wrong(f"there is no such file: {path}")
    return _load_world(path, mats, above)


def _parted(data: object, at: Location) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the values of a run in a world file, by path, and its other keys."""
    world = files.table(data, at, (*_World.__struct_fields__, *_TABLES))
    others = files.convert(
        {key: value for key, value in world.items() if key not in _TABLES}, _World, at
    )
    found: dict[str, Any] = {}
    for name, value in world.items():
        if keys := _TABLES.get(name):
            inside = files.table(value, at.at(name), keys)
            found |= {f"{name}.{key}": inside[key] for key in inside}
        elif name in _TABLES:
            found[name] = value
    found = {
        path: files.read_value(value, RUN_VALUES[path].value, at.at(path))
        for path, value in found.items()
    }
    return found, {
        key: value for key, value in structs.asdict(others).items() if value is not UNSET
    }


def pose_from_table(data: object, at: Location) -> Pose:
    """Return a pose; all of its keys are required.

    Raises:
        ConfigError: a key is missing or unknown, or a value is wrong.
    """
    given = files.table(data, at, START_VALUES)
    found = {
        key: files.read_value(value, START_VALUES[key], at.at(key)) for key, value in given.items()
    }
    for key in START_VALUES:
        files.required(found, key, at)
    return Pose(**found)


def _argument(word: object, at: Location) -> str:
    if not isinstance(word, str):
        raise at.wrong(f"must be text, got {quote(word)}", 'in quotes, such as "5"')
    if "\0" in word:
        raise at.wrong("must be text without null characters")
    return word


def _program(word: str, folder: Path, resolve: Resolver) -> str:
    """Resolve the path of a program; an example's name stays a name if there is no such file beside the world."""
    known = os.sep not in word and not os.path.exists(folder / word)
    if known and any(os.path.isfile(programs_folder() / name) for name in (word, f"{word}.py")):
        return word
    return resolve(word)


def _resolved(folder: Path, referred: list[Path], word: str) -> str:
    """Resolve a path in the file, and append it to `referred`."""
    found = Path(os.path.normpath(folder / user_path(word)))
    referred.append(found)
    return str(found)


def _mat(
    world: Mapping[str, Any], at: Location, resolve: Resolver, mats: str | None
) -> dict[str, Any]:
    """Return mat and folder of mats; the mat's start pose applies to what neither this nor another layer sets."""
    found: dict[str, Any] = {}
    if "mats" in world:
        found["mats"] = resolve(world["mats"])
    if "background" in world:
        word = world["background"]
        found["background"] = resolve(word) if os.sep in word or Path(word).suffix else word
        with files.errors_at(at.file, "background"):
            try:
                find_mat(found["background"], found.get("mats", mats))
            except ConfigError as error:
                if not error.file:
                    raise
                # What is wrong is an image that this file names.
                raise at.at("background", type(error)).wrong(f"{error}") from error.__cause__
    return found


def _named(word: str, at: Location, resolve: Resolver, load: Callable[[str], object]) -> str:
    """Return a name or the path of a file; it is loaded once, so that errors name this file and key."""
    if files.means_file(word):
        word = resolve(word)
    with files.errors_at(at.file, at.key):
        load(word)
    return word


def _infrared(world: Mapping[str, Any], at: Location) -> dict[str, Any]:
    """Return beacon and remote control."""
    found: dict[str, Any] = {}
    if "beacon" in world:
        found["beacon"] = files.read_part(
            world["beacon"], BeaconSpec, at.at("beacon", ObstacleError)
        )
    if "remote" in world:
        presses = files.entries(
            world["remote"], at.at("remote", ObstacleError), MAX_PRESSES, "presses"
        )
        found["remote"] = tuple(
            files.read_part(press, RemotePress, place) for press, place in presses
        )
    return found


_HEAD = "# A world for tuisim. Lengths in mm, angles in degrees counter-clockwise from +x; y up from the bottom edge."
_COMMENTS = {
    "program": "relative to this file",
    "arguments": "the program's sys.argv[1:]",
    "background": "a mat's name, or an image relative to this file",
}


def save_world(
    spec: RunSpec, path: Path | str, program: str | None = None, arguments: Sequence[str] = ()
) -> None:
    """Write a run atomically to a world file from which an equal run is built. Comments in the file stay.

    Args:
        path: The file; an image and a program are written relative to its folder.
        program: The program to run in it, as a path or as the name of an example.

    Raises:
        ConfigError: the file cannot be written, or cannot represent the run.
    """
    path = Path(path)
    at = Location(str(path))

    def read(data: object) -> RunSpec:
        return build_run_spec(settings_of(world_from_table(data, path).settings))

    def check(data: object) -> None:
        _, world = _parted(data, at)
        if "mats" in world:
            # A folder with an image of the same name would replace the mat.
            found = find_mat(
                settings_from(spec)["background"], str(path.parent / user_path(world["mats"]))
            )
            if spec_name(found) != spec.world.background:
                kept.remove("mats")

    kept = list(_NOT_IN_A_RUN)
    lines = world_lines(spec, path.parent, program, arguments)
    files.save_toml(path, lines, at, read, spec, check=check, kept=kept)


def world_lines(
    spec: RunSpec, folder: Path, program: str | None = None, arguments: Sequence[str] = ()
) -> list[str]:
    """Return a run as TOML lines.

    Args:
        folder: Where the file will be; paths are relative to it.
        program, arguments: As for `save_world`.
    """
    settings = settings_from(spec)
    top: dict[str, Scalar] = {}
    if program is not None:
        top["program"] = _relative(program, folder) if os.path.exists(program) else program
    if arguments:
        top["arguments"] = list(arguments)
    mat = settings["background"]
    top["background"] = _relative(mat, folder) if os.sep in mat else mat
    values = {
        path: files.toml_form(one.value, tree.get_value(spec, one.spec_path))
        for path, one in RUN_VALUES.items()
    }
    # What came later is left out at its default, so that files do not change.
    left_out = {
        path
        for path, one in RUN_VALUES.items()
        if one.value.later and values[path] == _DEFAULTS[path]
    }
    of_world = {
        name: values[name] for name, keys in _TABLES.items() if not keys and name not in left_out
    }
    presets = {
        key: settings[key]
        for key in ("robot", "obstacles", "profile")
        if isinstance(settings[key], str)
    }
    top |= of_world | presets
    comments = {**_COMMENTS, **{path: one.value.help for path, one in RUN_VALUES.items()}}
    lines = [_HEAD, "", *files.toml_lines(top, comments)]
    for name, keys in _TABLES.items():
        if keys:
            help_of = {key: comments[f"{name}.{key}"] for key in keys}
            lines += [
                "",
                f"[{name}]",
                *files.toml_lines({key: values[f"{name}.{key}"] for key in keys}, help_of),
            ]
    if isinstance(settings["robot"], RobotChoice):
        lines += ["", *robot_lines(spec.robot, "robot", ("x_mm", "y_mm"))]
    if isinstance(settings["profile"], ProfileSpec):
        lines += ["", *profile_lines(spec.profile, "profile")]
    if not isinstance(settings["obstacles"], str):
        lines += ["", *obstacle_lines(spec.world.obstacles)]
    return [*lines, *_infrared_lines(spec.world.beacon, spec.world.remote)]


def _infrared_lines(beacon: BeaconSpec | None, remote: Iterable[RemotePress]) -> list[str]:
    lines = ["", "[beacon]", *files.value_lines(beacon, list_values(BeaconSpec))] if beacon else []
    for press in remote:
        lines += ["", "[[remote]]", *files.value_lines(press, list_values(RemotePress))]
    return lines


def _relative(path: str, folder: Path) -> str:
    """Return a path relative to a folder, in a form that cannot be mistaken for a name."""
    found = os.path.relpath(user_path(path), folder)
    return found if os.sep in found or Path(found).suffix else f".{os.sep}{found}"
