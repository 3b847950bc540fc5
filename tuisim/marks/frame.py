"""The sheet of a class as a data frame, for CSV, Parquet, JSONL and Arrow files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.logs.export import export_frame
from tuisim.marks.sheet import Sheet

if TYPE_CHECKING:
    import pandas as pd

MARKS_FORMAT = 1
GOAL_PREFIX = "goal_"
"""Before the name of a goal in the name of its column."""


def frame_of(sheet: Sheet) -> pd.DataFrame:
    """Return the sheet as a frame: one row a student, for each goal a column `goal_NAME` with its mean points."""
    import pandas as pd

    rows = sheet.rows
    columns: dict[str, list[Any]] = {
        "student": [row.name for row in rows],
        "program": [row.program for row in rows],
        "points": [row.points for row in rows],
        "robustness": [row.robustness for row in rows],
        "runs": [row.runs for row in rows],
    }
    for at, column in enumerate(sheet.columns):
        columns[f"{GOAL_PREFIX}{column.name}"] = [row.cells[at].points for row in rows]
    columns |= {
        "reason": [row.reason for row in rows],
        "line": [row.line for row in rows],
        "source_line": [row.source_line for row in rows],
        "seed": [row.seed for row in rows],
    }
    return pd.DataFrame(columns)


def metadata_of(sheet: Sheet) -> dict[str, Any]:
    """Return the metadata of an exported sheet: the goals with their points, and the seeds."""
    return {
        "format": MARKS_FORMAT,
        "table": "marks",
        "title": sheet.title,
        "goals": [{"name": one.name, "say": one.say, "points": one.points} for one in sheet.columns],
        "points": sheet.most_points,
        "seeds": list(sheet.seeds),
    }


def export_marks(sheet: Sheet, path: Path) -> None:
    """Write the sheet in the format of the suffix; an existing file is replaced.

    Raises:
        ExportError: it cannot be written; an existing file is unchanged.
    """
    export_frame(frame_of(sheet), path, metadata_of(sheet))
