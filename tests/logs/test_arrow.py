"""Columns of tables: as numbers and texts, compared, sorted, named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from tuisim.base.errors import LogError
from tuisim.engine.core.conditions import Operator, ValueCondition
from tuisim.logs.arrow import (
    build_table,
    build_text_array,
    convert_to_floats,
    format_cell,
    make_names_unique,
    match_condition,
    match_text,
    read_numbers,
    sort_places,
    wrap_int64,
)

NAN = float("nan")


def column(*parts: list[Any], kind: pa.DataType | None = None) -> pa.ChunkedArray:
    return pa.chunked_array([pa.array(part, kind) for part in parts], kind)


@pytest.mark.parametrize(
    "cells, expected",
    [
        (column([1.5, None], [2.5]), [1.5, NAN, 2.5]),
        (column([3, None]), [3.0, NAN]),
        (column([None, None], kind=pa.float64()), [NAN, NAN]),
        (column([0.5, None], kind=pa.float32()), [0.5, NAN]),
        (column([1.0, None, 3.0]).slice(1), [NAN, 3.0]),
        (pa.chunked_array([], pa.float64()), []),
    ],
    ids=["parts", "whole", "nulls", "short", "slice", "empty"],
)
def test_convert_to_floats_gives_numbers_with_nan_for_missing_cells(
    cells: pa.ChunkedArray, expected: list[float]
) -> None:
    np.testing.assert_array_equal(convert_to_floats(cells), expected)


@pytest.mark.parametrize("rows", [0, 1, 9])
def test_an_arrow_table_built_of_columns_equals_that_of_a_pandas_frame(rows: int) -> None:
    known = np.arange(rows) / 3
    columns: dict[str, Any] = {
        "index": (np.arange(rows) * 7).astype("m8[ns]"),
        "variable": [f"Größe {at}" for at in range(rows)],
        "known": known,
        "some": np.where(np.arange(rows) % 2 == 0, NAN, known),
        "strided": np.stack([known, known])[:, ::-1].T[:, 0],
        "line": np.arange(rows),
    }
    frame = pd.DataFrame({**columns, "variable": pd.Series(columns["variable"], dtype="str")})
    expected = pa.Table.from_pandas(frame, preserve_index=False).replace_schema_metadata()
    table = build_table(columns)
    table.validate(full=True)
    assert table.cast(expected.schema).equals(expected)


def test_wrapping_and_reading_int64_columns_gives_their_numbers() -> None:
    numbers = np.arange(5, dtype=np.int64)
    assert wrap_int64(numbers).to_pylist() == [0, 1, 2, 3, 4]
    chunk = pa.array([1, 2, 3], pa.int32()).slice(1)
    assert read_numbers(chunk).tolist() == [2, 3]
    assert read_numbers(chunk.slice(2)).tolist() == []


def test_texts_that_are_no_utf_8_are_replaced() -> None:
    assert build_text_array(["é", "", "\udcff"]).to_pylist() == ["é", "", "?"]
    assert build_table({"\udcff_mm": np.array([1.0])}).column_names == ["?_mm"]


@pytest.mark.parametrize(
    "cells, operator, value, expected",
    [
        (column([1, 2, None]), Operator.GREATER, "1.5", [False, True, False]),
        (column([1_500, 500], kind=pa.duration("ms")), Operator.LESS, "1", [False, True]),
        (column(["b", "a", None]), Operator.EQUAL, "a", [False, True, False]),
        (column(["Left", "right"]), Operator.CONTAINS, "LE", [True, False]),
        (column([12, 3]), Operator.CONTAINS, "2", [True, False]),
    ],
    ids=["numbers", "spans", "texts", "part of a text", "part of a number"],
)
def test_match_condition_finds_the_cells_that_meet_a_condition(
    cells: pa.ChunkedArray, operator: Operator, value: str, expected: list[bool]
) -> None:
    assert match_condition(cells, ValueCondition("a", operator, value)).tolist() == expected


def test_a_number_is_not_compared_with_a_text() -> None:
    with pytest.raises(LogError, match="'x' is not a number"):
        match_condition(column([1]), ValueCondition("a", Operator.LESS, "x"))


def test_dictionary_encoded_texts_are_sorted_as_texts() -> None:
    coded = column(["b", "a", "c"]).dictionary_encode()
    assert sort_places(coded, descending=False).tolist() == [1, 0, 2]
    assert sort_places(column([3, 1, 2]), descending=True).tolist() == [0, 2, 1]
    assert match_text(coded, "C").tolist() == [False, False, True]


@pytest.mark.parametrize(
    "cell, text",
    [
        (pa.scalar(1_234_567, pa.duration("us")), "1.235"),
        (pa.scalar(None, pa.duration("s")), ""),
        (pa.scalar(None, pa.string()), ""),
        (pa.scalar(1 / 3), "0.333333"),
        (pa.scalar(1_000_000_000), "1000000000"),
    ],
    ids=["span", "no span", "nothing", "fraction", "whole"],
)
def test_format_cell_writes_each_kind_of_cell(cell: pa.Scalar, text: str) -> None:
    assert format_cell(cell) == text


def test_columns_of_the_same_name_get_numbers() -> None:
    assert make_names_unique(["a", "a", "", "a", "a (2)"]) == [
        "a",
        "a (2)",
        "column 3",
        "a (3)",
        "a (2) (2)",
    ]
