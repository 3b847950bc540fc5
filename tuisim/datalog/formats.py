"""File formats of a log: how each writes a frame and reads it back to the last bit.

No format may write anything that differs between two identical runs: no times, no paths,
no random numbers.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

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
