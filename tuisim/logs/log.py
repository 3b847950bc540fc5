"""A log: a table, what its columns mean, and the series in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.errors import LogError, listed
from tuisim.logs.arrow import numbers_of, whole_numbers, whole_numbers_of
from tuisim.logs.columns import ROW, Layout, seconds_of
from tuisim.runs.arrays import FloatArray, IntArray

_NO_ROWS: IntArray = np.empty(0, np.int64)


@dataclass(frozen=True, slots=True)
class Member:
    """One series of a log."""

    name: str
    """The variable; of several runs with `#` and the run's number."""
    variable: str
    """What its rows or its column are called."""
    run: int
    """Number in the run column, 0 if there is none."""
    rows: IntArray | None
    """Rows of the table that are its own, rising; None for all."""


def members(table: pa.Table, layout: Layout) -> list[Member]:
    """Return the series of a table, in the order in which they first appear.

    Args:
        table: The log.
        layout: What its columns mean.
    """
    runs, run_codes = _encoded(table.column(layout.run)) if layout.run else ([0], None)
    several = len(runs) > 1
    if not layout.variable:
        rows_of = _rows_by_code(run_codes, len(runs)) if several and run_codes is not None else [None]
        found = [(name, at) for at in range(len(runs)) for name in layout.values]
        return [_member(name, runs[at], rows_of[at], several) for name, at in found]
    names, codes = _encoded(table.column(layout.variable))
    if not several or run_codes is None:
        rows_of = [None] if len(names) == 1 else _rows_by_code(codes, len(names))
        run = runs[0] if runs else 0
        return [_member(name, run, rows, False) for name, rows in zip(names, rows_of, strict=True)]
    # Of all pairs of a variable and a run there may be but few.
    pairs, pair_codes = _encoded(whole_numbers(codes.astype(np.int64) * len(runs) + run_codes))
    rows_of = _rows_by_code(pair_codes, len(pairs))
    found = [(names[pair // len(runs)], runs[pair % len(runs)]) for pair in pairs]
    return [_member(name, run, rows, True) for (name, run), rows in zip(found, rows_of, strict=True)]


def _member(name: object, run: Any, rows: IntArray | None, several: bool) -> Member:
    # Rows that do not say of what they are, or of which run, belong to no series.
    number = int(run) if run is not None and isfinite(run) else 0
    if name is None or (several and number != run):
        rows = _NO_ROWS
    return Member(f"{name} #{number}" if several else str(name), str(name), number, rows)


def _encoded(column: pa.ChunkedArray) -> tuple[list[Any], IntArray]:
    """Return the distinct values of a column in the order in which they first appear, and each row's place there."""
    if pa.types.is_dictionary(column.type):
        column = column.unify_dictionaries()
        values = column.chunk(0).dictionary.to_pylist() if column.num_chunks else []
        if None in values or len(set(values)) < len(values):
            # Some writers list a value twice, or nothing as a value.
            column = column.cast(column.type.value_type)
    if not pa.types.is_dictionary(column.type):
        column = column.dictionary_encode("encode")
        values = column.chunk(0).dictionary.to_pylist() if column.num_chunks else []
    indices = [chunk.indices.cast(pa.int32()) for chunk in column.chunks]
    indices = [pc.fill_null(chunk, len(values)) if chunk.null_count else chunk for chunk in indices]
    appeared = pc.unique(pa.chunked_array(indices, pa.int32())).to_pylist()
    place_of = np.zeros(len(values) + 1, np.int32)
    place_of[appeared] = np.arange(len(appeared))
    codes = [place_of[whole_numbers_of(chunk)] for chunk in indices]
    return [[*values, None][at] for at in appeared], np.concatenate(codes) if codes else np.empty(0, np.int32)


def _rows_by_code(codes: IntArray, count: int) -> list[IntArray]:
    """Return the rows that hold each code from 0 to below `count`."""
    if not count:
        return []
    # Numbers of one or two bytes are sorted in a time in proportion to how many there are.
    small = codes.astype(np.min_scalar_type(count))
    order = np.argsort(small, kind="stable")
    ends = np.cumsum(np.bincount(small, minlength=count))
    return np.split(order, ends[:-1])


@dataclass(frozen=True, slots=True)
class Series:
    """One variable of one run, in the order of the table."""

    name: str
    """As in `Log.names`."""
    time_s: FloatArray
    """Shape (n,): from the time column, or the number of the sample, from 0."""
    values: FloatArray
    """Shape (n,); not a number where a cell is empty."""
    rows: IntArray
    """Row of the table that each sample stands in, from 0; rising."""
    run: int = 0
    """Number in the run column, 0 if there is none."""


@dataclass(slots=True)
class _Kept:
    """What of a log has been made ready to be reckoned with: only what was asked for, and that only once."""

    members: Mapping[str, Member] | None = None
    series: dict[str, Series] = field(default_factory=dict)
    numbers: dict[str, FloatArray] = field(default_factory=dict)
    times_s: FloatArray | None = None
    whole: tuple[IntArray, FloatArray] | None = None
    """Rows and times of a series that has all rows."""


def _has_rows(member: Member) -> bool:
    return member.rows is None or len(member.rows) > 0


@dataclass(frozen=True, slots=True)
class Log:
    """A log."""

    title: str
    table: pa.Table
    layout: Layout
    notes: tuple[str, ...] = ()
    """What was left out or guessed, one sentence each."""
    left_out: int = 0
    """Rows or cells that could not be read."""
    metadata: Mapping[str, Any] = field(default_factory=dict)
    """What an export of ours says of its runs."""
    derived: Mapping[str, Series] = field(default_factory=dict)
    """Series that were reckoned from others, by name."""
    _kept: _Kept = field(default_factory=_Kept, repr=False, compare=False)

    @property
    def rows(self) -> int:
        """How many rows the table has."""
        return int(self.table.num_rows)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the series, in the order in which they first appear; of several runs with `#` and its number."""
        return (*self._members(), *self.derived)

    def _members(self) -> Mapping[str, Member]:
        kept = self._kept
        if kept.members is None:
            found: dict[str, Member] = {}
            for member in members(self.table, self.layout):
                # What has no name or run is called like those that have such a name, but has no rows.
                if member.name not in found or not _has_rows(found[member.name]):
                    found[member.name] = member
            kept.members = found
        return kept.members

    def series(self, name: str) -> Series:
        """Return a series. Do not write to its arrays: they may be those of another one, or of the table.

        Raises:
            LogError: there is none of that name.
        """
        if name in self.derived:
            return self.derived[name]
        if name not in self._kept.series:
            member = self._members().get(name)
            if member is None:
                raise LogError(f"no variable {name!r}", f"there are {listed(self.names)}", file=self.title)
            self._kept.series[name] = self._series(member)
        return self._kept.series[name]

    def _series(self, member: Member) -> Series:
        layout, rows = self.layout, member.rows
        values = self.numbers(layout.values[0] if layout.variable else member.variable)
        if rows is not None:
            return Series(member.name, self._times(rows), values[rows], rows, member.run)
        kept = self._kept
        if kept.whole is None:
            kept.whole = np.arange(self.rows), self._times(None)
        return Series(member.name, kept.whole[1], values, kept.whole[0], member.run)

    def _times(self, rows: IntArray | None) -> FloatArray:
        if self.layout.time == ROW:
            return np.arange(self.rows if rows is None else len(rows), dtype=np.float64)
        if self._kept.times_s is None:
            self._kept.times_s = seconds_of(
                self.table.column(self.layout.time), self.layout.unit_s, self.layout.since_first
            )
        times = self._kept.times_s if rows is None else self._kept.times_s[rows]
        # A sample without a time of its own stands at the one before it.
        missing = ~np.isfinite(times)
        if missing.any():
            # What comes before the first time stands there.
            first = int(np.argmin(missing))
            last = np.maximum.accumulate(np.where(missing, first, np.arange(len(times))))
            times = np.zeros(len(times)) if missing.all() else times[last]
        return times

    def numbers(self, column: str) -> FloatArray:
        """Return a column of numbers as floats, shape (n,); not a number where it is empty. Not to be written to."""
        if column not in self._kept.numbers:
            self._kept.numbers[column] = numbers_of(self.table.column(column))
        return self._kept.numbers[column]

    def with_layout(self, layout: Layout) -> Log:
        """Return the same log with another meaning of its columns."""
        return replace(self.bare(), layout=layout, _kept=_Kept())

    def bare(self) -> Log:
        """Return the same log without anything that was derived."""
        log = self
        for name in self.derived:
            log = log.without_derived(name.partition(" #")[0])
        return log

    def with_derived(self, column: str, series: Sequence[Series]) -> Log:
        """Return the same log with series that were reckoned from its own.

        Args:
            column: Name of the column of the table that they become where each has its rows for itself.
            series: One, or one a run.
        """
        bare = self.without_derived(column)
        derived = {**bare.derived, **{one.name: one for one in series}}
        table = bare.table
        if all((np.diff(one.rows) > 0).all() for one in series):
            cells = np.full(self.rows, np.nan)
            for one in series:
                cells[one.rows] = one.values
            table = table.append_column(column, pa.array(cells, from_pandas=True))
        return replace(bare, table=table, derived=derived)

    def without_derived(self, column: str) -> Log:
        """Return the same log without what was reckoned under a name."""
        derived = {name: one for name, one in self.derived.items() if name.partition(" #")[0] != column}
        if len(derived) == len(self.derived):
            return self
        table = self.table.drop_columns([column]) if column in self.table.column_names else self.table
        kept = replace(self._kept, numbers={name: at for name, at in self._kept.numbers.items() if name != column})
        return replace(self, table=table, derived=derived, _kept=kept)
