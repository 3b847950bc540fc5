"""Which columns of a table are time, name of the variable and values, and time columns in seconds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.errors import LogError, listed
from tuisim.logs.arrow import PER_S, numbers_of
from tuisim.logs.units import SECONDS
from tuisim.runs.arrays import FloatArray

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
        return _floats(wide) / PER_S[kind.unit]
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


ROW = ""
"""Instead of a time column: the samples are counted."""

_TEXT_TIMES = frozenset(NAMES) - {"index", "row"}

_VARIABLE_NAMES = ("variable", "name", "sensor", "channel", "signal", "key", "metric")
_VALUE_NAMES = ("value", "val", "y", "reading", "measurement")
_NO_VALUES = ("run", "line", "row", "x_mm", "y_mm", "heading_deg")
"""Columns of our own long frames that say where a sample comes from."""


@dataclass(frozen=True, slots=True)
class Layout:
    """What the columns mean."""

    time: str = ROW
    """Column with the time; `ROW` where the samples are only counted."""
    unit_s: float = 1.0
    """Seconds that a unit of the time column stands for."""
    since_first: bool = False
    """Whether the time column holds numbers that are dates, shown as the time since the first of them."""
    variable: str = ""
    """Column that names the variable of each row; empty where each column is a variable of its own."""
    values: tuple[str, ...] = ()
    """Columns with values; one if `variable` names them."""
    run: str = ""
    """Column that tells runs apart; empty if there is one run only."""
    sure: bool = True
    """Whether the names of the columns say so; otherwise the user is better asked."""


def is_numeric(kind: pa.DataType) -> bool:
    """Return whether a column holds numbers."""
    return bool(pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind))


def is_time(kind: pa.DataType) -> bool:
    """Return whether a column holds moments or spans of time."""
    return bool(pa.types.is_temporal(kind) and not pa.types.is_interval(kind))


def guess_columns(table: pa.Table) -> Layout:
    """Return what the columns seem to mean.

    The time is the column with the surest name, else one whose type says so, else the rows are counted.
    Only where no column has a name, the first one that rises is the time. A text column with a known name
    next to one called `value` names the variables; otherwise every other column of numbers is one.
    """
    names = table.column_names
    named = _named_time(table)
    time = named or _rising(table)
    run = "run" if "run" in names and is_numeric(table.schema.field("run").type) else ""
    variable = next((n for n in _VARIABLE_NAMES if n in names and is_text(table.schema.field(n).type)), "")
    value = next((n for n in _VALUE_NAMES if n in names and is_numeric(table.schema.field(n).type)), "")
    numeric = [n for n in names if is_numeric(table.schema.field(n).type) and n not in (time, run)]
    if variable and value and value != time:
        sure = bool(named) or not set(numeric) - {value, *_NO_VALUES}
        return _timed(Layout(time, 1.0, False, variable, (value,), run, sure), table)
    if value and value in numeric:
        kept = [n for n in numeric if n not in _NO_VALUES]
    else:
        # In a frame of every tick the pose is a value like any other.
        kept = [n for n in numeric if n not in ("line", "row")]
    # Of one column of numbers there is nothing to choose.
    sure = bool(named) or (len(numeric) < 2 and not time)
    return _timed(Layout(time, 1.0, False, "", tuple(kept or numeric), run, sure), table)


def _timed(layout: Layout, table: pa.Table, unit_s: float | None = None) -> Layout:
    """The same layout with the unit of its time column: a given one, else what name and size of the numbers say."""
    if not layout.time or not is_numeric(table.schema.field(layout.time).type):
        return replace(layout, unit_s=1.0, since_first=False)
    if unit_s is None:
        unit_s = time_name(layout.time).unit_s
    date_unit_s = unit_since_1970_s(table.column(layout.time), unit_s)
    if date_unit_s is not None:
        return replace(layout, unit_s=date_unit_s, since_first=True)
    return replace(layout, unit_s=1.0 if unit_s is None else unit_s, since_first=False)


def _named_time(table: pa.Table) -> str:
    """The column that by its name or type is the time, empty if there is none."""
    bases: dict[str, list[str]] = {}
    for name in table.column_names:
        bases.setdefault(time_name(name).base, []).append(name)
    found = next((n for wanted in NAMES for n in bases.get(wanted, ()) if _is_usable(table, n)), ROW)
    if found:
        return found
    compound = (
        n for n in table.column_names if has_time_word(n) and _is_usable(table, n) and _is_rising_time(table, n)
    )
    return next(compound, next((n for n in table.column_names if is_time(table.schema.field(n).type)), ROW))


def _is_rising_time(table: pa.Table, name: str) -> bool:
    return not is_numeric(table.schema.field(name).type) or _rises(table, name)


def unread_time(table: pa.Table, layout: Layout) -> str:
    """Return the column that should be the time by its name, but whose texts say none; empty if there is none."""
    if layout.time:
        return ""
    named = (name for name in table.column_names if time_name(name).base in _TEXT_TIMES)
    return next((name for name in named if is_text(table.schema.field(name).type)), "")


def time_in_words(layout: Layout) -> str:
    """Return which column is the time, for people."""
    if layout.time in (ROW, "row"):
        return "no column is a time: the rows are counted"
    unit = UNIT_NAMES.get(layout.unit_s, f"{layout.unit_s:g} s")
    return f"time is the column {layout.time!r}, in {unit}{' since 1970' if layout.since_first else ''}"


def _rising(table: pa.Table) -> str:
    """Where no column has a name, the first one if it rises; else nothing: the rows are counted."""
    names = table.column_names
    nameless = all(name == f"column {at}" for at, name in enumerate(names, 1))
    first = names[0] if nameless and len(names) > 1 else ROW
    return first if first and is_numeric(table.schema.field(first).type) and _rises(table, first) else ROW


def _is_usable(table: pa.Table, name: str) -> bool:
    """Whether a column holds times or numbers, at least one."""
    column = table.column(name)
    return column.null_count < table.num_rows and (is_numeric(column.type) or _is_moment(table, name))


def is_text(kind: pa.DataType) -> bool:
    """Return whether a column holds texts, also as codes."""
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _is_moment(table: pa.Table, name: str) -> bool:
    """Whether a column holds times, also as text in ISO form."""
    kind = table.schema.field(name).type
    if is_time(kind):
        return True
    if not is_text(kind) or not table.num_rows:
        return False

    return bool(np.isfinite(seconds_of_texts(table.column(name).slice(0, 20))).any())


def _rises(table: pa.Table, name: str) -> bool:
    column = table.column(name)
    if column.null_count or table.num_rows < 2:
        return False
    # Compared, not subtracted: what is infinite has no difference.
    numbers = numbers_of(column)
    return bool((numbers[1:] > numbers[:-1]).all())


def choose_columns(table: pa.Table, time: str | None, values: Sequence[str], unit: str = "") -> Layout:
    """Return what the columns mean where the user names some of them.

    Args:
        table: The log.
        time: Column with the time; empty to count the rows; None to guess.
        values: Columns with values; none to guess.
        unit: Of a time column that holds numbers, one of `SECONDS`; empty to guess it by the column's name.

    Raises:
        LogError: there is no such column, or it holds no numbers.
    """
    layout = guess_columns(table)
    if time is not None:
        if time:
            _require(table, time)
        values = values or [n for n in layout.values if n != time]
        layout = replace(layout, time=time, sure=True)
    if values and tuple(values) != layout.values:
        for name in values:
            _require(table, name)
            if not is_numeric(table.schema.field(name).type):
                raise LogError(f"column {name!r} holds no numbers")
        keep = layout.variable if len(values) == 1 and layout.variable else ""
        layout = replace(layout, variable=keep, values=tuple(values), sure=True)
    return _timed(layout, table, SECONDS[unit] if unit else None)


def _require(table: pa.Table, name: str) -> None:
    if name not in table.column_names:
        near = get_close_matches(name, table.column_names, 1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise LogError(f"no column {name!r}", f"{hint}there are {listed(table.column_names)}")
