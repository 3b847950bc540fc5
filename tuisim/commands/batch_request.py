"""The request of a batch: its command line and batch file, checked as a whole before anything is run."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, see_page
from tuisim.base.folders import user_path
from tuisim.batch.parameters import SEED, Choice, parse_seeds, parse_values
from tuisim.batch.plan import Plan, Subject
from tuisim.batch.sweep import Workers
from tuisim.commands.batch_file import BatchFile, load_batch
from tuisim.commands.echo import echo_error
from tuisim.commands.listings import WORLD, list_names
from tuisim.commands.notebooks import NotRun
from tuisim.commands.resolve import check_arguments, prepare_runs
from tuisim.commands.run_options import (
    build_input_option,
    build_jobs_option,
    build_timeout_option,
    build_workers_option,
    keep_option,
)
from tuisim.engine import files
from tuisim.engine.runs.handle import RunOptions
from tuisim.logs.export import LISTED, check_target
from tuisim.settings.command_line import Arguments, WordType, argument, option
from tuisim.settings.worlds import BATCH_KEY, WORLD_SUFFIX, WorldFile, is_world_name
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.task import Keep

_GRID = "Parameters"
_RESULTS = "Results"
_LIMITS = "Input and limits"
OPTIONS = (
    argument("programs", "PROGRAM…|SPEC.toml", lambda: list_names("programs"), nargs=-1),
    WORLD,
    build_jobs_option(),
    option(
        "--scheduler",
        metavar="ADDRESS",
        help="Use the Dask cluster of a scheduler, such as tcp://host:8786.",
    ),
    build_workers_option("--workers", "Use a Dask cluster of this many workers on this machine."),
    option(
        "--seeds", metavar="SEEDS", group=_GRID, help="One run for each seed: 0..199, or 1,5,9."
    ),
    option(
        "--set",
        "sets",
        multiple=True,
        metavar="NAME=VALUES",
        group=_GRID,
        help="Vary a key of a world or robot file: noise.motor=0,20,50, robot.wheel_diameter_mm=54:58:0.5, "
        "start.x_mm=random(100, 300, 20), latin(…); may be repeated, for all combinations.",
    ),
    option(
        "--out", metavar="FILE", type=WordType(), group=_RESULTS, help=f"Write the table: {LISTED}."
    ),
    option(
        "--expr",
        "expressions",
        multiple=True,
        metavar="NAME=EXPR",
        group=_RESULTS,
        help="Add a column, such as 'error_mm=hypot(x_mm - 750, y_mm - 850)'; may be repeated.",
    ),
    option(
        "--goals",
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="Judge the goals in a file, one column each.",
    ),
    keep_option(Keep.NONE, _RESULTS),
    option(
        "--resume",
        is_flag=True,
        group=_RESULTS,
        help="Continue an interrupted batch that wrote the same --out.",
    ),
    option(
        "--json",
        "as_json",
        is_flag=True,
        group=_RESULTS,
        help="Print one JSON object per run, not the summary.",
    ),
    build_timeout_option(_LIMITS),
    build_input_option(_LIMITS),
)
"""The options of `tuisim batch` besides the shared ones."""


@dataclass(frozen=True, slots=True)
class Request:
    """A batch that the user requests: its plan, workers, and output."""

    plan: Plan
    expressions: Mapping[str, str]
    """By the name of their column."""
    out: Path | None
    workers: Workers
    resume: bool


def read_request(arguments: Arguments) -> Request:
    """Return the batch that the arguments of the command line describe.

    Raises:
        ConfigError: a program, a parameter, a goal, an expression or an option is wrong.
        ExportError: the table cannot be written.
    """
    file = _take_batch_file(arguments)
    named = arguments.goals or file.goals or _find_goals_world(arguments)
    goals = GoalsFile.load(named) if named else None
    subjects = _prepare_subjects(arguments, file, goals)
    typed = _parse_choices(arguments)
    decided = typed.keys() | arguments.settings.keys()
    free_choices = {name: choice for name, choice in file.choices.items() if name not in decided}
    choices = {**free_choices, **typed}
    if SEED in choices:
        # The seed comes last and so varies fastest: runs that differ only in the seed follow each other.
        choices[SEED] = choices.pop(SEED)
    plan = Plan(
        subjects,
        choices,
        file.path if free_choices.keys() - {SEED} else Path("--set"),
        goals=goals.goals if goals else (),
        keep=Keep(arguments.keep or file.keep or Keep.NONE),
        options=RunOptions(
            time_limit_s=arguments.timeout,
            answers=arguments.input or (goals.answers if goals else ()),
        ),
    )
    expressions = {**file.expressions, **dict(map(_parse_expression, arguments.expressions))}
    plan.check_expressions(expressions)
    for remark in plan.remarks:
        echo_error(f"note: {remark}")
    out = arguments.out or file.out
    if arguments.resume and out is None:
        raise ConfigError("needs the table that it continues", "--out FILE", key="--resume")
    target = check_target(out) if out is not None else None
    return Request(plan, expressions, target, _choose_workers(arguments, file), arguments.resume)


def _choose_workers(arguments: Arguments, file: BatchFile) -> Workers:
    options = {
        "--jobs": arguments.jobs,
        "--scheduler": arguments.scheduler,
        "--workers": arguments.workers,
    }
    named = [name for name, value in options.items() if value]
    if len(named) > 1:
        hint = f"give {named[0]} or {named[1]}"
        raise ConfigError(f"cannot be combined with {named[0]}", hint, key=named[1])
    jobs = arguments.jobs or (0 if named else file.jobs or 0)
    return Workers(jobs, arguments.scheduler or "", arguments.workers)


def _find_goals_world(arguments: Arguments) -> str | None:
    """Return the first world file in the arguments that has goals; None if there is none."""
    words: list[str | None] = [*filter(is_world_name, arguments.programs), arguments.world]
    for word in filter(None, words):
        with suppress(ConfigError):
            if "goal" in files.read_file(user_path(word), ConfigError):
                return word
    return None


def _take_batch_file(arguments: Arguments) -> BatchFile:
    """Return the batch file among the programs in the arguments, or an empty one if there is none.

    The batch file is removed from the arguments; its own programs are added to them unless the user names some.
    """
    named = [word for word in arguments.programs if is_batch_file(word)]
    if len(named) > 1:
        raise ConfigError(f"two batches: {named[0]} and {named[1]}", "give only one batch file")
    if not named:
        return BatchFile(Path())
    arguments.programs = tuple(word for word in arguments.programs if word not in named)
    file = load_batch(Path(named[0]), arguments.settings.get("mats"))
    if not any(not is_world_name(word) for word in arguments.programs):
        arguments.programs = (*arguments.programs, *file.programs)
    return file


def _prepare_subjects(
    arguments: Arguments, file: BatchFile, goals: GoalsFile | None
) -> tuple[Subject, ...]:
    """Return the programs of a batch with their settings.

    If no world is named, they run in the world of the goals.

    Args:
        arguments: The arguments of the command line.
        file: The batch file.
        goals: The goals; None for none.
    """
    check_arguments(arguments.programs, arguments)
    world = file.world
    if world is None and goals is not None:
        world = WorldFile(goals.path, goals.settings, goals.program)
    elif world is not None and goals is not None:
        settings = {**world.settings, **goals.presses}
        world = replace(world, settings=settings, program=world.program or goals.program)
    # A batch runs all programs of a notebook, as with --all.
    arguments.all = True
    subjects = []
    refusals = []
    for prepared in prepare_runs(arguments.programs, arguments, world, "batch"):
        if isinstance(prepared, NotRun):
            raise ConfigError(
                prepared.error.message,
                prepared.error.hint,
                file="" if prepared.error.file else prepared.label,
            )
        assert prepared.program is not None
        subjects.append(
            Subject(
                prepared.program, prepared.settings, frozenset(arguments.settings), prepared.label
            )
        )
        refusals += [prepared.decided.refusal] if prepared.decided.refusal else []
    for refusal in dict.fromkeys(refusals):
        echo_error(f"note: {refusal}")
    return tuple(subjects)


def _parse_choices(arguments: Arguments) -> dict[str, Choice]:
    choices: dict[str, Choice] = {}
    for text in arguments.sets:
        name, values = parse_set(text)
        if name in choices:
            raise ConfigError(
                f"{name} is given twice", "name all of its values at once", key="--set"
            )
        choices[name] = values
    if arguments.seeds is not None:
        if SEED in choices:
            raise ConfigError(
                "cannot be combined with --set seed", "give --seeds or --set seed", key="--seeds"
            )
        choices[SEED] = parse_seeds(arguments.seeds)
    return choices


def _parse_expression(text: str) -> tuple[str, str]:
    name, equals, expression = text.partition("=")
    if not equals or not name.strip() or not expression.strip():
        raise ConfigError(
            f"must be NAME=EXPR, got {text!r}", "such as 'far_mm=hypot(x_mm, y_mm)'", key="--expr"
        )
    return name.strip(), expression.strip()


def is_batch_file(word: str) -> bool:
    """Return whether a word of the command line names a batch file, which has a table `[batch]`.

    The result is False for a file that cannot be read.
    """
    path = user_path(word)
    if path.suffix.lower() != WORLD_SUFFIX:
        return False
    try:
        data = files.read_file(path, ConfigError)
    except ConfigError:
        return False
    return BATCH_KEY in data


def parse_set(text: str) -> tuple[str, Choice]:
    """Return the parameter's name and values in a text `NAME=VALUES`.

    Raises:
        ConfigError: there is no name, or the values are wrong; errors name the option `--set`.
    """
    name, equals, values = text.partition("=")
    name = name.strip()
    if not equals or not name:
        hint = f"such as noise.motor=0,20,50; {see_page('experiments')}"
        raise ConfigError(f"must be NAME=VALUES, got {text!r}", hint, key="--set")
    return name, parse_values(values, f"--set {name}")
