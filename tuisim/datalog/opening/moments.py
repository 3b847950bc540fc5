"""Time columns as seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.datalog.arrays import FloatArray
from tuisim.datalog.opening.plain import numbers_of

_PER_S = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
_SPAN = r"^(?P<sign>-?)(?:(?P<days>\d+) days? )?(?P<h>\d+):(?P<m>\d{2}):(?P<s>\d{2}(?:\.\d+)?)$"
"""A span as pandas prints it, or hours, minutes and seconds."""
_REST = r":\d{2}(?P<part>\.\d+)? ?(?:(?P<sign>[+-])(?P<h>\d{2}):?(?P<m>\d{2})|Z|UTC)?$"
"""Parts of a second, and how far a clock is ahead of the world's."""


def seconds_of(column: pa.ChunkedArray, unit_s: float, since_first: bool = False) -> FloatArray:
    """Return a time column in seconds, shape (n,): dates since the first of them, numbers times their unit.

    Args:
        column: Numbers, moments, spans of time, or texts that say one.
        unit_s: Seconds that one stands for, if they are numbers.
        since_first: Whether numbers are dates, too.
    """
    kind = column.type
    if pa.types.is_date(kind):
        column, kind = column.cast(pa.timestamp("s")), pa.timestamp("s")
    if pa.types.is_temporal(kind):
        # From 32 bits there is no way to a number but that of its own size.
        wide: Any = column.cast(pa.int32()).cast(pa.int64()) if pa.types.is_time32(kind) else column.cast(pa.int64())
        if pa.types.is_timestamp(kind):
            # Before they become floats, which have no digits left for parts of a date in nanoseconds.
            wide = pc.subtract(wide, pc.first(wide))
        return _floats(wide) / _PER_S[kind.unit]
    if pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_dictionary(kind):
        return seconds_of_texts(column)
    if since_first and pa.types.is_integer(kind):
        # Before they become floats, as above.
        column = pc.subtract(column.cast(pa.int64()), pc.first(column.cast(pa.int64())))
    seconds = _since_first(_floats(column)) if since_first else _floats(column)
    return seconds if unit_s == 1.0 else seconds * unit_s


def _since_first(seconds: FloatArray) -> FloatArray:
    known = seconds[np.isfinite(seconds)]
    return seconds - known[0] if len(known) else seconds


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
    return _seconds_of_dates(texts)


def _seconds_of_dates(texts: Any) -> FloatArray:
    texts = pc.replace_substring_regex(texts, r"^(\d{4}-\d{2}-\d{2})$", r"\1 00:00")
    texts = pc.replace_substring_regex(texts, r"^(\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2})($|[^:\d])", r"\1:00\2")
    dates = pc.strptime(pc.utf8_slice_codeunits(pc.replace_substring(texts, "T", " "), 0, 19),
                        format="%Y-%m-%d %H:%M:%S", unit="s", error_is_null=True)  # fmt: skip
    if dates.null_count == len(dates):
        return np.full(len(texts), np.nan)
    # What follows the seconds, such as .250+02:00.
    rest: Any = pc.extract_regex(texts, _REST)
    part, sign, hours, minutes = (pc.struct_field(rest, name) for name in ("part", "sign", "h", "m"))
    ahead_s = 3600.0 * _filled(hours) + 60.0 * _filled(minutes)
    ahead_s[np.asarray(pc.fill_null(pc.equal(sign, "-"), False).to_numpy(), bool)] *= -1.0
    whole: Any = dates.cast(pa.int64())
    whole_s = _floats(pc.subtract(whole, pc.first(whole)))
    return _since_first(whole_s + (_filled(part) - ahead_s))


def _filled(texts: Any) -> FloatArray:
    """Texts as numbers, 0 for what is empty."""
    return np.array(pc.cast(pc.if_else(pc.equal(texts, ""), "0", texts).fill_null("0"), pa.float64()).to_numpy())
