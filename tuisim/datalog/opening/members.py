"""Which series a log has, and which rows of its table belong to each."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.datalog.arrays import IntArray
from tuisim.datalog.opening.layout import Layout
from tuisim.datalog.opening.plain import whole_numbers, whole_numbers_of

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
