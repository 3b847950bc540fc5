"""Batch files: a TOML file with a table `[batch]`, and perhaps the keys of a world file beside it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Annotated, Any

from msgspec import Meta, Struct

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import user_path
from tuisim.batch.parameters import SEED, Choice, check_seeds, parse_seeds, parse_values
from tuisim.engine import files
from tuisim.engine.core.values import quote
from tuisim.engine.files import Location
from tuisim.settings.worlds import BATCH_KEY, WorldFile, parse_world
from tuisim.tasks.task import MAX_JOBS, Keep, Value

MAX_PROGRAMS = 10_000


class _BatchTable(Struct):
    """The keys of the table `[batch]` in a batch file.

    The values of keys of type `Any` are checked later, by the functions that use them.
    """

    program: str | list[str] | None = None
    world: str | None = None
    seeds: Any = None
    set: Any = None
    jobs: Annotated[int, Meta(ge=1, le=MAX_JOBS)] | None = None
    out: str | None = None
    expressions: Any = None
    goals: str | None = None
    keep: Keep | None = None


@dataclass(frozen=True, slots=True)
class BatchFile:
    """The contents of a batch file, with paths resolved relative to its folder."""

    path: Path
    programs: tuple[str, ...] = ()
    """Paths, or names of examples."""
    world: WorldFile | None = None
    choices: Mapping[str, Choice] = field(default_factory=dict)
    """The values of each parameter; the seeds come last."""
    jobs: int | None = None
    out: str | None = None
    goals: str | None = None
    keep: Keep | None = None
    expressions: Mapping[str, str] = field(default_factory=dict)


def load_batch(path: Path, mats: str | None = None) -> BatchFile:
    """Read a batch file, with the world that it names.

    Args:
        path: The file.
        mats: A folder of mats that is used if the file names none; None for none.

    Raises:
        ConfigError: the file, or its world, cannot be read or is wrong.
    """
    path = user_path(path)
    data = dict(files.table(files.read_file(path, ConfigError), Location(str(path))))
    location = Location(str(path)).at(BATCH_KEY)
    if BATCH_KEY not in data:
        raise ConfigError("is not a batch", f"a batch has a table [{BATCH_KEY}]", file=str(path))
    table = files.convert(data.pop(BATCH_KEY), _BatchTable, location)
    folder = path.parent
    world = None
    if table.world is not None:
        if data:
            raise location.at("world").wrong(
                f"cannot be combined with {', '.join(data)}", "give a world file, or its keys"
            )
        with files.errors_at(location.file, location.at("world").key):
            world = WorldFile.load(folder / table.world, mats)
    elif data:
        world = parse_world(data, path, mats)
    programs = [table.program] if isinstance(table.program, str) else table.program or []
    if len(programs) > MAX_PROGRAMS:
        raise location.at("program").wrong(
            f"has {len(programs)} programs", f"at most {MAX_PROGRAMS}"
        )
    return BatchFile(
        path,
        tuple(_find_program_beside(folder, word) for word in programs),
        world,
        _parse_choices(table, location),
        jobs=table.jobs,
        out=None if table.out is None else str(folder / table.out),
        goals=None if table.goals is None else str(folder / table.goals),
        keep=table.keep,
        expressions={}
        if table.expressions is None
        else _parse_expressions(table.expressions, location.at("expressions")),
    )


def _find_program_beside(folder: Path, word: str) -> str:
    """Return the path of a program in the batch file's folder.

    If there is none, return the name itself, as it may be an example's.
    """
    path, _, cell = word.partition("#")
    file = folder / user_path(path)
    return (
        f"{file}{'#' * bool(cell)}{cell}"
        if os.path.exists(file) or Path(path).parent != Path()
        else word
    )


def _parse_expressions(data: object, location: Location) -> dict[str, str]:
    return {
        name: files.convert(text, str, location.at(name))
        for name, text in files.table(data, location).items()
    }


def _parse_choices(table: _BatchTable, location: Location) -> dict[str, Choice]:
    choices: dict[str, Choice] = {}
    if table.set is not None:
        place = location.at("set")
        for name, values in _flatten_table(files.table(table.set, place)).items():
            choices[name] = _parse_choice(values, place.at(name))
    if table.seeds is not None:
        place = location.at("seeds")
        if SEED in choices:
            raise place.wrong(f"cannot be combined with set.{SEED}", f"give seeds or set.{SEED}")
        listed = table.seeds if isinstance(table.seeds, list) else [table.seeds]
        try:
            choices[SEED] = (
                parse_seeds(table.seeds, "")
                if isinstance(table.seeds, str)
                else check_seeds(listed, "")
            )
        except ConfigError as error:
            raise place.wrong(error.message, error.hint) from None
    return choices


def _flatten_table(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested tables as one, whose keys are joined by dots."""
    values: dict[str, Any] = {}
    for key, value in table.items():
        values |= (
            _flatten_table(value, f"{prefix}{key}.")
            if isinstance(value, dict)
            else {f"{prefix}{key}": value}
        )
    return values


def _parse_choice(values: object, location: Location) -> Choice:
    """Return the values of a parameter in a batch file: a list, or a text in the form of the command line."""
    try:
        if isinstance(values, str):
            return parse_values(values, "")
    except ConfigError as error:
        raise location.wrong(error.message, error.hint) from None
    listed = values if isinstance(values, list) else [values]
    if not listed:
        raise location.wrong("has no values")
    return tuple(
        _parse_scalar(value, location.at(f"[{number}]"))
        for number, value in enumerate(listed, start=1)
    )


def _parse_scalar(value: object, location: Location) -> Value:
    if not isinstance(value, str | bool | int | float):
        raise location.wrong(f"must be a text, a number, true or false, got {quote(value)}")
    return value
