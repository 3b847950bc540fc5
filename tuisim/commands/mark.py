"""`tuisim mark`: the programs of a class against the goals of a task."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from tuisim import __version__
from tuisim.base.errors import (
    ConfigError,
    ExportError,
    TuisimError,
    counted,
    listed,
    printable,
    see_page,
)
from tuisim.base.faults import UNJUDGED, describe_fault, report_file
from tuisim.base.source import source_lines
from tuisim.batch.parameters import parse_seeds
from tuisim.commands.echo import (
    Progress,
    draw_table,
    echo,
    echo_error,
    echo_lines,
    echo_wrapped,
    echo_written,
    is_watched,
    tell,
)
from tuisim.commands.exit_status import Interrupted, raise_signals
from tuisim.commands.listings import list_names
from tuisim.commands.run_options import (
    build_input_option,
    build_jobs_option,
    build_timeout_option,
    keep_option,
)
from tuisim.engine.core.values import Whole
from tuisim.engine.runs.child.isolation import MOST_BYTES, check_isolation
from tuisim.logs.export import EXPORTERS, check_place, check_target
from tuisim.settings.command_line import Arguments, WordType, argument, command, option
from tuisim.settings.shared_options import build_shared_options, build_type
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.marks.marking import GRADEBOOKS, Marking, MarkRequest
from tuisim.tasks.marks.sheet import Sheet
from tuisim.tasks.task import TIME_LIMIT_S, Keep

PAGE_SUFFIXES = (".html", ".htm")
DEFAULT_SEEDS = "0..19"
USUAL_KEEP = Keep.FAILED

_LEFT_OUT = ("seed", "speed", "press")
"""Shared options that marking does not take: each program has several seeds, and runs as fast as possible; a task says
what is pressed in each of its worlds."""
_MEGABYTES = Whole(1, 1 << 20)
_RUNS = "Runs"
_RESULTS = "Results"
_OPTIONS = (
    argument("goals", "GOALS"),
    argument("folders", "FOLDER…", nargs=-1),
    option(
        "--seeds",
        default=DEFAULT_SEEDS,
        metavar="SEEDS",
        group=_RUNS,
        help=f"Run each program with these seeds: 0..19, or 1,2,5 ({DEFAULT_SEEDS}).",
    ),
    build_timeout_option(_RUNS, TIME_LIMIT_S),
    build_input_option(_RUNS),
    build_jobs_option(group=_RUNS),
    option(
        "--isolate",
        is_flag=True,
        group=_RUNS,
        help="Refuse to mark if programs cannot be isolated: without network, without your files, with limited memory.",
    ),
    option(
        "--no-isolate",
        "no_isolate",
        is_flag=True,
        group=_RUNS,
        help="Do not isolate programs; by default each runs in bubblewrap, if that works.",
    ),
    option(
        "--max-mb",
        "max_mb",
        default=MOST_BYTES >> 20,
        metavar="MB",
        type=build_type(_MEGABYTES, "--max-mb"),
        group=_RUNS,
        help=f"Do not run hand-ins that are larger ({MOST_BYTES >> 20}).",
    ),
    option(
        "--resume",
        is_flag=True,
        group=_RUNS,
        help="Continue an interrupted marking with these goals; run only what is new or has changed.",
    ),
    keep_option(USUAL_KEEP, _RUNS),
    option(
        "--export",
        multiple=True,
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="Write the marks: .html is a page with a report of each stored run, else "
        f"{', '.join(EXPORTERS)}; may be repeated.",
    ),
    option(
        "--moodle",
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="Write a CSV file for Moodle's gradebook.",
    ),
    option(
        "--canvas",
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="Write a CSV file for Canvas's gradebook.",
    ),
    option(
        "--roster",
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="A CSV file that names the student of each submission, with the gradebook's columns.",
    ),
    option(
        "--goal-columns",
        "goal_columns",
        is_flag=True,
        group=_RESULTS,
        help="Give each goal its own column in the gradebook's file.",
    ),
    option(
        "--overrides",
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help="A TOML file with your own points and comments by student, which take precedence.",
    ),
    option(
        "--movies",
        is_flag=True,
        group=_RESULTS,
        help="Add a movie with the goals to the report of each run that missed a goal.",
    ),
    option(
        "--feedback",
        metavar="FOLDER",
        type=WordType(),
        group=_RESULTS,
        help="Write a text file for each student: what was met, what was missed, and why.",
    ),
)


@command(
    *_OPTIONS,
    *build_shared_options(without_app=True, left_out=_LEFT_OUT, names=list_names),
    help="""Mark the programs of a class.

    GOALS is a file with the goals of the task and its world. A FOLDER contains a file NAME.py or a folder for each
    student; a student's folder contains the program main.py, a single program, or the one that GOALS names.

    Programs run in the world of GOALS; if it names none, in that of their first line. A program that hangs, floods or
    crashes affects only its own marks. If bubblewrap is installed and works, each program is isolated.

    Exit code: 0 all programs have marks, 1 this machine could not make some runs (--resume tries them again), or a
    goal's regular expression took too long, 2 bad input, 130 interrupted (--resume continues).
    """,
)
def mark(**given: Any) -> int:
    """Mark the programs of a class, and return the exit code.

    Raises:
        ConfigError: goals, folders or options are wrong; nothing was run.
        ExportError: a target cannot be written; checked before anything is run.
        LogError: the journal or a recording cannot be read or written.
    """
    arguments = Arguments(**given)
    task = GoalsFile.load(Path(arguments.goals))
    seeds = parse_seeds(arguments.seeds, "--seeds")
    _check(arguments, task)
    request = MarkRequest(
        task=task,
        folders=arguments.folders,
        seeds=seeds,
        version=__version__,
        settings=arguments.settings,
        time_limit_s=arguments.timeout,
        answers=arguments.input,
        keep=Keep(arguments.keep or USUAL_KEEP),
        jobs=arguments.jobs,
        max_bytes=arguments.max_mb << 20,
        resumes=arguments.resume,
        roster=Path(arguments.roster) if arguments.roster else None,
        overrides=Path(arguments.overrides) if arguments.overrides else None,
        exports=tuple(map(Path, arguments.export)),
        gradebooks=_list_gradebooks(arguments),
        goal_columns=arguments.goal_columns,
        movies=arguments.movies,
        feedback=Path(arguments.feedback) if arguments.feedback else None,
    )
    with request.open_marking() as marking:
        return _mark(marking, arguments)


def _mark(marking: Marking, arguments: Arguments) -> int:
    _tell_strangers(marking, arguments.roster)
    marking.read_programs()
    isolate = _should_isolate(arguments)
    if is_watched():
        echo_error(f"marking: {marking.size_words}")
    with Progress("marking", in_lines=True):
        try:
            with raise_signals():
                marking.run(tell, isolate=isolate)
        except Interrupted as interrupted:
            _tell_so_far(marking)
            return interrupted.exit_code
        sheet = marking.build_sheet()
        # Printed before the files are written: the user sees the marks even if writing fails.
        _print(sheet)
        _tell_notes(marking)
        code = _write(marking.list_exports(sheet, tell))
    return max(code, _tell_unread(marking), _tell_missing(marking), _tell_unknown(marking))


def _tell_strangers(marking: Marking, roster: str) -> None:
    """Print which submissions are not in the class list, and which students in the list have no submission."""
    if marking.unlisted:
        echo_error(f"note: not in {roster}: {listed(map(printable, marking.unlisted))}")
    if marking.absent:
        echo_error(
            f"note: in {roster}, but without a submission: {listed(map(printable, marking.absent))}"
        )


def _tell_so_far(marking: Marking) -> None:
    """Print the marks of the students whose programs have finished all their runs, and how many runs are stored."""
    sheet = marking.build_sheet_so_far()
    if sheet.rows:
        _print(sheet)
    echo_error(
        f"tuisim: interrupted with {len(sheet.rows)} of {counted(len(marking.students), 'student')} marked, "
        "nothing exported;"
    )
    runs = counted(sum(map(len, marking.outcomes.values())), "run")
    echo_error(f"tuisim: {runs} stored: the same command with --resume continues")


def _tell_notes(marking: Marking) -> None:
    """Print which files were not marked and why, and which programs a real brick would refuse to start."""
    if marking.ignored:
        names = listed(marking.ignored)
        echo_error(f"note: not marked, because they are not Python programs: {names}")
    if marking.left_out:
        echo_error(
            f"note: left out, because they are not part of a hand-in: {listed(marking.left_out)}"
        )
    for student in marking.students:
        if student.refusal:
            echo_error(f"note: {printable(f'{student.name}: {student.refusal}')}")


def _tell_unread(marking: Marking) -> int:
    """Print the students whose programs this machine could not read; return 1 if there are some, else 0."""
    unread = [student for student in marking.students if student.is_unread]
    for student in unread:
        echo_error(f"tuisim: the marks do not include {printable(student.name)}: {student.problem}")
    return 1 if unread else 0


def _tell_missing(marking: Marking) -> int:
    """Print the runs that did not take place because of this machine; return 1 if there are some, else 0."""
    missing = marking.missing
    if not missing:
        return 0
    names = listed([f"{printable(name)} with seed {outcome.seed}" for name, outcome in missing])
    echo_error(
        f"tuisim: this machine could not make {counted(len(missing), 'run')}; the marks do not include: {names}"
    )
    echo_error(
        f"tuisim: {missing[0][1].failure}; the same command with --resume runs what is missing"
    )
    if any(UNJUDGED in outcome.failure for _, outcome in missing) and report_file().exists():
        echo_error(f"tuisim: the report of what went wrong is in {report_file()}")
    return 1


def _tell_unknown(marking: Marking) -> int:
    """Print the goals that could not be judged, and for which students; return 1 if there are some, else 0."""
    unjudged = marking.unjudged
    for goal, reason, names in unjudged:
        echo_error(
            f"tuisim: “{goal}” cannot be judged, so there are no points for {listed(map(printable, names))}:"
        )
        echo_error(f"tuisim: {reason}")
    return 1 if unjudged else 0


def _list_gradebooks(arguments: Arguments) -> dict[str, Path]:
    """Return the files for gradebooks by the kind of gradebook."""
    return {kind: Path(file) for kind in GRADEBOOKS if (file := vars(arguments)[kind])}


def _check(arguments: Arguments, task: GoalsFile) -> None:
    """Check the arguments before the runs, for faults that would otherwise be found only after them.

    Raises:
        ConfigError: an argument is wrong.
        ExportError: a file cannot be written.
    """
    if not arguments.folders:
        raise ConfigError("no folder of programs is named", "tuisim mark GOALS FOLDER…")
    if arguments.input and any(world.answers for world in task.worlds):
        raise ConfigError(
            f"{task.path} has answers", "give --input, or a file with answers", key="--input"
        )
    targets = [Path(target) for target in arguments.export]
    for target in targets:
        if target.suffix.lower() in PAGE_SUFFIXES:
            check_place(target)
        elif target.suffix.lower() in EXPORTERS:
            check_target(target)
        else:
            allowed = f"a file ends in .html, {', '.join(EXPORTERS)}"
            raise ExportError(f"cannot write {target}: unknown format {target.suffix!r}", allowed)
    gradebooks = _list_gradebooks(arguments).values()
    for target in gradebooks:
        check_place(target)
    places = [os.path.realpath(target) for target in (*targets, *gradebooks)]
    if len(set(places)) < len(places):
        raise ConfigError("a file is named twice", "give each export its own file", key="--export")
    for name in ("roster", "goal_columns"):
        if vars(arguments)[name] and not gradebooks:
            raise ConfigError(
                "is for a gradebook",
                "give --moodle FILE or --canvas FILE",
                key=f"--{name.replace('_', '-')}",
            )
    if arguments.movies and not any(target.suffix.lower() in PAGE_SUFFIXES for target in targets):
        raise ConfigError("is for the page of a class", "give --export FILE.html", key="--movies")
    if (
        arguments.feedback
        and os.path.exists(arguments.feedback)
        and not os.path.isdir(arguments.feedback)
    ):
        raise ConfigError(
            f"{arguments.feedback} is not a folder", "give the name of a folder", key="--feedback"
        )


def _write(exports: Iterable[tuple[Path, Callable[[], None]]]) -> int:
    """Write every file, even if another cannot be written; return the highest exit code of the failures, else 0."""
    code = 0
    for target, write in exports:
        tell(f"writing {target}")
        try:
            write()
        except TuisimError as error:
            code = max(code, error.exit_code)
            echo_error(f"tuisim: {' '.join(source_lines(str(error)))}")
        except Exception as error:  # a fault of tuisim in one export must not prevent the others
            code = max(code, 1)
            echo_error(f"tuisim: {target}: {describe_fault(error)}")
            echo_error(f"tuisim: the report is in {report_file()}")
        else:
            echo_written(target)
    return code


_NARROWER = ((40, 60), (24, 20), (16, 10), (12, 6))
"""Characters of the names of students and goals, from wide terminals to narrow ones."""


def _print(sheet: Sheet) -> None:
    columns = shutil.get_terminal_size().columns if sys.stdout.isatty() else 0
    heads, rows = sheet.tabulate()
    text = draw_table(heads, rows)
    if columns and _measure_width(text) > columns:
        for most_name, most_goal in _NARROWER:
            heads, rows = sheet.tabulate(most_name, most_goal)
            text = draw_table(heads[:-1], [row[:-1] for row in rows])
            if _measure_width(text) <= columns:
                break
        reasons = [f"{row[0]}: {row[-1]}" for row in rows if row[-1]]
        text = "\n".join([text, "", *reasons])
    echo_lines(text)
    echo()
    echo_wrapped(sheet.summary)


def _measure_width(text: str) -> int:
    return max(map(len, text.split("\n")))


def _should_isolate(arguments: Arguments) -> bool:
    """Return whether programs run isolated; print a note if they cannot and the user has not required it.

    Raises:
        ConfigError: the user requires isolation, which is impossible, or gives both options.
    """
    if arguments.isolate and arguments.no_isolate:
        raise ConfigError(
            "cannot be combined with --no-isolate",
            "give --isolate or --no-isolate",
            key="--isolate",
        )
    if arguments.no_isolate:
        return False
    try:
        check_isolation()
    except ConfigError as error:
        if arguments.isolate:
            raise
        reason = error.message.removeprefix(f"{error.key}: ")
        echo_error(
            f"note: {reason}: programs can read and change your files ({see_page('security')})"
        )
        return False
    return True
