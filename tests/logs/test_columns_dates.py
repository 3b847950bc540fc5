"""Columns of moments and spans are seconds, whatever they are kept as."""

from __future__ import annotations

import datetime as dt
from decimal import Decimal
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from numpy.testing import assert_allclose

from tests.cases import cases
from tuisim.logs.columns import Layout, read_times
from tuisim.logs.export import EXPORTERS, export_log
from tuisim.logs.reader import open_log

NAN = float("nan")
TEXTS: dict[str, tuple[list[str | None], list[float]]] = {
    "dates": (["2024-02-28", None, "2024-03-01"], [0, NAN, 172800]),
    "without seconds": (["2024-01-01 10:00", "2024-01-01T10:01Z"], [0, 60]),
    "parts of a second": (["2024-01-01T10:00:00.25Z", "2024-01-01T10:00:01.5Z"], [0, 1.25]),
    "two zones": (["2024-03-31T01:59:59+0100", "2024-03-31T03:00:00.5+02:00", "x"], [0, 1.5, NAN]),
    "spans": (["10:00:00", "-00:00:01.5"], [36000, -1.5]),
}


@cases("texts, expected", TEXTS)
def test_dates_and_times_as_text_are_read_as_seconds(
    texts: list[str | None], expected: list[float]
) -> None:
    assert_allclose(
        read_times(pa.table({"t": pa.array(texts, pa.string())}), Layout("t")).seconds,
        expected,
        atol=1e-9,
    )


KINDS: dict[str, tuple[pa.Array, list[float]]] = {
    "times of 32 bits": (pa.array([dt.time(1, 0, 1), None], pa.time32("ms")), [3601, NAN]),
    "times of 64 bits": (pa.array([dt.time(1, 0, 1), None], pa.time64("ns")), [3601, NAN]),
    "dates": (pa.array([dt.date(2024, 2, 28), dt.date(2024, 3, 1)]), [0, 172800]),
    "nanoseconds": (
        pa.array([None, 17 * 10**17 + 1, 17 * 10**17 + 4], "timestamp[ns]"),
        [NAN, 0, 3e-9],
    ),
    "spans": (pa.array([dt.timedelta(seconds=5)]), [5]),
}


@cases("column, expected", KINDS)
def test_timestamp_and_duration_columns_are_read_as_seconds(
    column: pa.Array, expected: list[float]
) -> None:
    assert_allclose(read_times(pa.table({"t": column}), Layout("t")).seconds, expected, rtol=1e-12)


@pytest.mark.parametrize("suffix", EXPORTERS)
def test_columns_of_any_kind_are_exported(tmp_path: Path, suffix: str) -> None:
    columns = {
        "time": [0.0, 1.0],
        "clock": pa.array([dt.time(1), None], pa.time32("s")),
        "date": pa.array([dt.datetime(2024, 1, 1), None]),
        "variable": pa.array([b"\xff", None]),
        "red": [1.0, 2.0],
        "pixels": [[1, 2], None],
    }
    pq.write_table(pa.table(columns), tmp_path / "a.parquet")
    log = open_log(tmp_path / "a.parquet")
    export_log(log, log.table, tmp_path / f"b{suffix}")
    assert open_log(tmp_path / f"b{suffix}").series("red").values.tolist() == [1, 2]


def test_decimal_and_string_view_columns_of_parquet_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    names = pa.array(["red", "blue"], pa.string_view())
    pq.write_table(
        pa.table(
            {"time": [0.0, 1.0], "variable": names, "value": [Decimal("1.5"), Decimal("2.5")]}
        ),
        path,
    )
    assert [open_log(path).series(name).values.tolist() for name in ("red", "blue")] == [
        [1.5],
        [2.5],
    ]
