"""Compression of output rows: their heads column by column, then all their texts."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING, Any

from tuisim.runs.packed.byte_planes import Source, changes, planes, summed
from tuisim.runs.records import OUTPUT_ROW

if TYPE_CHECKING:
    import numpy as np

HEAD_FIELDS = (("size", "<u4"), ("tick", "<u4"), ("time_ns", "<u8"), ("line", "<u4"), ("stream", "u1"), ("spare", "V3"))
"""Name and numpy type of each field of `records.OUTPUT_ROW`."""
COLUMNS = tuple(name for name, kind in HEAD_FIELDS if not kind.startswith("V"))
ROWS_AT_ONCE = 1 << 16
LEVEL = 6
"""Compression level of zlib."""


def fold(data: bytes) -> bytes:
    """Compress complete rows.

    Args:
        data: Rows as in an output file, without its header.

    Raises:
        ValueError: the last row is incomplete.
    """
    import numpy as np

    heads, texts, at = [], [], 0
    while at < len(data):
        text_at = at + OUTPUT_ROW.size
        heads.append(data[at:text_at])
        at = text_at + int.from_bytes(data[at : at + 4], "little")
        texts.append(data[text_at:at])
    if at != len(data):
        raise ValueError("the last row is torn")
    table = np.frombuffer(b"".join(heads), np.dtype(list(HEAD_FIELDS)))
    columns = [planes(changes(table[name])) for name in COLUMNS]
    return zlib.compress(b"".join([len(heads).to_bytes(4, "little"), *columns, *texts]), LEVEL)


def unfold(data: bytes) -> bytes:
    """Return the original rows.

    Raises:
        ValueError: the bytes are damaged.
    """
    import numpy as np

    try:
        source = Source(zlib.decompress(data))
    except zlib.error as error:
        raise ValueError(str(error)) from error
    count = source.number()
    table = np.zeros(count, np.dtype(list(HEAD_FIELDS)))
    for name, kind in HEAD_FIELDS[: len(COLUMNS)]:
        table[name] = summed(source.planes(count, kind))
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


def _rows(heads: np.ndarray[Any, Any], text: bytes) -> bytes:
    """Return rows: each head followed by its part of the text."""
    import numpy as np

    whole = OUTPUT_ROW.size + heads["size"].astype(np.int64)
    places = (np.cumsum(whole) - whole)[:, None] + np.arange(OUTPUT_ROW.size)
    rows = np.empty(int(whole.sum()), np.uint8)
    of_text = np.ones(len(rows), np.bool_)
    of_text[places] = False
    rows[places] = np.ascontiguousarray(heads).view(np.uint8).reshape(len(heads), OUTPUT_ROW.size)
    rows[of_text] = np.frombuffer(text, np.uint8)
    return rows.tobytes()
