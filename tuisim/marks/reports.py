"""The reports of kept runs, beside the page of a class."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

from tuisim.analysis.report import report_of
from tuisim.analysis.source import LogRequest, opening
from tuisim.charts.files import write_whole
from tuisim.errors import ExportError, LogError
from tuisim.marks.feedback import file_stems
from tuisim.marks.sheet import Sheet
from tuisim.runs.store import RunStore

MOST_OUTPUT_BYTES = 4 << 20
"""Runs that printed more get no report: a browser could hardly show it."""


def folder_of(page: Path) -> Path:
    """Return the folder of the reports that a page links to."""
    return page.with_name(f"{page.stem}-runs")


def write_reports(sheet: Sheet, page: Path) -> Iterator[tuple[str, int, str]]:
    """Write the report of each kept run; yield student, seed and path relative to the page.

    Runs that were removed from the store are left out. Reports of an earlier page of this name are replaced.

    Raises:
        ExportError: a report cannot be written.
    """
    folder, store = folder_of(page), RunStore()
    shutil.rmtree(folder, ignore_errors=True)
    for stem, row in zip(file_stems(one.name for one in sheet.rows), sheet.rows, strict=True):
        for outcome in row.outcomes:
            content = outcome.run_id and _report(store, outcome.run_id, f"{row.name}, seed {outcome.seed}")
            if not content:
                continue
            try:
                os.makedirs(folder, exist_ok=True)
            except OSError as error:
                raise ExportError(f"cannot write to {folder}: {error.strerror or error}") from error
            path = folder / f"{stem}-seed-{outcome.seed}.html"
            write_whole(path, content.encode())
            yield row.name, outcome.seed, f"{folder.name}/{path.name}"


def _report(store: RunStore, run_id: str, title: str) -> str:
    """Return the report of a run; empty if there is none."""
    try:
        if store.load_run(run_id).output.length > MOST_OUTPUT_BYTES:
            return ""
        *_, opened = opening(LogRequest(runs=(run_id,)))
        return report_of(opened, title=title)
    except LogError:
        return ""
