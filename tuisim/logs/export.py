"""Exports: frames and logs as files, each written whole or not at all."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from tuisim.base.atomic import replacing
from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.core.tree import dump_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs.metadata import SCALES
from tuisim.logs.units import TIMEDELTA, WHOLE, parse_unit

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.logs.log import Log, LogTable

LOG_FORMAT = 1
_MAX_WHOLE = 2.0**53
"""Whole numbers in a column of floating-point numbers are exported as integers if all are smaller than this: larger
ones may be rounded.
"""

_UNITS: Mapping[str, str] = {
    "index": "time since the first sample of the run was printed",
    "value": "as printed",
    "time": "s, simulated",
}


def check_target(path: str | Path, others: Sequence[str] = ()) -> Path:
    """Return the path of an export after checking that a file can be written there.

    Args:
        path: The file.
        others: Suffixes of further formats, which the caller writes itself; an error about the suffix lists them, too.

    Raises:
        ExportError: unknown suffix, no such folder, a folder that cannot be written, or an existing target that may not
            be replaced.
    """
    target = Path(path)
    exporter = EXPORTERS.get(target.suffix.lower())
    if exporter is None:
        raise ExportError(
            f"cannot write {target}: unknown format {target.suffix!r}",
            f"a file ends in {', '.join((*EXPORTERS, *others))}",
        )
    for place in (target, find_companion(target)) if exporter.companion else (target,):
        check_place(place)
    return target


def check_targets(targets: Iterable[str | Path]) -> None:
    """Check that all files can be written, and that no file is named twice.

    Raises:
        ConfigError: two of them are the same file.
        ExportError: a file cannot be written.
    """
    seen: set[str] = set()
    for target in targets:
        check_target(target)
        real = os.path.realpath(target)
        if real in seen:
            raise ConfigError(
                f"{real} is named twice", "give each export its own file", key="--export"
            )
        seen.add(real)


def check_place(place: Path) -> None:
    """Check that a file can be written, without creating it.

    Raises:
        ExportError: no such folder, a folder that cannot be written, or an existing target that may not be replaced.
    """
    import tempfile

    try:
        if os.path.isdir(place):
            raise ExportError(f"cannot write {place}: it is a folder")
        if os.path.exists(place) and not (os.path.isfile(place) and os.access(place, os.W_OK)):
            raise ExportError(f"cannot write {place}: it exists and cannot be replaced")
        if not os.path.isdir(place.parent):
            raise ExportError(f"cannot write {place}: there is no folder {place.parent}")
        # Permissions alone are not enough: a file system may be full or read-only.
        with tempfile.TemporaryFile(dir=place.parent):
            pass
    except OSError as error:
        # A name that is too long for the file system also raises this error.
        raise ExportError(f"cannot write {place}: {error.strerror or error}") from error


def export_frame(frame: pd.DataFrame, path: str | Path, metadata: Metadata) -> None:
    """Write a frame in the format of the path's suffix; an existing file is replaced.

    Args:
        frame: Columns of numbers, texts and time spans.
        path: The file.
        metadata: Stored with the frame, ready for JSON. It must be the same for identical runs.

    Raises:
        ExportError: the file cannot be written; an existing file is unchanged.
    """
    target = check_target(path)
    exporter = EXPORTERS[target.suffix.lower()]
    try:
        # The companion file is renamed just before the file, when both are complete.
        with ExitStack() as files:
            exporter.write(frame, metadata, files.enter_context(replacing(target)))
            if exporter.companion:
                beside = files.enter_context(replacing(find_companion(target)))
                beside.write(json.dumps(metadata, indent=1, sort_keys=True).encode() + b"\n")
    except OSError as error:
        raise ExportError(f"cannot write {target}: {error.strerror or error}") from error


def export_samples(runs: Sequence[StoredRun], path: str | Path) -> int:
    """Write the samples of one or more runs, see `frames.build_samples_frame`; return the number of rows.

    Raises:
        ExportError: the file cannot be written.
        LogError: a recording is damaged.
    """
    check_target(path)
    from tuisim.engine.runs.frames import build_samples_frame

    frame = build_samples_frame(runs)
    export_frame(frame, path, log_metadata("samples", frame, runs))
    return len(frame)


def export_telemetry(run: StoredRun, path: str | Path) -> int:
    """Write every tick of a run, see `frames.build_telemetry_frame`; return the number of rows.

    Raises:
        ExportError: the file cannot be written.
        LogError: a recording is damaged, or the mat cannot be found any more.
    """
    check_target(path)
    from tuisim.engine.runs.frames import build_telemetry_frame

    frame = build_telemetry_frame(run)
    export_frame(frame, path, log_metadata("telemetry", frame, [run]))
    return len(frame)


def export_log(log: Log, table: LogTable, path: str | Path) -> None:
    """Write rows and columns of a log in the format of the path's suffix; an existing file is replaced.

    Args:
        log: The log, whose metadata are stored with the rows.
        table: Some of its rows and columns, in any order.
        path: The file.

    Raises:
        ExportError: the file cannot be written; an existing file is unchanged.
    """
    frame = build_typed_frame(table)
    of_frame = build_table_metadata("log", frame)
    metadata: dict[str, Any] = {**of_frame, **log.metadata, "columns": of_frame["columns"]}
    units = metadata.get("units")
    if isinstance(units, dict):
        metadata["units"] = {
            name: unit for name, unit in units.items() if name in metadata["columns"]
        }
    export_frame(frame, path, metadata)


def build_typed_frame(table: LogTable) -> pd.DataFrame:
    """Return a table as a frame with the types of `frames.build_samples_frame`, even if it was read as text.

    A column keeps its type if another type would change a value.
    """
    import numpy as np
    import pandas as pd

    # The metadata of pandas are dropped, as they may be damaged.
    frame = table.replace_schema_metadata().to_pandas()
    for name in frame.columns:
        column = frame[name]
        if isinstance(column.dtype, pd.CategoricalDtype):
            frame[name] = column = column.astype(column.cat.categories.dtype)
        if name in TIMEDELTA and pd.api.types.is_string_dtype(column):
            spans = pd.to_timedelta(column, errors="coerce")
            frame[name] = column if spans.isna().any() else spans.astype("timedelta64[ns]")
        elif name in WHOLE and pd.api.types.is_float_dtype(column.dtype):
            numbers = column.to_numpy()
            if ((np.abs(numbers) < _MAX_WHOLE) & (numbers == np.rint(numbers))).all():
                frame[name] = column.astype("int64")
    return frame


def log_metadata(table: str, columns: Iterable[str], runs: Sequence[StoredRun]) -> dict[str, Any]:
    """Return the metadata of a log, by key: units, and program, seed, robot, world and profile of each run.

    The metadata of identical runs are equal: they have no id, no time of day and no path.

    Args:
        table: `samples` or `telemetry`.
        columns: The names of its columns.
        runs: Its runs, in the order of the `run` column.
    """
    from tuisim.engine.runs.frames import list_scale_changes

    return {
        **build_table_metadata(table, columns),
        "units": {
            name: unit for name in columns if (unit := _UNITS.get(name) or parse_unit(name).words)
        },
        "runs": [
            {
                "run": ordinal,
                "program": {
                    "name": run.program.name,
                    "sha256": run.program.sha256,
                    "prelude": run.program.prelude,
                    **({"arguments": list(run.program.arguments)} if run.program.arguments else {}),
                },
                **dump_run(run.spec),
                **({SCALES: changes} if (changes := list_scale_changes(run)) else {}),
            }
            for ordinal, run in enumerate(runs, 1)
        ],
    }


def build_table_metadata(table: str, columns: Iterable[str]) -> dict[str, Any]:
    """Return the metadata that every table has, by key: its format, its kind, and the names of its columns."""
    return {"format": LOG_FORMAT, "table": table, "columns": list(columns)}


Metadata = Mapping[str, Any]
"""The metadata of a log by key, of values that JSON can store."""


def describe_files(target: Path) -> str:
    """Return the names of the files of an export: the file and, if there is one, its companion file with metadata."""
    exporter = EXPORTERS.get(target.suffix.lower())
    beside = (
        f"; what it is and its units: {find_companion(target).name}"
        if exporter and exporter.companion
        else ""
    )
    return f"{target}{beside}"


def is_companion(path: Path) -> bool:
    """Return whether a file has the name of a companion file with the metadata of an export."""
    return path.suffix.lower() == ".json" and Path(path.stem).suffix.lower() in EXPORTERS


def find_companion(path: Path) -> Path:
    """Return the path of the companion file that has the metadata of a table, such as `log.csv.json` for `log.csv`.

    Formats such as CSV cannot store metadata themselves.
    """
    return path.with_name(path.name + ".json")


class Exporter(NamedTuple):
    """A file format of exports, with the function that writes it."""

    write: Callable[[pd.DataFrame, Metadata, BinaryIO], None]
    contents: str
    """What a file in this format contains, in words for dialogs."""
    companion: bool = True
    """Whether the metadata goes into a file beside the export, such as NAME.csv.json, because the format cannot store
    it.
    """


def _write_csv(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    from tuisim.logs.csv_cells import write_csv

    write_csv(frame, handle)


def _write_jsonl(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    names = [str(name) for name in frame.columns]
    columns = [
        frame[name].astype("str") if name in TIMEDELTA else frame[name] for name in frame.columns
    ]
    for values in zip(*(column.tolist() for column in columns), strict=True):
        row = {name: _convert_cell(value) for name, value in zip(names, values, strict=True)}
        # Dates and similar values are written as text.
        handle.write(
            json.dumps(row, ensure_ascii=False, default=str).encode(errors="backslashreplace")
            + b"\n"
        )


def _convert_cell(value: Any) -> Any:
    """Return a cell for JSON: arrays become lists, and NaN becomes None."""
    plain = value.tolist() if hasattr(value, "tolist") else value
    return plain if plain == plain else None


def _write_parquet(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    from tuisim.logs.arrow import write_parquet

    write_parquet(frame, metadata, handle)


def _write_arrow(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    from tuisim.logs.arrow import write_arrow

    write_arrow(frame, metadata, handle)


_TYPED = "all types, and the metadata of the runs"

EXPORTERS: Mapping[str, Exporter] = {
    ".csv": Exporter(_write_csv, "text"),
    ".parquet": Exporter(_write_parquet, _TYPED, companion=False),
    ".jsonl": Exporter(_write_jsonl, _TYPED),
    ".arrow": Exporter(_write_arrow, _TYPED, companion=False),
}
"""The formats of exports by the suffix of the file. A new one needs its function, a line here, and its reader in
`logs.reader`.
"""

LISTED = f"{', '.join([*EXPORTERS][:-1])} or {[*EXPORTERS][-1]}"
