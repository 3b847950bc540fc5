"""Parquet and Arrow files: read piece by piece, so that what is whole of a damaged one is not lost."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa

from tuisim.errors import LogError
from tuisim.logs.arrow import unique_names
from tuisim.logs.export import METADATA_KEY
from tuisim.logs.warnings import Notes

PARQUET_MAGIC, ARROW_MAGIC, ARROW_STREAM_MAGIC = b"PAR1", b"ARROW1", b"\xff\xff\xff\xff"
_CUT_OFF = "the file was cut off: read as far as it goes"


def metadata_in(schema: pa.Schema) -> Mapping[str, Any]:
    """Return what our own exports say of themselves; empty for other files."""
    try:
        found = json.loads((schema.metadata or {}).get(METADATA_KEY, b"{}"))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def parquet_parts(path: Path, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    """Yield the row groups of a file, each with the part of the file that is read then.

    Raises:
        LogError: the file has no readable footer, without which nothing can be found in it.
    """
    import pyarrow.parquet as pq

    try:
        file = pq.ParquetFile(path)
    except (pa.ArrowException, OSError, ValueError) as error:
        hint = "a Parquet file that was cut off cannot be read: its table of contents is at its end"
        raise LogError(f"no readable Parquet file: {_short(error)}", hint, file=str(path)) from error
    with file:
        count = file.metadata.num_row_groups
        if not count:
            yield 1.0, file.schema_arrow.empty_table()
        first = 1
        for at in range(count):
            rows = file.metadata.row_group(at).num_rows
            try:
                part = file.read_row_group(at)
            except (pa.ArrowException, OSError, ValueError):
                notes.add("row is damaged and was left out", "rows are damaged and were left out", [first], rows)
            else:
                yield (at + 1) / count, _named(part, notes)
            first += rows


def arrow_parts(path: Path, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    """Yield the record batches of a file; of one that was cut off those that are whole.

    Raises:
        LogError: not even the names of the columns can be read.
    """
    with pa.memory_map(str(path)) as source:
        try:
            with pa.ipc.open_file(source) as reader:
                count = reader.num_record_batches
                if not count:
                    yield 1.0, reader.schema.empty_table()
                for at in range(count):
                    try:
                        part = _whole(reader.get_batch(at))
                    except (pa.ArrowException, OSError, ValueError):
                        notes.add(
                            "batch of rows is damaged and was left out",
                            "batches of rows are damaged and were left out",
                            [],
                            1,
                        )
                    else:
                        yield (at + 1) / count, _named(part, notes)
                return
        except (pa.ArrowException, OSError, ValueError):
            notes.say(_CUT_OFF)
        # Behind eight bytes of magic an Arrow file is a stream of batches.
        yield from _stream_parts(path, source, 8, notes)


def arrow_stream_parts(path: Path, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    """Yield the record batches of an Arrow stream; of one that was cut off those that are whole.

    Raises:
        LogError: not even the names of the columns can be read.
    """
    with pa.memory_map(str(path)) as source:
        yield from _stream_parts(path, source, 0, notes)


def _stream_parts(path: Path, source: Any, start: int, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    size = max(path.stat().st_size, 1)
    source.seek(start)
    try:
        stream = pa.ipc.open_stream(source)
    except (pa.ArrowException, OSError, ValueError) as error:
        raise LogError(f"no readable Arrow file: {_short(error)}", file=str(path)) from error
    yield 0.0, stream.schema.empty_table()
    while True:
        try:
            part = _whole(stream.read_next_batch())
        except StopIteration:
            return
        except (pa.ArrowException, OSError, ValueError):
            notes.say(_CUT_OFF)
            return
        yield source.tell() / size, _named(part, notes)


def _whole(batch: pa.RecordBatch) -> pa.Table:
    """Return a batch as a table, checked to its last value; dates in milliseconds keep their time of day."""
    columns = [
        column.view(pa.timestamp("ms")) if pa.types.is_date64(column.type) else column for column in batch.columns
    ]
    part = pa.Table.from_arrays(columns, batch.schema.names).replace_schema_metadata(batch.schema.metadata)
    part.validate(full=True)
    return part


def _named(part: pa.Table, notes: Notes) -> pa.Table:
    # Renaming alone would lose what the file says about itself.
    renamed = part.rename_columns(unique_names(part.column_names, notes))
    for at, field in enumerate(part.schema):
        usual = _usual(field.type)
        if usual != field.type:
            renamed = renamed.set_column(at, renamed.field(at).with_type(usual), part.column(at).cast(usual))
    return renamed.replace_schema_metadata(part.schema.metadata)


def _usual(kind: pa.DataType) -> pa.DataType:
    """Return the type that columns of a kind are worked with; most are their own."""
    if pa.types.is_decimal(kind):
        return pa.float64()
    return pa.string() if pa.types.is_string_view(kind) else kind


def _short(error: Exception) -> str:
    return str(error).partition("\n")[0][:120] if str(error) else type(error).__name__
