"""Which series a log has and which rows are theirs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.cases import for_rows
from tuisim.logs.choices import ReadChoices
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log
from tuisim.logs.reader import open_log


def log_of(**columns: object) -> Log:
    table = pa.table(columns)
    return Log("test", table, choose_columns(table))


SMALL = (
    pa.array(["B", None, "A", "B"]).dictionary_encode().cast(pa.dictionary(pa.int8(), pa.string()))
)
TWICE = pa.DictionaryArray.from_arrays(pa.array([0, 1, 2, 1]), pa.array(["A", "B", "A"]))
ROWS = {
    "each in its order": (
        log_of(variable=["B", "A", "B"], value=[1.0, 2.0, 3.0]),
        {"B": [0, 2], "A": [1]},
    ),
    "coded names": (
        log_of(variable=pa.array(["B", "A", "B"]).dictionary_encode(), value=[1.0, 2.0, 3.0]),
        {"B": [0, 2], "A": [1]},
    ),
    "a name that is coded twice": (
        log_of(variable=TWICE, value=[1.0] * 4),
        {"A": [0, 2], "B": [1, 3]},
    ),
    "codes of one byte": (
        log_of(variable=SMALL, value=[1.0] * 4),
        {"B": [0, 3], "None": [], "A": [2]},
    ),
    "no name": (log_of(variable=["A", None, "A"], value=[1.0] * 3), {"A": [0, 2], "None": []}),
    "a variable called None": (log_of(variable=[None, "None"], value=[1.0] * 2), {"None": [1]}),
    "runs": (
        log_of(variable=["A", "A", "B", "A"], value=[1.0] * 4, run=[1, 2, 2, 1]),
        {"A #1": [0, 3], "A #2": [1], "B #2": [2]},
    ),
    "runs that are no whole numbers": (
        log_of(value=[1.0] * 4, run=[1.0, 1.5, None, float("nan")]),
        {"value #1": [0], "value #0": []},
    ),
    "columns of runs": (
        log_of(red=[2.0, 1.0], blue=[3.0, 4.0], run=[2, 1]),
        {"red #2": [0], "blue #2": [0], "red #1": [1], "blue #1": [1]},
    ),
    "one run": (log_of(red=[1.0, 2.0], run=[7, 7]), {"red": [0, 1]}),
    "no rows": (log_of(variable=pa.nulls(0, pa.string()), value=pa.nulls(0, pa.float64())), {}),
}


@for_rows("log, expected", ROWS)
def test_each_variable_of_a_log_has_its_rows(log: Log, expected: dict[str, list[int]]) -> None:
    assert {name: list(log.series(name).rows) for name in log.names} == expected
    assert list(log.names) == list(expected)


def test_variables_of_a_log_share_the_memory_of_their_times() -> None:
    log = log_of(time=[0.0, 1.0], red=[1.0, 2.0], blue=[3.0, 4.0])
    red, blue = log.series("red"), log.series("blue")
    assert np.shares_memory(red.time_s, blue.time_s)
    assert np.shares_memory(red.values, log.numbers("red"))


def test_a_log_column_that_stays_empty_is_read_as_missing_numbers(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,red,none\n1,2,\n2,3,NA\n")
    assert np.isnan(open_log(tmp_path / "a.csv").series("none").values).all()


def test_a_column_without_a_type_has_no_numbers(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    pq.write_table(
        pa.table({"time": [0.0, 1.0], "red": [5.0, 6.0], "none": pa.nulls(2)}),
        path,
        row_group_size=1,
    )
    assert np.isnan(open_log(path).series("none").values).all()


def test_infinite_numbers_in_a_log_raise_no_warning() -> None:
    infinite = float("inf")
    assert log_of(a=[infinite, infinite, 3.0], b=[1.0, 2.0, 3.0]).names == ("a", "b")


def test_a_layout_whose_time_is_missing_in_a_row_leaves_that_row_out() -> None:
    log = log_of(row=[0, 1, 2], at=[float("inf"), 7.0, None], a=[1.0, 2.0, 3.0])
    timed = log.choose(ReadChoices(time="at", value=("a",)))
    assert timed.series("a").time_s.tolist() == [7.0]
    assert timed.series("a").values.tolist() == [2.0]
    assert timed.notes == (
        "2 rows have no time and are left out: 'at' is empty there, or cannot be read",
    )


def test_the_rows_are_counted_if_none_has_a_time() -> None:
    log = log_of(at=pa.nulls(2, pa.float64()), a=[1.0, 2.0])
    timed = log.choose(ReadChoices(time="at", value=("a",)))
    assert timed.series("a").time_s.tolist() == [0.0, 1.0]
    assert timed.notes == ("no time in 'at' can be read: row numbers are used",)
