"""The page of a class with all that is on it: reports of runs, programs that are alike, where goals were missed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from tuisim.base.errors import ExportError, counted
from tuisim.pictures.charts.files import write_whole
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.class_map import build_class_maps
from tuisim.tasks.marks.copies import find_similar
from tuisim.tasks.marks.page import build_page
from tuisim.tasks.marks.reports import write_reports
from tuisim.tasks.marks.sheet import Sheet
from tuisim.tasks.marks.students import Student
from tuisim.tasks.marks.workspace import read_modules


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
        students: Those whose programs are compared.
        ignored: Names of files that are no programs.
        target: The page.
        tell: Receives the progress: words, the number of reports that are written, and of all.
        movies: Whether reports of runs that missed a goal have movies.

    Raises:
        ExportError: the page cannot be written, or is without some of the reports.
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
        misses.append(report.misses)
        tell(f"report {len(links)} of {run_count}", len(links), run_count)
    alike = find_similar({student.name: read_modules(student) for student in students})
    write_whole(target, build_page(sheet, links, ignored, alike, build_class_maps(misses)).encode())
    if faults:
        raise ExportError(f"{target} is without {counted(len(faults), 'report')}: {faults[0]}")
