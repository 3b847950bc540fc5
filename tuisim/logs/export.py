"""Logs as files: written whole or not at all, and read back to the last bit."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from tuisim.atomic import replacing
from tuisim.core.spec import to_plain
from tuisim.errors import ExportError, LogError
from tuisim.logs.units import unit_of
from tuisim.runs.frames import samples_frame, telemetry_frame
from tuisim.runs.run_folder import StoredRun

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

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


Metadata = Mapping[str, Any]
"""What travels with a log, ready for JSON."""

METADATA_KEY = b"tuisim"
"""Key of the metadata in the schema of Parquet and Arrow files."""

TIMEDELTA, TEXT, WHOLE = ("index",), ("variable",), ("run", "line")
"""Columns of the frames by type; all others are floating-point numbers."""


def companion_of(path: Path) -> Path:
    """Return where the metadata of a file without room for them goes."""
    return path.with_name(path.name + ".json")


@dataclass(frozen=True, slots=True)
class Exporter:
    """One file format."""

    write: Callable[[pd.DataFrame, Metadata, BinaryIO], None]
    read: Callable[[Path], pd.DataFrame]
    inside: Callable[[Path], Mapping[bytes, bytes]] | None = None
    """What a file says besides its rows; None if it has no room for that."""

    @property
    def companion(self) -> bool:
        """Whether the metadata goes into a file of its own, NAME.csv.json."""
        return self.inside is None


def _write_csv(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    # Floats are written as their shortest exact text, time spans as pandas prints them.
    frame.to_csv(handle, index=False, lineterminator="\n", encoding="utf-8", mode="wb")


def _read_csv(path: Path) -> pd.DataFrame:
    import pandas as pd

    # As text first: a variable may be called NA, and the reader's own numbers may be a last bit off.
    frame = pd.read_csv(path, dtype="str", keep_default_na=False, encoding="utf-8")
    for name in frame.columns:
        if name not in (*TIMEDELTA, *TEXT):
            frame[name] = _cells(frame[name].tolist())
    return _typed(frame)


def _cells(texts: list[str]) -> list[Any]:
    """Return a column as numbers or truths if it holds nothing else, otherwise as it is."""
    if texts and not set(texts) - {"True", "False"}:
        return [text == "True" for text in texts]
    try:
        return [_number(text) for text in texts]
    except ValueError:
        return texts


def _number(text: str) -> int | float:
    """Return a number as it was written: one without a point is whole, nothing is missing."""
    if not text:
        return math.nan
    return int(text) if text.lstrip("-").isdigit() else float(text)


def _write_jsonl(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    names = [str(name) for name in frame.columns]
    columns = [frame[name].astype("str") if name in TIMEDELTA else frame[name] for name in frame.columns]
    for values in zip(*(column.tolist() for column in columns), strict=True):
        row = {name: _plain(value) for name, value in zip(names, values, strict=True)}
        # Moments and the like become the text that says them.
        handle.write(json.dumps(row, ensure_ascii=False, default=str).encode() + b"\n")


def _plain(value: Any) -> Any:
    """Return a cell for JSON: lists as such, nothing for what is missing, which is not equal to itself."""
    plain = value.tolist() if hasattr(value, "tolist") else value
    return plain if plain == plain else None


def _read_jsonl(path: Path) -> pd.DataFrame:
    import pandas as pd

    with open(path, encoding="utf-8") as handle:
        rows = [json.loads(line) for line in handle]
    beside = companion_of(path)
    if not rows and beside.exists():
        # Without a row nothing in the file itself names the columns.
        return _typed(pd.DataFrame(columns=json.loads(beside.read_bytes())["columns"]))
    return _typed(pd.DataFrame(rows))


def _typed(frame: pd.DataFrame) -> pd.DataFrame:
    """Give the columns of a text format their types, also those of a frame without rows."""
    import pandas as pd

    for name in frame.columns:
        if name in TIMEDELTA:
            frame[name] = pd.to_timedelta(frame[name]).astype("timedelta64[ns]")
        elif name in TEXT:
            frame[name] = frame[name].astype("str")
        elif name in WHOLE:
            frame[name] = frame[name].astype("int64")
        elif frame[name].dtype == object:
            frame[name] = frame[name].astype("float64")
    return frame


def _table(frame: pd.DataFrame, metadata: Metadata) -> pa.Table:
    import pyarrow as pa

    table = pa.Table.from_pandas(frame, preserve_index=False)
    text = json.dumps(metadata, sort_keys=True).encode()
    return table.replace_schema_metadata({**(table.schema.metadata or {}), METADATA_KEY: text})


def _write_parquet(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    import pyarrow.parquet as pq

    pq.write_table(_table(frame, metadata), handle)


def _read_parquet(path: Path) -> pd.DataFrame:
    import pandas as pd

    return pd.read_parquet(path)


def _write_arrow(frame: pd.DataFrame, metadata: Metadata, handle: BinaryIO) -> None:
    import pyarrow as pa

    table = _table(frame, metadata)
    with pa.ipc.new_file(handle, table.schema) as writer:
        writer.write_table(table)


def _read_arrow(path: Path) -> pd.DataFrame:
    import pandas as pd

    return pd.read_feather(path)


def _inside_parquet(path: Path) -> Mapping[bytes, bytes]:
    import pyarrow.parquet as pq

    return pq.read_schema(path).metadata or {}


def _inside_arrow(path: Path) -> Mapping[bytes, bytes]:
    import pyarrow as pa

    with pa.OSFile(str(path)) as handle, pa.ipc.open_file(handle) as reader:
        return reader.schema.metadata or {}


EXPORTERS: Mapping[str, Exporter] = {
    ".csv": Exporter(_write_csv, _read_csv),
    ".parquet": Exporter(_write_parquet, _read_parquet, _inside_parquet),
    ".jsonl": Exporter(_write_jsonl, _read_jsonl),
    ".arrow": Exporter(_write_arrow, _read_arrow, _inside_arrow),
}
"""Every format by the suffix of its files. To add one: write its functions and a line here."""

LISTED = f"{', '.join([*EXPORTERS][:-1])} or {[*EXPORTERS][-1]}"
"""The suffixes in words."""
