"""Rows as objects, from lines of JSON, of Python's dictionaries, or of what else has names with values."""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

import pyarrow as pa

from tuisim.logs.blocks import Block
from tuisim.logs.typed_columns import TypedColumns
from tuisim.logs.warnings import Notes

_NAMELESS = "(no name)"
# Python's output can contain values that JSON does not have, such as sets and bytes.
_format_value = json.JSONEncoder(default=repr, skipkeys=True).encode

Row = Mapping[str, Any]
"""Cells by the names of their columns."""


class ObjectReader:
    """Reads, block by block, a file whose lines contain objects, such as JSON.

    The first block fixes the columns and their types.

    Args:
        notes: Receives warnings.
        parse: Returns the objects in a line, given its number and text; empty if it has none.
        kind: What a line must be, in the singular and in the plural, for warnings.
    """

    def __init__(
        self, notes: Notes, parse: Callable[[int, str], Sequence[Row]], *kind: str
    ) -> None:
        self._notes = notes
        self._parse = parse
        self._singular, self._plural = kind
        self._columns = TypedColumns(notes, "")

    def read(self, block: Block) -> pa.Table | None:
        """Return the objects in a block as a table; None if it has none."""
        numbered_rows: list[tuple[int, Row]] = []
        others: list[int] = []
        for number, line in block.lines():
            if line.strip() in ("[", "]", "[]"):
                continue
            rows = self._parse(number, line)
            numbered_rows += [(number, row) for row in rows]
            if not rows:
                others.append(number)
        self._notes.add(f"line is not {self._singular}", f"lines are not {self._plural}", others)
        return self.build_table(numbered_rows) if numbered_rows else None

    def build_table(self, numbered_rows: Sequence[tuple[int, Row]]) -> pa.Table:
        """Return objects as a table.

        Args:
            numbered_rows: The objects, each with its row in the file.
        """
        names = dict.fromkeys(name for _, cells in numbered_rows for name in cells)
        texts = {
            _escape_surrogates(str(name)) or _NAMELESS: pa.array(
                [_format_cell(cells.get(name)) for _, cells in numbered_rows], pa.string()
            )
            for name in names
        }
        return self._columns.convert(texts, lambda: [row for row, _ in numbered_rows], "")


def build_json_reader(notes: Notes) -> ObjectReader:
    """Return a reader for a file each of whose lines is a JSON object, or a list of objects."""
    return ObjectReader(notes, lambda _, line: _parse_rows(line), "a JSON object", "JSON objects")


def _format_cell(cell: object) -> str | None:
    if cell is None:
        return None
    if type(cell) in (int, float):
        return repr(cell)
    return _escape_surrogates(cell if isinstance(cell, str) else _format_value(cell))


def _escape_surrogates(text: str) -> str:
    """Return a text in which surrogates, halves of characters, are replaced by escape sequences."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


def parse_value(line: str) -> Any:
    """Return the value of a line in JSON, or in the form in which Python prints dictionaries and lists.

    The result is None for a line in neither form.
    """
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
    """Return the object in a line, or the objects in its list; empty for other lines."""
    value = parse_value(line)
    rows = value if isinstance(value, list) else [value]
    return rows if all(isinstance(row, dict) for row in rows) else []
