"""Rows in JSON, one object a line: also as Python prints dictionaries."""

from __future__ import annotations

import ast
import json
from contextlib import suppress
from typing import Any

import pyarrow as pa

from tuisim.logs.blocks import Block
from tuisim.logs.typed_columns import TypedColumns
from tuisim.logs.warnings import Notes

_NAMELESS = "(no name)"


class JsonReader:
    """Reads blocks of JSON lines of one file; names and types of the columns are fixed by the first block."""

    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._columns = TypedColumns(notes, "")

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
        texts = {
            _escape_surrogates(str(name)) or _NAMELESS: pa.array(
                [_format_cell(cells.get(name)) for _, cells in numbered_rows], pa.string()
            )
            for name in names
        }
        return self._columns.convert(texts, lambda: [row for row, _ in numbered_rows], "")


def _format_cell(cell: object) -> str | None:
    if cell is None:
        return None
    # Python prints more than JSON has: sets, bytes, numbers as names.
    text = cell if isinstance(cell, str) else json.dumps(cell, default=repr, skipkeys=True)
    return _escape_surrogates(text)


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
