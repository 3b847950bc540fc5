"""Which columns of a table are time, name of the variable, and values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

import numpy as np
import pyarrow as pa

from tuisim.datalog.opening.plain import numbers_of
from tuisim.datalog.units import SECONDS
from tuisim.errors import LogError, listed

ROW = ""
"""Instead of a time column: the samples are counted."""

_TIME_NAMES = ("time", "time_s", "t", "seconds", "sec", "elapsed", "timestamp", "datetime", "date", "index", "x")
"""Names of time columns, the surest first; ends such as `_ms` tell the unit."""

_TEXT_TIMES = frozenset(_TIME_NAMES) - {"index", "x"}

_UNITS_S = {**SECONDS, "sec": 1.0, "µs": 1e-6}
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

    The time is the column with the surest name, else the first one that rises all the
    time, else the rows are counted. A text column with a known name next to one called
    `value` names the variables; otherwise every other column of numbers is one.
    """
    names = table.column_names
    time = _named_time(table)
    run = "run" if "run" in names and is_numeric(table.schema.field("run").type) else ""
    variable = next((n for n in _VARIABLE_NAMES if n in names and is_text(table.schema.field(n).type)), "")
    value = next((n for n in _VALUE_NAMES if n in names and is_numeric(table.schema.field(n).type)), "")
    if variable and value and value != time:
        rising = "" if time else _rising(table, besides=value)
        return Layout(time or rising, unit_of(time or rising, table), variable, (value,), run, not rising)
    sure = bool(time)
    time = time or _rising(table)
    numeric = [n for n in names if is_numeric(table.schema.field(n).type) and n not in (time, run)]
    if value and value in numeric:
        kept = [n for n in numeric if n not in _NO_VALUES]
    else:
        # In a frame of every tick the pose is a value like any other.
        kept = [n for n in numeric if n not in ("line", "row")]
    # Of one column of numbers there is nothing to choose.
    return Layout(time, unit_of(time, table), "", tuple(kept or numeric), run, sure or (len(numeric) < 2 and not time))


def _named_time(table: pa.Table) -> str:
    """The column that by its name is the time, empty if there is none."""
    lowered: dict[str, str] = {name.lower(): name for name in table.column_names}
    for wanted in _TIME_NAMES:
        for ending in ("", *(f"_{unit}" for unit in _UNITS_S), *(f" ({unit})" for unit in _UNITS_S)):
            name = lowered.get(wanted + ending, "")
            if name and _is_usable(table, name):
                return name
    return ROW


def unread_time(table: pa.Table, layout: Layout) -> str:
    """Return the column that should be the time by its name, but whose texts say none; empty if there is none."""
    if layout.time:
        return ""
    named = (name for name in table.column_names if name.lower() in _TEXT_TIMES)
    return next((name for name in named if is_text(table.schema.field(name).type)), "")


def _rising(table: pa.Table, besides: str = "") -> str:
    """The first column of numbers besides one if it rises all the time, else nothing: the rows are counted."""
    numeric = [n for n in table.column_names if is_numeric(table.schema.field(n).type) and n not in _NO_VALUES]
    # A single column of numbers is what was measured.
    others = [n for n in numeric if n != besides]
    return others[0] if others and len(numeric) > 1 and _rises(table, others[0]) else ROW


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


def unit_of(name: str, table: pa.Table) -> float:
    """Return the seconds that a unit of a time column stands for, by the end of its name."""
    if not name or not is_numeric(table.schema.field(name).type):
        return 1.0
    ending = name.lower().rstrip(")").replace("(", "_").replace("[", "_").rstrip("]").rpartition("_")[2].strip()
    return _UNITS_S.get(ending, 1.0) if ending != name.lower() else 1.0


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
        layout = Layout(time, unit_of(time, table), layout.variable, layout.values, layout.run)
    if values and tuple(values) != layout.values:
        for name in values:
            _require(table, name)
            if not is_numeric(table.schema.field(name).type):
                raise LogError(f"column {name!r} holds no numbers")
        keep = layout.variable if len(values) == 1 and layout.variable else ""
        layout = Layout(layout.time, layout.unit_s, keep, tuple(values), layout.run)
    if unit and layout.time and is_numeric(table.schema.field(layout.time).type):
        layout = replace(layout, unit_s=SECONDS[unit])
    return replace(layout, sure=layout.sure or time is not None or bool(values))


def _require(table: pa.Table, name: str) -> None:
    if name not in table.column_names:
        near = get_close_matches(name, table.column_names, 1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise LogError(f"no column {name!r}", f"{hint}there are {listed(table.column_names)}")
