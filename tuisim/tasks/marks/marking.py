"""The marking of a class: what was handed in, its runs, the marks, and the files that are written."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, nullcontext
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, counted
from tuisim.engine import files
from tuisim.engine.runs.child.isolation import MOST_BYTES
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.logs.export import EXPORTERS
from tuisim.settings.options import Settings
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.judgement import sum_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.marks.entries import build_entries
from tuisim.tasks.marks.feedback import write_feedback
from tuisim.tasks.marks.gradebook import Roster, read_roster, write_gradebook
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.journal import Journal, build_journal_path
from tuisim.tasks.marks.outcome import Outcome, find_unknown_goals
from tuisim.tasks.marks.page import build_reports_folder
from tuisim.tasks.marks.runs import STALL_LIMIT_S, MarkPlan, RunEntry, count_runs, run_entries
from tuisim.tasks.marks.sheet import (
    Sheet,
    SheetRow,
    build_sheet,
    export_marks,
    list_columns,
    round_points,
)
from tuisim.tasks.marks.students import Student, find_students
from tuisim.tasks.marks.supervisor import keep_running
from tuisim.tasks.task import TIME_LIMIT_S, Keep

# ```toml
# [ada]
# comment = "The path is right; the robot was set down a centimetre too far."
# points = 9          # of the whole task; or, goal by goal:
#
# [ben.goals]
# heading = 1
# ```

TUTOR_REASON = "given by the tutor"


@dataclass(frozen=True, slots=True)
class Override:
    """A tutor's changes to the marks of one student."""

    points: float | None = None
    """Points of the whole task; None if they follow from the goals."""
    comment: str = ""
    goals: Mapping[str, float] = field(default_factory=dict)
    """Points by the name of the goal."""


def read_overrides(
    path: Path, goals: Sequence[Goal], students: Sequence[str]
) -> Mapping[str, Override]:
    """Read the file with a tutor's overrides; return them by the student's name.

    Args:
        path: The file.
        goals: The goals that the sheet shows.
        students: The names of the students.

    Raises:
        ConfigError: the file cannot be read, or names a student, a goal or a key that does not exist.
    """
    location = files.Location(str(path))
    overrides: dict[str, Override] = {}
    for student, entry in files.table(
        files.read_file(path, ConfigError), location, students
    ).items():
        overrides[student] = files.convert(entry, Override, location.at(student))
        files.table(
            dict(overrides[student].goals),
            location.at(student).at("goals"),
            [goal.name for goal in goals],
        )
    return overrides


def apply_overrides(sheet: Sheet, overrides: Mapping[str, Override]) -> Sheet:
    """Return the sheet with a tutor's overrides; the points of the runs are still in `earned`."""
    rows = tuple(
        _override_row(row, sheet.columns, overrides[row.name]) if row.name in overrides else row
        for row in sheet.rows
    )
    return replace(sheet, rows=rows)


def _override_row(row: SheetRow, columns: Sequence[Goal], override: Override) -> SheetRow:
    cells = tuple(
        replace(cell, points=override.goals[column.name], reason=TUTOR_REASON)
        if column.name in override.goals
        else cell
        for column, cell in zip(columns, row.cells, strict=True)
    )
    points = override.points
    if points is None:
        points = (
            round_points(sum_points(cell.points for cell in cells))
            if override.goals
            else row.points
        )
    earned = row.points if points != row.points or cells != row.cells else None
    return replace(row, cells=cells, points=points, earned=earned, comment=override.comment)


Tell = Callable[[str, float, float], None]
"""Receives the progress: words, how much is done, and how much there is."""
GRADEBOOKS: Sequence[str] = [*GradebookKind]
"""Kinds of gradebooks, as options are called."""


@dataclass(frozen=True, slots=True)
class MarkRequest:
    """A request to mark a class: which programs, how they run, and which files to write."""

    task: GoalsFile
    folders: Sequence[str]
    """Folders and files of students' programs."""
    seeds: tuple[int, ...]
    version: str
    """Version of tuisim: an interrupted marking is resumed only with the same."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Settings that override those of the task, by path."""
    time_limit_s: float = TIME_LIMIT_S
    answers: tuple[str, ...] = ()
    """Answers to `input()`; without them, a program gets those of its world."""
    keep: Keep = Keep.FAILED
    jobs: int = 0
    """Number of workers; 0 is one for each processor."""
    max_bytes: int = MOST_BYTES
    """A larger hand-in is not run."""
    resumes: bool = False
    """Whether an earlier marking goes on."""
    roster: Path | None = None
    overrides: Path | None = None
    exports: tuple[Path, ...] = ()
    """Tables, by their suffix, and pages."""
    gradebooks: Mapping[str, Path] = field(default_factory=dict)
    """By the value of `GradebookKind`."""
    goal_columns: bool = False
    """Whether gradebooks have a column for each goal."""
    movies: bool = False
    """Whether reports of runs that missed a goal have movies."""
    feedback: Path | None = None
    """A folder for what is told to each student."""

    def list_own_files(self) -> frozenset[Path]:
        """Return the resolved paths of the marking's own files, such as goals and results.

        They may be in the folder of the students' files, and must not be taken for a student's.
        """
        files = [self.task.path, self.roster, self.overrides, self.feedback]
        files += self.gradebooks.values()
        for target in self.exports:
            files += [target, target.with_name(target.name + ".json"), build_reports_folder(target)]
        return frozenset(Path(os.path.realpath(path)) for path in files if path)

    @contextmanager
    def open_marking(self) -> Iterator[Marking]:
        """Yield a marking in a `with` block, after which the folder with the unpacked hand-ins is removed.

        Raises:
            ConfigError: a folder, the class list or the overrides are wrong.
        """
        with create_temporary_home("tuisim-hand-ins-") as unpacked:
            yield Marking(self, unpacked.resolve())


class Marking:
    """The marking of a class: call `read_programs`, then `run`, then `build_sheet` and `list_exports`.

    Attributes:
        students: In the order of the sheet; problems of their programs are known after `read_programs`.
        ignored: Names of files that are no programs.
        left_out: Names of files and folders that no student has handed in, such as `__MACOSX`.
        unlisted: Names of students who are not in the class list.
        absent: Names in the class list without a submission.
        outcomes: The outcomes of the runs so far, by the name of the student.
    """

    def __init__(self, request: MarkRequest, unpacked: Path) -> None:
        self._request = request
        task = request.task
        submissions = find_students(
            request.folders,
            Path(task.program).name if task.program else "",
            request.list_own_files(),
            unpacked,
            request.max_bytes,
        )
        names = [student.name for student in submissions.students]
        self.students: Sequence[Student] = submissions.students
        self.ignored = submissions.ignored
        self.left_out = submissions.left_out
        self.outcomes: dict[str, list[Outcome]] = {name: [] for name in names}
        self._columns = list_columns(task.every_goal)
        self._overrides = (
            read_overrides(request.overrides, self._columns, names) if request.overrides else {}
        )
        self._roster = read_roster(request.roster) if request.roster else Roster({})
        self.unlisted = self._roster.missing(names) if request.roster else []
        self.absent = self._roster.absent(names)
        self._entries: Sequence[RunEntry] = ()
        self._plan = MarkPlan(
            worlds=task.worlds,
            seeds=request.seeds,
            options=RunOptions(
                time_limit_s=request.time_limit_s,
                stall_limit_s=STALL_LIMIT_S,
                answers=request.answers,
            ),
            keep=request.keep,
            jobs=request.jobs,
            version=request.version,
            arguments=Settings.merge(task.settings)["arguments"],
        )

    def read_programs(self) -> None:
        """Read the students' programs, and check the world in which each runs.

        Raises:
            ConfigError: the task's world, or a setting, is wrong, or the profile fits none of the programs.
        """
        self._entries, self.students = build_entries(
            self.students, self._request.task, self._request.settings
        )

    def run(self, tell: Tell, *, isolate: bool) -> None:
        """Run all programs, except runs whose outcomes are in the journal; blocks until all outcomes are known.

        Args:
            tell: Called with the progress: words, the number of finished runs, and the number of all runs.
            isolate: Whether programs run isolated from this machine.

        Raises:
            LogError: the journal cannot be read or written.
        """
        plan = replace(self._plan, isolate=isolate)
        counts = {entry.student.name: count_runs((), plan) for entry in self._entries}
        with (
            nullcontext() if isolate else keep_running(),
            Journal(
                build_journal_path(self._request.task.path), resumes=self._request.resumes
            ) as known,
            closing(run_entries(self._entries, plan, known)) as outcomes,
        ):
            for done, (name, outcome) in enumerate(outcomes, start=1):
                self.outcomes[name].append(outcome)
                counts[name] = count_runs(self.outcomes[name], plan)
                total = sum(counts.values())
                tell(f"run {done} of {total}", done, total)

    @property
    def size_words(self) -> str:
        """How many runs the marking has at most, such as `40 runs: 2 programs × 20 seeds`."""
        entries, seeds, worlds = len(self._entries), len(self._plan.seeds), len(self._plan.worlds)
        words = f"{counted(entries, 'program')} × {counted(seeds, 'seed')}"
        words += f" × {worlds} worlds" if worlds > 1 else ""
        return f"{counted(entries * seeds * worlds, 'run')}: {words}"

    @property
    def missing(self) -> list[tuple[str, Outcome]]:
        """The runs that did not take place because of this machine, each with the name of its student."""
        return [
            (name, outcome)
            for name, outcomes in self.outcomes.items()
            for outcome in outcomes
            if not outcome.counts
        ]

    @property
    def unjudged(self) -> list[tuple[str, str, list[str]]]:
        """The goals that could not be judged, each with the reason and the names of the students."""
        reasons: dict[str, str] = {}
        names = defaultdict(list)
        for name, outcomes in self.outcomes.items():
            unknown = find_unknown_goals(outcomes)
            reasons |= unknown
            for goal in unknown:
                names[goal].append(name)
        return [(goal, reasons[goal], names[goal]) for goal in sorted(reasons)]

    def build_sheet(self) -> Sheet:
        """Return the marks of the class, changed by the tutor's overrides."""
        return apply_overrides(self._build_sheet(self.students), self._overrides)

    def build_sheet_so_far(self) -> Sheet:
        """Return the marks of the students whose programs have finished all their runs."""
        return self._build_sheet(
            [
                student
                for student in self.students
                if not student.source
                or len(outcomes := self.outcomes[student.name]) == count_runs(outcomes, self._plan)
            ]
        )

    def _build_sheet(self, students: Sequence[Student]) -> Sheet:
        worlds = [world.where for world in self._plan.worlds]
        return build_sheet(
            self._request.task.title,
            self._columns,
            self._plan.seeds,
            students,
            self.outcomes,
            worlds,
        )

    def list_exports(self, sheet: Sheet, tell: Tell) -> Iterator[tuple[Path, Callable[[], None]]]:
        """Yield the path of each file or folder to write, and a function that writes it and may raise ExportError.

        Args:
            sheet: The marks.
            tell: Called with the progress: words, the number of written reports, and the number of all reports.
        """
        request = self._request
        sources = [student.text for student in self.students]
        if request.exports or request.feedback or request.gradebooks:
            # Imported on demand: a marking that writes no files needs no reasons.
            from tuisim.tasks.marks.diagnosis import add_diagnoses

            sheet = add_diagnoses(sheet)
        for target in request.exports:
            if target.suffix.lower() in EXPORTERS:
                yield target, partial(export_marks, sheet, target)
            else:
                yield target, partial(self._write_page, sheet, target, tell)
        if request.feedback:
            yield request.feedback, partial(write_feedback, request.feedback, sheet, sources)
        for kind, target in request.gradebooks.items():
            book = partial(
                write_gradebook, target, GradebookKind(kind), sheet, sources, self._roster
            )
            yield target, partial(book, goals=request.goal_columns)

    def _write_page(self, sheet: Sheet, target: Path, tell: Tell) -> None:
        # Imported on demand: the charts of the page are slow to import, and a marking without a page needs none.
        from tuisim.tasks.marks.reports import write_class_page

        worlds = self._plan.worlds
        movies = self._request.movies
        write_class_page(sheet, worlds, self.students, self.ignored, target, tell, movies=movies)
