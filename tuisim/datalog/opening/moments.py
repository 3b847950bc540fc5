"""Time columns as seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.datalog.arrays import FloatArray
from tuisim.datalog.opening.plain import numbers_of

_SPAN = r"^(?P<sign>-?)(?:(?P<days>\d+) days? )?(?P<h>\d+):(?P<m>\d{2}):(?P<s>\d{2}(?:\.\d+)?)$"
"""A span as pandas prints it, or hours, minutes and seconds."""


def seconds_of(column: pa.ChunkedArray, unit_s: float) -> FloatArray:
    """Return a time column in seconds, shape (n,): dates since the first of them, numbers times their unit.

    Args:
        column: Numbers, moments, spans of time, or texts that say one.
        unit_s: Seconds that one stands for, if they are numbers.
    """
    kind = column.type
    if pa.types.is_duration(kind) or pa.types.is_timestamp(kind):
        per_s = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}[kind.unit]
        return _since_first(_floats(column.cast(pa.int64())) / per_s, pa.types.is_timestamp(kind))
    if pa.types.is_temporal(kind):
        return _since_first(_floats(column.cast(pa.timestamp("ns")).cast(pa.int64())) / 1e9, True)
    if pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_dictionary(kind):
        return seconds_of_texts(column)
    seconds = _floats(column)
    return seconds if unit_s == 1.0 else seconds * unit_s


def _since_first(seconds: FloatArray, from_first: bool) -> FloatArray:
    known = seconds[np.isfinite(seconds)]
    return seconds - known[0] if from_first and len(known) else seconds


def _floats(column: pa.ChunkedArray) -> FloatArray:
    return np.asarray(numbers_of(column), np.float64)


def seconds_of_texts(column: pa.ChunkedArray) -> FloatArray:
    """Return texts in seconds: spans as they are, dates since the first; not a number for what is neither."""
    texts: Any = column.cast(pa.string())
    spans: Any = pc.extract_regex(texts, _SPAN)
    parts = {}
    for name, seconds in (("days", 86400.0), ("h", 3600.0), ("m", 60.0), ("s", 1.0)):
        field = pc.struct_field(spans, name)
        # Where the days are not mentioned the text is empty, where nothing matches it is null.
        field = pc.if_else(pc.equal(field, ""), "0", field)
        parts[name] = np.asarray(pc.cast(field, pa.float64()).to_numpy(), np.float64) * seconds
    total: FloatArray = parts["days"] + parts["h"] + parts["m"] + parts["s"]
    minus = np.asarray(pc.fill_null(pc.equal(pc.struct_field(spans, "sign"), "-"), False).to_numpy(), bool)
    total[minus] *= -1.0
    if np.isfinite(total).any():
        return total
    dates = pc.strptime(pc.utf8_slice_codeunits(pc.replace_substring(texts, "T", " "), 0, 19),
                        format="%Y-%m-%d %H:%M:%S", unit="ns", error_is_null=True)  # fmt: skip
    if dates.null_count == len(dates):
        return np.full(len(texts), np.nan)
    # What follows the seconds, such as .250, is added; a time zone is not looked at.
    rest: Any = pc.struct_field(pc.extract_regex(texts, r":\d{2}(?P<part>\.\d+)"), "part")
    parts_s = np.nan_to_num(np.asarray(pc.cast(rest, pa.float64()).to_numpy(), np.float64))
    whole = np.asarray(pc.cast(dates.cast(pa.int64()), pa.float64(), safe=False).to_numpy(), np.float64) / 1e9
    return _since_first(whole + parts_s, True)
