"""Columns of files that are read block by block."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.logs.blocks import BLOCK_BYTES
from tuisim.logs.reader import open_log

LONG = BLOCK_BYTES // 16


TEXTS = {
    # Of the last block, too short to tell whether texts repeat, the column is the same as of those before.
    "names that repeat": (
        lambda at: ("Colour", "Left")[at % 2],
        "dictionary<values=string, indices=int32, ordered=0>",
    ),
    "texts that are all different": ("{:07}x".format, "string"),
}


@pytest.mark.quick_cases("names that repeat")
@cases("text, kind", TEXTS)
def test_texts_of_a_csv_longer_than_one_block_are_read_to_the_end(
    tmp_path: Path, text: Callable[[int], str], kind: str
) -> None:
    lines = [f"{at},{text(at)},5" for at in range(LONG)]
    (tmp_path / "a.csv").write_text("time,variable,value\n" + "\n".join(lines) + "\n")
    log = open_log(tmp_path / "a.csv")
    assert log.rows == LONG and str(log.table.column("variable").type) == kind
    assert log.table.column("variable")[LONG - 1].as_py() == text(LONG - 1)


LATE = {"numbers": ("5.5", 5.5), "texts": ("five", "five")}


@pytest.mark.quick_cases(".csv-*")
@cases("cell, value", LATE)
@pytest.mark.parametrize("suffix", [".csv", ".jsonl"])
def test_a_column_that_is_empty_in_its_first_blocks_is_read_with_its_type(
    tmp_path: Path, suffix: str, cell: str, value: object
) -> None:
    quoted = cell if isinstance(value, float) else f'"{cell}"'
    empty = '{"time": 1, "late": null}\n'
    full = f'{{"time": 2, "late": {quoted}}}\n'
    if suffix == ".csv":
        empty = "1.00000000000000,\n"
        full = f"2,{cell}\n"
    head = "time,late\n" if suffix == ".csv" else ""
    path = tmp_path / f"a{suffix}"
    path.write_text(head + empty * (2 * BLOCK_BYTES // len(empty) // 8) + full)
    log = open_log(path)
    assert log.table.column("late")[log.rows - 1].as_py() == value
    assert log.table.column("late")[0].as_py() is None
