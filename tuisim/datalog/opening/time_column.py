"""What the name and the size of a column say about it as a time."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa

from tuisim.datalog.opening.plain import numbers_of

NAMES = (
    "time", "t", "seconds", "secs", "sec", "elapsed", "timestamp", "datetime", "date", "ts", "clock", "epoch",
    "zeit", "temps", "tiempo", "tempo", "minutes", "millis", "milliseconds", "ms", "micros", "microseconds", "us",
    "nanos", "nanoseconds", "ns", "index", "row",
)  # fmt: skip
"""Names of time columns, the surest first."""
_WORDS = frozenset({"time", "timestamp", "datetime", "elapsed", "stamp"})
"""A column with one of these among the words of its name is a time if it rises, too: `sim_time`, `Time Stamp`."""

_UNIT_WORDS_S = {
    1.0: ("s", "sec", "secs", "second", "seconds"),
    1e-3: ("ms", "msec", "msecs", "millis", "millisecond", "milliseconds"),
    1e-6: ("us", "µs", "μs", "usec", "usecs", "micros", "microsecond", "microseconds"),
    1e-9: ("ns", "nsec", "nsecs", "nanos", "nanosecond", "nanoseconds"),
    60.0: ("min", "mins", "minute", "minutes"),
    3600.0: ("h", "hour", "hours"),
}
_UNITS_S = {word: seconds for seconds, words in _UNIT_WORDS_S.items() for word in words}
_UNIT = re.compile(
    r"(?:[ _]*[(\[](?P<bracket>[^)\]]*)[)\]]|\s*/\s*(?P<slash>[^\W\d_]+)|[_ ](?:in[_ ])?(?P<end>[^\W\d_]+))$"
)
"""How a name ends with its unit: `time (ms)`, `Time [s]`, `t/s`, `timestamp_ms`, `time in ms`."""
_SINCE_1970_S = (6.3e8, 4.2e9)
"""Seconds since 1970 of the years 1990 to 2103: times of this size are dates."""
UNIT_NAMES = {
    1.0: "seconds",
    1e-3: "milliseconds",
    1e-6: "microseconds",
    1e-9: "nanoseconds",
    60.0: "minutes",
    3600.0: "hours",
}
"""Units of times by their seconds."""


class TimeName(NamedTuple):
    """A name of a column, taken apart."""

    base: str
    """Lower case, without its unit and without signs around it."""
    unit_s: float | None
    """Seconds that its unit stands for, None if it names none."""


def time_name(name: str) -> TimeName:
    """Return the name without its unit, and the unit; a name such as `ms` is its own unit."""
    text = name.strip().lower()
    found = _UNIT.search(text)
    unit_s = None
    if found is not None and found.start() > 0:
        word = next(part for part in found.groups() if part is not None).strip()
        unit_s = _UNITS_S.get(word)
        if unit_s is not None or found["bracket"] is not None:
            text = text[: found.start()]
    base = text.strip(" #%@._/\"'")
    return TimeName(base, _UNITS_S.get(base) if unit_s is None else unit_s)


def has_time_word(name: str) -> bool:
    """Return whether one of the words of a name stands for a time."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return not _WORDS.isdisjoint(re.split(r"[\W_]+", spaced.lower()))


def unit_since_1970_s(column: pa.ChunkedArray, unit_s: float | None) -> float | None:
    """Return the unit of a column of numbers that are dates, counted from the beginning of 1970.

    Args:
        column: Numbers.
        unit_s: Seconds that one stands for; None if nothing but its size says so.

    Returns:
        Seconds that one stands for; None if the numbers are no dates.
    """
    first = _first(column)
    units: tuple[float, ...] = (1.0, 1e-3, 1e-6, 1e-9) if unit_s is None else (unit_s,)
    return next((unit for unit in units if _SINCE_1970_S[0] <= first * unit <= _SINCE_1970_S[1]), None)


def _first(column: pa.ChunkedArray) -> float:
    chunk: Any
    for chunk in column.chunks:
        numbers = numbers_of(pa.chunked_array([chunk.slice(0, 1000)]))
        known = numbers[np.isfinite(numbers)]
        if len(known):
            return float(known[0])
    return 0.0
