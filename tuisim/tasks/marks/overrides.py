"""What a tutor decides over the runs: points and comments by student, kept in a file and applied to each marking.

```toml
[ada]
comment = "The path is right; the robot was set down a centimetre too far."
points = 9          # of the whole task; or, goal by goal:

[ben.goals]
heading = 1
```
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine import files
from tuisim.tasks.goals.judgement import sum_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.marks.sheet import Sheet, SheetRow, round_points

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
    """Read the overrides of a class, by student.

    Args:
        goals: The goals that have a column.
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
    """Return the sheet with a tutor's overrides; what the runs have earned is kept in `earned`."""
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
