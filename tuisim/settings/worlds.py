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
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.remote_spec import BeaconSpec, RemotePress
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.values import list_values, quote
from tuisim.engine.files import Location, Scalar
from tuisim.engine.mats import find_mat
from tuisim.engine.obstacles import load_obstacles, obstacle_lines, obstacles_from_list
from tuisim.settings.build import build_run_spec, extract_settings
from tuisim.settings.options import OPTION_PANELS, PRESSES, RUN_VALUES, Settings, has_world_values
from tuisim.settings.presses import MAX_PRESSES
from tuisim.settings.profiles import format_profile, load_profile, parse_profile
from tuisim.settings.robots import RobotChoice, format_robot

WORLD_SUFFIX = ".toml"
BATCH_KEY = "batch"
"""The table of a batch file, which may have the keys of a world beside it."""
MAX_INPUTS = 10_000

_Value = TypeVar("_Value")
Given: TypeAlias = _Value | UnsetType
"""A key that may be missing."""


class _World(Struct):
    """The keys that a world file can have besides the values of a run, such as `robot` and `mats`.

    Other functions check the keys of type `Any`.
    """

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
_TASK_KEYS = ("title", "press", "inputs", "goal", "also")
_NOT_IN_A_RUN = ("world", "mats", "rays", "autorun", "panels", "hidden_panels", *_TASK_KEYS)
"""Keys that are kept when a run is saved to an existing file."""
_PANEL_FIELDS = {"panels": "panels_on", "hidden_panels": "panels_off"}


Resolver = Callable[[str], str]
"""Resolves a path in the file."""


@dataclass(frozen=True, slots=True)
class WorldFile:
    """The contents of a world file: the settings of a run and, if the file names one, the program to run."""

    path: Path
    settings: Mapping[str, Any]
    """By path; in precedence between a program's magic line and the command line."""
    program: str | None = None
    """The program to run in it: a path, or the name of an example."""
    files: tuple[Path, ...] = ()
    """The file itself, and the files that it refers to."""
    inputs: tuple[str, ...] = ()
    """The answers to `input()` in a run."""

    @classmethod
    def load(
        cls, path: Path | str, mats: str | None = None, above: tuple[Path, ...] = ()
    ) -> WorldFile:
        """Return the contents of a world file. Paths in it are relative to its folder.

        Args:
            path: The file.
            mats: A folder of mats that is used if the file names none; None for none.
            above: The world files that are based on this one.

        Raises:
            ConfigError: the file, or a file that it refers to, cannot be read or is wrong.
        """
        path = user_path(path)
        if not is_world_name(path.name):
            raise ConfigError(
                f"is not a {WORLD_SUFFIX} file", "a world file is TOML", file=str(path)
            )
        data = files.read_file(path, ConfigError)
        if BATCH_KEY in data:
            raise ConfigError(
                "is a batch file, not a world",
                f"start it with: tuisim batch {path}",
                file=str(path),
            )
        return parse_world(data, path, mats, above)


def parse_world(
    data: object,
    path: Path,
    mats: str | None = None,
    above: tuple[Path, ...] = (),
    *,
    changes: bool = False,
) -> WorldFile:
    """Return the world in a table; keys of goals files are ignored here, since `tuisim.tasks.goals` reads them.

    Args:
        data: The table.
        path: The path of the file, which may not exist yet.
        mats: A folder of mats that is used if the file names none; None for none.
        above: The world files that are based on this one.
        changes: Whether the table only changes another world; otherwise the world has no floor unless the table
            sets it.

    Raises:
        ConfigError: a key or a value is wrong.
    """
    location = Location(str(path))
    values, world = _split_table(data, location)
    referred: list[Path] = []
    resolve = partial(_resolve, path.parent, referred)
    values |= {key: world[key] for key in ("rays", "autorun") if key in world} | _parse_mat(
        world, location, resolve, mats
    )
    for key, load, read, error in (
        ("robot", RobotChoice.load, RobotChoice.parse, RobotError),
        ("obstacles", load_obstacles, None, ObstacleError),
        ("profile", load_profile, parse_profile, ProfileError),
    ):
        match world.get(key):
            case str(word):
                values[key] = _resolve_name(word, location.at(key), resolve, load)
            case dict(inside) if read:
                values[key] = read(inside, files.name_of(path), location.at(key, error))
    if "obstacle" in world:
        if "obstacles" in world:
            raise location.at("obstacle").wrong(
                "cannot be combined with obstacles", "give obstacle or obstacles"
            )
        values["obstacles"] = obstacles_from_list(
            world["obstacle"], location.at("obstacle", ObstacleError)
        )
    values |= _parse_infrared(world, location)
    for key, field in _PANEL_FIELDS.items():
        if key in world:
            listed = files.entries(world[key], location.at(key), len(OPTION_PANELS), "panels")
            values[field] = tuple(
                files.one_of(panel, place, OPTION_PANELS) for panel, place in listed
            )
    if "arguments" in world:
        values["arguments"] = tuple(
            _parse_argument(word, location.at(f"arguments[{number}]"))
            for number, word in enumerate(world["arguments"], 1)
        )
    program = _find_program(world["program"], path.parent, resolve) if "program" in world else None
    if "press" in world:
        values["press"] = files.read_value(world["press"], PRESSES, location.at("press"))
    inputs = _parse_inputs(world, location)
    if "world" in world:
        base = _load_base(world["world"], location.at("world"), resolve, mats, (*above, path))
    else:
        base = WorldFile(path, {"floor": False} if has_world_values(values) and not changes else {})
    return WorldFile(
        path,
        {**base.settings, **values},
        program or base.program,
        (path, *referred, *base.files),
        inputs or base.inputs,
    )


def is_world_name(word: str) -> bool:
    """Return whether a word of the command line names a world file, not a program."""
    return Path(word).suffix.lower() == WORLD_SUFFIX


def _parse_inputs(world: Mapping[str, Any], location: Location) -> tuple[str, ...]:
    listed = files.entries(world.get("inputs", []), location.at("inputs"), MAX_INPUTS, "inputs")
    return tuple(files.convert(text, str, place) for text, place in listed)


def _load_base(
    word: str, location: Location, resolve: Resolver, mats: str | None, above: tuple[Path, ...]
) -> WorldFile:
    """Return the world on which another world is based.

    Args:
        word: The path of its file, as it is written in the file of the other world.
        location: The location of that path, for errors.
        resolve: Resolves a path in the file of the other world.
        mats: A folder of mats that is used if the file names none; None for none.
        above: The files that are based on this one, directly or through others.

    Raises:
        ConfigError: the file does not exist, is wrong, or is one of `above`.
    """
    path = Path(resolve(word))
    if any(os.path.normpath(path) == os.path.normpath(other) for other in above):
        raise location.wrong(f"{path} is based on itself")
    if not os.path.exists(path):
        # The error names this file and the key, because the user may not know that the file is based on another one.
        raise location.wrong(f"there is no such file: {path}")
    return WorldFile.load(path, mats, above)


def _split_table(data: object, location: Location) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the values of a run in a world file by path, and the file's other keys.

    Args:
        data: The contents of the file.
        location: The file, for errors.

    Raises:
        ConfigError: a key is unknown, or a value is wrong.
    """
    world = files.table(data, location, (*_World.__struct_fields__, *_TABLES))
    others = files.convert(
        {key: value for key, value in world.items() if key not in _TABLES}, _World, location
    )
    values: dict[str, Any] = {}
    for name, value in world.items():
        if keys := _TABLES.get(name):
            inside = files.table(value, location.at(name), keys)
            values |= {f"{name}.{key}": inside[key] for key in inside}
        elif name in _TABLES:
            values[name] = value
    values = {
        path: files.read_value(value, RUN_VALUES[path].value, location.at(path))
        for path, value in values.items()
    }
    return values, {
        key: value for key, value in structs.asdict(others).items() if value is not UNSET
    }


def _parse_argument(word: object, location: Location) -> str:
    if not isinstance(word, str):
        raise location.wrong(f"must be text, got {quote(word)}", 'in quotes, such as "5"')
    if "\0" in word:
        raise location.wrong("must be text without null characters")
    return word


def _find_program(word: str, folder: Path, resolve: Resolver) -> str:
    """Return the program that a world file names: the name of an example, or else a resolved path.

    A file of that name in the world file's folder takes precedence over an example.

    Args:
        word: The name or the path in the file.
        folder: The folder of the file.
        resolve: Resolves a path in the file.
    """
    known = os.sep not in word and not os.path.exists(folder / word)
    if known and any(os.path.isfile(programs_folder() / name) for name in (word, f"{word}.py")):
        return word
    return resolve(word)


def _resolve(folder: Path, referred: list[Path], word: str) -> str:
    """Return a path in a world file, resolved relative to the file's folder.

    Args:
        folder: The folder of the file.
        referred: A list to which the result is appended.
        word: The path in the file.
    """
    resolved = Path(os.path.normpath(folder / user_path(word)))
    referred.append(resolved)
    return str(resolved)


def _parse_mat(
    world: Mapping[str, Any], location: Location, resolve: Resolver, mats: str | None
) -> dict[str, Any]:
    """Return by name the settings `background` (a mat) and `mats` (a folder of mats), if a world file sets them.

    Args:
        world: The keys of the file.
        location: The file, for errors.
        resolve: Resolves a path in the file.
        mats: A folder of mats that is used if the file names none; None for none.
    """
    settings: dict[str, Any] = {}
    if "mats" in world:
        settings["mats"] = resolve(world["mats"])
    if "background" in world:
        word = world["background"]
        settings["background"] = resolve(word) if os.sep in word or Path(word).suffix else word
        with files.errors_at(location.file, "background"):
            try:
                find_mat(settings["background"], settings.get("mats", mats))
            except ConfigError as error:
                if not error.file:
                    raise
                # The error is about the image, so this file and its key are added.
                raise location.at("background", type(error)).wrong(f"{error}") from error.__cause__
    return settings


def _resolve_name(
    word: str, location: Location, resolve: Resolver, load: Callable[[str], object]
) -> str:
    """Check that a preset or a file exists and is right, and return the name or the resolved path.

    Args:
        word: The name of the preset, or the path of the file.
        location: The key that gives the word; errors name it.
        resolve: Resolves a path in the world file.
        load: Loads the preset or the file, or raises ConfigError.

    Raises:
        ConfigError: `load` raises it.
    """
    if files.means_file(word):
        word = resolve(word)
    with files.errors_at(location.file, location.key):
        load(word)
    return word


def _parse_infrared(world: Mapping[str, Any], location: Location) -> dict[str, Any]:
    """Return by name the settings `beacon` and `remote`, if a world file sets them.

    Args:
        world: The keys of the file.
        location: The file, for errors.
    """
    settings: dict[str, Any] = {}
    if "beacon" in world:
        settings["beacon"] = files.read_part(
            world["beacon"], BeaconSpec, location.at("beacon", ObstacleError)
        )
    if "remote" in world:
        presses = files.entries(
            world["remote"], location.at("remote", ObstacleError), MAX_PRESSES, "presses"
        )
        settings["remote"] = tuple(
            files.read_part(press, RemotePress, place) for press, place in presses
        )
    return settings


_HEAD = "# A world for tuisim. Lengths in mm, angles in degrees counter-clockwise from +x; y up from the bottom edge."
_COMMENTS = {
    "program": "relative to this file",
    "arguments": "the program's sys.argv[1:]",
    "background": "a mat's name, or an image relative to this file",
}


def save_world(
    spec: RunSpec, path: Path | str, program: str | None = None, arguments: Sequence[str] = ()
) -> None:
    """Write a run atomically to a world file from which an equal run is built. Comments in the file are kept.

    Args:
        spec: The run.
        path: The file; paths of an image and a program are written relative to its folder.
        program: The program to run in it, as a path or as the name of an example; None for none.
        arguments: The program's arguments.

    Raises:
        ConfigError: the file cannot be written, or cannot represent the run.
    """
    path = Path(path)
    location = Location(str(path))

    def read(data: object) -> RunSpec:
        return build_run_spec(Settings.merge(parse_world(data, path).settings))

    def check(data: object) -> None:
        _, world = _split_table(data, location)
        if "mats" in world:
            # The key `mats` is dropped if an image of the same name in its folder would replace the mat.
            mat = find_mat(
                extract_settings(spec)["background"], str(path.parent / user_path(world["mats"]))
            )
            if mat.find_spec_name() != spec.world.background:
                kept_keys.remove("mats")

    kept_keys = list(_NOT_IN_A_RUN)
    lines = format_world(spec, path.parent, program, arguments)
    files.save_toml(path, lines, location, read, spec, check=check, kept=kept_keys)


def format_world(
    spec: RunSpec, folder: Path, program: str | None = None, arguments: Sequence[str] = ()
) -> list[str]:
    """Return a run as TOML lines of a world file.

    Args:
        spec: The run.
        folder: The folder of the file; paths are relative to it.
        program: The program to run in the world, as a path or as the name of an example; None for none.
        arguments: The program's arguments.
    """
    settings = extract_settings(spec)
    top: dict[str, Scalar] = {}
    if program is not None:
        top["program"] = _make_relative(program, folder) if os.path.exists(program) else program
    if arguments:
        top["arguments"] = list(arguments)
    mat = settings["background"]
    top["background"] = _make_relative(mat, folder) if os.sep in mat else mat
    values = {
        path: files.toml_form(option.value, tree.get_value(spec, option.spec_path))
        for path, option in RUN_VALUES.items()
    }
    # Values that older versions lack are left out at their defaults, so that saved files do not change.
    left_out = {
        path
        for path, option in RUN_VALUES.items()
        if option.value.later and values[path] == _DEFAULTS[path]
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
    comments = {**_COMMENTS, **{path: option.value.help for path, option in RUN_VALUES.items()}}
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
        lines += ["", *format_robot(spec.robot, "robot", ("x_mm", "y_mm"))]
    if isinstance(settings["profile"], ProfileSpec):
        lines += ["", *format_profile(spec.profile, "profile")]
    if not isinstance(settings["obstacles"], str):
        lines += ["", *obstacle_lines(spec.world.obstacles)]
    return [*lines, *_format_infrared(spec.world.beacon, spec.world.remote)]


def _format_infrared(beacon: BeaconSpec | None, remote: Iterable[RemotePress]) -> list[str]:
    lines = ["", "[beacon]", *files.value_lines(beacon, list_values(BeaconSpec))] if beacon else []
    for press in remote:
        lines += ["", "[[remote]]", *files.value_lines(press, list_values(RemotePress))]
    return lines


def _make_relative(path: str, folder: Path) -> str:
    """Return a path relative to a folder; with `./` in front if it could be taken for a mat's or program's name."""
    relative = os.path.relpath(user_path(path), folder)
    return relative if os.sep in relative or Path(relative).suffix else f".{os.sep}{relative}"
