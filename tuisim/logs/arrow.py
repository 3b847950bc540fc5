"""Conversion of columns to and from Arrow, without pandas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from tuisim.logs.warnings import Notes
from tuisim.runs.arrays import FloatArray


def texts_array(texts: Sequence[str]) -> pa.Array:
    """Return texts as an Arrow string array."""
    encoded = [text.encode("utf-8", "replace") for text in texts]
    ends = np.cumsum([0, *map(len, encoded)], dtype=np.int32)
    return pa.StringArray.from_buffers(len(texts), pa.py_buffer(ends), pa.py_buffer(b"".join(encoded)))


def numbers_of(column: pa.ChunkedArray) -> FloatArray:
    """Return a numeric column as floats, shape (n,), NaN for nulls. Copied only if necessary."""
    if not pa.types.is_floating(column.type) or pa.types.is_float16(column.type):
        column = column.cast(pa.float64(), safe=False)
    kind = np.float32 if pa.types.is_float32(column.type) else np.float64
    parts = [_floats(chunk, kind) for chunk in column.chunks]
    if len(parts) == 1:
        return parts[0]
    found: FloatArray = np.concatenate(parts) if parts else np.empty(0, kind)
    return found


def _floats(chunk: pa.Array, kind: Any) -> FloatArray:
    known, numbers = chunk.buffers()
    first, count = chunk.offset, len(chunk)
    if not count or numbers is None:
        return np.full(count, np.nan, kind)
    found = np.frombuffer(numbers, kind, count, first * np.dtype(kind).itemsize)
    if not chunk.null_count or known is None:
        return found
    bits = np.unpackbits(np.frombuffer(known, np.uint8), count=first + count, bitorder="little")
    return np.where(bits[first:], found, kind(np.nan))


def whole_numbers_of(chunk: pa.Array) -> np.ndarray[Any, np.dtype[np.int32]]:
    """Return a 32-bit integer array without nulls, shape (n,), not copied."""
    if not len(chunk):
        return np.empty(0, np.int32)
    return np.frombuffer(chunk.buffers()[1], np.int32, len(chunk), chunk.offset * 4)


def whole_numbers(numbers: np.ndarray[Any, np.dtype[np.int64]]) -> pa.ChunkedArray:
    """Return 64-bit integers, shape (n,), as a column, not copied."""
    return pa.chunked_array([pa.Array.from_buffers(pa.int64(), len(numbers), [None, pa.py_buffer(numbers)])])


def unique_names(names: Sequence[str], notes: Notes) -> list[str]:
    """Return unique column names; renamed columns are noted."""
    unique: list[str] = []
    for at, name in enumerate(names, 1):
        wanted, again = name or f"column {at}", 2
        while wanted in unique:
            wanted, again = f"{name or f'column {at}'} ({again})", again + 1
        if name and wanted != name:
            notes.say(f"two columns are named {name!r}: the second is renamed to {wanted!r}")
        unique.append(wanted)
    return unique
