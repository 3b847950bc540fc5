"""Rows in JSON, one object a line: also as Python prints dictionaries."""

from __future__ import annotations

import ast
import json
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
            text = line.strip()
            if text in ("[", "]", "[]"):
                continue
            try:
                value = parse_value(text.removesuffix(","))
            except (ValueError, RecursionError):
                broken.append(row)
                continue
            objects = value if isinstance(value, list) else [value]
            if objects and all(isinstance(cells, dict) for cells in objects):
                numbered_rows += [(row, cells) for cells in objects]
            else:
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


def parse_value(text: str) -> Any:
    """Return the value of a line in JSON, or as Python prints dictionaries and lists.

    Raises:
        ValueError: it is neither.
        RecursionError: it is nested too deeply.
    """
    try:
        return json.loads(text)
    except ValueError:
        if "'" not in text and "None" not in text and "True" not in text and "False" not in text:
            raise
    try:
        return ast.literal_eval(text)
    except (SyntaxError, MemoryError, TypeError) as error:
        raise ValueError("neither JSON nor Python") from error
