"""Lines as a program prints them: `NAME: number`, perhaps with a time."""

from __future__ import annotations

import re

import pyarrow as pa

from tuisim.datalog.opening.lines import Block
from tuisim.datalog.opening.notes import Notes
from tuisim.datalog.samples import parse_sample

_TABLE_ROW = re.compile(r"[,;\t]|^[^A-Za-z]*[0-9][^A-Za-z]*$")
"""Cells with a separator between them, or nothing but numbers."""


class PrintedReader:
    """Reads blocks of one file.

    Args:
        notes: Where it says what was wrong.
    """

    def __init__(self, notes: Notes) -> None:
        self._notes = notes

    def read(self, block: Block) -> pa.Table | None:
        """Return the samples of a block; None if there is none. Without a printed time that column is empty."""
        rows, names, values, times, others = [], [], [], [], []
        for row, line in block.lines():
            sample = parse_sample(line)
            if sample is None:
                others.append(row)
                continue
            name, value, time_s = sample
            rows.append(row)
            names.append(name)
            values.append(value)
            times.append(time_s)
        if others:
            self._notes.add("lines are no sample", others)
        if not rows:
            return None
        return pa.table(
            {
                "row": pa.array(rows, pa.float64()),
                "variable": pa.array(names, pa.string()),
                "value": pa.array(values, pa.float64()),
                "time": pa.array(times, pa.float64()),
            }
        )


def looks_printed(lines: list[str]) -> bool:
    """Return whether more of some lines are samples than look like rows of a table; other words count for neither."""
    others = [line for line in lines if parse_sample(line) is None]
    return len(lines) - len(others) > sum(_TABLE_ROW.search(line) is not None for line in others)
