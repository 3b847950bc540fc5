"""A log: a table, its column layout, and the series in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import pyarrow as pa

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.arrow import convert_to_floats, read_numbers, wrap_int64
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.columns import (
    NO_ROWS,
    ROW,
    Layout,
    choose_columns,
    list_numeric_columns,
    read_times,
)
from tuisim.logs.metadata import read_spec
from tuisim.logs.signals import Between, sample_signal, sort_known
from tuisim.logs.time_order import keep_timed_rows
from tuisim.logs.units import drop_run
from tuisim.logs.warnings import Notes

LogTable: TypeAlias = pa.Table


@dataclass(frozen=True, slots=True)
class Member:
    """A variable of one run, with its rows in the table."""

    name: str
    """The name of the variable; in a log of several runs, ` #` and the run's number follow."""
    variable: str
    """The name of the variable without the run's number."""
    run: int
    """Number of the run, from the run column; 0 in a log without that column."""
    rows: IntArray | None
    """Rows of the table that have the variable's samples, in ascending order; None for all rows."""


def list_members(table: pa.Table, layout: Layout) -> list[Member]:
    """Return the variables of each run in a table, in order of first appearance."""
    runs, codes = _encode_column(table.column(layout.run)) if layout.run else ([0], NO_ROWS)
    several = len(runs) > 1
    names: Sequence[Any] = [None]
    groups: Sequence[int] = range(len(runs))
    if layout.variable:
        names, name_codes = _encode_column(table.column(layout.variable))
        groups = range(len(names))
        if several:
            # Only pairs of variable and run that occur are numbered, as often most do not.
            pairs = name_codes.astype(np.int64) * len(runs) + codes
            groups, codes = _encode_column(wrap_int64(pairs))
        else:
            codes = name_codes
    all_rows = [None] if len(groups) == 1 else _group_rows(codes, len(groups))
    return [
        _build_member(name, runs[group % len(runs)], rows, several)
        for group, rows in zip(groups, all_rows, strict=True)
        for name in ([names[group // len(runs)]] if layout.variable else layout.values)
    ]


def _build_member(name: object, run: Any, rows: IntArray | None, several: bool) -> Member:
    # Rows without a variable or a run belong to no series.
    number = int(run) if run is not None and isfinite(run) else 0
    if name is None or (several and number != run):
        rows = NO_ROWS
    return Member(f"{name} #{number}" if several else str(name), str(name), number, rows)


def _encode_column(column: pa.ChunkedArray) -> tuple[list[Any], IntArray]:
    """Return the distinct values of a column in order of first appearance, and the index of each row's value."""
    if pa.types.is_dictionary(column.type):
        column = column.unify_dictionaries()
        values = column.chunk(0).dictionary.to_pylist() if column.num_chunks else []
        if None not in values and len(set(values)) == len(values):
            indices = [chunk.indices for chunk in column.chunks]
            places, codes = _encode_column(pa.chunked_array(indices, column.type.index_type))
            return [None if place is None else values[place] for place in places], codes
        # Some writers put duplicates or nulls into the dictionary, so the column is decoded first.
        column = column.cast(column.type.value_type)
    column = column.dictionary_encode("encode")
    names = column.chunk(0).dictionary.to_pylist() if column.num_chunks else []
    parts = [read_numbers(chunk.indices) for chunk in column.chunks]
    return names, np.concatenate(parts) if parts else np.empty(0, np.int32)


def _group_rows(codes: IntArray, count: int) -> list[IntArray]:
    """Return for each code from 0 to `count` - 1 the rows with this code."""
    if not count:
        return []
    # The codes are stored in one or two bytes if possible, as such integers are sorted in linear time.
    small = codes.astype(np.min_scalar_type(count))
    order = np.argsort(small, kind="stable")
    ends = np.cumsum(np.bincount(small, minlength=count))
    return np.split(order, ends[:-1])


@dataclass(frozen=True, slots=True)
class Series:
    """The samples of one variable of one run, in the order of the table."""

    name: str
    """The name of the series, one of `Log.names`."""
    time_s: FloatArray
    """Times of the samples in seconds, or numbers from 0 in a log without a time column, shape (n,)."""
    values: FloatArray
    """Values of the samples, shape (n,); NaN for empty cells."""
    rows: IntArray
    """Row of each sample in the table, from 0, in ascending order, shape (n,)."""
    run: int = 0
    """Number of the run, from the run column; 0 in a log without that column."""

    def sample(self, moments_s: FloatArray, between: Between = Between.HOLD) -> FloatArray:
        """Return its values at given times, shape (m,); see `signals.sample_signal`."""
        known = sort_known(self.time_s, self.values)
        return sample_signal(self.time_s[known], self.values[known], moments_s, between)


@dataclass(slots=True)
class LogCache:
    """Cache of a log's converted columns and series, filled on demand."""

    members: Mapping[str, Member] | None = None
    series: dict[str, Series] = field(default_factory=dict)
    numbers: dict[str, FloatArray] = field(default_factory=dict)
    times_s: FloatArray | None = None
    rows: IntArray | None = None
    """The rows from 0 to n - 1, for all series that have every row of the table; None until a series needs them."""
    specs: dict[int, RunSpec | None] = field(default_factory=dict)
    """Specification of each run that was asked for, by the run's index; those of stored runs are all there from the
    start.
    """


def _has_rows(member: Member) -> bool:
    return member.rows is None or len(member.rows) > 0


@dataclass(frozen=True, slots=True)
class Log:
    """A log: a table with the roles of its columns, and its variables as series."""

    title: str
    table: pa.Table
    layout: Layout
    notes: tuple[str, ...] = ()
    """Warnings about skipped or guessed data, one sentence each."""
    left_out: int = 0
    """Number of rows or cells that could not be read."""
    metadata: Mapping[str, Any] = field(default_factory=dict)
    """The metadata that tuisim stored when it exported the log; empty for any other file."""
    form: ReadChoices = NO_CHOICES
    """How a text was read: the choices of the user, completed by what was found in the text."""
    first_lines: Sequence[tuple[int, str]] = ()
    """The first lines of a text that are not blank, each with its number in the file; empty if the log is no text."""
    derived: Mapping[str, Series] = field(default_factory=dict)
    _cache: LogCache = field(default_factory=LogCache, repr=False, compare=False)

    @property
    def rows(self) -> int:
        """The number of rows of the log's table."""
        return int(self.table.num_rows)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the log's series, in order of first appearance.

        With several runs, each name is followed by ` #` and the run's number.
        """
        return (*self._find_members(), *self.derived)

    @property
    def sampled_names(self) -> tuple[str, ...]:
        """Names of the series that have samples."""
        members = self._find_members() if self.rows else {}
        derived = [name for name, series in self.derived.items() if len(series.rows)]
        return (*(name for name, member in members.items() if _has_rows(member)), *derived)

    def _find_members(self) -> Mapping[str, Member]:
        cache = self._cache
        if cache.members is None:
            members: dict[str, Member] = {}
            for member in list_members(self.table, self.layout):
                # A member without rows must not replace one of the same name that has rows.
                if member.name not in members or not _has_rows(members[member.name]):
                    members[member.name] = member
            cache.members = members
        return cache.members

    def series(self, name: str) -> Series:
        """Return the series with a name. Its arrays must not be modified, as they may be shared.

        Raises:
            LogError: the log has no series with that name.
        """
        if name in self.derived:
            return self.derived[name]
        if name not in self._cache.series:
            member = self._find_members().get(name)
            if member is None:
                raise LogError(f"no variable {name!r}", among(name, self.names), file=self.title)
            self._cache.series[name] = self._read_series(member)
        return self._cache.series[name]

    def _read_series(self, member: Member) -> Series:
        layout = self.layout
        rows = member.rows
        values = self.numbers(layout.values[0] if layout.variable else member.variable)
        if rows is None:
            if self._cache.rows is None:
                self._cache.rows = np.arange(self.rows)
            return Series(member.name, self.times_s, values, self._cache.rows, member.run)
        times_s = np.arange(float(len(rows))) if layout.time == ROW else self.times_s[rows]
        return Series(member.name, times_s, values[rows], rows, member.run)

    @property
    def numeric_columns(self) -> list[str]:
        """The names of the columns with numbers."""
        return list_numeric_columns(self.table.schema)

    @property
    def times_s(self) -> FloatArray:
        """The time of each row in seconds, shape (n,).

        Without a time column, the times are row numbers from 0. The array must not be modified.
        """
        if self._cache.times_s is None:
            if self.layout.time == ROW:
                self._cache.times_s = np.arange(float(self.rows))
            else:
                self._cache.times_s = read_times(self.table, self.layout).seconds
        return self._cache.times_s

    def numbers(self, column: str) -> FloatArray:
        """Return a numeric column as floats, shape (n,), NaN for empty cells. Callers must not modify the array."""
        if column not in self._cache.numbers:
            self._cache.numbers[column] = convert_to_floats(self.table.column(column))
        return self._cache.numbers[column]

    def pick_numbers(self, column: str, rows: IntArray) -> FloatArray:
        """Return the numbers of a column in some rows, as `numbers` does, but without caching the whole column."""
        return convert_to_floats(
            self.table.column(column).take(wrap_int64(np.ascontiguousarray(rows, np.int64)))
        )

    def compute_driven_mm(self, series: Series) -> FloatArray | None:
        """Return the distance driven at each sample of a series in mm, shape (n,); None if there are no positions."""
        if not {"x_mm", "y_mm"} <= set(self.numeric_columns) or not len(series.rows):
            return None
        x_mm, y_mm = (self.pick_numbers(name, series.rows) for name in ("x_mm", "y_mm"))
        if not (np.isfinite(x_mm).all() and np.isfinite(y_mm).all()):
            return None
        return np.append(0.0, np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm))))

    def select_variables(self, names: Sequence[str]) -> pa.Table:
        """Return the rows in which one of some series has a sample.

        In a log with a column for each variable, the columns of other variables are left out.
        """
        rows = np.unique(np.concatenate([self.series(name).rows for name in names]))
        part = self.table if len(rows) == self.rows else self.table.take(rows)
        if self.layout.variable:
            return part
        variables = {drop_run(name) for name in names}
        others = {*self.layout.values} - variables
        return part.select([name for name in part.column_names if name not in others])

    def find_spec(self, run: int = 0) -> RunSpec | None:
        """Return the specification of a run, given by its index from 0; None if the metadata lack it."""
        if run not in self._cache.specs:
            self._cache.specs[run] = read_spec(self.metadata, run)
        return self._cache.specs[run]

    def choose(self, choices: ReadChoices) -> Log:
        """Return the same log with the columns of time and values that the user has chosen.

        Rows without a value in the new column of time are left out.

        Raises:
            LogError: the table has no such column, or it is not numeric.
        """
        notes = Notes()
        layout = choose_columns(self.table, choices)
        table, layout, _ = keep_timed_rows(self.table, layout, notes)
        return replace(
            self,
            table=table,
            layout=layout,
            notes=(*self.notes, *notes.texts()),
            _cache=LogCache(),
        )

    def add_derived(self, column: str, series: Sequence[Series]) -> Log:
        """Return a log with the series of a further derived variable; an earlier one of the same name is replaced.

        Args:
            column: Name of the variable, and of the new column of the table that has its values. The table gets no
                column if a series has several samples in one row.
            series: One series, or one for each run.
        """
        bare = self.drop_derived(column)
        derived = {**bare.derived, **{member.name: member for member in series}}
        table = bare.table
        if all((np.diff(member.rows) > 0).all() for member in series):
            cells = np.full(self.rows, np.nan)
            for member in series:
                cells[member.rows] = member.values
            table = table.append_column(column, pa.array(cells, from_pandas=True))
        return replace(bare, table=table, derived=derived)

    def drop_derived(self, column: str) -> Log:
        """Return the same log without the derived series of this name."""
        derived = {
            name: series for name, series in self.derived.items() if drop_run(name) != column
        }
        if len(derived) == len(self.derived):
            return self
        table = (
            self.table.drop_columns([column]) if column in self.table.column_names else self.table
        )
        cache = replace(self._cache, numbers={})
        return replace(self, table=table, derived=derived, _cache=cache)
