"""Which columns of a table are time, name of the variable and values, and time columns in seconds."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.arrow import PER_S, convert_to_floats
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.dates import (
    CLOCK_OF_12_HOURS,
    SPAN,
    WORDS,
    describe_guess,
    is_moment,
    normalize_dates,
)

if TYPE_CHECKING:
    import pandas as pd

_UNIT_WORDS_S = {
    1.0: ("s", "sec", "secs", "second", "seconds"),
    1e-3: ("ms", "msec", "msecs", "millis", "millisecond", "milliseconds"),
    1e-6: ("us", "µs", "μs", "usec", "usecs", "micros", "microsec", "microsecond", "microseconds"),
    1e-9: ("ns", "nsec", "nsecs", "nanos", "nanosec", "nanosecond", "nanoseconds"),
    60.0: ("min", "mins", "minute", "minutes"),
    3600.0: ("h", "hour", "hours"),
}
UNITS_S = {word: seconds for seconds, words in _UNIT_WORDS_S.items() for word in words}

COUNTS = ("index", "row")
"""Names by which a column is recognised as one that counts the samples."""
NAMES = (
    *(
        "time",
        "t",
        "elapsed",
        "timestamp",
        "datetime",
        "date",
        "ts",
        "clock",
        "epoch",
        "stamp",
        "timer",
    ),
    *(
        "x_value",
        "uptime",
        "zeit",
        "temps",
        "tiempo",
        "tempo",
        "tid",
        "tijd",
        "czas",
        "время",
        "时间",
        "時間",
        "sec",
    ),
    *(word for word in UNITS_S if len(word) > 1 and word.endswith("s")),
    *COUNTS,
)
"""Names by which a column is recognised as the time, the most certain first; units such as `ms` are among them."""
_WORDS = frozenset(word for word in NAMES if len(word) > 3 and word not in COUNTS)
"""Words in the name of a column by which it is the time if its values rise, as in `sim_time` and `brick clock (ms)`."""

_UNIT = re.compile(
    r"(?:[ _]*[(\[](?P<bracket>[^)\]]*)[)\]]|\s*/\s*(?P<slash>[^\W\d_]+)|[._ ](?:in[_ ])?(?P<end>[^\W\d_]+))$"
)
"""Matches the unit at the end of a column's name: `time (ms)`, `Time [s]`, `t/s`, `timestamp_ms`, `time in ms`."""
_LONGEST_UNIT = 200
"""A unit is looked for in the last characters of a column's name, this many: the time of the search grows with their
square.
"""
_SINCE_1970_S = (6.3e8, 4.2e9)
"""Seconds from 1970 to the years 1990 and 2103: a number between the two is taken for a date."""
UNIT_NAMES = {seconds: words[-1] for seconds, words in _UNIT_WORDS_S.items()}
"""Names of the units of time, in the plural, by their length in seconds."""


class TimeName(NamedTuple):
    """The name of a column, split into a word and a unit of time: `Time (ms)` into `time` and 0.001."""

    base: str
    """The column's name in lower case, without the unit and without punctuation around it."""
    unit_s: float | None
    """The unit of time in the column's name, in seconds; None if there is none."""


def parse_time_name(name: str) -> TimeName:
    """Return a column's name split into a word and a unit of time in seconds.

    `Time (ms)` becomes `time` and 0.001. If the whole name is a unit, such as `ms`, it is the word as well. A name
    without a unit has the unit None.
    """
    text = name.strip().lower()
    match = _UNIT.search(text, max(0, len(text) - _LONGEST_UNIT))
    unit_s = None
    if match is not None and match.start() > 0:
        word = next(part for part in match.groups() if part is not None).strip()
        unit_s = UNITS_S.get(word)
        if unit_s is not None or match["bracket"] is not None:
            text = text[: match.start()]
    base = text.strip(" #%@._/\"'")
    return TimeName(base, UNITS_S.get(base) if unit_s is None else unit_s)


def has_time_word(name: str) -> bool:
    """Return whether a word of a column's name means a time or a unit of time, as in `since start (s)`."""
    if parse_time_name(name).unit_s is not None:
        return True
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return not _WORDS.isdisjoint(re.split(r"[\W_]+", spaced.lower()))


def find_epoch_unit_s(column: pa.ChunkedArray, unit_s: float | None) -> float | None:
    """Return the unit in seconds of numbers that are times since the beginning of 1970; None if they are not.

    Args:
        column: The numbers.
        unit_s: The unit in seconds; None to guess it from the size of the numbers.
    """
    numbers = convert_to_floats(column[:JUDGED_TIMES])
    first = next(iter(numbers[np.isfinite(numbers)]), 0.0)
    units: tuple[float, ...] = (1.0, 1e-3, 1e-6, 1e-9) if unit_s is None else (unit_s,)
    return next(
        (unit for unit in units if _SINCE_1970_S[0] <= first * unit <= _SINCE_1970_S[1]), None
    )


JUDGED_TIMES = 1000
_DAY_S = 86400.0
_COUNTER = 2.0**32
"""A microcontroller's counter of milliseconds or microseconds begins again at 0 after this number of them."""
NO_ROWS: IntArray = np.empty(0, np.int64)


class Times(NamedTuple):
    """The times of a log in seconds, and the rows at which its clock or counter began again at 0."""

    seconds: FloatArray
    """The time of each row in seconds, shape (n,); NaN where a row has no time."""
    wraps: IntArray = NO_ROWS
    """Rows, from 0, in which a clock or a counter began again at 0; from each of them on, one more period is added to
    the times.
    """
    period: str = ""
    """The period of the clock or counter in words; empty if it never began again."""


def read_times(table: pa.Table, layout: Layout) -> Times:
    """Return the time column of a table in seconds: dates count from the first date, numbers have the layout's unit.

    Args:
        table: The table.
        layout: Names the column, which has numbers, dates, time spans, or texts with dates or time spans.
    """
    column = table.column(layout.time)
    kind = column.type
    if is_text(kind):
        return parse_times(column)
    if pa.types.is_date(kind):
        column = column.cast(pa.timestamp("s"))
    elif pa.types.is_time32(kind):
        # Arrow casts 32-bit times only to integers of the same size.
        column = column.cast(pa.time64("us"))
    kind = column.type
    is_temporal = pa.types.is_temporal(kind)
    if is_temporal or pa.types.is_integer(kind):
        # Differences of unsigned numbers would wrap where time goes back.
        column = column.cast(pa.int64(), safe=False)
    if layout.since_first or pa.types.is_timestamp(kind):
        # Integers are subtracted, as floats have too few digits for nanoseconds since 1970.
        column = pc.subtract(column, pc.first(column.filter(pc.is_finite(column))))
    seconds = np.asarray(convert_to_floats(column), np.float64)
    if is_temporal:
        return Times(seconds / PER_S[kind.unit])
    times = Times(seconds) if layout.since_first else _unwrap(seconds, _COUNTER, "2³²")
    if layout.unit_s == 1.0:
        return times
    return times._replace(seconds=times.seconds * layout.unit_s)


def _unwrap(seconds: FloatArray, period: float, words: str) -> Times:
    """Return times to which a period is added each time that their clock or counter begins again at 0.

    Args:
        seconds: The times in seconds.
        period: The period of the clock or counter in seconds.
        words: The period in words.
    """
    with np.errstate(invalid="ignore"):
        if not 0.9 * period < np.nanmax(seconds, initial=0.0) < period:
            return Times(seconds)
        wraps = np.flatnonzero(np.diff(seconds) < -0.8 * period) + 1
    rounds = np.zeros(len(seconds))
    rounds[wraps] = period
    return Times(seconds + np.cumsum(rounds), wraps, words)


def parse_times(column: pa.ChunkedArray) -> Times:
    """Return texts as times: time spans and times of day in seconds, dates in seconds since the first date.

    Each time that the time of day begins again at 0, a day is added. Any other text becomes NaN.
    """
    import pandas as pd

    texts = normalize_dates(column.cast(pa.string()))
    spans = texts.filter(pc.match_substring_regex(texts, SPAN)).to_pandas()
    if not len(spans):
        form = "mixed" if pc.any(pc.match_substring_regex(texts, WORDS)).as_py() else "ISO8601"
        dates = pd.to_datetime(texts.to_pandas(), format=form, utc=True, errors="coerce")
        if pc.all(pc.match_substring_regex(texts, CLOCK_OF_12_HOURS)).as_py():
            return _unwrap(_count_seconds(dates - dates.dt.normalize()), _DAY_S, "a day")
        return Times(_count_seconds(dates - dates.bfill().iloc[0]))
    cells = texts.to_pandas()
    seconds = _count_seconds(pd.to_timedelta(cells.where(cells.isin(spans)), errors="coerce"))
    return Times(seconds) if spans.str.contains("day").any() else _unwrap(seconds, _DAY_S, "a day")


def _count_seconds(spans: pd.Series) -> FloatArray:
    return np.asarray(spans.dt.total_seconds(), np.float64)


_MAX_TIMES = 500
"""Largest number of numeric columns that are offered as the time: nobody chooses from more one by one."""
ROW = ""
"""Stands for the name of the time column if the log has none, and the rows are counted instead."""

_JUDGED_CELLS = 20

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
"""Columns of tuisim's own tables with one sample in each row: they say where the sample is from, and are no values."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Which columns of a table have the times, the names of variables, the values, and the numbers of the runs."""

    time: str = ROW
    """Name of the column with the time; `ROW` if the log has none, and the rows are counted."""
    unit_s: float = 1.0
    """Unit of the time column in seconds."""
    since_first: bool = False
    """Whether the numbers of the time column are dates, of which the time since the first one is shown."""
    variable: str = ""
    """Name of the column that says which variable the value in a row is of; empty if each column of values is a
    variable.
    """
    values: tuple[str, ...] = ()
    """Names of the columns with values; only one if there is a `variable` column."""
    run: str = ""
    """Name of the column with the number of each row's run; empty if the table has only one run."""
    sure: bool = True
    """Whether the names of the columns leave no doubt about this layout; otherwise the user should be asked."""

    def describe_time(self) -> str:
        """Return a sentence that says which column is the time."""
        if self.time in (ROW, "row"):
            return "no time column: row numbers from 0 are used"
        unit = UNIT_NAMES.get(self.unit_s, f"{self.unit_s:g} s")
        return f"time is the column {self.time!r}, in {unit}{' since 1970' if self.since_first else ''}"


def is_numeric(kind: pa.DataType) -> bool:
    """Return whether an Arrow type is numeric."""
    return bool(
        pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)
    )


def list_numeric_columns(schema: pa.Schema) -> list[str]:
    """Return the names of a table's numeric columns."""
    return [field.name for field in schema if is_numeric(field.type)]


def list_time_columns(table: pa.Table) -> list[str]:
    """Return the names of the columns that can be the time: columns of numbers, dates, times or time spans."""
    names = list_numeric_columns(table.schema)[:_MAX_TIMES]
    return [*names, *_list_moments(table)]


def _list_moments(table: pa.Table) -> list[str]:
    """Return the names of the columns of dates, times or time spans, including texts with these."""
    typed = [
        field.name
        for field in table.schema
        if pa.types.is_temporal(field.type) and not pa.types.is_interval(field.type)
    ]
    return [*typed, *find_texts(table, is_moment)]


def _guess_columns(table: pa.Table) -> Layout:
    """Return the roles of the columns as guessed from their names and types.

    The time is the first of these that the table has: the column whose name most certainly means a time; a column of
    dates or times; in a table without headings, the first column, if its numbers rise; the number of the row.

    A table may name the variable of each row in a text column, such as `variable`, and have a column `value` beside it.
    In any other table, each further numeric column is a variable.
    """
    named = _find_named_time(table)
    time = named or _find_rising(table)
    numeric = list_numeric_columns(table.schema)
    run = "run" if "run" in numeric else ""
    variable = _find_named(table, _VARIABLE_NAMES, is_text)
    value = _find_named(table, _VALUE_NAMES, is_numeric)
    numeric = [name for name in numeric if name not in (time, run)]
    if variable and value and value != time:
        values = [value]
        sure = bool(named) or not set(numeric) - {value, *_NO_VALUES}
    else:
        variable = ""
        # In telemetry, which has no column of values, the pose is not hidden.
        hidden = _NO_VALUES if value in numeric else ("line", "row")
        values = [n for n in numeric if n not in hidden] or numeric
        # With a single numeric column, there is no other choice, so the guess is sure.
        sure = bool(named) or (len(numeric) < 2 and not time)
    return Layout(time, 1.0, False, variable, tuple(values), run, sure)


def _find_named(table: pa.Table, names: Sequence[str], fits: Callable[[pa.DataType], bool]) -> str:
    """Return the name of the first column that has one of some names, in upper or lower case, and a fitting type.

    The result is empty if there is no such column.

    Args:
        table: The table.
        names: The names in lower case, the most wanted first.
        fits: Returns whether a type fits.
    """
    columns = {
        field.name.strip(" _").lower(): field.name for field in table.schema if fits(field.type)
    }
    return next((columns[name] for name in names if name in columns), "")


def _find_named_time(table: pa.Table) -> str:
    """Return the name of the column that is the time, judged by names and types, such as a column of dates.

    The result is empty if there is none.
    """
    likely = table.select(
        [
            index
            for index, name in enumerate(table.column_names)
            if parse_time_name(name).base in NAMES or has_time_word(name)
        ]
    )
    moments = _list_moments(likely)
    numbers = list_numeric_columns(likely.schema)
    usable = [n for n in (*moments, *numbers) if table.column(n).null_count < table.num_rows]
    bases = {parse_time_name(name).base: name for name in reversed(usable)}
    named = (bases[word] for word in NAMES if word in bases)
    compound = (n for n in usable if has_time_word(n) and (n in moments or _is_rising(table, n)))
    name = next(chain(named, compound), None)
    # The cells of other columns are looked at only if no name tells.
    return next(iter(_list_moments(table)), ROW) if name is None else name


def find_texts(table: pa.Table, fits: Callable[[str], bool]) -> Iterator[str]:
    """Yield the names of the text columns in which at least half of the first cells meet a condition.

    Args:
        table: The table.
        fits: Returns whether a cell meets the condition.
    """
    for field in table.schema:
        if is_text(field.type):
            cells = table.column(field.name).slice(0, _JUDGED_CELLS).cast(pa.string()).to_pylist()
            if 0 < len(cells) <= 2 * sum(cell is not None and fits(cell) for cell in cells):
                yield field.name


def find_unread_time(table: pa.Table, layout: Layout) -> str:
    """Return the name of a text column that should be the time but cannot be read as one, such as `time` with words.

    The result is empty if there is no such column, or if another column is the time.
    """
    if layout.time:
        return ""
    texts = (field.name for field in table.schema if is_text(field.type))
    return next((name for name in texts if parse_time_name(name).base in {*NAMES} - {*COUNTS}), "")


def describe_guessed_times(table: pa.Table, layout: Layout) -> str:
    """Return a note on how the dates or times in the time column are read, if this is only a guess.

    For example, it may say that they are read as day, month, year. The note is empty if there is no doubt, or if the
    column has no texts.
    """
    if not layout.time or not is_text(table.field(layout.time).type):
        return ""
    parts = describe_guess(table.column(layout.time).cast(pa.string()))
    return f"the dates or times in {layout.time!r} are read as {parts}" if parts else ""


def _find_rising(table: pa.Table) -> str:
    """Return the name of the first column without empty cells, if its numbers rise and the table has no headings.

    In any other case, return `ROW`.
    """
    names = table.column_names
    nameless = all(name == f"column {number}" for number, name in enumerate(names, 1))
    full = (name for name in names if not _has_empty_cells(table.column(name)))
    first = next(full, ROW)
    can_count = nameless and len(names) > 1 and first != ROW
    return first if can_count and _is_rising(table, first) else ROW


def _has_empty_cells(column: pa.ChunkedArray) -> bool:
    is_empty_text = is_text(column.type) and pc.any(pc.equal(column.cast(pa.string()), "")).as_py()
    return column.null_count > 0 or bool(is_empty_text)


def is_text(kind: pa.DataType) -> bool:
    """Return whether an Arrow type is text, including dictionary-encoded text."""
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _is_rising(table: pa.Table, name: str) -> bool:
    column = table.column(name)
    if column.null_count or table.num_rows < 2 or not is_numeric(column.type):
        return False
    # Numbers are compared, not subtracted, as infinite ones have no difference.
    numbers = convert_to_floats(column)
    return bool((numbers[1:] > numbers[:-1]).all())


def choose_columns(table: pa.Table, choices: ReadChoices = NO_CHOICES) -> Layout:
    """Return the roles of a table's columns: the user's choices, and guesses for all others.

    Raises:
        LogError: the table has no such column, or it is not numeric.
    """
    layout = _guess_columns(table)
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
        keep = layout.variable if len(values) == 1 else ""
        layout = replace(layout, variable=keep, values=values, sure=True)
    if not layout.time or not is_numeric(table.field(layout.time).type):
        return layout
    unit_s = UNITS_S.get(choices.unit) or parse_time_name(layout.time).unit_s
    date_unit_s = find_epoch_unit_s(table.column(layout.time), unit_s)
    return replace(layout, unit_s=date_unit_s or unit_s or 1.0, since_first=date_unit_s is not None)


def _require(table: pa.Table, name: str) -> None:
    if name not in table.column_names:
        raise LogError(f"no column {name!r}", among(name, table.column_names))
