"""Logs as files: written whole or not at all, and read back to the last bit."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.atomic import replacing
from tuisim.core.spec import to_plain
from tuisim.datalog.formats import EXPORTERS, METADATA_KEY, Metadata, companion_of
from tuisim.datalog.frames import samples_frame, telemetry_frame
from tuisim.datalog.runfile import StoredRun
from tuisim.datalog.units import unit_of
from tuisim.errors import ExportError, LogError

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.core.field import Field

__all__ = [
    "EXPORTERS",
    "check_place",
    "check_target",
    "export_frame",
    "export_samples",
    "export_telemetry",
    "log_metadata",
    "read_log",
    "read_metadata",
]

LOG_FORMAT = 1

_UNITS: Mapping[str, str] = {
    "index": "time since the first sample of the run was printed",
    "value": "as printed",
    "time": "s, simulated",
}


def check_target(path: str | Path) -> Path:
    """Return the path of an export, if a file can be written there; nothing is left behind.

    Raises:
        ExportError: unknown suffix, no such folder, a folder that cannot be written, or a
            target that is there and is no file that may be replaced.
    """
    target = Path(path)
    exporter = EXPORTERS.get(target.suffix.lower())
    if exporter is None:
        raise ExportError(f"cannot write {target}: unknown format {target.suffix!r}", f"a file ends in {_allowed()}")
    for place in (target, companion_of(target)) if exporter.companion else (target,):
        check_place(place)
    return target


def check_place(place: Path) -> None:
    """Make sure that a file can be written at a place; nothing is left behind.

    Raises:
        ExportError: no such folder, a folder that cannot be written, or something is there that is no file
            that may be replaced.
    """
    try:
        if place.is_dir():
            raise ExportError(f"cannot write {place}: it is a folder")
        if place.exists() and not (place.is_file() and os.access(place, os.W_OK)):
            raise ExportError(f"cannot write {place}: it is there and may not be replaced")
        if not place.parent.is_dir():
            raise ExportError(f"cannot write {place}: there is no folder {place.parent}")
        # The rights alone do not tell: a file system may be full or read-only.
        with tempfile.TemporaryFile(dir=place.parent):
            pass
    except OSError as error:
        # Also a name that is too long for the file system, which every look at it says.
        raise ExportError(f"cannot write {place}: {error.strerror or error}") from error


def export_frame(frame: pd.DataFrame, path: str | Path, metadata: Metadata) -> None:
    """Write a frame in the format that the suffix names; files that are there are replaced.

    Args:
        frame: Columns of numbers, texts and time spans.
        path: Where to.
        metadata: What travels with it, ready for JSON. It must be the same for identical runs.

    Raises:
        ExportError: it cannot be written; what was there is as it was.
    """
    target = check_target(path)
    exporter = EXPORTERS[target.suffix.lower()]
    try:
        # The text that belongs to the file is renamed just before it, when both are whole.
        with ExitStack() as files:
            exporter.write(frame, metadata, files.enter_context(replacing(target)))
            if exporter.companion:
                beside = files.enter_context(replacing(companion_of(target)))
                beside.write(json.dumps(metadata, indent=1, sort_keys=True).encode() + b"\n")
    except OSError as error:
        raise ExportError(f"cannot write {target}: {error.strerror or error}") from error


def export_samples(runs: Sequence[StoredRun], path: str | Path) -> None:
    """Write the samples of one or more runs, see `frames.samples_frame`.

    Raises:
        ExportError: it cannot be written.
        LogError: a recording is damaged.
    """
    check_target(path)
    frame = samples_frame(runs)
    export_frame(frame, path, log_metadata("samples", frame, runs))


def export_telemetry(run: StoredRun, path: str | Path, field: Field | None = None) -> None:
    """Write every tick of a run, see `frames.telemetry_frame`.

    Raises:
        ExportError: it cannot be written.
        LogError: a recording is damaged, or the mat cannot be found any more.
    """
    check_target(path)
    frame = telemetry_frame(run, field)
    export_frame(frame, path, log_metadata("telemetry", frame, [run]))


def log_metadata(table: str, frame: pd.DataFrame, runs: Sequence[StoredRun]) -> dict[str, Any]:
    """Return what travels with a log: units, and program, seed, robot, world and profile of each run.

    Nothing in it tells two identical runs apart: no id, no time of day, no path.

    Args:
        table: `samples` or `telemetry`.
        frame: The log.
        runs: Where it comes from, in the order of its `run` column.
    """
    return {
        "format": LOG_FORMAT,
        "table": table,
        "columns": list(frame.columns),
        "units": {name: unit for name in frame.columns if (unit := _unit(name))},
        "runs": [
            {
                "run": ordinal,
                "program": {
                    "name": run.program.name,
                    "sha256": run.program.sha256,
                    "prelude": run.program.prelude,
                    **({"arguments": list(run.program.arguments)} if run.program.arguments else {}),
                },
                **to_plain(run.spec),
            }
            for ordinal, run in enumerate(runs, 1)
        ],
    }


def read_log(path: str | Path) -> pd.DataFrame:
    """Return the frame in an exported file: the same values and types as were written, to the last bit.

    Raises:
        LogError: no such file, unknown format, or it cannot be read.
    """
    source = _source(path)
    try:
        return EXPORTERS[source.suffix.lower()].read(source)
    # The libraries raise OSError for a file that is no Parquet or Arrow, ValueError for any other.
    except (OSError, ValueError, KeyError) as error:
        raise LogError(f"cannot be read: {error}", file=str(source)) from error


def read_metadata(path: str | Path) -> dict[str, Any]:
    """Return what travels with an exported file; empty if there is nothing.

    Raises:
        LogError: no such file, unknown format, or it cannot be read.
    """
    source = _source(path)
    try:
        inside = EXPORTERS[source.suffix.lower()].inside
        if inside is None:
            beside = companion_of(source)
            text = beside.read_bytes() if beside.exists() else b"{}"
        else:
            text = inside(source).get(METADATA_KEY, b"{}")
        found = json.loads(text)
    except (OSError, ValueError) as error:
        raise LogError(f"cannot be read: {error}", file=str(source)) from error
    return found if isinstance(found, dict) else {}


def _source(path: str | Path) -> Path:
    source = Path(path)
    if source.suffix.lower() not in EXPORTERS:
        raise LogError(f"unknown format {source.suffix!r}", f"a log ends in {_allowed()}", file=str(source))
    if not source.is_file():
        raise LogError("no such file", file=str(source))
    return source


def _allowed() -> str:
    return ", ".join(EXPORTERS)


def _unit(column: str) -> str:
    return _UNITS.get(column) or unit_of(column).words
