"""The logs that the bench makes are logs like any other."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.bench.longlogs import KINDS, written
from tuisim.logs.reader import open_log

NAMES = {
    "samples": ("Colour", "Right", "Ultrasonic", "Gyro"),
    "telemetry": ("x_mm", "y_mm", "heading_deg", "left_position_deg"),
}


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@pytest.mark.parametrize("kind", KINDS)
def test_logs_drawn_for_the_bench_are_read_with_every_row(
    tmp_path: Path, kind: str, suffix: str
) -> None:
    table = KINDS[kind](2000)
    log = open_log(written(table, tmp_path / f"log{suffix}"))
    assert (log.rows, log.left_out, log.names[:4]) == (2000, 0, NAMES[kind])
    assert log.table.column("time").to_pylist() == pytest.approx(table.column("time").to_pylist())
    if kind == "samples":
        assert str(log.table.column("index")[30].as_py()) == "0 days 00:00:01.500000"
