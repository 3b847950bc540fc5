"""Which columns of a table are time, name of the variable and values, and time columns in seconds."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.arrow import PER_S, convert_to_floats
from tuisim.logs.choices import ReadChoices
from tuisim.logs.dates import SPAN, is_moment, normalize_dates, order_is_guessed
from tuisim.logs.units import SECONDS

if TYPE_CHECKING:
    import pandas as pd

NAMES = (
    "time",
    "t",
    "seconds",
    "secs",
    "sec",
    "elapsed",
    "timestamp",
    "datetime",
    "date",
    "ts",
    "clock",
    "epoch",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "minutes",
    "millis",
    "milliseconds",
    "ms",
    "micros",
    "microseconds",
    "us",
    "nanos",
    "nanoseconds",
    "ns",
    "index",
    "row",
)
"""Names of time columns, the most certain first."""
_WORDS = frozenset(
    {"time", "timestamp", "datetime", "elapsed", "stamp", "clock", "timer", "uptime", "zeit"}
)
"""A rising column with one of these words in its name is a time, too: `sim_time`, `brick clock (ms)`."""

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
"""The unit at the end of a name: `time (ms)`, `Time [s]`, `t/s`, `timestamp_ms`, `time in ms`."""
_LONGEST_UNIT = 200
"""Characters at the end of a name in which a unit is looked for: a search takes their square."""
_SINCE_1970_S = (6.3e8, 4.2e9)
"""Seconds since 1970 of the years 1990 to 2103: times of this size are dates."""
UNIT_NAMES = {seconds: words[-1] for seconds, words in _UNIT_WORDS_S.items()}
"""Names of units of time by their seconds."""


class TimeName(NamedTuple):
    """A column name, split into its base and its unit of time."""

    base: str
    """Lower case, without its unit and without surrounding punctuation."""
    unit_s: float | None
    """Its unit in seconds, None if it has none."""


def parse_time_name(name: str) -> TimeName:
    """Return the name without its unit, and the unit; a name such as `ms` is its own unit."""
    text = name.strip().lower()
    match = _UNIT.search(text, max(0, len(text) - _LONGEST_UNIT))
    unit_s = None
    if match is not None and match.start() > 0:
        word = next(part for part in match.groups() if part is not None).strip()
        unit_s = _UNITS_S.get(word)
        if unit_s is not None or match["bracket"] is not None:
            text = text[: match.start()]
    base = text.strip(" #%@._/\"'")
    return TimeName(base, _UNITS_S.get(base) if unit_s is None else unit_s)


def has_time_word(name: str) -> bool:
    """Return whether one of the words of a name means a time, or its unit in brackets: `since start (s)`."""
    if name.endswith((")", "]")) and parse_time_name(name).unit_s is not None:
        return True
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return not _WORDS.isdisjoint(re.split(r"[\W_]+", spaced.lower()))


def find_epoch_unit_s(column: pa.ChunkedArray, unit_s: float | None) -> float | None:
    """Return the unit in seconds of numbers that are times since the beginning of 1970; None if they are not.

    Args:
        unit_s: The unit, if it is known; None guesses it from the size of the numbers.
    """
    first = _find_first(column)
    units: tuple[float, ...] = (1.0, 1e-3, 1e-6, 1e-9) if unit_s is None else (unit_s,)
    return next(
        (unit for unit in units if _SINCE_1970_S[0] <= first * unit <= _SINCE_1970_S[1]), None
    )


def _find_first(column: pa.ChunkedArray) -> float:
    chunk: Any
    for chunk in column.chunks:
        numbers = convert_to_floats(pa.chunked_array([chunk.slice(0, 1000)]))
        known = numbers[np.isfinite(numbers)]
        if len(known):
            return float(known[0])
    return 0.0


_DAY_S = 86400.0
_COUNTER = 2.0**32
"""After as many milliseconds or microseconds the counter of a microcontroller begins again."""
_NO_ROWS: IntArray = np.empty(0, np.int64)


class Times(NamedTuple):
    """A time column in seconds."""

    seconds: FloatArray
    """Shape (n,); NaN where there is no time."""
    wraps: IntArray = _NO_ROWS
    """Rows, from 0, in which a clock or a counter began again at 0; from there on its period is added."""
    period: str = ""
    """The period in words, if there are wraps."""


def read_seconds(column: pa.ChunkedArray, unit_s: float, since_first: bool = False) -> FloatArray:
    """Return a time column in seconds, as `read_times`."""
    return read_times(column, unit_s, since_first).seconds


def read_times(column: pa.ChunkedArray, unit_s: float, since_first: bool) -> Times:
    """Return a time column in seconds: dates since the first of them, numbers times their unit.

    Args:
        column: Numbers, dates, time spans, or texts with dates or time spans.
        unit_s: Unit of numbers in seconds.
        since_first: Whether numbers are dates, too, and count from the first.
    """
    kind = column.type
    if pa.types.is_date(kind):
        column = column.cast(pa.timestamp("s"))
        kind = pa.timestamp("s")
    if pa.types.is_temporal(kind):
        # Arrow casts 32-bit times only to integers of the same size.
        wide: Any = (
            column.cast(pa.int32()).cast(pa.int64())
            if pa.types.is_time32(kind)
            else column.cast(pa.int64())
        )
        if pa.types.is_timestamp(kind):
            # Subtracted as integers: floats have no digits left for nanoseconds since 1970.
            wide = pc.subtract(wide, pc.first(wide))
        return Times(_read_floats(wide) / PER_S[kind.unit])
    if pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_dictionary(kind):
        return parse_times(column)
    if since_first and pa.types.is_integer(kind):
        # Subtracted as integers, as above.
        column = pc.subtract(column.cast(pa.int64()), pc.first(column.cast(pa.int64())))
    if since_first:
        return Times(_subtract_first(_read_floats(column)) * unit_s)
    times = _unwrap(_read_floats(column), _COUNTER, "2³²")
    return times if unit_s == 1.0 else times._replace(seconds=times.seconds * unit_s)


def _unwrap(seconds: FloatArray, period: float, words: str) -> Times:
    """Return times to which a period is added each time that their clock or counter begins again at 0.

    Args:
        period: That of the clock or counter, in the unit of the times.
        words: The period in words.
    """
    with np.errstate(invalid="ignore"):
        if not len(seconds) or not 0.9 * period < np.nanmax(seconds, initial=0.0) < period:
            return Times(seconds)
        wraps = np.flatnonzero(np.diff(seconds) < -0.8 * period) + 1
    if not len(wraps):
        return Times(seconds)
    rounds = np.zeros(len(seconds))
    rounds[wraps] = period
    return Times(seconds + np.cumsum(rounds), wraps, words)


def _subtract_first(seconds: FloatArray) -> FloatArray:
    known = seconds[np.isfinite(seconds)]
    return seconds - known[0] if len(known) else seconds


def _read_floats(column: pa.ChunkedArray) -> FloatArray:
    return np.asarray(convert_to_floats(column), np.float64)


def parse_times(column: pa.ChunkedArray) -> Times:
    """Return texts as times: spans and times of day as they are, dates since the first; NaN for other texts."""
    import pandas as pd

    texts = normalize_dates(column.cast(pa.string()))
    spans = texts.filter(pc.match_substring_regex(texts, SPAN)).to_pandas()
    if not len(spans):
        dates = pd.to_datetime(texts.to_pandas(), format="ISO8601", utc=True, errors="coerce")
        return Times(_count_seconds(dates - dates.bfill().iloc[0]))
    cells = texts.to_pandas()
    seconds = _count_seconds(pd.to_timedelta(cells.where(cells.isin(spans)), errors="coerce"))
    return Times(seconds) if spans.str.contains("day").any() else _unwrap(seconds, _DAY_S, "a day")


def _count_seconds(spans: pd.Series) -> FloatArray:
    return np.asarray(spans.dt.total_seconds(), np.float64)


_MAX_TIMES = 500
"""More columns are too many to choose from one by one."""
ROW = ""
"""In place of a time column: the samples are counted."""

_JUDGED_CELLS = 20
COUNTS = ("index", "row")
"""Names of columns that count the samples."""
_TEXT_TIMES = frozenset(NAMES) - {*COUNTS}

_VARIABLE_NAMES = (
    "variable",
    "name",
    "sensor",
    "channel",
    "signal",
    "key",
    "metric",
    "entry",
    "topic",
    "field",
)
_VALUE_NAMES = ("value", "val", "y", "reading", "measurement")
_NO_VALUES = ("run", "line", "row", "x_mm", "y_mm", "heading_deg")
"""Columns of our own long frames with the origin of a sample."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Which columns of a table are the time, the variable, the values and the run."""

    time: str = ROW
    """Column with the time; `ROW` if the samples are counted."""
    unit_s: float = 1.0
    """Unit of the time column in seconds."""
    since_first: bool = False
    """Whether the time column has numbers that are dates, shown as the time since the first one."""
    variable: str = ""
    """Column with the variable of each row; empty if each column is a variable."""
    values: tuple[str, ...] = ()
    """Columns with values; only one if there is a `variable` column."""
    run: str = ""
    """Column with the number of the run; empty if there is only one run."""
    sure: bool = True
    """Whether the names of the columns are clear; otherwise the user should be asked."""


def is_numeric(kind: pa.DataType) -> bool:
    """Return whether a type is numeric."""
    return bool(
        pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)
    )


def list_numeric_columns(schema: pa.Schema) -> list[str]:
    """Return the names of the numeric columns."""
    return [field.name for field in schema if is_numeric(field.type)]


def is_time(kind: pa.DataType) -> bool:
    """Return whether a type is a date, a time or a time span."""
    return bool(pa.types.is_temporal(kind) and not pa.types.is_interval(kind))


def time_columns(table: pa.Table) -> list[str]:
    """Return the names of the columns that can be the time."""
    names = table.column_names[:_MAX_TIMES]
    return [n for n in names if is_numeric(table.field(n).type) or _is_moment(table, n)]


def guess_columns(table: pa.Table) -> Layout:
    """Guess the roles of the columns from their names and types.

    The time is the column with the most certain name, else one with a type for times, else the rows are counted.
    If no column has a name, the first one is the time if it rises. A text column with a known name next to a
    column `value` has the variables; otherwise every other numeric column is a variable.
    """
    names = table.column_names
    named = _find_named_time(table)
    time = named or _find_rising(table)
    run = "run" if "run" in names and is_numeric(table.field("run").type) else ""
    variable = _find_named(table, _VARIABLE_NAMES, is_text)
    value = _find_named(table, _VALUE_NAMES, is_numeric)
    numeric = [n for n in names if is_numeric(table.field(n).type) and n not in (time, run)]
    if variable and value and value != time:
        sure = bool(named) or not set(numeric) - {value, *_NO_VALUES}
        return _set_time_unit(Layout(time, 1.0, False, variable, (value,), run, sure), table)
    if value and value in numeric:
        value_columns = [n for n in numeric if n not in _NO_VALUES]
    else:
        # In telemetry, the pose is a value like any other.
        value_columns = [n for n in numeric if n not in ("line", "row")]
    # With a single numeric column, there is no choice.
    sure = bool(named) or (len(numeric) < 2 and not time)
    return _set_time_unit(
        Layout(time, 1.0, False, "", tuple(value_columns or numeric), run, sure), table
    )


def _find_named(table: pa.Table, names: Sequence[str], fits: Callable[[pa.DataType], bool]) -> str:
    """Return the column with the first of the names, in upper or lower case, if its type fits; empty if none has."""
    columns = {field.name.strip().lower(): field.name for field in table.schema if fits(field.type)}
    return next((columns[name] for name in names if name in columns), "")


def _set_time_unit(layout: Layout, table: pa.Table, unit_s: float | None = None) -> Layout:
    """Return a layout with the unit of its time column: as given, or guessed from name and size of the numbers."""
    if not layout.time or not is_numeric(table.field(layout.time).type):
        return replace(layout, unit_s=1.0, since_first=False)
    if unit_s is None:
        unit_s = parse_time_name(layout.time).unit_s
    date_unit_s = find_epoch_unit_s(table.column(layout.time), unit_s)
    if date_unit_s is not None:
        return replace(layout, unit_s=date_unit_s, since_first=True)
    return replace(layout, unit_s=1.0 if unit_s is None else unit_s, since_first=False)


def _find_named_time(table: pa.Table) -> str:
    """Return the column that is the time by its name or type, empty if there is none."""
    bases: dict[str, list[str]] = {}
    for name in table.column_names:
        bases.setdefault(parse_time_name(name).base, []).append(name)
    column = next(
        (n for time_word in NAMES for n in bases.get(time_word, ()) if _is_usable(table, n)), ROW
    )
    if column:
        return column
    compound = (
        n
        for n in table.column_names
        if has_time_word(n) and _is_usable(table, n) and _is_rising_time(table, n)
    )
    by_type = (n for n in table.column_names if is_time(table.field(n).type))
    by_content = find_texts(table, is_moment)
    return next((name for names in (compound, by_type, by_content) for name in names), ROW)


def find_texts(table: pa.Table, fits: Callable[[str], bool]) -> Iterator[str]:
    """Yield the columns of texts whose first cells all fit; less than half of these cells may be missing."""
    for field in table.schema:
        if is_text(field.type):
            cells = table.column(field.name).slice(0, _JUDGED_CELLS).cast(pa.string())
            texts = list(filter(str.strip, cells.drop_null().to_pylist()))
            if 2 * len(texts) > len(cells) and all(map(fits, texts)):
                yield field.name


def _is_rising_time(table: pa.Table, name: str) -> bool:
    return not is_numeric(table.field(name).type) or _is_rising(table, name)


def find_unread_time(table: pa.Table, layout: Layout) -> str:
    """Return the column of texts with the name of a time, if no column could be read as the time; otherwise empty."""
    if layout.time:
        return ""
    named = (name for name in table.column_names if parse_time_name(name).base in _TEXT_TIMES)
    return next((name for name in named if is_text(table.field(name).type)), "")


def has_guessed_order(table: pa.Table, layout: Layout) -> bool:
    """Return whether the times are dates such as 03/04/2024, whose first number is only guessed to be the day."""
    if not layout.time or not is_text(table.field(layout.time).type):
        return False
    return order_is_guessed(table.column(layout.time).cast(pa.string()))


def time_in_words(layout: Layout) -> str:
    """Return a sentence on which column is the time."""
    if layout.time in (ROW, "row"):
        return "no time column: row numbers from 0 are used"
    unit = UNIT_NAMES.get(layout.unit_s, f"{layout.unit_s:g} s")
    return f"time is the column {layout.time!r}, in {unit}{' since 1970' if layout.since_first else ''}"


def _find_rising(table: pa.Table) -> str:
    """Return the first column if no column has a name, and its numbers rise; else `ROW`."""
    names = table.column_names
    nameless = all(name == f"column {number}" for number, name in enumerate(names, 1))
    first = names[0] if nameless and len(names) > 1 else ROW
    return (
        first if first and is_numeric(table.field(first).type) and _is_rising(table, first) else ROW
    )


def _is_usable(table: pa.Table, name: str) -> bool:
    """Return whether a column has at least one time or number."""
    column = table.column(name)
    return column.null_count < table.num_rows and (
        is_numeric(column.type) or _is_moment(table, name)
    )


def is_text(kind: pa.DataType) -> bool:
    """Return whether a type is text, also dictionary-encoded."""
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _is_moment(table: pa.Table, name: str) -> bool:
    """Return whether a column has times, also as ISO texts."""
    kind = table.field(name).type
    if is_time(kind):
        return True
    if not is_text(kind) or not table.num_rows:
        return False
    return bool(np.isfinite(parse_times(table.column(name).slice(0, _JUDGED_CELLS)).seconds).any())


def _is_rising(table: pa.Table, name: str) -> bool:
    column = table.column(name)
    if column.null_count or table.num_rows < 2:
        return False
    # Compared, not subtracted: infinite values have no difference.
    numbers = convert_to_floats(column)
    return bool((numbers[1:] > numbers[:-1]).all())


def choose_columns(table: pa.Table, choices: ReadChoices) -> Layout:
    """Return the roles of the columns; the user may have chosen some of them.

    Raises:
        LogError: there is no such column, or it is not numeric.
    """
    layout = guess_columns(table)
    time = choices.time
    values = choices.value
    if time is not None:
        if time:
            _require(table, time)
        values = values or tuple(n for n in layout.values if n != time)
        layout = replace(layout, time=time, sure=True)
    if values and values != layout.values:
        for name in values:
            _require(table, name)
            if not is_numeric(table.field(name).type):
                raise LogError(f"column {name!r} is not numeric")
        keep = layout.variable if len(values) == 1 and layout.variable else ""
        layout = replace(layout, variable=keep, values=values, sure=True)
    return _set_time_unit(layout, table, SECONDS[choices.unit] if choices.unit else None)


def _require(table: pa.Table, name: str) -> None:
    if name not in table.column_names:
        raise LogError(f"no column {name!r}", among(name, table.column_names))
