"""The time of a table: joined from two columns, and split into runs where it begins again."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.errors import counted
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.arrow import convert_to_floats, make_names_unique, wrap_int64
from tuisim.logs.columns import (
    COUNTS,
    JUDGED_TIMES,
    ROW,
    UNITS_S,
    Layout,
    Times,
    find_epoch_unit_s,
    find_texts,
    is_numeric,
    parse_time_name,
    read_times,
)
from tuisim.logs.dates import is_clock, is_date
from tuisim.logs.warnings import Notes, list_rows

_UNIT_NAME = re.compile(r"(.*?)[._ ]?([^\W_]+)")
"""The name of a column whose last word may be a unit."""
_RESTART_PART = 0.1
"""A time begins again if it goes back to this part of what had passed."""
_MAX_RUNS = 1000
_MIN_STEPS = {1e-9: 1e7, 1e-6: 1e4, 1e-3: 5.0}
"""Smallest usual step of whole numbers by the unit in seconds: a robot samples every 5 ms to 10 s."""


def join_times(table: pa.Table) -> pa.Table:
    """Return a table with its time in one column; a time in two columns is joined.

    The two columns can be seconds and their fractions, or date and time of day.
    """
    names = {}
    for name in table.column_names:
        if match := _UNIT_NAME.fullmatch(name):
            names[match[1], UNITS_S.get(match[2].lower())] = name
    for (base, unit_s), part in names.items():
        whole = names.get((base, 1.0))
        if whole and unit_s in (1e-6, 1e-9) and (joined := _join_parts(table, whole, part, unit_s)):
            return _replace_columns(table, whole, part, base or "time", joined)
    dates, clocks = (list(find_texts(table, fits)) for fits in (is_date, is_clock))
    if len(dates) == 1 and clocks:
        texts = [table.column(name).cast(pa.string()) for name in (dates[0], clocks[0])]
        joined = pc.binary_join_element_wise(*texts, " ")
        return _replace_columns(table, dates[0], clocks[0], f"{dates[0]} {clocks[0]}", joined)
    return table


def _replace_columns(
    table: pa.Table, first: str, second: str, name: str, joined: pa.ChunkedArray
) -> pa.Table:
    position = table.column_names.index(first)
    rest = table.drop_columns([first, second])
    return rest.add_column(
        min(position, rest.num_columns), make_names_unique([*rest.column_names, name])[-1], joined
    )


def _join_parts(table: pa.Table, seconds: str, parts: str, unit_s: float) -> pa.ChunkedArray | None:
    if not all(is_numeric(table.field(name).type) for name in (seconds, parts)):
        return None
    whole, fraction = (
        np.asarray(convert_to_floats(table.column(name)), float) for name in (seconds, parts)
    )
    if not (np.isfinite(whole).all() and ((fraction >= 0) & (fraction * unit_s < 1)).all()):
        return None
    nanoseconds = whole.astype(np.int64) * 10**9 + np.rint(fraction * unit_s * 1e9).astype(np.int64)
    is_date = find_epoch_unit_s(table.column(seconds), 1.0) is not None
    kind = pa.timestamp("ns") if is_date else pa.duration("ns")
    return pa.chunked_array([wrap_int64(nanoseconds)]).cast(kind)


def guess_unit_s(table: pa.Table, layout: Layout) -> float | None:
    """Return the unit in s of a time column that names no unit; None if it cannot be guessed.

    It is guessed for whole numbers whose steps are too large for seconds.
    """
    if layout.time in (ROW, *COUNTS) or layout.since_first or "line" in table.column_names:
        return None
    if parse_time_name(layout.time).unit_s is not None or not is_numeric(
        table.field(layout.time).type
    ):
        return None
    times = convert_to_floats(table.column(layout.time))
    times = times[np.isfinite(times)][:JUDGED_TIMES]
    if len(times) < 3 or (times != np.floor(times)).any():
        return None
    # A line with several samples gives as many rows with the same time.
    steps = np.abs(np.diff(times))
    step = float(np.median(steps[steps > 0])) if steps.any() else 0.0
    return next((unit_s for unit_s, min_step in _MIN_STEPS.items() if step >= min_step), None)


def reverse_newest_first(
    table: pa.Table, layout: Layout, times: Times, notes: Notes
) -> tuple[pa.Table, Times]:
    """Return the rows of a table in the order of time if the newest is first, with their times; else both unchanged."""
    steps = np.diff(times.seconds)
    if len(steps) < 2 or (steps > 0).any() or not steps.any():
        return table, times
    notes.say("the newest row is first: the rows are read from the last")
    table = table.take(np.arange(table.num_rows)[::-1])
    return table, read_times(table, layout)


def number_runs(
    table: pa.Table, layout: Layout, times: Times, notes: Notes
) -> tuple[pa.Table, Layout]:
    """Return a table and its layout; each time that the time begins again, another run begins.

    If there are several runs, the table gets a column with the number of the run.

    Args:
        table: The table.
        layout: The roles of its columns.
        times: The times of its rows.
        notes: Receives the rows where time goes back.
    """
    seconds, wraps, period = times
    if len(wraps):
        notes.say(f"the clock begins again at 0 in {_name_rows(wraps)}: {period} is added")
    back = np.flatnonzero(seconds[1:] < seconds[:-1]) + 1
    if len(back) and not layout.run and _is_one_clock(table, layout, back):
        restarts = _find_restarts(seconds, back)
        others = np.setdiff1d(back, restarts)
        if len(others):
            notes.say(f"time goes back in {_name_rows(others)}")
        if 0 < len(restarts) <= _MAX_RUNS:
            runs = counted(len(restarts) + 1, "run")
            notes.say(f"time begins again in {_name_rows(restarts)}: {runs}")
            name = make_names_unique([*table.column_names, "run"])[-1]
            numbers = 1 + np.searchsorted(restarts, np.arange(table.num_rows), side="right")
            table = table.append_column(name, wrap_int64(numbers))
            layout = replace(layout, run=name)
    return table, layout


def keep_timed_rows(
    table: pa.Table, layout: Layout, notes: Notes
) -> tuple[pa.Table, Layout, Times | None]:
    """Return the rows of a table that have a time, the table's layout, and the times.

    If no row has a time, or the layout names no column with times, all rows are returned, the times are None, and the
    number of the row is used as the time.

    Args:
        table: The table.
        layout: The roles of its columns.
        notes: Receives how many rows have no time.
    """
    if layout.time in (ROW, "row"):
        return table, layout, None
    times = read_times(table, layout)
    has_time = np.isfinite(times.seconds)
    count = int(np.count_nonzero(~has_time))
    if not count:
        return table, layout, times
    if count == len(has_time):
        notes.say(f"no time in {layout.time!r} can be read: row numbers are used")
        return table, replace(layout, time=ROW, unit_s=1.0, since_first=False), None
    rows = counted(count, "row has no time and is", "rows have no time and are")
    notes.say(f"{rows} left out: {layout.time!r} is empty there, or cannot be read")
    table = table.filter(pa.array(has_time))
    # The times are read again, as a clock may begin again at 0 after a row that is left out.
    return table, layout, read_times(table, layout)


def _name_rows(rows: IntArray) -> str:
    return f"{list_rows((rows + 1).tolist())} of the table"


def _find_restarts(seconds: FloatArray, back: IntArray) -> IntArray:
    """Return the rows at which time begins again near its start, not those at which it only goes back a little.

    Args:
        seconds: The time of each row.
        back: The rows at which it is less than in the row before.
    """
    start = 0
    restarts = []
    for row in back.tolist():
        passed = seconds[row - 1] - seconds[start]
        if seconds[row] <= seconds[start] + _RESTART_PART * passed:
            restarts.append(row)
            start = row
    return np.array(restarts, np.int64)


def _is_one_clock(table: pa.Table, layout: Layout, back: IntArray) -> bool:
    """Return whether one clock wrote all rows in order of time, and began again at the given rows, as in several runs.

    The result is False if the file has one variable after another: each variable then has its own times. The file is
    taken for such a file if, at one of the given rows, no variable has samples both before and after the row.

    Args:
        table: The table.
        layout: The roles of its columns.
        back: The rows at which time is less than in the row before.
    """
    if not layout.variable:
        return True
    names = table.column(layout.variable)
    edges = [0, *back.tolist(), table.num_rows]
    if len(edges) > _MAX_RUNS:
        return False
    parts = [
        set(names.slice(start, stop - start).unique().to_pylist())
        for start, stop in pairwise(edges)
    ]
    return all(not before.isdisjoint(after) for before, after in pairwise(parts))
