"""The sheet of a class: one row a student, with points, robustness and the reason of failure.

It becomes a text table, or a data frame for CSV, Parquet, JSONL and Arrow files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted, printable, shortened
from tuisim.base.faults import UNJUDGED
from tuisim.base.source import source_lines
from tuisim.logs.export import export_frame
from tuisim.tasks.goals.judgement import GOAL, compute_max_points, format_points, sum_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.outcome import Outcome, merge_worlds
from tuisim.tasks.marks.students import Student

if TYPE_CHECKING:
    import pandas as pd

NOT_RUN = "not run"
DIGITS = 4
"""Points and shares are rounded to so many decimals: sums of floats are not exact."""
MARKS_FORMAT = 1


@dataclass(frozen=True, slots=True)
class Cell:
    """The result of one student for one goal."""

    points: float
    """Mean over the runs; NaN if one could not be judged."""
    met: int
    """Number of runs that met the goal; if the goal takes points off, these are the runs with the fault."""
    reason: str = ""
    """Why the first run that missed the goal missed it; empty if each run met it."""
    line: int = 0
    """The program's line that the reason is about; 0 if there is none."""
    seed: int = 0
    """The seed of that run."""
    hidden: bool = False
    """Whether that was only in hidden worlds."""


@dataclass(frozen=True, slots=True)
class SheetRow:
    """The marks of one student: points in total and for each goal, and why runs failed."""

    name: str
    program: str
    """Name of the main program; empty if there is none."""
    points: float
    """Mean over the runs, NaN if one could not be judged; unless the tutor has set others."""
    robustness: float
    """Share of the runs with all points, 0 to 1; in a task without points, of those that met every goal."""
    cells: tuple[Cell, ...]
    """In the order of the columns."""
    reason: str = ""
    """Why the first run without all points failed; empty if each has them."""
    line: int = 0
    """The program's line that the reason is about; 0 if there is none."""
    source_line: str = ""
    """The text of that line."""
    seed: int = 0
    """The seed of that run."""
    failure: str = ""
    """Why the program of that run did not finish, or could not be run; empty if it finished."""
    hidden: bool = False
    """Whether that was only in a hidden world."""
    error: str = ""
    """The traceback of that run; empty if it has none."""
    diagnosis: str = ""
    """The first reason why that run went wrong, see `find_diagnosis`; empty if none was looked for or found."""
    runs: int = 0
    stopped_early: bool = False
    """Whether further seeds were left out, because the program hung, flooded or died."""
    refusal: str = ""
    """The first line of the program that the brick's Python would refuse, and how many follow; empty for none."""
    outcomes: tuple[Outcome, ...] = ()
    earned: float | None = None
    """The points that the runs have earned, if the tutor has set others."""
    comment: str = ""
    """The comment that the tutor has written for the student."""
    ids: Mapping[GradebookKind, str] = field(default_factory=dict)
    """How a gradebook names the student; see `Student.ids`."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """The marks of a class for one task: the goals that are shown, the seeds, and a row for each student."""

    title: str
    columns: tuple[Goal, ...]
    """The goals that are shown."""
    rows: tuple[SheetRow, ...]
    seeds: tuple[int, ...]

    @property
    def most_points(self) -> float:
        """The points of a program that meets every goal with positive points and no other."""
        return round_points(compute_max_points(self.columns))

    @property
    def summary(self) -> str:
        """One sentence about the marks of the class."""
        full = sum(row.robustness == 1 for row in self.rows)
        known = [row.points for row in self.rows if not math.isnan(row.points)]
        mean = math.fsum(known) / len(known) if known else 0.0
        size = f"{counted(len(self.rows), 'student')}, {counted(len(self.seeds), 'seed')}"
        points = f"mean {format_points(mean)} of {format_points(self.most_points)} points"
        return f"{size}: {points}; {full} with all points" + (
            " for every seed" if len(self.seeds) > 1 else ""
        )

    def tabulate(self, max_name: int = 40, max_goal: int = 60) -> tuple[list[str], list[list[str]]]:
        """Return the sheet as texts: the list of headings, and the rows; the last column is the reason.

        Args:
            max_name, max_goal: Maximum characters of the names of students and of goals; of a longer name, the middle
                is left out.
        """
        goals = [_cut_middle(column.name, max_goal) for column in self.columns]
        heads = ["student", "points", "robustness", *goals, "reason"]
        rows = []
        for row in self.rows:
            points = (
                format_points(row.points),
                f"{row.robustness:.0%}",
                *(format_points(cell.points) for cell in row.cells),
            )
            where = (
                f"line {row.line}: " if row.line and f"line {row.line}" not in row.reason else ""
            )
            rows.append([_cut_middle(row.name, max_name), *points, f"{where}{row.reason}"])
        return heads, rows

    def build_frame(self) -> pd.DataFrame:
        """Return the sheet as a pandas frame: one row a student, with the mean points for each goal as `goal_NAME`."""
        import pandas as pd

        rows = self.rows
        columns: dict[str, list[Any]] = {
            "student": [row.name for row in rows],
            "program": [row.program for row in rows],
            "points": [row.points for row in rows],
            "robustness": [row.robustness for row in rows],
            "runs": [row.runs for row in rows],
        }
        for index, column in enumerate(self.columns):
            columns[f"{GOAL}{column.name}"] = [row.cells[index].points for row in rows]
        columns |= {
            "reason": [row.reason for row in rows],
            "line": [row.line for row in rows],
            "source_line": [row.source_line for row in rows],
            "seed": [row.seed for row in rows],
            "earned": [row.points if row.earned is None else row.earned for row in rows],
            "comment": [row.comment for row in rows],
        }
        return pd.DataFrame(columns)


def list_columns(goals: Sequence[Goal]) -> list[Goal]:
    """Return the goals that a sheet shows: those with points or with a sentence (`say`).

    The other goals of a task are not shown, as they only serve as conditions of these.
    """
    return [replace(goal, say=goal.say or goal.name) for goal in goals if goal.points or goal.say]


def build_sheet(
    title: str,
    columns: Sequence[Goal],
    seeds: Sequence[int],
    students: Sequence[Student],
    outcomes: Mapping[str, Sequence[Outcome]],
    worlds: Sequence[str] = ("",),
) -> Sheet:
    """Return the sheet of a class.

    Args:
        title: The title of the task.
        columns: The goals that are shown.
        seeds: The seeds of the runs.
        students: The students, in the order of the rows.
        outcomes: The outcomes of the runs so far, by the name of the student, in any order.
        worlds: The worlds of the task, see `TrialWorld.where`, the first one first.
    """
    rows = tuple(
        build_row(student, columns, outcomes.get(student.name, ()), seeds, worlds)
        for student in students
    )
    return Sheet(title, tuple(columns), rows, tuple(seeds))


def _quote_line(text: str, number: int) -> str:
    """Return a line of a program for a cell of the sheet; empty if the program has no line of this number."""
    lines = source_lines(text)
    return shortened(printable(lines[number - 1].strip())) if 0 < number <= len(lines) else ""


def build_row(
    student: Student,
    columns: Sequence[Goal],
    outcomes: Sequence[Outcome],
    seeds: Sequence[int],
    worlds: Sequence[str],
) -> SheetRow:
    """Return the row of a student for the sheet.

    Args:
        student: The student.
        columns: The goals that are shown.
        outcomes: The outcomes of the student's runs so far, in any order.
        seeds: The seeds of the runs.
        worlds: The worlds of the task, the first one first.
    """
    ordered = merge_worlds(outcomes, seeds, worlds)
    if not student.source or not ordered:
        return _build_empty_row(student, columns, outcomes)
    totals = [_compute_points(columns, outcome) for outcome in ordered]
    # In a task without points, all goals are counted.
    counted_goals = [column for column in columns if column.points] or columns
    incomplete = [outcome for outcome in ordered if _has_missed(outcome, counted_goals)]
    failed = incomplete[0] if incomplete else None
    reason, line = _find_reason(failed, counted_goals) if failed else ("", 0)
    return SheetRow(
        name=student.name,
        program=student.shown_main,
        points=round_points(math.fsum(totals) / len(totals)),
        robustness=round_points(1 - len(incomplete) / len(ordered)),
        cells=tuple(_build_cell(column, ordered) for column in columns),
        reason=reason,
        line=line,
        source_line=_quote_line(student.text, line),
        seed=failed.seed if failed else 0,
        failure=failed.failure if failed else "",
        error=failed.error if failed else "",
        hidden=failed.hidden if failed else False,
        runs=len(ordered),
        stopped_early=len(ordered) < len(seeds) and ordered[0].gave_up,
        refusal=student.refusal,
        ids=student.ids,
        outcomes=tuple(
            sorted(
                (outcome for outcome in outcomes if outcome.counts),
                key=lambda outcome: (worlds.index(outcome.world), outcome.seed),
            )
        ),
    )


def _build_empty_row(
    student: Student, columns: Sequence[Goal], outcomes: Sequence[Outcome]
) -> SheetRow:
    """Return the row of a student without a run that counts.

    Its points are 0 if the hand-in is at fault, and NaN (unknown) if this machine is.
    """
    failed = next(
        (
            outcome
            for outcome in sorted(outcomes, key=lambda outcome: not outcome.is_in_doubt)
            if not outcome.counts
        ),
        None,
    )
    reason = student.problem or NOT_RUN
    if failed or student.is_unread:
        reason = (
            f"{UNJUDGED}: {(failed.failure if failed else reason).removeprefix(f'{UNJUDGED}: ')}"
        )
    points = math.nan if failed or student.is_unread else 0.0
    cells = tuple(Cell(points, 0, reason) for _ in columns)
    return SheetRow(
        *(student.name, student.shown_main, points, 0.0, cells, reason),
        failure=student.problem,
        ids=student.ids,
    )


def _compute_points(columns: Sequence[Goal], outcome: Outcome) -> float:
    """Return the points of one run; 0 for a run without a recording, which has no judgements."""
    met = {goal.name for goal in outcome.goals if goal.met}
    unknown = {goal.name for goal in outcome.goals if goal.is_unknown}
    return sum_points(
        math.nan if column.points and column.name in unknown else column.points
        for column in columns
        if column.name in met | unknown
    )


def _build_cell(column: Goal, outcomes: Sequence[Outcome]) -> Cell:
    goals = [
        (
            world_outcome,
            next((goal for goal in world_outcome.goals if goal.name == column.name), None),
        )
        for world_outcome in outcomes
    ]
    met = sum(goal is not None and goal.met for _, goal in goals)
    is_unknown = any(goal is not None and goal.is_unknown for _, goal in goals)
    points = math.nan if is_unknown else round_points(column.points * met / len(goals))
    for outcome, goal in goals:
        if goal is None:
            # A run without a recording has no goals, only a failure.
            return Cell(points, met, outcome.failure, 0, outcome.seed, outcome.hidden)
        if not goal.is_good:
            return Cell(points, met, goal.reason, goal.line, outcome.seed, goal.hidden)
    return Cell(points, met)


def _has_missed(outcome: Outcome, columns: Sequence[Goal]) -> bool:
    """Return whether a run has missed one of the goals, or met one that takes points off."""
    good = {goal.name for goal in outcome.goals if goal.is_good}
    return not all(column.name in good for column in columns)


def _find_reason(outcome: Outcome, columns: Sequence[Goal]) -> tuple[str, int]:
    """Return why a run failed, and the number of the program's line that the reason is about; 0 if it is about no line.

    The reason is the program's error. Without an error, it is the reason of the first goal that the run missed; it is
    empty for a good run.
    """
    names = {column.name: column.say for column in columns}
    missed = [goal for goal in outcome.goals if not goal.is_good and goal.name in names]
    if outcome.failure:
        # A program that was stopped has no line of an error; the first missed goal with a line gives one.
        return outcome.failure, outcome.line or next((goal.line for goal in missed if goal.line), 0)
    return (missed[0].reason or names[missed[0].name], missed[0].line) if missed else ("", 0)


def round_points(value: float) -> float:
    """Return points or a share, rounded to `DIGITS` decimals for display and storage."""
    # Adding 0 turns -0 into 0.
    return round(value, DIGITS) + 0.0


def _cut_middle(name: str, max_length: int) -> str:
    # Both ends of the name are kept, as similar names usually differ at one of them.
    end = max_length // 3
    return name if len(name) <= max_length else f"{name[: max_length - end - 1]}…{name[-end:]}"


def build_metadata(sheet: Sheet) -> dict[str, Any]:
    """Return the metadata of an exported sheet, by key, such as the goals with their points, and the seeds."""
    return {
        "format": MARKS_FORMAT,
        "table": "marks",
        "title": sheet.title,
        "goals": [
            {"name": goal.name, "say": goal.say, "points": goal.points} for goal in sheet.columns
        ],
        "points": sheet.most_points,
        "seeds": list(sheet.seeds),
    }


def export_marks(sheet: Sheet, path: Path) -> None:
    """Write the sheet as a table in the format of the path's suffix; an existing file is replaced.

    Raises:
        ExportError: the file cannot be written; an existing file is unchanged.
    """
    export_frame(sheet.build_frame(), path, build_metadata(sheet))
