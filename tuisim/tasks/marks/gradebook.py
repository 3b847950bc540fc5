"""The marks of a class as files that the gradebooks of Moodle and Canvas import.

Moodle finds a student by one column, which one chooses when one imports: user name, ID number or e-mail address.
Moodle's grading worksheet finds a student by the number that is in the names of the hand-ins, `Participant 4713`.
Canvas finds a student by `ID` or one of the SIS columns, and reads the most points from a row `Points Possible`.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, listed
from tuisim.engine.files import read_bytes
from tuisim.logs.csv_cells import escape_formula, restore_formula
from tuisim.pictures.charts.files import write_whole
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.marks.feedback import build_feedback
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.sheet import Sheet, SheetRow

MAX_BYTES = 16 << 20
ITEM = "tuisim"
"""Name of the assignment, if the task has no title."""


SUBMISSION = "submission"
"""Column of a roster: the name of the student's file or folder."""

_IDENTITY: Mapping[GradebookKind, Sequence[str]] = {
    GradebookKind.MOODLE: ("Username", "ID number", "Email address"),
    GradebookKind.CANVAS: ("Student", "ID", "SIS User ID", "SIS Login ID", "Section"),
}
"""Columns that say who a student is."""
_NAME_COLUMNS: Mapping[GradebookKind, str] = {
    GradebookKind.MOODLE: "Username",
    GradebookKind.CANVAS: "SIS Login ID",
}
"""The column that is the name of the submission, unless a roster says more."""
_WORKSHEET = ("Identifier", "Full name", "Last modified (grade)")
"""The first columns of Moodle's grading worksheet; without the third one, which may be empty, it imports nothing."""


@dataclass(frozen=True, slots=True)
class Roster:
    """The class list: for each student a row of texts, as in the file."""

    people: Mapping[str, Mapping[str, str]]
    """By the name of the submission: the cells of the row by the column's name in lower case."""

    def missing(self, names: Sequence[str]) -> list[str]:
        """Return those names of students with a submission that have no row in the class list."""
        return [name for name in names if name not in self.people]

    def absent(self, names: Sequence[str]) -> list[str]:
        """Return the names in the class list that are not among the submissions' names."""
        return [name for name in self.people if name not in names]


def read_roster(path: Path) -> Roster:
    """Read a class list: a CSV file with a heading, and one row for each student.

    The column `submission` has the name of the student's file or folder. Without this column, the user name is taken
    instead. The other columns have the names that the gradebook gives them, such as `Email address` or `SIS User ID`.

    Raises:
        ConfigError: the file cannot be read, has no column that names the submissions, or names a submission twice.
    """
    file_name = str(path)
    data = read_bytes(
        path, MAX_BYTES, ConfigError, "there is no such file", "is a folder", "give a CSV file"
    )
    try:
        text = data.decode("utf-8-sig")
        heading = text.partition("\n")[0]
        separator = max(",;\t", key=heading.count)
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
        rows = [
            cells for row in reader if any(cells := [restore_formula(cell.strip()) for cell in row])
        ]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ConfigError(
            f"is not a CSV file in UTF-8: {error}",
            "it needs a heading, and one row for each student",
            file=file_name,
        ) from error
    heads = [cell.casefold() for cell in rows[0]] if rows else []
    keys = (SUBMISSION, *(name.casefold() for name in _NAME_COLUMNS.values()))
    key = next((name for name in keys if name in heads), None)
    if key is None:
        raise ConfigError(
            "has no column that names the submissions",
            f"name one of the columns: {listed([SUBMISSION, *_NAME_COLUMNS.values()])}",
            file=file_name,
        )
    people: dict[str, Mapping[str, str]] = {}
    for row in rows[1:]:
        person = dict(zip(heads, row, strict=False))
        name = person.get(key, "")
        if name in people:
            raise ConfigError(
                f"has two rows for {name!r}", "one row for each student", file=file_name
            )
        if name:
            people[name] = person
    return Roster(people)


def write_gradebook(
    path: Path,
    kind: GradebookKind,
    sheet: Sheet,
    sources: Sequence[str],
    roster: Roster,
    *,
    goals: bool,
) -> None:
    """Write the marks as a file for a gradebook to import; an existing file is replaced.

    Args:
        path: The file.
        kind: The gradebook.
        sheet: The marks of the class.
        sources: The texts of the students' programs, which the feedback quotes, in the order of the rows.
        roster: The class list.
        goals: Whether each goal that is not hidden has its own column, beside the column of the total.

    Raises:
        ExportError: the file cannot be written.
    """
    item = sheet.title or ITEM
    # Students see these columns, so hidden goals and those that take points off are only in the total.
    indices = [
        index
        for index, column in enumerate(sheet.columns)
        if goals and not column.hidden and column.points >= 0
    ]
    identity, total, feedback = _choose_heads(kind, sheet, roster)
    names = [total or item, *(f"{item}: {sheet.columns[index].name}" for index in indices)]
    heads = [*identity, *names]
    table = []
    if kind is GradebookKind.CANVAS:
        possible = [
            format_points(points)
            for points in (sheet.most_points, *(sheet.columns[index].points for index in indices))
        ]
        table.append(["Points Possible", *[""] * (len(identity) - 1), *possible])
    else:
        heads.append(feedback)
    for row, source in zip(sheet.rows, sources, strict=True):
        points = [row.points, *(row.cells[index].points for index in indices)]
        # A cell stays empty if its points could not be judged.
        words = ["" if math.isnan(number) else format_points(number) for number in points]
        cells = [*_identify(row, identity, kind, roster), *words]
        table.append(
            cells if kind is GradebookKind.CANVAS else [*cells, build_feedback(sheet, row, source)]
        )
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(
        [*map(escape_formula, row)] for row in [heads, *table]
    )
    write_whole(path, text.getvalue().encode("utf-8", "backslashreplace"))


def _choose_heads(
    kind: GradebookKind, sheet: Sheet, roster: Roster
) -> tuple[Sequence[str], str, str]:
    """Return the headings of a gradebook's columns, in three parts.

    Returns:
        The headings of the columns that identify a student; the heading of the total, or "" to take the title of the
        task as this heading; and the heading of the feedback.
    """
    has_numbers = kind is GradebookKind.MOODLE and any(kind in row.ids for row in sheet.rows)
    if has_numbers and not roster.people:
        return _WORKSHEET, "Grade", "Feedback comments"
    return _IDENTITY[kind], "", "Feedback"


def _identify(
    row: SheetRow, heads: Sequence[str], kind: GradebookKind, roster: Roster
) -> list[str]:
    names = ("student", "full name", *(() if kind in row.ids else [_NAME_COLUMNS[kind].casefold()]))
    person = dict.fromkeys(names, row.name)
    if number := row.ids.get(kind):
        person |= {"id": number, "identifier": f"Participant {number}"}
    person |= {head: cell for head, cell in roster.people.get(row.name, {}).items() if cell}
    return [person.get(head.casefold(), "") for head in heads]
