"""`tuisim open` and `tuisim analyse`: the commands that start the app. `tuisim serve` also reads here what to open."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from tuisim import __version__
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.commands.listings import WORLD, list_names
from tuisim.commands.log import COLUMNS, TELEMETRY
from tuisim.settings.command_line import Arguments, WordType, argument, command, option
from tuisim.settings.shared_options import build_shared_options

if TYPE_CHECKING:
    from tuisim.commands.resolve import Prepared
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.settings.options import Settings
    from tuisim.settings.worlds import WorldFile
    from tuisim.tasks.goals.files import GoalsFile
    from tuisim.tasks.lessons.spec import Lesson

VERSION = "%(prog)s %(version)s"
_WORLD = frozenset({"background", "robot", "obstacles"})
"""Settings of a world: with one of these, the user has chosen what to open."""


OPENED: Sequence[click.Parameter] = (
    argument("words", "[PROGRAM]", lambda: list_names("programs"), nargs=-1),
    WORLD,
    option(
        "--goals",
        metavar="FILE",
        type=WordType(names=lambda: list_names("goals")),
        help="Judge the runs by a goals file, which may also precede the program.",
    ),
    option("--run", metavar="RUN", help="Open a stored run, see `tuisim runs`."),
    *build_shared_options(names=list_names),
)
"""What the app opens, and how."""


@dataclass(frozen=True, slots=True)
class Opened:
    """The content with which the app opens: a program in its world with goals, or a stored run.

    It has been read and checked already.
    """

    prepared: Prepared
    goals: GoalsFile | None
    replay: StoredRun | None
    is_empty: bool = False
    """Whether nothing was named: no program, no world, no mat."""


def read_opened(arguments: Arguments, *, can_begin: bool = False) -> Opened | None:
    """Return the content with which the app opens; None if the command only lists the programs of a notebook.

    Args:
        arguments: The arguments of the command line.
        can_begin: Whether a Python file that does not exist is a new program.

    Raises:
        ConfigError: a program, a world, a run or an option is wrong.
    """
    from tuisim.commands.notebooks import find_listed, print_list
    from tuisim.commands.resolve import check_arguments, prepare_app, prepare_replay
    from tuisim.settings.user_config import UserConfig

    check_arguments(arguments.words, arguments)
    if listed := find_listed(arguments.words):
        print_list(arguments.words[0], listed)
        return None
    goals = _load_goals(arguments.goals)
    config = UserConfig.load()
    if arguments.run is not None:
        replay, prepared = prepare_replay(arguments.run, arguments.words, arguments, config)
        return Opened(prepared, goals, replay)
    prepared = prepare_app(_list_words(arguments, goals), arguments, config, can_begin)
    is_empty = (
        not arguments.words
        and not arguments.world
        and goals is None
        and _WORLD.isdisjoint(arguments.settings)
    )
    return Opened(
        prepared,
        goals or _load_world_goals(prepared.world, prepared.settings["mats"]),
        None,
        is_empty,
    )


@click.version_option(__version__, prog_name="tuisim", message=VERSION, hidden=True)
@command(
    *OPENED,
    passes_arguments=True,
    name="open",
    help="""Open the app.

    A PROGRAM is a Python file, which may be new, a notebook, one of its cells (FILE.ipynb#2), a world or goals file,
    or an example by name. The words after -- are its arguments.

    A program from a real robot gets the robot that it describes, unless -r names one: see tuisim guide real-programs.

    A program's first line, such as `# %%sim_magic_preloaded -b Grey_bands`, can also hold options. The command line
    takes precedence over a world file, the world file over the first line.
    """,
)
def open_app(**given: Any) -> int:
    """Start the app, block until it ends, and return the exit code.

    Args:
        **given: The arguments of the command line.

    Raises:
        ConfigError: a program, a world, a run or an option is wrong, or there is no terminal.
    """
    opened = read_opened(Arguments(**given), can_begin=sys.stdin.isatty() and sys.stdout.isatty())
    if opened is None:
        return 0
    if not has_terminal():
        raise ConfigError("the app needs a terminal", "without one, use `tuisim run PROGRAM`")
    from tuisim.app.app import AppSettings, run_app

    prepared = opened.prepared
    settings = opened.prepared.settings
    goals = opened.goals
    app_settings = AppSettings(
        spec=prepared.spec,
        settings=None if opened.replay else settings,
        replay=opened.replay,
        world_file=prepared.world.path if prepared.world else None,
        program=prepared.program,
        goals=goals,
        panels_on=frozenset(settings["panels_on"]) | ({"goals"} if goals else set()),
        panels_off=frozenset(settings["panels_off"]),
        welcomes=opened.is_empty,
        autorun=settings["autorun"],
        from_config=prepared.from_config,
        decided=prepared.decided,
        **_select_app_settings(settings),
    )
    with _draw_on_stdout():
        return run_app(app_settings)


def _select_app_settings(settings: Settings) -> dict[str, Any]:
    """Return the settings of the app itself, without settings of a run, by the field names of `AppSettings`."""
    return {
        "quiet": settings["quiet"],
        "rays": settings["rays"],
        "speed": 1.0 if settings["speed"] is None else settings["speed"],
        "fps": settings["fps"],
        "colors": settings["colors"],
        "cells": settings["cells"],
        "pixels": settings["pixels"],
    }


def open_lesson_in_app(lesson: Lesson, folder: str | None) -> int:
    """Start the app with a lesson, block until it ends, and return the exit code.

    Args:
        lesson: The lesson.
        folder: The folder with the user's own lessons; None if the user has named none.

    Raises:
        ConfigError: the student's program of the lesson cannot be read or written.
    """
    from tuisim.app.app import AppSettings, run_app
    from tuisim.programs.program_file import read_program
    from tuisim.programs.program_settings import build_program_settings
    from tuisim.settings.build import build_run_spec
    from tuisim.settings.user_config import Section, UserConfig
    from tuisim.tasks.lessons.progress import prepare_program

    source = read_program(prepare_program(lesson))
    effective = build_program_settings(
        source, lesson.settings, below=UserConfig.load().layer(Section.APP)
    )
    settings = effective.settings
    app_settings = AppSettings(
        spec=build_run_spec(settings),
        settings=settings,
        program=source.program,
        goals=lesson.task,
        lesson=lesson,
        lessons_folder=folder,
        panels_on=frozenset(settings["panels_on"]) | {"lesson", "code"},
        panels_off=frozenset(settings["panels_off"]),
        decided=effective.decided,
        **_select_app_settings(settings),
    )
    with _draw_on_stdout():
        return run_app(app_settings)


def has_terminal() -> bool:
    """Return whether the app can be shown: in a terminal, or in a browser by `tuisim serve`."""
    return _is_in_browser() or (sys.stdin.isatty() and sys.stdout.isatty())


def _is_in_browser() -> bool:
    from tuisim.terminal.probe import is_in_browser

    return is_in_browser()


def _load_goals(word: str | None) -> GoalsFile | None:
    if word is None:
        return None
    from tuisim.tasks.goals.files import GoalsFile

    return GoalsFile.load(word)


def _load_world_goals(world: WorldFile | None, mats: str | None) -> GoalsFile | None:
    if world is None:
        return None
    from tuisim.tasks.goals.files import load_task

    return load_task(world.path, mats)[1]


def _list_words(arguments: Arguments, goals: GoalsFile | None) -> tuple[str, ...]:
    """Return the words of the command line.

    If they name no world, and there are goals, the path of the goals file comes first, as the world.
    """
    from tuisim.settings.worlds import is_world_name

    words: tuple[str, ...] = arguments.words
    if goals is None or arguments.world or any(map(is_world_name, words)):
        return words
    return (str(goals.path), *words)


@command(
    argument("words", "[RUN…|FILE|-]", lambda: ("last",), nargs=-1),
    TELEMETRY,
    *COLUMNS,
    help="""Explore logs in the app: table, chart, bands, notes.

    A RUN is given by its number, its id, or `last` (the default); several are drawn in one chart. A FILE is CSV,
    Parquet, JSONL, Arrow or text with lines such as `Colour: 98.8`; - is the standard input.
    """,
)
def analyse(**given: Any) -> int:
    """Start the analyser of logs, block until it ends, and return the exit code.

    Args:
        **given: The arguments of the command line.

    Raises:
        ConfigError: the logs are wrong, or there is no terminal.
    """
    from tuisim.commands.logs.sources import build_request

    request = build_request(Arguments(**given))
    if not (_is_in_browser() or sys.stdout.isatty()):
        raise ConfigError("the analyser needs a terminal", "without one, use `tuisim log`")
    from tuisim.app.analyser.app import run_analyser
    from tuisim.logs.reader import STDIN

    if request.file == STDIN:
        _read_terminal_keys()
    with _draw_on_stdout():
        return run_analyser(request)


def _read_terminal_keys() -> None:
    """Move standard input, which has the log, to a new `sys.stdin`; file descriptor 0 becomes the terminal, for keys.

    Raises:
        ConfigError: there is no terminal.
    """
    try:
        terminal = os.open("/dev/tty", os.O_RDWR)
    except OSError as error:
        raise ConfigError(
            "there is no terminal to read keys from", "give a file instead of -"
        ) from error
    sys.stdin = os.fdopen(os.dup(0))
    os.dup2(terminal, 0)
    os.close(terminal)


@contextmanager
def _draw_on_stdout() -> Iterator[None]:
    """In a `with` block, redirect stderr to the terminal of stdout: Textual draws on stderr, which may be a file."""
    if _is_in_browser():
        yield
        return
    stderr = os.dup(2)
    os.dup2(1, 2)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
