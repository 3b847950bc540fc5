"""Rows as objects: from lines of JSON, of Python's dictionaries or of names with values, and from JSON documents."""

from __future__ import annotations

import ast
import csv
import io
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import pyarrow as pa

from tuisim.base.errors import LogError, listed, shortened
from tuisim.logs.blocks import MAX_DOCUMENT_BYTES, Block
from tuisim.logs.cells import TypedColumns
from tuisim.logs.choices import ReadChoices
from tuisim.logs.text_tables import CsvReader
from tuisim.logs.warnings import Notes

_ALLOWED = "a JSON log is rows as objects, or an object of columns that have equal lengths"
_MAX_DEPTH = 8
_NAMELESS = "(no name)"
# Python's output can contain values that JSON does not have, such as sets and bytes.
_format_value = json.JSONEncoder(default=repr, skipkeys=True).encode

Row = Mapping[str, Any]
"""The cells of a row, by the names of their columns."""


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
        return self.build_table(numbered_rows)

    def build_table(self, numbered_rows: Sequence[tuple[int, Row]]) -> pa.Table | None:
        """Return objects as a table; None if they have no cells.

        Args:
            numbered_rows: The objects, each with its row in the file.
        """
        names = dict.fromkeys(name for _, cells in numbered_rows for name in cells)
        if not names:
            return None
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


def _list_cells(row: Row, prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield the cells of an object; those of objects in it have names with a point, such as `imu.x`."""
    for name, cell in row.items():
        if isinstance(cell, dict) and cell and prefix.count(".") < _MAX_DEPTH:
            yield from _list_cells(cell, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", cell


def _format_cell(cell: object) -> str | None:
    if cell is None:
        return None
    if type(cell) in (int, float):
        return repr(cell)
    return _escape_surrogates(cell if isinstance(cell, str) else _format_value(cell))


def _escape_surrogates(text: str) -> str:
    """Return a text in which surrogates, halves of characters, are replaced by escape sequences."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


def _parse_value(line: str) -> Any:
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


def _parse_rows(line: str) -> list[dict[str, Any]]:
    """Return the object in a line, or the objects in its list; empty for other lines."""
    value = _parse_value(line)
    rows = value if isinstance(value, list) else [value]
    are_objects = all(isinstance(row, dict) for row in rows)
    return [dict(_list_cells(row, "")) for row in rows] if are_objects else []


def is_json_start(lines: Sequence[str]) -> bool:
    """Return whether a text with these first lines is JSON."""
    first = lines[0].strip() if lines else ""
    if not first.startswith("["):
        return first.startswith("{")
    return first == "[" or first.startswith("[{") or _parse_value(first) is not None


def has_objects(lines: Sequence[str]) -> bool:
    """Return whether there are several lines, most of which are a JSON object each."""
    count = sum(isinstance(_parse_value(line), dict) for line in lines)
    return len(lines) > 1 and 2 * count > len(lines)


class DocumentReader:
    """Reads a file that is one JSON document: collects its blocks, and parses them at the end."""

    def __init__(self, notes: Notes, choices: ReadChoices) -> None:
        self._notes = notes
        self._choices = choices
        self._text = ""

    def read(self, block: Block) -> None:
        """Add a block of the file to the text that `finish` parses.

        Raises:
            LogError: the file is too large.
        """
        self._text += block.text
        if len(self._text) > MAX_DOCUMENT_BYTES:
            raise LogError(
                f"is JSON in one piece, larger than {MAX_DOCUMENT_BYTES >> 20} MiB",
                "write each row as an object on a line of its own",
            )

    def finish(self) -> pa.Table | None:
        """Return the rows of the document as a table; None if it has no rows.

        If the document is damaged, only those rows are returned that are each on a line of their own.

        Raises:
            LogError: the document is not a table.
        """
        try:
            value = json.loads(self._text)
        except (ValueError, RecursionError) as error:
            table = build_json_reader(self._notes).read(Block(1, self._text))
            if table is None:
                self._notes.say(f"not complete JSON: {error}")
            return table
        self._notes.noun = "row"
        return self._build_table(value)

    def _build_table(self, value: Any) -> pa.Table | None:
        if isinstance(value, dict):
            value = self._list_rows(value)
        if not isinstance(value, list):
            raise LogError(
                f"is a single JSON value, {shortened(json.dumps(value), 40)}, not a table", _ALLOWED
            )
        objects = [
            (number, dict(_list_cells(row, "")))
            for number, row in enumerate(value, 1)
            if isinstance(row, dict)
        ]
        if not objects:
            return self._build_from_lists(value)
        others = [number for number, row in enumerate(value, 1) if not isinstance(row, dict)]
        self._notes.add(
            "value is not a row and was skipped", "values are not rows and were skipped", others
        )
        return build_json_reader(self._notes).build_table(objects)

    def _build_from_lists(self, rows: Sequence[Any]) -> pa.Table | None:
        """Return a table of rows that are lists or single values; the first list may be the column names.

        The result is None if there are no rows.
        """
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(
            row if isinstance(row, list) else [row] for row in rows
        )
        return CsvReader(self._notes, self._choices).read(Block(1, text.getvalue()))

    def _list_rows(self, value: Mapping[str, Any]) -> list[Any]:
        """Return the rows that a JSON object stands for.

        If one value of the object is a table, these are its rows. Otherwise, lists in the object are columns, which are
        joined to rows. An object without lists is a single row.

        Raises:
            LogError: the object has several tables, or columns of different lengths.
        """
        inner = [name for name, cells in value.items() if _is_table(cells)]
        if len(inner) > 1:
            raise LogError(f"has several tables: {listed(map(repr, inner))}", _ALLOWED)
        if inner:
            self._notes.say(f"only the table {inner[0]!r} is read")
            table = value[inner[0]]
            return self._list_rows(table) if isinstance(table, dict) else table
        # pandas writes a frame as an object of cells for each column.
        has_labels = all(isinstance(cells, dict) for cells in value.values())
        columns = {n: cells for n, cells in value.items() if has_labels or isinstance(cells, list)}
        if not columns:
            return [value] if value else []
        others = [repr(name) for name in value if name not in columns]
        if others:
            self._notes.say(f"only the lists are read as columns, without {listed(others)}")
        import pandas as pd

        try:
            frame = pd.DataFrame(columns, dtype=object)
        except ValueError as error:
            raise LogError("has columns of different lengths", _ALLOWED) from error
        rows: list[Any] = frame.where(frame.notna(), None).to_dict("records")
        return rows


def _is_table(value: Any) -> bool:
    """Return whether a value in a JSON document is a table: a list of objects, or an object with at least one list."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(cell, dict) for cell in value)
    return isinstance(value, dict) and any(isinstance(cell, list) for cell in value.values())
