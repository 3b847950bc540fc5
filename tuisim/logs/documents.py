"""JSON documents: rows as objects or lists, and columns, on any number of lines."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import pyarrow as pa

from tuisim.base.errors import LogError, counted, listed, shortened
from tuisim.logs.arrow import make_names_unique
from tuisim.logs.blocks import MAX_DOCUMENT_BYTES, Block
from tuisim.logs.columns import NAMES, parse_time_name
from tuisim.logs.json_rows import JsonReader, parse_value
from tuisim.logs.warnings import Notes

_ALLOWED = "a JSON log is rows as objects, or an object of columns that have equal lengths"
_TIME_NAMES = frozenset(NAMES)


def is_json_start(lines: Sequence[str]) -> bool:
    """Return whether a text with these first lines is JSON."""
    first = lines[0].strip() if lines else ""
    if first == "[" or first.startswith(("{", "[{")):
        return True
    return first.startswith("[") and _parse_value(first) is not None


def has_objects(lines: Sequence[str]) -> bool:
    """Return whether most of the lines are a JSON object each."""
    return 2 * sum(line.lstrip().startswith("{") and _is_row(line) for line in lines) > len(lines)


def is_document(lines: Sequence[str]) -> bool:
    """Return whether JSON with these first lines is one document, not a row on each line."""
    first = lines[0].strip()
    if len(lines) == 1 or not _is_row(first):
        return not (first == "[" and len(lines) > 1 and _is_row(lines[1]))
    return False


def _parse_value(line: str) -> Any:
    try:
        return parse_value(line.strip().removesuffix(","))
    except (ValueError, RecursionError):
        return None


def _is_row(line: str) -> bool:
    value = _parse_value(line)
    rows = value if isinstance(value, list) else [value]
    return bool(rows) and all(isinstance(row, dict) for row in rows)


class DocumentReader:
    """Reads one file of JSON: collects its blocks, and parses them at the end."""

    def __init__(self, notes: Notes) -> None:
        self._notes, self._lines = notes, JsonReader(notes)
        self._text = b""
        self._first_row = 1
        self._is_too_large = False

    def read(self, block: Block) -> pa.Table | None:
        """Keep a block and return None; once the file is too large for one document, return the rows on its lines."""
        if self._is_too_large:
            return self._lines.read(block)
        self._first_row = self._first_row if self._text else block.first_row
        self._text += block.text
        if len(self._text) <= MAX_DOCUMENT_BYTES:
            return None
        self._is_too_large = True
        self._notes.say(f"larger than {MAX_DOCUMENT_BYTES >> 20} MiB: each line is read by itself")
        return self._lines.read(Block(self._first_row, self._text))

    def finish(self) -> pa.Table | None:
        """Return the rows of the document, None if it has none; of a damaged one, the rows that have their own line.

        Raises:
            LogError: it is no table.
        """
        if self._is_too_large:
            return None
        try:
            values = _parse_values(self._text.decode("utf-8"))
        except (ValueError, RecursionError) as error:
            table = self._lines.read(Block(self._first_row, self._text))
            if table is None:
                where = f" (line {error.lineno})" if isinstance(error, json.JSONDecodeError) else ""
                self._notes.say(f"not complete JSON{where}")
            return table
        return _build_table(values[0] if len(values) == 1 else values, self._notes)


def _parse_values(text: str) -> list[Any]:
    """Return the values that follow each other in a text."""
    decoder = json.JSONDecoder()
    values = []
    position = 0
    while position < len(text):
        if text[position].isspace():
            position += 1
            continue
        value, position = decoder.raw_decode(text, position)
        values.append(value)
    return values


def _build_table(value: Any, notes: Notes) -> pa.Table | None:
    """Return a JSON value as a table, None if it has no row."""
    if isinstance(value, list):
        return _build_table_from_rows(value, notes)
    if not isinstance(value, dict):
        raise LogError(
            f"is a single JSON value, {shortened(json.dumps(value), 40)}, not a table", _ALLOWED
        )
    if isinstance(value.get("columns"), list) and isinstance(value.get("data"), list):
        # pandas writes a frame like this with `orient="split"`.
        return _build_table_from_rows(
            value["data"], notes, [str(name) for name in value["columns"]]
        )
    inner = [name for name, cells in value.items() if _is_table(cells)]
    if len(inner) > 1:
        raise LogError(f"has several tables: {listed(map(repr, inner))}", _ALLOWED)
    if inner:
        notes.say(f"only the table {inner[0]!r} is read")
        return _build_table(value[inner[0]], notes)
    if value and all(isinstance(cells, dict) for cells in value.values()):
        # pandas writes a frame like this: an object of cells for each column.
        labels = dict.fromkeys(label for cells in value.values() for label in cells)
        return _build_table_from_rows(
            [{name: cells.get(label) for name, cells in value.items()} for label in labels], notes
        )
    return (
        _build_table_from_rows([value], notes)
        if _is_record(value)
        else _build_table_from_columns(value, notes)
    )


def _is_table(value: Any) -> bool:
    """Return whether a value in a document is a list of objects, or an object with lists."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(cell, dict) for cell in value)
    return isinstance(value, dict) and any(isinstance(cell, list) for cell in value.values())


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_record(cells: Mapping[str, Any]) -> bool:
    """Return whether an object is one row, not columns: without lists, or with numbers beside lists that are cells."""
    lists = [cell for cell in cells.values() if isinstance(cell, list)]
    numbers = [name for name, cell in cells.items() if _is_number(cell)]
    if not lists or not numbers:
        return not lists
    alike = len(lists) > 1 and len({len(values) for values in lists}) == 1
    return not alike or any(parse_time_name(name).base in _TIME_NAMES for name in numbers)


def _build_table_from_columns(value: Mapping[str, Any], notes: Notes) -> pa.Table | None:
    columns = {name: cells for name, cells in value.items() if isinstance(cells, list)}
    if len({len(cells) for cells in columns.values()}) > 1:
        lengths = listed(
            f"{name!r} has {counted(len(cells), 'value')}" for name, cells in columns.items()
        )
        raise LogError(f"columns of different lengths: {lengths}", _ALLOWED)
    others = [repr(name) for name in value if name not in columns]
    if others:
        notes.say(f"only the lists are read as columns, without {listed(others)}")
    rows = zip(*columns.values(), strict=True)
    return _build_table_from_rows([dict(zip(columns, cells, strict=True)) for cells in rows], notes)


def _build_table_from_rows(
    rows: Sequence[Any], notes: Notes, names: Sequence[str] = ()
) -> pa.Table | None:
    """Return rows that are objects, lists or single values as a table; None if they have no cells.

    Args:
        names: Names of the cells of lists.
    """
    if rows and not any(isinstance(row, list | dict) for row in rows):
        notes.say("a list of single values is read as one column")
        rows = [[row] for row in rows]
    if any(isinstance(row, list) for row in rows) and not any(
        isinstance(row, dict) for row in rows
    ):
        rows = _convert_lists(rows, names)
    objects = [(number, row) for number, row in enumerate(rows, 1) if isinstance(row, dict)]
    notes.add(
        "value is not a row and was skipped",
        "values are not rows and were skipped",
        [number for number, row in enumerate(rows, 1) if not isinstance(row, dict)],
    )
    return JsonReader(notes).build_table(objects) if any(row for _, row in objects) else None


def _convert_lists(rows: Sequence[Any], names: Sequence[str]) -> list[Any]:
    """Return rows with lists as objects. Without names, the first list may have them."""
    lists = [row for row in rows if isinstance(row, list)]
    first = lists[0]
    if not names and len(lists) > 1 and first and all(isinstance(cell, str) for cell in first):
        names = first
        rows = rows[1:]
    width = max(len(row) for row in lists)
    names = make_names_unique([*names, *[""] * (width - len(names))])
    return [dict(zip(names, row, strict=False)) if isinstance(row, list) else row for row in rows]
