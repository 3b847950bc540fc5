"""JSON in one piece: rows, columns, and what is neither."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.logs.log_cases import Case, Read, check_input, times, values

ROWS = [{"time": 0, "red": 1}, {"time": 0.5, "red": 2}]
COLUMNS = {"time": [0, 0.5], "red": [1, 2]}
TWO = Read(2, check=lambda log: (times(log), values(log)) == ([0, 0.5], [1, 2]))


def text(value: Any, indent: int | None = None) -> bytes:
    return json.dumps(value, indent=indent).encode()


CASES: dict[str, Case] = {
    "columns": ("a.json", text(COLUMNS), TWO),
    "columns under another name": ("a.txt", text(COLUMNS), TWO),
    "a text that is missing": (
        "a.jsonl",
        b'{"time": 0, "red": 1, "who": "a"}\n{"time": 1, "red": 2}\n',
        Read(2, check=lambda log: log.table["who"].to_pylist() == ["a", None]),
    ),
    "columns in a file of rows": ("a.jsonl", text(COLUMNS) + b"\n", TWO),
    "columns on many lines": ("a.json", text(COLUMNS, 2), TWO),
    "rows on many lines": ("a.json", text(ROWS, 4), TWO),
    "rows on many lines under another name": ("a.log", text(ROWS, 4), TWO),
    "rows behind each other": (
        "a.json",
        b"\n".join(text(row, 2) for row in ROWS),
        "not complete JSON: Extra data",
    ),
    "one row on many lines": (
        "a.json",
        text(ROWS[1], 2),
        Read(1, check=lambda log: values(log) == [2]),
    ),
    "lists with names": ("a.json", text([["time", "red"], [0, 1], [0.5, 2]]), TWO),
    "lists": (
        "a.json",
        b"[0, 1]\n[0.5, 2]\n",
        Read(2, ("column 2",), check=lambda log: times(log, "column 2") == [0, 0.5]),
    ),
    "numbers": (
        "a.txt",
        b"[5, 6, 7]",
        Read(3, ("column 1",), note="no header"),
    ),
    "columns with labels, as pandas writes them": (
        "a.json",
        text({"time": {"0": 0, "1": 0.5}, "red": {"0": 1, "1": 2}}),
        TWO,
    ),
    "rows in an object": (
        "a.json",
        text({"robot": {"wheel_mm": 56}, "data": ROWS}, 1),
        Read(2, note="only the table 'data'", check=TWO.check),
    ),
    "columns in an object": (
        "a.json",
        text({"version": 1, "log": COLUMNS}),
        Read(2, note="only the table 'log'", check=TWO.check),
    ),
    "words beside columns": (
        "a.json",
        text({"robot": "x", **COLUMNS}),
        Read(2, note="without 'robot'", check=TWO.check),
    ),
    "numbers beside a column": (
        "a.json",
        text({"time": 0, "red": [1, 2, 3]}),
        Read(3, note="without 'time'"),
    ),
    "empty cells": (
        "a.json",
        text({"time": [0, 0.5], "red": [None, 2]}),
        Read(2, check=lambda log: values(log)[1] == 2),
    ),
    "a word among the numbers": (
        "a.json",
        text({"time": [0, 1, 2], "red": [1, "x", 3]}),
        Read(3, left_out=1, note="(row 2)"),
    ),
    "rows and other values": (
        "a.json",
        text([*ROWS, 5, None], 1),
        Read(2, left_out=2, note="2 values are not rows", check=TWO.check),
    ),
    "unequal columns": (
        "a.json",
        text({"a": [0, 1], "b": [2]}),
        "columns of different lengths",
    ),
    "two tables": ("a.json", text({"a": ROWS, "b": ROWS}), "has several tables: 'a', 'b'"),
    "a single number": ("a.json", b"5", "is a single JSON value, 5, not a table"),
    "a truncated document": (
        "a.json",
        text(ROWS, 2)[:-8],
        r"no rows: not complete JSON: .* line 9 column",
    ),
    "a truncated document with a row on a line": (
        "a.json",
        b'{"data": [\n{"time": 0, "red": 1},\n{"tim',
        Read(1, left_out=2),
    ),
    "an empty list": ("a.json", b"[]", "no rows"),
    "an empty object": ("a.json", b"{}", "no rows"),
    "empty columns": ("a.json", b'{"a": [], "b": []}', "no rows"),
    "a line of more than a megabyte": ("a.json", text({"red": [1.25] * 300_000}), Read(300_000)),
}


@pytest.mark.slow_cases("a line of more than a megabyte")
@cases("name, content, expected", CASES)
def test_a_json_document_is_read_as_a_log_of_rows_or_columns(
    tmp_path: Path, name: str, content: bytes, expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)
