"""Arrow: its columns as arrays; Parquet and Arrow files, read piece by piece and written."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.errors import LogError
from tuisim.engine.core.conditions import Operator, ValueCondition
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.warnings import Notes

if TYPE_CHECKING:
    import pandas as pd

PER_S = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
"""How many of each of Arrow's units of time make a second."""

METADATA_KEY = b"tuisim"
"""Key under which Parquet and Arrow files that tuisim writes have tuisim's metadata in their schema."""


def build_text_array(texts: Sequence[str]) -> pa.Array:
    """Return texts as an Arrow array of strings."""
    encoded = [text.encode("utf-8", "replace") for text in texts]
    ends = np.cumsum([0, *map(len, encoded)], dtype=np.int32)
    return pa.StringArray.from_buffers(
        len(texts), pa.py_buffer(ends), pa.py_buffer(b"".join(encoded))
    )


def build_table(columns: Mapping[str, Any]) -> pa.Table:
    """Return columns as an Arrow table; NaN becomes null, as it does when a frame is converted.

    Args:
        columns: The columns by name, each a list of texts or an array of numbers.
    """
    # A name in a damaged run may contain surrogates, which UTF-8 cannot encode.
    names = [name.encode("utf-8", "replace").decode() for name in columns]
    return pa.table([_build_column(cells) for cells in columns.values()], names=names)


def _build_column(cells: Any) -> pa.Array:
    if isinstance(cells, list):
        return build_text_array(cells).cast(pa.large_string())
    numbers = np.ascontiguousarray(cells)
    # `pa.array` is avoided, as it imports pandas.
    known = None
    if numbers.dtype.kind == "f" and np.isnan(numbers).any():
        known = pa.py_buffer(np.packbits(~np.isnan(numbers), bitorder="little"))
    return pa.Array.from_buffers(
        pa.from_numpy_dtype(numbers.dtype), len(numbers), [known, pa.py_buffer(numbers)]
    )


def convert_to_floats(column: pa.ChunkedArray) -> FloatArray:
    """Return a numeric column as floats, shape (n,), with NaN for nulls. The data are copied only if necessary."""
    if not pa.types.is_floating(column.type) or pa.types.is_float16(column.type):
        column = column.cast(pa.float64(), safe=False)
    parts = [
        read_numbers(chunk.fill_null(float("nan")) if chunk.null_count else chunk)
        for chunk in column.chunks
    ]
    if len(parts) == 1:
        return parts[0]
    numbers: FloatArray = np.concatenate(parts) if parts else np.empty(0)
    return numbers


def read_numbers(chunk: pa.Array) -> np.ndarray[Any, Any]:
    """Return an Arrow array of numbers without nulls as a NumPy array, shape (n,), without copying it."""
    # `to_numpy` is avoided, as it imports pandas.
    return np.from_dlpack(chunk)


def wrap_int64(numbers: np.ndarray[Any, np.dtype[np.int64]]) -> pa.ChunkedArray:
    """Return 64-bit integers, shape (n,), as an Arrow column, without copying them."""
    return pa.chunked_array([_build_column(numbers)])


BoolArray = np.ndarray[Any, np.dtype[np.bool_]]


def convert_to_texts(column: pa.ChunkedArray) -> pa.ChunkedArray:
    """Return a column as texts; time spans become the texts of their numbers."""
    if pa.types.is_duration(column.type):
        column = column.cast(pa.int64()).cast(pa.float64(), safe=False)
    return column.cast(pa.string())


def match_text(column: pa.ChunkedArray, text: str) -> BoolArray:
    """Return for each cell whether it contains a text, shape (n,); upper and lower case are the same."""
    return _convert_mask(pc.match_substring(convert_to_texts(column), text, ignore_case=True))


def match_condition(column: pa.ChunkedArray, condition: ValueCondition) -> BoolArray:
    """Return for each cell whether it meets a condition, shape (n,); False for empty cells.

    Numbers, and time spans in seconds, are compared as numbers, everything else as texts.

    Raises:
        LogError: the value of the condition is not a number, but the column has numbers.
    """
    if condition.operator is Operator.CONTAINS:
        return match_text(column, condition.value)
    if condition.operator is Operator.CHANGES:
        turns = _convert_mask(pc.not_equal(column[1:], column[:-1]))
        return np.append(False, turns)[: len(column)]
    compare: Callable[[Any, Any], Any] = getattr(pc, condition.operator.name.lower())
    kind = column.type
    if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_duration(kind)):
        return _convert_mask(compare(convert_to_texts(column), condition.value))
    try:
        value = float(condition.value)
    except ValueError as error:
        message = f"{condition}: {condition.value!r} is not a number"
        raise LogError(message, f"{condition.name} has numbers") from error
    if pa.types.is_duration(kind):
        column = pc.divide(column.cast(pa.int64()).cast(pa.float64(), safe=False), PER_S[kind.unit])
    return _convert_mask(compare(column.cast(pa.float64(), safe=False), value))


def _convert_mask(truths: Any) -> BoolArray:
    return np.asarray(pc.fill_null(truths, False).to_numpy(zero_copy_only=False), bool)


def sort_places(column: pa.ChunkedArray, descending: bool) -> IntArray:
    """Return the indices of the cells of a column in sorted order, shape (n,)."""
    column = convert_to_texts(column) if pa.types.is_dictionary(column.type) else column
    way = "descending" if descending else "ascending"
    places: IntArray = pc.sort_indices(column, sort_keys=[("", way)]).to_numpy().astype(np.int64)
    return places


def format_cell(cell: pa.Scalar) -> str:
    """Return a cell as text, empty for a missing value; a time span is given in seconds."""
    if pa.types.is_duration(cell.type):
        # `as_py` is avoided, as it imports pandas, which takes longer than drawing a whole screen.
        return f"{cell.value / PER_S[cell.type.unit]:.3f}" if cell.is_valid else ""
    value = cell.as_py()
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def make_names_unique(names: Sequence[str], notes: Notes | None = None) -> list[str]:
    """Return column names in which repeated names are changed to be unique; the changes are added to `notes`."""
    unique: list[str] = []
    for number, name in enumerate(names, 1):
        base = unique_name = name or f"column {number}"
        again = 2
        while unique_name in unique:
            unique_name = f"{base} ({again})"
            again += 1
        if name and unique_name != name and notes:
            notes.say(f"two columns are named {name!r}: the second is renamed to {unique_name!r}")
        unique.append(unique_name)
    return unique


_FILE_MAGIC = b"ARROW1"
_DAMAGES = (pa.ArrowException, OSError, ValueError)
"""Errors that the reading of a damaged file raises."""
_CUT_OFF = "the file is truncated: only the readable part was read"


def read_metadata(schema: pa.Schema) -> Mapping[str, Any]:
    """Return the metadata of an export of tuisim, by key; empty for other files."""
    try:
        metadata = json.loads((schema.metadata or {}).get(METADATA_KEY, b"{}"))
    except (ValueError, RecursionError):
        return {}
    return metadata if isinstance(metadata, dict) else {}


def read_parquet(path: Path, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    """Yield the row groups of a Parquet file, each with the fraction of the file that has been read.

    Raises:
        LogError: the file has no readable footer.
    """
    import pyarrow.parquet as pq

    notes.noun = "row"
    try:
        file = pq.ParquetFile(path)
        empty = _name_columns(file.schema_arrow.empty_table(), notes)
    except _DAMAGES as error:
        hint = "a truncated Parquet file cannot be read: its index is at its end"
        raise LogError(f"not a readable Parquet file: {_shorten_error(error)}", hint) from error
    with file:
        count = file.metadata.num_row_groups
        if not count:
            yield 1.0, empty
        first = 1
        for group in range(count):
            rows = file.metadata.row_group(group).num_rows
            try:
                part = file.read_row_group(group)
            except _DAMAGES:
                notes.add(
                    "row is damaged and was skipped",
                    "rows are damaged and were skipped",
                    range(first, first + rows),
                )
            else:
                yield (group + 1) / count, _name_columns(part, notes)
            first += rows


def read_arrow(path: Path, notes: Notes) -> Iterator[tuple[float, pa.Table]]:
    """Yield the record batches of an Arrow file or stream, each with the fraction of the file that has been read.

    If the file was cut off, only its complete batches are yielded.

    Raises:
        LogError: not even the names of the columns can be read.
    """
    with pa.memory_map(str(path)) as source:
        # In a file, unlike in a stream, the batches begin after eight magic bytes.
        source.seek(8 if source.read(len(_FILE_MAGIC)) == _FILE_MAGIC else 0)
        size = max(path.stat().st_size, 1)
        try:
            stream = pa.ipc.open_stream(source)
            empty = _name_columns(stream.schema.empty_table(), notes)
        except _DAMAGES as error:
            raise LogError(f"not a readable Arrow file: {_shorten_error(error)}") from error
        yield 0.0, empty
        while True:
            try:
                part = _validate_batch(stream.read_next_batch())
            except StopIteration:
                return
            except _DAMAGES:
                notes.say(_CUT_OFF)
                return
            yield source.tell() / size, _name_columns(part, notes)


FORMATS: Mapping[bytes, Callable[[Path, Notes], Iterator[tuple[float, pa.Table]]]] = {
    b"PAR1": read_parquet,
    _FILE_MAGIC: read_arrow,
    b"\xff\xff\xff\xff": read_arrow,
}
"""The functions that read a file part by part, each with the fraction read so far, by the first bytes of the file."""


def _validate_batch(batch: pa.RecordBatch) -> pa.Table:
    """Return a batch as a table after a check of its data; a pyarrow error is raised if they are damaged."""
    part = pa.Table.from_batches([batch])
    part.validate(full=True)
    return part


def _name_columns(part: pa.Table, notes: Notes) -> pa.Table:
    # Renaming columns drops the metadata, so they are set again.
    renamed = part.rename_columns(make_names_unique(part.column_names, notes))
    fields = [field.with_type(_choose_type(field.type)) for field in renamed.schema]
    return renamed.cast(pa.schema(fields, part.schema.metadata), safe=False)


def _choose_type(kind: pa.DataType) -> pa.DataType:
    """Return the type to which a column of some type is converted, such as float for decimals.

    Most types stay the same.

    Raises:
        LogError: columns of this type cannot be read.
    """
    if pa.types.is_decimal(kind):
        return pa.float64()
    if pa.types.is_date64(kind):
        message = "has a column of Arrow's type date64, which cannot be read"
        raise LogError(message, "write dates as date32 and times as timestamp")
    # Times of day become microseconds, as pandas has no nanoseconds for them.
    if kind == pa.time64("ns"):
        return pa.time64("us")
    return pa.string() if pa.types.is_string_view(kind) else kind


def _shorten_error(error: Exception) -> str:
    return str(error).partition("\n")[0][:120] if str(error) else type(error).__name__


def write_parquet(frame: pd.DataFrame, metadata: Mapping[str, Any], handle: BinaryIO) -> None:
    """Write a frame as a Parquet file, with metadata in its schema."""
    import pyarrow.parquet as pq

    pq.write_table(_convert_frame(frame, metadata), handle)


def write_arrow(frame: pd.DataFrame, metadata: Mapping[str, Any], handle: BinaryIO) -> None:
    """Write a frame as an Arrow file, with metadata in its schema."""
    table = _convert_frame(frame, metadata)
    with pa.ipc.new_file(handle, table.schema) as writer:
        writer.write_table(table)


def _convert_frame(frame: pd.DataFrame, metadata: Mapping[str, Any]) -> pa.Table:
    table = pa.Table.from_pandas(frame, preserve_index=False)
    text = json.dumps(metadata, sort_keys=True).encode()
    return table.replace_schema_metadata({**(table.schema.metadata or {}), METADATA_KEY: text})
