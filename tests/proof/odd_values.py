"""Well-formed files in which a value has become one of another type, or a text an odd one, at any depth."""

from __future__ import annotations

import csv
import io
import json
import sqlite3
import struct
import tempfile
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from random import Random
from typing import Any

import pyarrow as pa
import pyarrow.ipc
import pyarrow.parquet
import tomlkit

from tests.proof.odd_texts import odd_text

_DEEP = "nested deeply"
"""Stands for a value that is nested more deeply than data structures of Python can be."""
_VALUES: tuple[Any, ...] = (
    None,
    True,
    False,
    0,
    -1,
    1.5,
    10**30,
    1e308,
    float("nan"),
    float("-inf"),
    "",
    "x",
    "0",
    "../x",
    [],
    {},
    [[]],
    [{}],
    [None],
    [1, "x"],
    ["x"],
    [0, 0],
    {"": {}},
    {"x": None},
    {"x": [1]},
    _DEEP,
    _DEEP,
    _DEEP,
)
_CELLS = (
    "",
    "x",
    "nan",
    "-inf",
    "1e999",
    "0",
    "-1",
    "true",
    "1,5",
    "[]",
    "9" * 30,
    "2026-11-22",
    "0 days 00:00:01",
)
_FIELDS = tuple(
    [struct.pack("<I", number) for number in (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)]
    + [struct.pack("<d", number) for number in (0.0, -1.0, 1e308, float("nan"), float("inf"))]
)


class Syntax(StrEnum):
    """How the values of a file are written."""

    JSON = "JSON"
    ROWS = "a JSON text on each line"
    TOML = "TOML"
    FRONT = "TOML before other text"
    CSV = "CSV"
    PARQUET = "Parquet"
    ARROW = "Arrow"
    SQLITE = "SQLite"
    FIELDS = "fields of 4 or 8 bytes"

    @property
    def has_texts(self) -> bool:
        """Whether `with_odd_text` can change it."""
        return self in _TEXTS

    @property
    def is_text(self) -> bool:
        """Whether people can read it."""
        return self in (Syntax.JSON, Syntax.ROWS, Syntax.TOML, Syntax.FRONT, Syntax.CSV)


def with_odd_value(data: bytes, random: Random, syntax: Syntax) -> bytes:
    """Return the data with one or two values of another type."""
    for _ in range(random.choice((1, 1, 2))):
        data = _CHANGES[syntax](data, random)
    deep = _TOML_DEEP if syntax in (Syntax.TOML, Syntax.FRONT) else _JSON_DEEP
    opened, closed = random.choice(deep)
    depth = random.choice((60, 300, 20_000))
    return data.replace(f'"{_DEEP}"'.encode(), opened * depth + b"1" + closed * depth)


def with_odd_text(data: bytes, random: Random, syntax: Syntax) -> bytes:
    """Return the data with one text that is another one."""
    return _TEXTS[syntax](data, random, _with_other_text)


_TOO_DEEP = b"[" * 20_000 + b"]" * 20_000
_JSON_DEEP = ((b"[", b"]"), (b'{"x":', b"}"))
_TOML_DEEP = ((b"[\n", b"]\n"),)
"""Its lines are short, since long ones are refused before."""


def _places(data: Any, depth: int = 0) -> Iterator[tuple[int, Any, Any]]:
    """Yield depth, container and key of each value."""
    pairs = (
        data.items()
        if isinstance(data, dict)
        else enumerate(data)
        if isinstance(data, list)
        else ()
    )
    for key, value in pairs:
        yield depth, data, key
        yield from _places(value, depth + 1)


def _changed(data: Any, random: Random) -> Any:
    """Return the data with one change: each depth is as probable as the others."""
    root = [data]
    places = list(_places(root))
    depth = random.choice(sorted({at for at, _, _ in places}))
    _, inside, key = random.choice([place for place in places if place[0] == depth])
    match random.randrange(8):
        case 0 if depth:
            del inside[key]
        case 1:
            inside[key] = [inside[key]]
        case 2:
            inside[key] = {random.choice(("x", "", "0")): inside[key]}
        case 3 if isinstance(inside, dict):
            inside[random.choice(("", "x", f"{key}x"))] = inside.pop(key)
        case _:
            inside[key] = random.choice(_VALUES)
    return root[0]


def _with_other_text(data: Any, random: Random) -> Any:
    """Return the data with another text, or the same if it has none."""
    root = [data]
    if places := [
        (inside, key) for _, inside, key in _places(root) if isinstance(inside[key], str)
    ]:
        inside, key = random.choice(places)
        inside[key] = odd_text(random)
    return root[0]


_Change = Callable[[Any, Random], Any]


def _json(data: bytes, random: Random, change: _Change = _changed) -> bytes:
    return json.dumps(change(json.loads(data), random)).encode()


def _rows(data: bytes, random: Random, change: _Change = _changed) -> bytes:
    lines = data.splitlines()
    at = random.randrange(len(lines))
    lines[at] = _json(lines[at], random, change)
    return b"\n".join(lines) + b"\n"


def _of_toml(value: Any) -> Any:
    """Return a value in which nothing is None, which TOML cannot say."""
    if isinstance(value, dict):
        return {key: _of_toml(one) for key, one in value.items() if one is not None}
    return [_of_toml(one) for one in value if one is not None] if isinstance(value, list) else value


def _toml(data: bytes, random: Random, change: _Change = _changed) -> bytes:
    found = _of_toml(change(tomllib.loads(data.decode()), random))
    text = tomlkit.dumps(
        found if isinstance(found, dict) else {"x": "" if found is None else found}
    )
    return text.encode(errors="surrogateescape")


def _front(data: bytes, random: Random, change: _Change = _changed) -> bytes:
    start, front, rest = data.split(b"+++\n", 2)
    return b"+++\n".join((start, _toml(front, random, change), rest))


def _csv(data: bytes, random: Random) -> bytes:
    """Change a cell, or those of a whole column with or without its name."""
    rows = list(csv.reader(io.StringIO(data.decode())))
    column = random.randrange(len(rows[0]))
    cell = random.choice(_CELLS)
    row = random.randrange(len(rows))
    for changed in random.choice((rows, rows[1:], rows[row : row + 1])):
        changed[column : column + 1] = [cell]
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue().encode()


def _odd_column(count: int, random: Random) -> pa.Array:
    value, kind = random.choice(
        (
            (None, pa.null()),
            ("x", pa.string()),
            ("1.5", pa.large_string()),
            (True, pa.bool_()),
            (b"\xff", pa.binary()),
            ([1, 2], pa.list_(pa.int8())),
            ({"x": 1}, pa.struct({"x": pa.int8()})),
            (1, pa.timestamp("s", "UTC")),
            (1, pa.duration("ns")),
            (1, pa.date32()),
            (-(2**63), pa.int64()),
            (2**64 - 1, pa.uint64()),
            (float("nan"), pa.float16()),
            ("x", pa.dictionary(pa.int8(), pa.string())),
            (1, pa.time64("ns")),
        )
    )
    return pa.array([random.choice((value, value, None)) for _ in range(count)], kind)


def _changed_table(table: pa.Table, random: Random) -> pa.Table:
    """Return a table with another column, or other metadata."""
    metadata = dict(table.schema.metadata or {})
    if random.random() < 0.5:
        key = random.choice(sorted(metadata))
        return table.replace_schema_metadata({**metadata, key: _metadata(metadata[key], random)})
    at = random.randrange(table.num_columns)
    name = table.column_names[at]
    if random.random() < 0.2:
        return (
            table.remove_column(at)
            if random.random() < 0.5
            else table.append_column(name, table.column(at))
        )
    return table.set_column(at, name, _odd_column(table.num_rows, random)).replace_schema_metadata(
        metadata
    )


def _metadata(text: bytes, random: Random) -> bytes:
    # What a change before has nested deeply, Python cannot read either.
    return (
        text if _TOO_DEEP in text else _json(text, random).replace(f'"{_DEEP}"'.encode(), _TOO_DEEP)
    )


def _parquet(data: bytes, random: Random) -> bytes:
    out = io.BytesIO()
    pa.parquet.write_table(
        _changed_table(pa.parquet.ParquetFile(io.BytesIO(data)).read(), random), out
    )
    return out.getvalue()


def _arrow(data: bytes, random: Random) -> bytes:
    table = _changed_table(pa.ipc.open_file(data).read_all(), random)
    out = io.BytesIO()
    with pa.ipc.new_file(out, table.schema) as writer:
        writer.write_table(table)
    return out.getvalue()


def _sqlite(data: bytes, random: Random) -> bytes:
    with tempfile.NamedTemporaryFile() as file:
        place = Path(file.name)
        place.write_bytes(data)
        connection = sqlite3.connect(place)
        names = [row[1] for row in connection.execute("PRAGMA table_info(runs)")]
        value = random.choice(
            (None, -1, 2**62, 1.5, float("inf"), "", "x", "1.5", "[]", "a,b", b"", b"\xff")
        )
        every = random.choice(("", " WHERE number = (SELECT max(number) FROM runs)"))
        # Some values are refused in some columns.
        with suppress(sqlite3.IntegrityError):
            connection.execute(
                f'UPDATE OR IGNORE runs SET "{random.choice(names)}" = ?{every}', (value,)
            )
        connection.commit()
        connection.close()
        return place.read_bytes()


def _fields(data: bytes, random: Random) -> bytes:
    """Overwrite a field, in a third of the cases one of the header."""
    field = random.choice(_FIELDS)
    most = 64 if random.random() < 1 / 3 else len(data)
    at = random.randrange(0, max(1, min(most, len(data)) - len(field) + 1), 4)
    return data[:at] + field + data[at + len(field) :]


_CHANGES: Mapping[Syntax, Callable[[bytes, Random], bytes]] = {
    Syntax.JSON: _json,
    Syntax.ROWS: _rows,
    Syntax.TOML: _toml,
    Syntax.FRONT: _front,
    Syntax.CSV: _csv,
    Syntax.PARQUET: _parquet,
    Syntax.ARROW: _arrow,
    Syntax.SQLITE: _sqlite,
    Syntax.FIELDS: _fields,
}
_TEXTS: Mapping[Syntax, Callable[[bytes, Random, _Change], bytes]] = {
    Syntax.JSON: _json,
    Syntax.ROWS: _rows,
    Syntax.TOML: _toml,
    Syntax.FRONT: _front,
}
