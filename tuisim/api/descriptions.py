"""Descriptions of worlds and robots: values that a script has chosen, checked at once, with a `repr` of one line."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

from tuisim.base.errors import ConfigError
from tuisim.batch.parameters import check_seeds
from tuisim.engine.core.sensors import find_named_column
from tuisim.engine.core.spec import RunSpec
from tuisim.programs.program_file import find_program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import APP, APP_PATHS, OPTIONS, Option, Settings
from tuisim.settings.overrides import resolve_keys
from tuisim.settings.robots import DEFAULT_ROBOT
from tuisim.settings.worlds import WorldFile, is_world_name

OPTIONS_BY_NAME: Mapping[str, Option] = {
    option.name: option
    for option in OPTIONS
    if not option.panel
    and option.group != APP
    and option.path not in APP_PATHS
    and option.constant is not False
}
"""Every option that affects a run, by the name that it has in Python."""


TIME = "time"
"""Name of the column with the simulated time in seconds."""


class Description:
    """Values, by name, that a script chooses for a world or a robot.

    Two descriptions with the same values are equal.
    """

    __slots__ = ("_values",)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value!r}" for name, value in self._values.items())
        return f"{type(self).__name__}({values})"

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and repr(self) == repr(other)

    def __hash__(self) -> int:
        return hash(repr(self))

    if not TYPE_CHECKING:  # With `__getattr__`, mypy would accept any name.

        def __getattr__(self, name: str) -> Any:
            message = f"{type(self).__name__} has no attribute {name!r}; print it to see its values"
            raise AttributeError(message, name=name, obj=self)

    @property
    def label(self) -> str:
        """The values in short, for a cell of a table."""
        texts = [
            str(value) if name in ("base", "file") else f"{name}={value}"
            for name, value in self._values.items()
            if value != DEFAULT_ROBOT or len(self._values) == 1
        ]
        return ", ".join(texts) or repr(self)

    def _take(self, arguments: Mapping[str, Any]) -> None:
        """Check and store the arguments of `__init__` that are not None."""
        self._values = {
            name: plain(value)
            for name, value in arguments.items()
            if value is not None and value is not self
        }
        # Build a run once: a wrong value is reported in the line of the script that has it.
        build_run_spec(Settings.merge(self.settings))

    @property
    def settings(self) -> Mapping[str, Any]:
        """The chosen values as settings of a run, by their keys, such as `world.start.x_mm`."""
        raise AssertionError


class WorldDescription(Description):
    """A world that a script describes: a world file, if any, and options that take precedence over it."""

    __slots__ = ()

    @property
    def settings(self) -> Mapping[str, Any]:
        """The chosen values as settings of a run, by their keys, such as `world.start.x_mm`.

        Names of files in the world file are relative to its folder.
        """
        options = {**self._values}
        file = options.pop("file", None)
        chosen = read_options(options)
        return {**read_world(file, chosen.get("mats")), **chosen}


class RobotDescription(Description):
    """A robot that a script describes: a robot given by name or file, with some of its values changed."""

    __slots__ = ()

    @property
    def settings(self) -> Mapping[str, Any]:
        """The robot as settings of a run, by their keys, such as `robot.wheel_diameter_mm`."""
        values = {**self._values}
        base = values.pop("base", DEFAULT_ROBOT)
        parts = values.pop("parts", {})
        if "hub" in values and base == DEFAULT_ROBOT:
            raise ConfigError(
                "needs a robot with its ports", "such as base='Prime_Robot'", key="hub"
            )
        keys = {f"robot.{key}": value for key, value in {**values, **parts}.items()}
        return resolve_keys({"robot": base, **keys}, Settings(), Path("Robot"))


def plain(value: Any) -> Any:
    """Return a value in the form in which files have it: a path as a text, a NumPy number as a Python number."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.item() if getattr(value, "size", None) == 1 else value


def warn_all(remarks: Iterable[str], depth: int = 5) -> None:
    """Issue each of some sentences as a warning.

    Args:
        remarks: The sentences.
        depth: How many calls above this function the line is to which the warning points, as `stacklevel` of
            `warnings.warn`. By default it is the user's line that calls `simulate` or `experiment`; this is right for a
            function that is called directly by one of these.
    """
    for remark in remarks:
        warn(remark, stacklevel=depth)


def read_columns(columns: Sequence[str], spec: RunSpec) -> tuple[str, ...]:
    """Return the full names of telemetry columns of a run.

    Args:
        columns: Names, which may be short; a text is a single name.
        spec: The run.

    Raises:
        ConfigError: the run has no such column.
    """
    names = (columns,) if isinstance(columns, str) else columns
    return tuple(name if name == TIME else find_named_column(name, spec) for name in names)


def read_seeds(seeds: Any) -> tuple[int, ...]:
    """Return seeds as a tuple of whole numbers.

    Raises:
        ConfigError: the seeds are no list, there are none, or one of them is wrong.
    """
    if isinstance(seeds, str) or not isinstance(seeds, Iterable):
        raise ConfigError(f"must be several, got {seeds!r}", "such as range(200)", key="seeds")
    if not (checked := check_seeds([plain(seed) for seed in seeds], "seeds")):
        raise ConfigError("has no values", key="seeds")
    return checked


def read_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options as settings, by path.

    Args:
        options: Values by the name of the option, such as `background` or `x`; None is ignored.

    Raises:
        ConfigError: a value is wrong.
    """
    settings: dict[str, Any] = {}
    for name, value in options.items():
        if isinstance(value, RobotDescription):
            settings |= value.settings
        elif value is not None:
            option = OPTIONS_BY_NAME[name]
            several = isinstance(value, Iterable) and not isinstance(value, str | Mapping)
            if several and not option.repeats:
                hint = (
                    "a file has several boxes: see `tuisim guide world-files`"
                    if name == "obstacles"
                    else "tuisim.experiment takes several"
                )
                raise ConfigError(f"must be one value, got {value!r}", hint, key=name)
            settings[option.path] = option.from_python(plain(value), name)
    return settings


def read_world(world: str | Path | WorldDescription | None, mats: str | None) -> Mapping[str, Any]:
    """Return the settings of a world, by path; empty for None.

    Args:
        world: A world, or its file.
        mats: A folder of mats that is used if the file names none; None for none.

    Raises:
        ConfigError: there is no such file, or it is wrong.
    """
    if world is None:
        return {}
    if isinstance(world, WorldDescription):
        return world.settings
    if not isinstance(world, str | Path) or not is_world_name(str(world)):
        hint = "a mat is tuisim.World(background=…)"
        raise ConfigError(f"must be a .toml file or a World, got {world!r}", hint, key="world")
    return WorldFile.load(find_program(str(world)), mats).settings
