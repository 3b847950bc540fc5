"""Which columns of a table are time, name of the variable, and values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

import numpy as np
import pyarrow as pa

from tuisim.datalog.opening.plain import numbers_of
from tuisim.datalog.opening.time_column import NAMES, UNIT_NAMES, has_time_word, time_name, unit_since_1970_s
from tuisim.datalog.units import SECONDS
from tuisim.errors import LogError, listed

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


def guessed(table: pa.Table) -> Layout:
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
    from tuisim.datalog.opening.moments import seconds_of_texts

    return bool(np.isfinite(seconds_of_texts(table.column(name).slice(0, 20))).any())


def _rises(table: pa.Table, name: str) -> bool:
    column = table.column(name)
    if column.null_count or table.num_rows < 2:
        return False
    # Compared, not subtracted: what is infinite has no difference.
    numbers = numbers_of(column)
    return bool((numbers[1:] > numbers[:-1]).all())


def chosen(table: pa.Table, time: str | None, values: Sequence[str], unit: str = "") -> Layout:
    """Return what the columns mean where the user names some of them.

    Args:
        table: The log.
        time: Column with the time; empty to count the rows; None to guess.
        values: Columns with values; none to guess.
        unit: Of a time column that holds numbers, one of `SECONDS`; empty to guess it by the column's name.

    Raises:
        LogError: there is no such column, or it holds no numbers.
    """
    layout = guessed(table)
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
