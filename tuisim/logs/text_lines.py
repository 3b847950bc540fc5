"""Lines of text as rows: JSON objects, and `NAME: number` as programs print it."""

from __future__ import annotations

import json
import re
from typing import Any

import pyarrow as pa

from tuisim.logs.blocks import Block
from tuisim.logs.warnings import Notes
from tuisim.runs.samples import parse_sample

_NAMELESS = "(no name)"


class JsonReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first.

    Args:
        notes: Receives warnings about bad input.
        exact: Whether each column has the type that all its cells have, as in an export; else texts or numbers.
    """

    def __init__(self, notes: Notes, exact: bool = False) -> None:
        self._notes, self._exact = notes, exact
        self._kinds: dict[str, bool] = {}
        """By column, whether it holds numbers; missing while it held nothing."""

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if there is none."""
        found: list[tuple[int, dict[str, Any]]] = []
        broken: list[int] = []
        for row, line in block.lines():
            text = line.strip()
            if text in ("[", "]", "[]"):
                continue
            try:
                value = json.loads(text.removesuffix(","))
            except (ValueError, RecursionError):
                broken.append(row)
                continue
            objects = value if isinstance(value, list) else [value]
            if objects and all(isinstance(one, dict) for one in objects):
                found += [(row, one) for one in objects]
            else:
                broken.append(row)
        if broken:
            self._notes.add(
                "line is no JSON object and was left out", "lines are no JSON object and were left out", broken
            )
        if not found:
            return None
        names = dict.fromkeys(name for _, cells in found for name in cells)
        return pa.table({_valid(name) or _NAMELESS: self._column(name, found) for name in names})

    def _column(self, name: str, found: list[tuple[int, dict[str, Any]]]) -> pa.Array:
        cells = [cells.get(name) for _, cells in found]
        if self._exact:
            column = pa.array(cells)
            # Of numbers and truth values, a missing one is not a number.
            whole = column.null_count and (pa.types.is_null(column.type) or pa.types.is_boolean(column.type))
            return column.cast(pa.float64()) if whole else column
        if name not in self._kinds:
            kinds = [_is_number(cell) for cell in cells if cell is not None]
            if not kinds:
                return pa.nulls(len(cells), pa.float64())
            self._kinds[name] = 2 * sum(kinds) >= len(kinds)
        if not self._kinds[name]:
            return pa.array([None if cell is None else _text(cell) for cell in cells], pa.string())
        wrong = [row for (row, _), cell in zip(found, cells, strict=True) if cell is not None and not _is_number(cell)]
        if wrong:
            self._notes.add(f"cell of {name!r} holds no number", f"cells of {name!r} hold no number", wrong)
        return pa.array(
            [_float(cell) if cell is not None and _is_number(cell) else None for cell in cells], pa.float64()
        )


def _is_number(cell: object) -> bool:
    # What is true or false is 1 or 0.
    return isinstance(cell, int | float)


def _float(cell: float) -> float:
    try:
        return float(cell)
    except OverflowError:
        return float("inf") if cell > 0 else float("-inf")


def _text(cell: object) -> str:
    return _valid(cell) if isinstance(cell, str) else json.dumps(cell)


def _valid(text: str) -> str:
    """The same text, halves of characters told by their numbers."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


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
            self._notes.add("line is no sample", "lines are no sample", others)
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
