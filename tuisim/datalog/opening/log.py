"""A log as the analyser sees it: a table, what its columns mean, and the series in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pyarrow as pa

from tuisim.datalog.arrays import FloatArray, IntArray
from tuisim.datalog.opening.layout import ROW, Layout
from tuisim.datalog.opening.members import Member, members
from tuisim.datalog.opening.moments import seconds_of
from tuisim.datalog.opening.plain import numbers_of
from tuisim.errors import LogError, listed


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
