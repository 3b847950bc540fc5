"""Lossless compression of recordings: column by column, as differences of successive numbers, byte by byte.

Numbers are subtracted as integers of their bits, so that every bit comes back on every machine. Output rows are stored
the same way, then all their texts.
"""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np

from tuisim.core.tick_record import TICK_FIELDS
from tuisim.runs.records import OUTPUT_ROW

Column = np.ndarray[Any, Any]

TICK = np.dtype(list(TICK_FIELDS))
"""Type of a tick record."""

LEVEL = 6
"""Compression level of zlib; higher ones take twice as long and gain 1 %."""

HEAD_FIELDS = (
    ("size", "<u4"),
    ("tick", "<u4"),
    ("time_ns", "<u8"),
    ("line", "<u4"),
    ("stream", "u1"),
    ("spare", "V3"),
)
"""Name and numpy type of each field of `records.OUTPUT_ROW`."""
HEAD_COLUMNS = tuple(name for name, kind in HEAD_FIELDS if not kind.startswith("V"))
ROWS_AT_ONCE = 1 << 16


# Columns


def folded(values: Column) -> bytes:
    """Return a column as the differences of the bits of each number and its predecessor, modulo their range.

    First come the lowest bytes of all differences, then the next bytes of all, and so on.
    """
    bits = np.ascontiguousarray(values).view(f"<u{values.dtype.itemsize}")
    changes = np.concatenate((bits[:1], bits[1:] - bits[:-1]))
    return changes.view(np.uint8).reshape(len(changes), values.dtype.itemsize).T.tobytes()


class Source:
    """A reader for bytes, from the beginning on."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def number(self) -> int:
        """Read an integer of four bytes.

        Raises:
            ValueError: too few bytes are left; also raised by the other methods.
        """
        return int.from_bytes(self._bytes(4), "little")

    def column(self, count: int, kind: np.dtype[Any]) -> Column:
        """Read a column written by the function `folded`, shape (count,)."""
        raw = np.frombuffer(self._bytes(count * kind.itemsize), np.uint8).reshape(
            kind.itemsize, count
        )
        changes = np.ascontiguousarray(raw.T).reshape(-1).view(f"<u{kind.itemsize}")
        return np.add.accumulate(changes, dtype=changes.dtype).view(kind)

    def rest(self) -> bytes:
        """Read the remaining bytes."""
        return self._bytes(len(self._data) - self._at)

    def _bytes(self, size: int) -> bytes:
        piece = self._data[self._at : self._at + size]
        if len(piece) != size:
            raise ValueError("its end is missing")
        self._at += size
        return piece


def _source(data: bytes) -> Source:
    try:
        return Source(zlib.decompress(data))
    except zlib.error as error:
        raise ValueError(str(error)) from error


# Tick records


def fold_ticks(data: bytes) -> bytes:
    """Compress tick records, as in a telemetry file without its header."""
    records = np.frombuffer(data, TICK)
    return zlib.compress(b"".join(folded(records[name]) for name, _ in TICK_FIELDS), LEVEL)


def unfold_ticks(data: bytes, count: int) -> bytes:
    """Return the original records, from the result of `fold_ticks`.

    Raises:
        ValueError: the bytes are damaged.
    """
    source = _source(data)
    records = np.zeros(count, TICK)
    for name, _ in TICK_FIELDS:
        records[name] = source.column(count, TICK[name])
    return records.tobytes()


# Output rows


def fold_rows(data: bytes) -> bytes:
    """Compress complete rows, as in an output file without its header.

    Raises:
        ValueError: the last row is incomplete.
    """
    heads, texts, at = [], [], 0
    while at < len(data):
        text_at = at + OUTPUT_ROW.size
        heads.append(data[at:text_at])
        at = text_at + int.from_bytes(data[at : at + 4], "little")
        texts.append(data[text_at:at])
    if at != len(data):
        raise ValueError("the last row is incomplete")
    table = np.frombuffer(b"".join(heads), np.dtype(list(HEAD_FIELDS)))
    columns = [folded(table[name]) for name in HEAD_COLUMNS]
    return zlib.compress(b"".join([len(heads).to_bytes(4, "little"), *columns, *texts]), LEVEL)


def unfold_rows(data: bytes) -> bytes:
    """Return the original rows.

    Raises:
        ValueError: the bytes are damaged.
    """
    source = _source(data)
    count = source.number()
    table = np.zeros(count, np.dtype(list(HEAD_FIELDS)))
    for name, kind in HEAD_FIELDS[: len(HEAD_COLUMNS)]:
        table[name] = source.column(count, np.dtype(kind))
    text = source.rest()
    if int(table["size"].sum(dtype=np.int64)) != len(text):
        raise ValueError("its rows have another length than their texts")
    pieces, used = [], 0
    for first in range(0, count, ROWS_AT_ONCE):
        heads = table[first : first + ROWS_AT_ONCE]
        size = int(heads["size"].sum(dtype=np.int64))
        pieces.append(_rows(heads, text[used : used + size]))
        used += size
    return b"".join(pieces)


def _rows(heads: Column, text: bytes) -> bytes:
    """Return rows: each head followed by its part of the text."""
    whole = OUTPUT_ROW.size + heads["size"].astype(np.int64)
    places = (np.cumsum(whole) - whole)[:, None] + np.arange(OUTPUT_ROW.size)
    rows = np.empty(int(whole.sum()), np.uint8)
    of_text = np.ones(len(rows), np.bool_)
    of_text[places] = False
    rows[places] = np.ascontiguousarray(heads).view(np.uint8).reshape(len(heads), OUTPUT_ROW.size)
    rows[of_text] = np.frombuffer(text, np.uint8)
    return rows.tobytes()
