"""Resolve the words of a command line into program, settings and run specification.

The command line takes precedence over the world file, the world file over the program's magic line, and the magic
line over the defaults.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace

from tuisim.commands.echo import echo_error
from tuisim.commands.notebooks import NotRun, check_folder, known_programs, without_unknown
from tuisim.config.build import build_run_spec
from tuisim.config.command_line import ARGUMENTS_FOLLOW, Arguments
from tuisim.config.options import RobotChoice, Settings, settings_of
from tuisim.config.program_file import ProgramSource, find_program, read_program
from tuisim.config.robots import choose_robot
from tuisim.config.worlds import WorldFile, load_world, means_world
from tuisim.core.spec import RunSpec
from tuisim.errors import ConfigError
from tuisim.notebook.cells import is_notebook, notebook_programs
from tuisim.runs.run_folder import StoredRun, field_files
from tuisim.runs.store import RunStore
from tuisim.source import Program

_OF_THE_APP = frozenset({"panels_on", "panels_off", "quiet", "rays", "speed", "fps", "colors", "cells", "pixels"})
"""Fields of `Settings` that do not affect the run."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """Everything needed to start a run or the app."""

    program: Program | None
    settings: Settings
    spec: RunSpec
    world: WorldFile | None = None
    label: str = ""
    """Its name in a table; empty for the program's name."""


def check_arguments(words: Sequence[str], arguments: Arguments) -> None:
    """Check that the words after `--`, if any, belong to exactly one of the programs and worlds that the user named.

    Raises:
        ConfigError: there is no program, more than one, or a notebook.
    """
    if "arguments" not in arguments.settings:
        return
    programs = [word for word in words if not means_world(word)]
    if getattr(arguments, "run", None) is not None:
        raise ConfigError("a stored run has its own arguments", "leave them out", key=ARGUMENTS_FOLLOW)
    if len(programs) > 1:
        raise ConfigError("arguments go to one program", f"got {len(programs)}", key=ARGUMENTS_FOLLOW)
    if not programs and not any(map(means_world, words)) and not arguments.world:
        raise ConfigError("arguments need a program", "tuisim PROGRAM -- ARGUMENTS", key=ARGUMENTS_FOLLOW)
    if programs and os.path.isdir(programs[0]):
        raise ConfigError(f"{programs[0]} is a folder; notebooks take no arguments", key=ARGUMENTS_FOLLOW)
    if programs and is_notebook(programs[0]):
        raise ConfigError(f"{programs[0]} is a notebook; its cells take no arguments", key=ARGUMENTS_FOLLOW)


def _world(words: Sequence[str], arguments: Arguments) -> WorldFile | None:
    """Load the world that is named as a word or with `--world`, if any."""
    named = [word for word in words if means_world(word)]
    named += [] if arguments.world is None else [arguments.world]
    if len(named) > 1:
        raise ConfigError(f"two worlds: {named[0]} and {named[1]}", "name one", key="--world")
    return load_world(find_program(named[0]), arguments.settings.get("mats")) if named else None


def _prepared(word: str | None, world: WorldFile | None, arguments: Arguments) -> Prepared:
    in_world = world.settings if world else {}
    if word is None:
        if "arguments" in arguments.settings:
            named = world.path if world else arguments.world
            raise ConfigError(f"{named} names no program to pass arguments to", key=ARGUMENTS_FOLLOW)
        settings = settings_of(in_world, arguments.settings)
        return Prepared(None, settings, _spec(settings), world)
    return _of_source(read_program(find_program(word)), world, arguments)


def _of_source(file: ProgramSource, world: WorldFile | None, arguments: Arguments) -> Prepared:
    settings = settings_of(file.options, world.settings if world else {}, arguments.settings)
    prelude = settings.preload or file.program.prelude
    program = replace(file.program, prelude=prelude, arguments=settings.arguments)
    return Prepared(program, settings, _spec(settings), world)


def _spec(settings: Settings) -> RunSpec:
    """Return the run specification; print warnings about the robot file on stderr."""
    robot = settings.robot if isinstance(settings.robot, RobotChoice) else choose_robot(settings.robot, "-r")
    for note in robot.notes:
        echo_error(f"note: {note}")
    return build_run_spec(replace(settings, robot=robot) if robot.notes else settings)


def _of_cell(file: ProgramSource, world: WorldFile | None, arguments: Arguments) -> Prepared:
    try:
        return _of_source(file, world, arguments)
    except ConfigError as error:
        # An error about a mat or robot must also name the cell.
        raise ConfigError(error.message, error.hint, file="" if error.file else file.program.name) from None


def prepare_app(words: Sequence[str], arguments: Arguments) -> Prepared:
    """Prepare the app for nothing, a program, a world, or a program in a world, as the user named them.

    Raises:
        ConfigError: program, magic line, world or options are wrong, or there are two programs.
    """
    world = _world(words, arguments)
    programs = [word for word in words if not means_world(word)]
    if len(programs) > 1:
        raise ConfigError(f"two programs: {programs[0]} and {programs[1]}", "the app opens only one")
    word = programs[0] if programs else world.program if world else None
    if word is not None and is_notebook(word):
        return _of_cell(known_programs(word)[0].source, world, arguments)
    return _prepared(word, world, arguments)


def prepare_replay(run: str, words: Sequence[str], arguments: Arguments) -> tuple[StoredRun, Prepared]:
    """Load a stored run for the app.

    Args:
        run: Its number, its id or the start of its id, its folder's path, or `last`.
        words: Other words of the command line; must be empty.

    Raises:
        ConfigError: a program, a world or an option of a run is given too.
        LogError: there is no such run, or it is damaged.
    """
    chosen = arguments.settings
    if words or arguments.world or (wrong := sorted(chosen.keys() - _OF_THE_APP)):
        what = words[0] if words else arguments.world or wrong[0].replace("_", " ")
        raise ConfigError(f"a stored run has its own program and world: remove {what}", "name one", key="--run")
    stored = RunStore().load_run(run)
    opened = replace(stored.program, python_path=(), working_directory="")
    return stored, Prepared(opened, settings_of(chosen), stored.spec)


def prepare_runs(
    words: Sequence[str], arguments: Arguments, usual_world: WorldFile | None = None, command: str = "run"
) -> list[Prepared | NotRun]:
    """Prepare the programs that the user named to run one after another, all in the named world, if any.

    An error in one notebook of a folder does not prevent the others from running.

    Args:
        usual_world: The world if none is named.
        command: The command that is asked for, for errors.

    Raises:
        ConfigError: a program, magic line, world or option is wrong, or there is no program.
    """
    world = _world(words, arguments) or usual_world
    programs = [word for word in words if not means_world(word)]
    if not programs and world and world.program is not None:
        programs = [world.program]
    if not programs:
        where = f"{world.path} names no program" if world else "no program is named"
        raise ConfigError(where, f"tuisim {command} PROGRAM…")
    prepared: list[Prepared | NotRun] = []
    for word in programs:
        if os.path.isdir(word):
            prepared += _of_folder(word, world, arguments)
        elif is_notebook(word):
            prepared += [_checked(_of_cell(program.source, world, arguments)) for program in known_programs(word)]
        else:
            prepared.append(_checked(_prepared(word, world, arguments)))
    return prepared


def _of_folder(word: str, world: WorldFile | None, arguments: Arguments) -> list[Prepared | NotRun]:
    # Errors of the command line are raised once, not for each cell.
    build_run_spec(settings_of(world.settings if world else {}, arguments.settings))
    found: list[Prepared | NotRun] = []
    for path in check_folder(word, run_all=arguments.all):
        label = os.path.relpath(path, word)
        try:
            programs = without_unknown(notebook_programs(path))
        except ConfigError as error:
            found.append(NotRun(label, error))
            continue
        for program in programs:
            cell = f"{label}#{program.number}"
            try:
                found.append(replace(_checked(_of_source(program.source, world, arguments)), label=cell))
            except ConfigError as error:
                found.append(NotRun(cell, error))
    if not found:
        raise ConfigError("has no notebook with a program", "program cells begin with %%sim_magic", file=word)
    return found


def _checked(one: Prepared) -> Prepared:
    """Read the image of a user's own mat, to detect a damaged file before the run."""
    if os.path.isabs(one.spec.world.background):
        field_files(one.spec)
    return one
