"""Resolve the words of a command line into program, settings and run specification.

The command line takes precedence over the world file, the world file over the program's magic line, and the magic
line over the defaults. With a world file these are tuisim's own, so that a task is the same for everybody; else those
of the user's `config.toml` take precedence over them.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.commands.echo import echo_error
from tuisim.commands.notebooks import NotRun, check_folder, drop_unknown, find_programs
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.run_folder import StoredRun, field_files
from tuisim.engine.runs.store import RunStore
from tuisim.programs.notebook_file import is_notebook, read_notebook_programs
from tuisim.programs.program_file import (
    ProgramSource,
    build_program,
    drop_wrong_names,
    find_program,
    find_wrong_names,
    read_program,
)
from tuisim.programs.program_settings import Decided, build_program_settings, find_free_paths
from tuisim.settings.build import build_run_spec
from tuisim.settings.command_line import ARGUMENTS_FOLLOW, Arguments
from tuisim.settings.options import APP_PATHS, Settings
from tuisim.settings.robots import RobotChoice
from tuisim.settings.user_config import Section, UserConfig
from tuisim.settings.worlds import WorldFile, is_world_name

NO_CONFIG = UserConfig(Path())
"""No defaults of the user."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """A program with its settings and specification, ready to be run or opened in the app."""

    program: Program | None
    settings: Settings
    spec: RunSpec
    world: WorldFile | None = None
    label: str = ""
    """Its name in a table; empty for the program's name."""
    from_config: tuple[str, ...] = ()
    """What the user's `config.toml` decides about the run, in words."""
    decided: Decided = field(default_factory=Decided)
    """What the source of the program decides."""


def check_arguments(words: Sequence[str], arguments: Arguments) -> None:
    """Check that words after `--`, the program's arguments, are for exactly one program.

    Args:
        words: The programs and worlds that the user named.
        arguments: The arguments of the command line.

    Raises:
        ConfigError: there is no program, more than one, or a notebook.
    """
    if "arguments" not in arguments.settings:
        return
    programs = [word for word in words if not is_world_name(word)]
    if getattr(arguments, "run", None) is not None:
        raise ConfigError(
            "a stored run has its own arguments", "leave them out", key=ARGUMENTS_FOLLOW
        )
    if len(programs) > 1:
        raise ConfigError(
            "arguments go to one program", f"got {len(programs)}", key=ARGUMENTS_FOLLOW
        )
    if not programs and not any(map(is_world_name, words)) and not arguments.world:
        raise ConfigError(
            "arguments need a program", "tuisim PROGRAM -- ARGUMENTS", key=ARGUMENTS_FOLLOW
        )
    if programs and os.path.isdir(programs[0]):
        raise ConfigError(
            f"{programs[0]} is a folder; notebooks take no arguments", key=ARGUMENTS_FOLLOW
        )
    if programs and is_notebook(programs[0]):
        raise ConfigError(
            f"{programs[0]} is a notebook; its cells take no arguments", key=ARGUMENTS_FOLLOW
        )


def _load_named_world(words: Sequence[str], arguments: Arguments) -> WorldFile | None:
    """Return the world that a word or `--world` names; None if none is named."""
    named = [word for word in words if is_world_name(word)]
    named += [] if arguments.world is None else [arguments.world]
    if len(named) > 1:
        raise ConfigError(
            f"two worlds: {named[0]} and {named[1]}", "give only one world", key="--world"
        )
    return WorldFile.load(find_program(named[0]), arguments.settings.get("mats")) if named else None


def _prepare_word(
    word: str | None, world: WorldFile | None, arguments: Arguments, config: UserConfig
) -> Prepared:
    in_world = world.settings if world else {}
    if word is None:
        if "arguments" in arguments.settings:
            named = world.path if world else arguments.world
            raise ConfigError(
                f"{named} has no program that the arguments could go to",
                f"tuisim PROGRAM {named} -- ARGUMENTS",
                key=ARGUMENTS_FOLLOW,
            )
        settings = Settings.merge(_select_defaults(world, config), in_world, arguments.settings)
        spec = _build_spec(settings)
        plain = Settings.merge(arguments.settings)
        remarks = _find_effective_defaults(spec, world, config, plain, arguments.settings)
        decided = Decided(free=find_free_paths(settings))
        return Prepared(None, settings, spec, world, from_config=remarks, decided=decided)
    return _prepare_source(read_program(find_program(word)), world, arguments, config)


def _select_defaults(world: WorldFile | None, config: UserConfig) -> dict[str, Any]:
    return config.layer(Section.APP) | ({} if world else config.layer(Section.SIMULATION))


def _find_effective_defaults(
    spec: RunSpec,
    world: WorldFile | None,
    config: UserConfig,
    plain: Settings,
    *above: Mapping[str, Any],
) -> tuple[str, ...]:
    """Return a sentence for each default of the user that changes a run; empty if the run has a world file.

    Args:
        spec: The run with the defaults.
        world: Its world; None if there is none.
        config: The user's defaults.
        plain: The settings without the defaults.
        above: Settings that take precedence over the defaults.
    """
    remarks = () if world else tuple(config.list_effective(*above))
    try:
        return remarks if remarks and build_run_spec(plain) != spec else ()
    except ConfigError:
        # Without the user's defaults, the run is impossible, for example on a mat in the user's own folder.
        return remarks


def _prepare_source(
    file: ProgramSource, world: WorldFile | None, arguments: Arguments, config: UserConfig
) -> Prepared:
    layers = [*([world.settings] if world else []), arguments.settings]
    resolve_settings = partial(build_program_settings, file, *layers)
    effective = resolve_settings(below=_select_defaults(world, config))
    try:
        program = effective.apply(file.program)
        spec = _build_spec(effective.settings)
    except ConfigError:
        path = Path(file.program.path) if file.program.path else None
        mats = effective.settings["mats"]
        for wrong in find_wrong_names(file.program.text, path, file.program.name, mats):
            if effective.settings[wrong.path] == file.options[wrong.path]:
                raise wrong.error from None
        raise
    above = (effective.decided.layer, file.options, arguments.settings)
    changed = _find_effective_defaults(spec, world, config, resolve_settings().settings, *above)
    return Prepared(
        program, effective.settings, spec, world, from_config=changed, decided=effective.decided
    )


def _build_spec(settings: Settings) -> RunSpec:
    """Return the run specification of settings; print warnings about the robot file on stderr."""
    robot = RobotChoice.load(settings["robot"], "-r")
    for note in robot.notes:
        echo_error(f"note: {note}")
    return build_run_spec(settings.changed({"robot": robot}) if robot.notes else settings)


def _prepare_cell(
    file: ProgramSource, world: WorldFile | None, arguments: Arguments, config: UserConfig
) -> Prepared:
    try:
        return _prepare_source(file, world, arguments, config)
    except ConfigError as error:
        # An error about a mat or robot must also name the cell.
        raise ConfigError(
            error.message, error.hint, file="" if error.file else file.program.name
        ) from None


def prepare_app(
    words: Sequence[str], arguments: Arguments, config: UserConfig, can_begin: bool = False
) -> Prepared:
    """Return what the app opens: nothing, a program, a world, or a program in a world.

    Args:
        words: The programs and worlds that the user named.
        arguments: The arguments of the command line.
        config: The user's defaults.
        can_begin: Whether to open a new, empty program for a Python file that does not exist; its folder must exist.

    Raises:
        ConfigError: program, magic line, world or options are wrong, or there are two programs.
    """
    world = _load_named_world(words, arguments)
    programs = [word for word in words if not is_world_name(word)]
    if len(programs) > 1:
        raise ConfigError(
            f"two programs: {programs[0]} and {programs[1]}", "the app opens only one"
        )
    word = world.program if world else None
    if programs:
        word = programs[0]
    if word is not None and is_notebook(word):
        return _prepare_cell(find_programs(word)[0].source, world, arguments, config)
    if word is None:
        return _prepare_word(word, world, arguments, config)
    path = find_program(word)
    is_new = (
        can_begin and path.suffix == ".py" and not os.path.lexists(path) and path.parent.is_dir()
    )
    source = (
        build_program("", path, path.name) if is_new else read_program(path, is_unfinished=True)
    )
    mats = Settings.merge(_select_defaults(world, config), source.options, arguments.settings)[
        "mats"
    ]
    return _prepare_source(drop_wrong_names(source, mats), world, arguments, config)


def prepare_replay(
    run: str, words: Sequence[str], arguments: Arguments, config: UserConfig
) -> tuple[StoredRun, Prepared]:
    """Return a stored run, and what the app needs to open it.

    Args:
        run: Its number, its id or the start of its id, its folder's path, or `last`.
        words: Other words of the command line; must be empty.
        arguments: The arguments of the command line.
        config: The user's defaults; only the defaults of the app apply.

    Raises:
        ConfigError: a program, a world or an option of a run is given, too.
        LogError: there is no such run, or it is damaged.
    """
    chosen = arguments.settings
    if words or arguments.world or (wrong := sorted(chosen.keys() - APP_PATHS)):
        what = words[0] if words else arguments.world or wrong[0].replace("_", " ")
        raise ConfigError(
            "a stored run has its own program and world", f"remove {what}", key="--run"
        )
    stored = RunStore().load_run(run)
    opened = replace(stored.program, python_path=(), working_directory="")
    return stored, Prepared(opened, Settings.merge(config.layer(Section.APP), chosen), stored.spec)


def prepare_runs(
    words: Sequence[str],
    arguments: Arguments,
    usual_world: WorldFile | None = None,
    command: str = "run",
    config: UserConfig = NO_CONFIG,
) -> list[Prepared | NotRun]:
    """Return the programs that the user named, to be run one after another in the named world, if any.

    An error in one notebook of a folder does not prevent the other notebooks from running.

    Args:
        words: The programs and worlds that the user named.
        arguments: The arguments of the command line.
        usual_world: The world if the user names none; None to run each program in its own.
        command: The name of the command, for errors.
        config: The user's defaults.

    Raises:
        ConfigError: a program, magic line, world or option is wrong, or there is no program.
    """
    world = _load_named_world(words, arguments) or usual_world
    programs = [word for word in words if not is_world_name(word)]
    if not programs and world and world.program is not None:
        programs = [world.program]
    if not programs:
        where = f"{world.path} names no program" if world else "no program is named"
        raise ConfigError(where, f"tuisim {command} PROGRAM…")
    prepared: list[Prepared | NotRun] = []
    for word in programs:
        if os.path.isdir(word):
            prepared += _prepare_folder(word, world, arguments, config)
        elif is_notebook(word):
            prepared += [
                _check_mat(_prepare_cell(program.source, world, arguments, config))
                for program in find_programs(word)
            ]
        else:
            prepared.append(_check_mat(_prepare_word(word, world, arguments, config)))
    return prepared


def _prepare_folder(
    word: str, world: WorldFile | None, arguments: Arguments, config: UserConfig
) -> list[Prepared | NotRun]:
    # The options are checked here, so that an error in them is raised once, and not for each program.
    build_run_spec(Settings.merge(world.settings if world else {}, arguments.settings))
    prepared: list[Prepared | NotRun] = []
    for path in check_folder(word, run_all=arguments.all):
        label = os.path.relpath(path, word)
        try:
            programs = drop_unknown(read_notebook_programs(path))
        except ConfigError as error:
            prepared.append(NotRun(label, error))
            continue
        for program in programs:
            cell = f"{label}#{program.number}"
            try:
                prepared.append(
                    replace(
                        _check_mat(_prepare_source(program.source, world, arguments, config)),
                        label=cell,
                    )
                )
            except ConfigError as error:
                prepared.append(NotRun(cell, error))
    if not prepared:
        raise ConfigError(
            "has no notebook with a program", "program cells begin with %%sim_magic", file=word
        )
    return prepared


def _check_mat(prepared: Prepared) -> Prepared:
    """Read the image of a user's own mat, so that a damaged file is detected before the run; return `prepared`."""
    if os.path.isabs(prepared.spec.world.background):
        field_files(prepared.spec)
    return prepared
