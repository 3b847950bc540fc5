"""`tuisim mark`: the programs of a class against the goals of a task."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, nullcontext
from functools import partial
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
from tuisim.commands.batch_options import jobs_option, keep_option
from tuisim.commands.echo import (
    Progress,
    echo,
    echo_error,
    echo_lines,
    echo_wrapped,
    echo_written,
    table,
    tell,
)
from tuisim.commands.exit_status import Interrupted, signals_raise
from tuisim.commands.listings import names_of
from tuisim.commands.run_options import input_option, timeout_option
from tuisim.engine.core.values import Whole
from tuisim.engine.runs.child.isolation import MOST_BYTES, check_isolation
from tuisim.engine.runs.child.supervisor import supervised
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.temporary import temporary_home
from tuisim.logs.export import ALLOWED, EXPORTERS, check_place, check_target
from tuisim.settings.command_line import Arguments, WordType, argument, command, option
from tuisim.settings.options import APP, PANEL, parse, settings_of
from tuisim.settings.shared_options import shared_options
from tuisim.tasks.goals.files import GoalsFile, load_goals
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.entries import entries_of
from tuisim.tasks.marks.feedback import write_feedback
from tuisim.tasks.marks.gradebook import Roster, read_roster, write_gradebook
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.journal import Journal, journal_of
from tuisim.tasks.marks.outcome import Outcome, unknown_goals
from tuisim.tasks.marks.overrides import Override, overridden, read_overrides
from tuisim.tasks.marks.page import reports_folder
from tuisim.tasks.marks.runs import (
    STALL_LIMIT_S,
    TIME_LIMIT_S,
    MarkPlan,
    RunEntry,
    outcomes_of,
    runs_of,
)
from tuisim.tasks.marks.sheet import Sheet, columns_of, export_marks, lines_of, sheet_of, summary_of
from tuisim.tasks.marks.students import Student, StudentsFound, find_students
from tuisim.tasks.task import Keep

PAGE_SUFFIXES = (".html", ".htm")
DEFAULT_SEEDS = "0..19"
USUAL_KEEP = Keep.FAILED

_LEFT_OUT = ("seed", "speed", "press")
"""Shared options that marking does not take: each program has several seeds, and runs as fast as possible; a task says
what is pressed in each of its worlds."""
_MEGABYTES = Whole(1, 1 << 20)
_RUNS, _RESULTS = "Runs", "Results"
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
    timeout_option(_RUNS, TIME_LIMIT_S),
    input_option(_RUNS),
    jobs_option(group=_RUNS),
    option(
        "--isolate",
        is_flag=True,
        group=_RUNS,
        help="Refuse to mark where programs cannot be isolated: without network, your files, and much memory.",
    ),
    option(
        "--no-isolate",
        "no_isolate",
        is_flag=True,
        group=_RUNS,
        help="Do not isolate programs; otherwise each runs through bubblewrap, where that starts.",
    ),
    option(
        "--max-mb",
        "max_mb",
        default=MOST_BYTES >> 20,
        metavar="MB",
        type=WordType(lambda word: parse(_MEGABYTES, word, "--max-mb")),
        group=_RUNS,
        help=f"Run no hand-in that is larger ({MOST_BYTES >> 20}).",
    ),
    option(
        "--resume",
        is_flag=True,
        group=_RUNS,
        help="Go on where an earlier marking with these goals ended; run only what is new or has changed.",
    ),
    keep_option(USUAL_KEEP, _RUNS),
    option(
        "--export",
        multiple=True,
        metavar="FILE",
        type=WordType(),
        group=_RESULTS,
        help=f"Write the marks: .html is a page with a report of each stored run, else {ALLOWED}; may be repeated.",
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
        help="Give each goal a column of its own in the gradebook's file.",
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
        help="Give the page's report of each run that missed a goal a movie with the goals on it.",
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
    *(
        one
        for one in shared_options(hidden=(APP, PANEL), names=names_of)
        if one.name not in _LEFT_OUT
    ),
    help="""Mark the programs of a class.

    GOALS is a file with the goals of the task and its world. A FOLDER contains a file NAME.py or a folder for each
    student; a student's folder contains the program main.py, a single program, or the one that GOALS names.

    Programs run in the world of GOALS; if it names none, in that of their first line. A program that hangs, floods or
    crashes affects its own marks only. Where bubblewrap is installed and starts, each program is isolated.

    Exit code: 0 all programs have marks, 1 this machine could not make some runs (--resume makes them), or a goal's
    regular expression took too long, 2 bad input, 130 interrupted (--resume goes on).
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
    task = load_goals(Path(arguments.goals))
    seeds = parse_seeds(arguments.seeds, "--seeds")
    _check(arguments, task)
    with temporary_home("tuisim-hand-ins-") as unpacked:
        found = find_students(
            arguments.folders,
            Path(task.program).name if task.program else "",
            _excluded(arguments, task),
            unpacked.resolve(),
            arguments.max_mb << 20,
        )
        return _mark(task, seeds, found, arguments)


def _mark(
    task: GoalsFile, seeds: tuple[int, ...], found: StudentsFound, arguments: Arguments
) -> int:
    roster, overrides = _tutor_files(found, task, arguments)
    entries, students = entries_of(found.students, task, arguments.settings)
    plan = MarkPlan(
        worlds=task.worlds,
        seeds=seeds,
        options=RunOptions(
            time_limit_s=arguments.timeout, stall_limit_s=STALL_LIMIT_S, answers=arguments.input
        ),
        keep=Keep(arguments.keep or USUAL_KEEP),
        jobs=arguments.jobs,
        isolate=isolates(arguments, "programs can read and change your files", "security"),
        version=__version__,
        arguments=settings_of(task.settings)["arguments"],
    )
    outcomes: dict[str, list[Outcome]] = {student.name: [] for student in students}
    with Progress("marking", in_lines=True):
        try:
            with signals_raise(), nullcontext() if plan.isolate else supervised():
                _collect(entries, plan, journal_of(task.path), outcomes, resumes=arguments.resume)
        except Interrupted as interrupted:
            _tell_so_far(task, plan, students, outcomes)
            return interrupted.exit_code
        sheet = overridden(_sheet(task, plan, students, outcomes), overrides)
        # First, so that marks are seen also if a file cannot be written.
        _print(sheet, found)
        _tell_refusals(students)
        code = _write(_list_exports(sheet, task.worlds, students, found.ignored, roster, arguments))
    return max(code, _tell_unread(students), _tell_missing(outcomes), _tell_unknown(outcomes))


def _tutor_files(
    found: StudentsFound, task: GoalsFile, arguments: Arguments
) -> tuple[Roster, Mapping[str, Override]]:
    """Return the class list and the tutor's overrides; say which submissions are not in the list, and who is absent.

    Raises:
        ConfigError: one of the files is wrong.
    """
    names = [student.name for student in found.students]
    overrides = (
        read_overrides(Path(arguments.overrides), columns_of(task.every_goal), names)
        if arguments.overrides
        else {}
    )
    if not arguments.roster:
        return Roster({}), overrides
    roster = read_roster(Path(arguments.roster))
    if missing := roster.missing(names):
        echo_error(f"note: not in {arguments.roster}: {listed(map(printable, missing))}")
    if absent := roster.absent(names):
        echo_error(
            f"note: in {arguments.roster}, but without a submission: {listed(map(printable, absent))}"
        )
    return roster, overrides


def _tell_so_far(
    task: GoalsFile,
    plan: MarkPlan,
    students: Sequence[Student],
    outcomes: Mapping[str, Sequence[Outcome]],
) -> None:
    """Print the marks of the students whose programs have had all their runs, and what is kept of the others."""
    done = [
        student
        for student in students
        if not student.source
        or len(outcomes[student.name]) == runs_of(outcomes[student.name], plan)
    ]
    if done:
        _print(_sheet(task, plan, done, outcomes))
    echo_error(
        f"tuisim: interrupted with {len(done)} of {counted(len(students), 'student')} marked, nothing exported;"
    )
    kept = counted(sum(map(len, outcomes.values())), "run")
    echo_error(f"tuisim: {kept} kept: the same command with --resume goes on")


def _sheet(
    task: GoalsFile,
    plan: MarkPlan,
    students: Sequence[Student],
    outcomes: Mapping[str, Sequence[Outcome]],
) -> Sheet:
    worlds = [world.where for world in plan.worlds]
    return sheet_of(task.title, columns_of(task.every_goal), plan.seeds, students, outcomes, worlds)


def _tell_unread(students: Sequence[Student]) -> int:
    """Tell whose programs this machine could not read; return the exit code."""
    unread = [student for student in students if student.is_unread]
    for student in unread:
        echo_error(f"tuisim: the marks are without {printable(student.name)}: {student.problem}")
    return 1 if unread else 0


def _tell_refusals(students: Sequence[Student]) -> None:
    """Tell whose programs would not start on a brick."""
    for student in students:
        if student.refusal:
            echo_error(f"note: {printable(f'{student.name}: {student.refusal}')}")


def _tell_missing(outcomes: Mapping[str, Sequence[Outcome]]) -> int:
    """Tell which runs are missing in the marks; return the exit code."""
    missing = [(name, one) for name, every in outcomes.items() for one in every if not one.counts]
    if not missing:
        return 0
    names = listed([f"{printable(name)} with seed {one.seed}" for name, one in missing])
    echo_error(
        f"tuisim: this machine could not make {counted(len(missing), 'run')}; the marks are without: {names}"
    )
    echo_error(
        f"tuisim: {missing[0][1].failure}; the same command with --resume runs what is missing"
    )
    if any(UNJUDGED in one.failure for _, one in missing) and report_file().exists():
        echo_error(f"tuisim: the report of what went wrong is in {report_file()}")
    return 1


def _tell_unknown(outcomes: Mapping[str, Sequence[Outcome]]) -> int:
    """Tell which goals could not be judged; return the exit code."""
    by_student = {name: unknown_goals(every) for name, every in outcomes.items()}
    found = {goal: reason for unknown in by_student.values() for goal, reason in unknown.items()}
    for goal in sorted(found):
        by = [name for name, unknown in by_student.items() if goal in unknown]
        echo_error(
            f"tuisim: “{goal}” cannot be judged, so that there are no points for {listed(map(printable, by))}:"
        )
        echo_error(f"tuisim: {found[goal]}")
    return 1 if found else 0


def _check(arguments: Arguments, task: GoalsFile) -> None:
    """Raise ConfigError or ExportError if something is wrong that would only be noticed after the runs."""
    if not arguments.folders:
        raise ConfigError("no folder of programs is named", "tuisim mark GOALS FOLDER…")
    if arguments.input and any(world.answers for world in task.worlds):
        raise ConfigError(f"{task.path} has answers", "give only one of them", key="--input")
    targets = [Path(target) for target in arguments.export]
    for target in targets:
        if target.suffix.lower() in PAGE_SUFFIXES:
            check_place(target)
        elif target.suffix.lower() in EXPORTERS:
            check_target(target)
        else:
            allowed = f"a file ends in .html, {ALLOWED}"
            raise ExportError(f"cannot write {target}: unknown format {target.suffix!r}", allowed)
    gradebooks = [Path(target) for kind in GradebookKind if (target := vars(arguments)[kind])]
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
        raise ConfigError(f"{arguments.feedback} is no folder", "name a folder", key="--feedback")


def _excluded(arguments: Arguments, task: GoalsFile) -> frozenset[Path]:
    """Return what may lie among the students' files without being one: the goals, and results."""
    found = [task.path]
    for name in (*GradebookKind, "roster", "overrides"):
        found += [Path(vars(arguments)[name])] if vars(arguments)[name] else []
    for target in map(Path, arguments.export):
        found += [target, target.with_name(target.name + ".json"), reports_folder(target)]
    if arguments.feedback:
        found.append(Path(arguments.feedback))
    return frozenset(Path(os.path.realpath(path)) for path in found)


def _collect(
    entries: Sequence[RunEntry],
    plan: MarkPlan,
    journal: Path,
    outcomes: dict[str, list[Outcome]],
    *,
    resumes: bool,
) -> None:
    """Run what is to be run; add the outcomes by name of student as they become known."""
    wanted = {entry.student.name: runs_of((), plan) for entry in entries}
    with (
        Journal(journal, resumes=resumes) as known,
        closing(outcomes_of(entries, plan, known)) as found,
    ):
        for done, (name, outcome) in enumerate(found, start=1):
            outcomes[name].append(outcome)
            wanted[name] = runs_of(outcomes[name], plan)
            total = sum(wanted.values())
            tell(f"run {done} of {total}", done, total)


def _list_exports(
    sheet: Sheet,
    worlds: Sequence[TrialWorld],
    students: Sequence[Student],
    ignored: Sequence[str],
    roster: Roster,
    arguments: Arguments,
) -> Iterator[tuple[Path, Callable[[], None]]]:
    """Yield what is to be written: each file or folder, and what writes it."""
    for target in map(Path, arguments.export):
        if target.suffix.lower() in EXPORTERS:
            yield target, partial(export_marks, sheet, target)
        else:
            page = partial(_write_page, sheet, worlds, students, ignored, target)
            yield target, partial(page, movies=arguments.movies)
    sources = [student.text for student in students]
    if arguments.feedback:
        folder = Path(arguments.feedback)
        yield folder, partial(write_feedback, folder, sheet, sources)
    for kind in GradebookKind:
        if name := vars(arguments)[kind]:
            book = partial(write_gradebook, Path(name), kind, sheet, sources, roster)
            yield Path(name), partial(book, goals=arguments.goal_columns)


def _write(exports: Iterable[tuple[Path, Callable[[], None]]]) -> int:
    """Write everything that can be written; return the exit code."""
    code = 0
    for target, write in exports:
        tell(f"writing {target}")
        try:
            write()
        except TuisimError as error:
            code = max(code, error.exit_code)
            echo_error(f"tuisim: {' '.join(source_lines(str(error)))}")
        except Exception as error:  # Whatever it is, the other files are written.
            code = max(code, 1)
            echo_error(f"tuisim: {target}: {describe_fault(error)}")
            echo_error(f"tuisim: the report is in {report_file()}")
        else:
            echo_written(target)
    return code


def _write_page(
    sheet: Sheet,
    worlds: Sequence[TrialWorld],
    students: Sequence[Student],
    ignored: Sequence[str],
    target: Path,
    *,
    movies: bool,
) -> None:
    # Its charts are slow to import, and a table needs none.
    from tuisim.tasks.marks.class_page import write_class_page

    write_class_page(sheet, worlds, students, ignored, target, tell, movies=movies)


_NARROWER = ((40, 60), (24, 20), (16, 10), (12, 6))
"""Characters of the names of students and goals, from wide terminals to narrow ones."""


def _print(sheet: Sheet, found: StudentsFound | None = None) -> None:
    columns = shutil.get_terminal_size().columns if sys.stdout.isatty() else 0
    heads, rows = lines_of(sheet)
    text = table(heads, rows)
    if columns and _width(text) > columns:
        for most_name, most_goal in _NARROWER:
            heads, rows = lines_of(sheet, most_name, most_goal)
            text = table(heads[:-1], [row[:-1] for row in rows])
            if _width(text) <= columns:
                break
        reasons = [f"{row[0]}: {row[-1]}" for row in rows if row[-1]]
        text = "\n".join([text, "", *reasons])
    echo_lines(text)
    echo()
    echo_wrapped(summary_of(sheet))
    if found and found.ignored:
        names = listed(found.ignored)
        echo_error(f"note: not marked, because they are no Python programs: {names}")
    if found and found.left_out:
        echo_error(f"note: left out, because nobody hands them in: {listed(found.left_out)}")


def _width(text: str) -> int:
    return max(map(len, text.split("\n")))


def isolates(arguments: Arguments, danger: str, page: str) -> bool:
    """Return whether programs are isolated; say so if they are not, and nobody has asked for that.

    Args:
        arguments: Those of the command, with `isolate` and `no_isolate`.
        danger: What programs can do that are not isolated.
        page: The page of the guide that tells more.

    Raises:
        ConfigError: they cannot be isolated, and must be; or the options contradict each other.
    """
    if arguments.isolate and arguments.no_isolate:
        raise ConfigError(
            "is given together with --no-isolate", "give only one of them", key="--isolate"
        )
    if arguments.no_isolate:
        return False
    try:
        check_isolation()
    except ConfigError as error:
        if arguments.isolate:
            raise
        reason = error.message.removeprefix(f"{error.key}: ")
        echo_error(f"note: {reason}: {danger} ({see_page(page)})")
        return False
    return True
