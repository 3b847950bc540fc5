"""The reports of kept runs, beside the page of a class."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.analysis.report import report_of
from tuisim.analysis.source import LogRequest, opening
from tuisim.charts.files import write_whole
from tuisim.errors import ExportError, LogError
from tuisim.goals.spec import Goal
from tuisim.marks.feedback import file_stems
from tuisim.marks.page import reports_folder
from tuisim.marks.results import portable
from tuisim.marks.sheet import Sheet
from tuisim.marks.verdicts import verdicts
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore

MOST_OUTPUT_BYTES = 4 << 20
"""Runs that printed more get no report: a browser could hardly show it."""


def write_reports(sheet: Sheet, goals: Sequence[Goal], page: Path) -> Iterator[tuple[str, int, str]]:
    """Write the reports of kept runs; yield student, seed and path relative to the page.

    Runs of a student that recorded the same have one report. Runs that were removed from the store are left out.
    Reports of an earlier page of this name are replaced.

    Args:
        goals: All goals of the task.

    Raises:
        ExportError: a report cannot be written.
    """
    folder, store = reports_folder(page), RunStore()
    shutil.rmtree(folder, ignore_errors=True)
    for stem, row in zip(file_stems(one.name for one in sheet.rows), sheet.rows, strict=True):
        written: dict[str, str] = {}
        for outcome in row.outcomes:
            run = _stored(store, outcome.run_id) if outcome.run_id else None
            if run is None:
                continue
            recorded = _digest(run)
            if recorded not in written:
                name = f"{stem}-seed-{outcome.seed}.html"
                *_, opened = opening(LogRequest(runs=(run.id,)))
                opened = replace(opened, runs=tuple(map(_portable, opened.runs)))
                shown, pins = verdicts(sheet.columns, goals, outcome, run)
                title = f"{row.name}, seed {outcome.seed}"
                _write(folder / name, report_of(opened, title=title, pins=pins, parts=[shown]))
                written[recorded] = f"{folder.name}/{name}"
            yield row.name, outcome.seed, written[recorded]


def _write(path: Path, content: str) -> None:
    try:
        os.makedirs(path.parent, exist_ok=True)
    except OSError as error:
        raise ExportError(f"cannot write to {path.parent}: {error.strerror or error}") from error
    write_whole(path, content.encode())


def _stored(store: RunStore, run_id: str) -> StoredRun | None:
    """Return a run; None if it no longer exists, or is too large for a report."""
    try:
        run = store.load_run(run_id)
        return run if run.output.length <= MOST_OUTPUT_BYTES else None
    except LogError:
        return None


def _portable(run: StoredRun) -> StoredRun:
    """Return a run whose end is described without what differs from machine to machine."""
    if run.end is None:
        return run
    folder = run.program.working_directory
    end = replace(run.end, error=portable(run.end.error, folder), summary=portable(run.end.summary, folder))
    return replace(run, end=end)


def _digest(run: StoredRun) -> str:
    """Return a hash of what a run recorded, hexadecimal."""
    found = hashlib.sha256(run.telemetry.array().tobytes())
    folder = run.program.working_directory.encode("utf-8", "surrogateescape")
    for stream, row in run.output.raw_rows():
        text = row.replace(folder, b"")
        found.update(b"%d %d " % (stream, len(text)) + text)
    return found.hexdigest()
