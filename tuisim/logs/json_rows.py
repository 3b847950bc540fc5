"""Rows in JSON, one object a line: also as Python prints dictionaries."""

from __future__ import annotations

import ast
import json
from contextlib import suppress
from typing import Any, TypeGuard

import pyarrow as pa

from tuisim.logs.blocks import Block
from tuisim.logs.warnings import Notes

_NAMELESS = "(no name)"


class JsonReader:
    """Reads blocks of JSON lines of one file; names and types of the columns are fixed by the first block.

    Columns are texts or numbers; if `exact`, each has the type that all its cells have, as in an export.
    """

    def __init__(self, notes: Notes, exact: bool = False) -> None:
        self._notes = notes
        self._exact = exact
        self._kinds: dict[str, bool] = {}
        """By column, whether it has numbers; missing while all its cells were empty."""

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it has none."""
        numbered_rows: list[tuple[int, dict[str, Any]]] = []
        broken: list[int] = []
        for row, line in block.lines():
            if line.strip() in ("[", "]", "[]"):
                continue
            objects = _parse_rows(line)
            numbered_rows += [(row, cells) for cells in objects]
            if not objects:
                broken.append(row)
        skipped = (
            "line is not a JSON object and was skipped",
            "lines are not JSON objects and were skipped",
        )
        self._notes.add(*skipped, broken)
        return self.build_table(numbered_rows) if numbered_rows else None

    def build_table(self, numbered_rows: list[tuple[int, dict[str, Any]]]) -> pa.Table:
        """Return a table of objects, each of which comes with its row in the file."""
        names = dict.fromkeys(name for _, cells in numbered_rows for name in cells)
        return pa.table(
            {
                _escape_surrogates(name) or _NAMELESS: self._build_column(name, numbered_rows)
                for name in names
            }
        )

    def _build_column(self, name: str, numbered_rows: list[tuple[int, dict[str, Any]]]) -> pa.Array:
        cells = [cells.get(name) for _, cells in numbered_rows]
        if self._exact:
            column = pa.array(cells)
            # Of numbers and truth values, a missing one is not a number.
            whole = column.null_count and (
                pa.types.is_null(column.type) or pa.types.is_boolean(column.type)
            )
            return column.cast(pa.float64()) if whole else column
        if name not in self._kinds:
            kinds = [_is_number(cell) for cell in cells if cell is not None]
            if not kinds:
                return pa.nulls(len(cells))
            self._kinds[name] = 2 * sum(kinds) >= len(kinds)
        if not self._kinds[name]:
            return pa.array(
                [None if cell is None else _format_cell(cell) for cell in cells], pa.string()
            )
        wrong = [
            row
            for (row, _), cell in zip(numbered_rows, cells, strict=True)
            if cell is not None and not _is_number(cell)
        ]
        self._notes.add(
            f"cell of {name!r} is not a number", f"cells of {name!r} are not numbers", wrong
        )
        return pa.array(
            [_float(cell) if _is_number(cell) else None for cell in cells], pa.float64()
        )


def _is_number(cell: object) -> TypeGuard[float]:
    # True and false count as 1 and 0.
    return isinstance(cell, int | float)


def _float(cell: float) -> float:
    try:
        return float(cell)
    except OverflowError:
        return float("inf") if cell > 0 else float("-inf")


def _format_cell(cell: object) -> str:
    return _escape_surrogates(cell) if isinstance(cell, str) else json.dumps(cell)


def _escape_surrogates(text: str) -> str:
    """Return a text with surrogates, which are halves of characters, as escape sequences."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


def parse_value(line: str) -> Any:
    """Return the value of a line in JSON, or as Python prints dictionaries and lists; None if it is neither."""
    text = line.strip().removesuffix(",")
    # Values that are nested too deeply for a parser raise RecursionError or MemoryError.
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    with suppress(SyntaxError, ValueError, MemoryError, TypeError, RecursionError):
        return ast.literal_eval(text)
    return None


def is_row(line: str) -> bool:
    """Return whether a line is an object, or a list of objects."""
    return bool(_parse_rows(line))


def _parse_rows(line: str) -> list[dict[str, Any]]:
    """Return the object, or the objects in the list, of a line; none if it is anything else."""
    value = parse_value(line)
    rows = value if isinstance(value, list) else [value]
    return rows if all(isinstance(row, dict) for row in rows) else []
