"""The reports of kept runs, beside the page of a class; each has the goals, and where on the mat they were decided."""

from __future__ import annotations

import hashlib
import math
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.analysis.pins import Pin
from tuisim.analysis.report import build_report
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ExportError, LogError, counted
from tuisim.base.faults import describe_fault
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.logs.reader import build_log
from tuisim.pictures.charts.files import write_whole
from tuisim.pictures.html.render import Table
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.class_map import Miss, build_class_maps
from tuisim.tasks.marks.copies import find_similar
from tuisim.tasks.marks.feedback import build_file_stems
from tuisim.tasks.marks.outcome import GoalOutcome, Outcome, make_portable
from tuisim.tasks.marks.page import build_page, build_reports_folder
from tuisim.tasks.marks.sheet import Sheet
from tuisim.tasks.marks.students import Student
from tuisim.tasks.marks.workspace import read_modules

MAX_OUTPUT_BYTES = 4 << 20
"""Runs that printed more get no report: a browser could hardly show it."""
_HEADS = ("", "goal", "result", "why", "points")


@dataclass(frozen=True, slots=True)
class Report:
    """The report of a kept run, as an HTML file."""

    student: str
    world: str
    """See `TrialWorld.where`."""
    seed: int
    path: str
    """The path of the report, relative to the page of the class."""
    run: StoredRun
    misses: tuple[Miss, ...]
    """Where the run missed goals; none if another run with the same record has listed them."""
    fault: str = ""
    """Why the report could not be made; empty if it was made."""


def write_reports(
    sheet: Sheet, worlds: Sequence[TrialWorld], page: Path, *, movies: bool = False
) -> Iterator[Report]:
    """Write the reports of kept runs; yield each once it is written.

    Runs of a student with equal recordings share one report. Runs that were removed from the store, or whose recording
    is damaged, are left out. Reports of an earlier page of this name are replaced. If a report cannot be made, its
    `fault` says why.

    Args:
        sheet: The marks of the class.
        worlds: The worlds of the task, the first one first.
        page: The page that links to the reports.
        movies: Whether the report of a run that missed a goal has a movie with the goals on it.

    Raises:
        ExportError: a report cannot be written.
    """
    folder = build_reports_folder(page)
    store = RunStore()
    shutil.rmtree(folder, ignore_errors=True)
    for stem, row in zip(
        build_file_stems(student_row.name for student_row in sheet.rows), sheet.rows, strict=True
    ):
        written: dict[tuple[str, str], str] = {}
        for outcome in row.outcomes:
            run = _load_stored(store, outcome.run_id) if outcome.run_id else None
            if run is None:
                continue
            number, world = next(
                (index, student_row)
                for index, student_row in enumerate(worlds)
                if student_row.where == outcome.world
            )
            name = f"{stem}{f'-world-{number + 1}' if number else ''}-seed-{outcome.seed}.html"
            misses = tuple[Miss, ...]()
            fault = ""
            try:
                recorded = outcome.world, _compute_digest(run)
                if recorded not in written:
                    columns = [column for column in sheet.columns if column.name in world.goals]
                    misses = _find_misses(row.name, columns, outcome, run)
                    shows = movies and bool(misses)
                    report = _build_report(row.name, columns, outcome, run, movie=shows)
                    _write(folder / name, report)
                    written[recorded] = f"{folder.name}/{name}"
                path = written[recorded]
            except ExportError:
                raise
            except LogError:
                # The program has damaged its recording, which is no failure of the marking.
                continue
            except Exception as error:  # Any error concerns this report only.
                path = ""
                fault = describe_fault(error)
            yield Report(row.name, outcome.world, outcome.seed, path, run, misses, fault)


def _build_report(
    student: str, columns: Sequence[Goal], outcome: Outcome, run: StoredRun, *, movie: bool
) -> str:
    opened = OpenedLog(LogRequest(runs=(run.id,)), build_log((run,)), (_make_portable(run),))
    goals, pins = _list_verdicts(columns, outcome)
    title = ", ".join(filter(None, (student, outcome.world, f"seed {outcome.seed}")))
    return build_report(opened, title=title, movie=movie, pins=pins, goals=goals)


def _write(path: Path, content: str) -> None:
    try:
        os.makedirs(path.parent, exist_ok=True)
    except OSError as error:
        raise ExportError(f"cannot write to {path.parent}: {error.strerror or error}") from error
    write_whole(path, content.encode())


def _load_stored(store: RunStore, run_id: str) -> StoredRun | None:
    """Return the stored run with an id; None if it no longer exists, or is too large for a report."""
    try:
        run = store.load_run(run_id)
        return run if run.output.length <= MAX_OUTPUT_BYTES else None
    except LogError:
        return None


def _make_portable(run: StoredRun) -> StoredRun:
    """Return a run whose error and summary are the same texts on every machine, see `make_portable`."""
    if run.end is None:
        return run
    folder = run.program.working_directory
    end = replace(
        run.end,
        error=make_portable(run.end.error, folder),
        summary=make_portable(run.end.summary, folder),
    )
    return replace(run, end=end)


def _compute_digest(run: StoredRun) -> str:
    """Return a hash of a run's recording, hexadecimal."""
    digest = hashlib.sha256(run.telemetry.array().tobytes())
    folder = run.program.working_directory.encode("utf-8", "surrogateescape")
    for row in run.output.rows():
        text = row.text.encode().replace(folder, b"")
        digest.update(b"%d %d " % (row.stream, len(text)) + text)
    return digest.hexdigest()


def _find_misses(
    student: str, columns: Sequence[Goal], outcome: Outcome, run: StoredRun
) -> tuple[Miss, ...]:
    """Return the goals that a run missed, each with the place where it was decided, or else the robot's last position.

    Args:
        student: The student's name.
        columns: The goals that are shown.
        outcome: The outcome of the run.
        run: The run.
    """
    last = run.telemetry.last()
    missed = {goal.name: goal for goal in outcome.goals if not goal.is_good}
    misses = []
    for column in columns:
        goal = missed.get(column.name)
        if goal is not None and (place := goal.event or last) is not None:
            misses.append(Miss(student, goal.name, place.x_mm, place.y_mm, goal.reason))
    return tuple(misses)


def _list_verdicts(columns: Sequence[Goal], outcome: Outcome) -> tuple[Table, list[Pin]]:
    """Return the table of the goals of a run, and a pin on the mat for each goal that was decided at a place.

    Args:
        columns: The goals that are shown, in their order.
        outcome: The outcome of the run.
    """
    goals = {goal_outcome.name: goal_outcome for goal_outcome in outcome.goals}
    rows = []
    pins = []
    for number, column in enumerate(columns, start=1):
        goal = goals.get(column.name, GoalOutcome(column.name, False, outcome.failure))
        result, earned = "missed", 0.0
        if goal.is_unknown:
            result, earned = "could not be judged", math.nan
        elif goal.met:
            result, earned = "met", column.points
        why = f"{goal.reason} (line {goal.line})" if goal.line else goal.reason
        points = f"{format_points(earned)} of {format_points(max(0, column.points))}"
        if (event := goal.event) is not None:
            result += f" at {event.time_s:.2f} s, x {event.x_mm:.0f}, y {event.y_mm:.0f} mm"
            verdict = f"{number}. {column.say} {result}"
            pins.append(
                Pin(
                    str(number),
                    event.x_mm,
                    event.y_mm,
                    goal.is_good,
                    f"{verdict}: {why}" if why else verdict,
                )
            )
        rows.append([str(number), column.say, result, why, points])
    return Table(_HEADS, rows, numbers=len(_HEADS) - 1), pins


def write_class_page(
    sheet: Sheet,
    worlds: Sequence[TrialWorld],
    students: Sequence[Student],
    ignored: Sequence[str],
    target: Path,
    tell: Callable[[str, float, float], None],
    *,
    movies: bool,
) -> None:
    """Write the page of a class, and the reports of its runs into a folder beside it.

    Args:
        sheet: The marks.
        worlds: The worlds of the task.
        students: The students whose programs are compared with each other.
        ignored: Names of files that are no programs.
        target: The page.
        tell: Called with the progress: words, the number of written reports, and the number of all reports.
        movies: Whether reports of runs that missed a goal have movies.

    Raises:
        ExportError: the page cannot be written; or it was written, but some reports were not.
    """
    run_count = sum(bool(outcome.run_id) for row in sheet.rows for outcome in row.outcomes)
    links = {}
    misses = []
    faults = []
    for report in write_reports(sheet, worlds, target, movies=movies):
        if report.fault:
            faults.append(f"{report.student}: {report.fault}")
            continue
        links[report.student, report.world, report.seed] = report.path
        misses.append((report.run, report.misses))
        tell(f"report {len(links)} of {run_count}", len(links), run_count)
    alike = find_similar({student.name: read_modules(student) for student in students})
    write_whole(target, build_page(sheet, links, ignored, alike, build_class_maps(misses)).encode())
    if faults:
        raise ExportError(f"{target} is without {counted(len(faults), 'report')}: {faults[0]}")
