"""The file of the rows that are done: what an interrupted batch goes on with."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tuisim.base.errors import ConfigError, ExportError
from tuisim.batch.sweep import PartialTable, find_partial

ROWS = {
    0: {"run": 1, "x_mm": 0.1 + 0.2, "end": "finished"},
    2: {"run": 3, "x_mm": math.nan, "end": "räised\n"},
}


def table(folder: Path, sha256: str = "a") -> PartialTable:
    return PartialTable(find_partial(folder / "out.csv"), {"sha256": sha256, "runs": 3})


def test_partial_rows_of_a_batch_are_read_back_bit_for_bit(tmp_path: Path) -> None:
    file = table(tmp_path).open({0: ROWS[0]})
    file.add(ROWS[2])
    file.close()
    assert repr(table(tmp_path).rows()) == repr(ROWS)


def test_without_a_file_of_partial_rows_no_run_counts_as_done(tmp_path: Path) -> None:
    assert table(tmp_path).rows() == {}


def test_a_cut_off_last_row_of_a_partial_table_is_left_out(tmp_path: Path) -> None:
    table(tmp_path).open(ROWS).close()
    path = find_partial(tmp_path / "out.csv")
    path.write_bytes(path.read_bytes()[:-5])
    rows = table(tmp_path).rows()
    assert list(rows) == [0]
    table(tmp_path).open(rows).close()
    assert list(table(tmp_path).rows()) == [0]


def test_a_partial_table_of_another_batch_is_refused(tmp_path: Path) -> None:
    table(tmp_path).open(ROWS).close()
    with pytest.raises(ConfigError, match=r"out.csv.part: is of another batch"):
        table(tmp_path, "b").rows()


def test_the_partial_table_is_removed_when_the_batch_is_done(tmp_path: Path) -> None:
    table(tmp_path).open(ROWS).remove()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_missing_is_reported(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="cannot write"):
        table(tmp_path / "none").open({})
