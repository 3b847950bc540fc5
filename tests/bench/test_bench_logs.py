"""The logs that the bench makes are logs like any other; programs that are not installed are not measured."""

from __future__ import annotations

import json
from math import isnan
from pathlib import Path

import pytest

from tests.bench.figures import as_json, as_table
from tests.bench.longlogs import KINDS, written
from tests.bench.others import TOOLONG, VISIDATA, others
from tuisim.logs.reader import open_log

NAMES = {
    "samples": ("Colour", "Right", "Ultrasonic", "Gyro"),
    "telemetry": ("x_mm", "y_mm", "heading_deg", "left_position_deg"),
}


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_long_log_is_read_whole(tmp_path: Path, kind: str, suffix: str) -> None:
    table = KINDS[kind](2000)
    log = open_log(written(table, tmp_path / f"log{suffix}"))
    assert (log.rows, log.left_out, log.names[:4]) == (2000, 0, NAMES[kind])
    assert log.table.column("time").to_pylist() == pytest.approx(table.column("time").to_pylist())
    if kind == "samples":
        assert str(log.table.column("index")[30].as_py()) == "0 days 00:00:01.500000"


def test_what_is_not_installed_is_not_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    for _, variable, _ in (VISIDATA, TOOLONG):
        monkeypatch.delenv(variable, raising=False)
    figures = list(others(tmp_path / "log.csv"))
    assert [figure.name.rpartition(": ")[2] for figure in figures] == ["not installed"] * 2
    assert all(isnan(figure.value) for figure in figures)
    assert all(line.endswith("–") for line in as_table(figures).splitlines()[1:])
    assert [entry["value"] for entry in json.loads(as_json(figures))] == [None, None]
