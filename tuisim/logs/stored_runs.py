"""Stored runs as logs: printed samples, or telemetry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pyarrow as pa

from tuisim.logs.columns import guess_columns
from tuisim.logs.export import log_metadata
from tuisim.logs.log import Log
from tuisim.runs.frames import damage_note, samples_frame, telemetry_frame
from tuisim.runs.run_folder import StoredRun

if TYPE_CHECKING:
    import pandas as pd


def log_of_runs(runs: Sequence[StoredRun]) -> Log:
    """Return the samples of one or more runs; a run without any gives an empty log.

    Raises:
        LogError: a recording is damaged.
    """
    return _log("samples", runs, samples_frame(runs))


def telemetry_log(run: StoredRun) -> Log:
    """Return the telemetry of a run.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """
    return _log("telemetry", [run], telemetry_frame(run))


def _log(kind: str, runs: Sequence[StoredRun], frame: pd.DataFrame) -> Log:
    table = pa.Table.from_pandas(frame, preserve_index=False).replace_schema_metadata()
    title = ", ".join(f"run {run.number or run.id}: {run.program.name}" for run in runs)
    found = [note for run in runs for note in run.notes]
    if kind == "telemetry":
        found += filter(None, map(damage_note, runs))
    return Log(title, table, guess_columns(table), tuple(found), 0, log_metadata(kind, frame, runs))
