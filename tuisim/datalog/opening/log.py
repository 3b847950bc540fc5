"""A log as the analyser sees it: a table, what its columns mean, and the series in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.datalog.arrays import FloatArray, IntArray
from tuisim.datalog.opening.layout import ROW, Layout
from tuisim.datalog.opening.moments import seconds_of
from tuisim.errors import LogError


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
    """Row of the table that each sample stands in, from 0."""
    run: int = 0
    """Number in the run column, 0 if there is none."""


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
    _made: dict[str, Series] = field(default_factory=dict, repr=False, compare=False)

    @property
    def rows(self) -> int:
        """How many rows the table has."""
        return int(self.table.num_rows)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the series, in the order in which they first appear; of several runs with `#` and its number."""
        return tuple(name for name, _, _ in self._keys())

    def _keys(self) -> list[tuple[str, str, int]]:
        """Name, variable and run of each series."""
        layout, table = self.layout, self.table
        runs = pc.unique(table.column(layout.run)).to_pylist() if layout.run else [0]
        several = len(runs) > 1
        if not layout.variable:
            variables = [(name, int(run or 0)) for run in runs for name in layout.values]
        elif not several:
            variables = [
                (name, int(runs[0] or 0) if runs else 0)
                for name in pc.unique(table.column(layout.variable)).to_pylist()
            ]
        else:
            pairs = table.select([layout.variable, layout.run]).group_by([layout.variable, layout.run]).aggregate([])
            found = zip(pairs.column(0).to_pylist(), pairs.column(1).to_pylist(), strict=True)
            variables = [(name, int(run or 0)) for name, run in found]
        return [(f"{name} #{run}" if several else str(name), str(name), run) for name, run in variables]

    def series(self, name: str) -> Series:
        """Return a series.

        Raises:
            LogError: there is none of that name.
        """
        if name not in self._made:
            for key, variable, run in self._keys():
                if key == name:
                    self._made[name] = self._series(key, variable, run)
                    break
            else:
                raise LogError(f"no variable {name!r}", f"there are {', '.join(self.names) or 'none'}", file=self.title)
        return self._made[name]

    def _series(self, name: str, variable: str, run: int) -> Series:
        layout, mask = self.layout, None
        if layout.variable:
            mask = pc.equal(self.table.column(layout.variable).cast(pa.string()), variable)
        if layout.run and name != variable:
            of_run = pc.equal(self.table.column(layout.run), run)
            mask = of_run if mask is None else pc.and_(mask, of_run)
        column = layout.values[0] if layout.variable else variable
        values = numbers_of(self.table.column(column))
        rows = np.arange(self.rows) if mask is None else np.flatnonzero(pc.fill_null(mask, False).to_numpy())
        if len(rows) != self.rows:
            values = values[rows]
        return Series(name, self._times(rows), values, rows, run)

    def _times(self, rows: IntArray) -> FloatArray:
        if self.layout.time == ROW:
            return np.arange(len(rows), dtype=np.float64)
        times = seconds_of(self.table.column(self.layout.time), self.layout.unit_s)
        times = times if len(rows) == self.rows else times[rows]
        # A sample without a time of its own stands at the one before it.
        missing = ~np.isfinite(times)
        if missing.any():
            last = np.maximum.accumulate(np.where(missing, 0, np.arange(len(times))))
            times = np.nan_to_num(times[last])
        return times

    def with_layout(self, layout: Layout) -> Log:
        """Return the same log with another meaning of its columns."""
        return replace(self, layout=layout, _made={})


def numbers_of(column: pa.ChunkedArray) -> FloatArray:
    """Return a column of numbers as floats, shape (n,); not a number where it is empty. Copied only if it must be."""
    if pa.types.is_floating(column.type):
        found: FloatArray = column.to_numpy()
        return found
    return np.asarray(column.cast(pa.float64(), safe=False).to_numpy(), np.float64)
