"""Tables of a log on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from tests.conftest import Command


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A log of two variables."""
    path = tmp_path / "two.csv"
    path.write_text("time,left,right\n" + "".join(f"{at / 2},{at},{10 - at}\n" for at in range(10)))
    return path


def test_a_summary_has_count_mean_and_limits(here: Command, log: Path) -> None:
    left, right = json.loads(here("log", "summary", str(log), "--json").stdout)
    assert (left["variable"], left["count"], left["mean"], left["max"]) == ("left", 10, 4.5, 9.0)
    assert (right["min"], right["first_s"], right["last_s"]) == (1.0, 0.0, 4.5)


def test_a_row_without_a_readable_time_has_no_part_in_any_table(
    here: Command, tmp_path: Path
) -> None:
    path = tmp_path / "bad.csv"
    path.write_text("Time;Speed\n0,0;1,5\n1,0;2,0\nabc;7,0\n3,0;2,5\n4,0;x\n")
    summary = here("log", "summary", str(path), "--json")
    (speed,) = json.loads(summary.stdout)
    assert (speed["count"], speed["max"], speed["last_s"]) == (3, 2.5, 3.0)
    assert "1 cell of 'Time' is not a number (line 4)" in speed["notes"]
    assert "1 row has no time and is left out" in "; ".join(speed["notes"])
    assert json.loads(here("log", "events", str(path), "--at", "6", "--json").stdout) == []
    resampled = here("log", "resample", str(path), "--period", "1").stdout
    assert resampled.split()[1:4] == ["0.0,1.5", "1.0,2.0", "2.0,2.0"]


def test_events_list_the_commands_to_a_motor(here: Command, log: Path) -> None:
    here("run", "square")
    rows = json.loads(here("log", "events", "last", "--when", "command left", "--json").stdout)
    assert rows and {row["part"] for row in rows} == {"left motor B"}
    assert any("°/s" in row["asked"] and "°" in row["came"] for row in rows)
    table = here("log", "events", "last", "--when", "command left").stdout
    assert table.split()[:2] == ["PART", "TIME"] and rows[-1]["asked"] in table
    refused = here("log", "events", str(log), "--when", "command")
    assert refused.returncode == 2 and "only runs have commands" in refused.stderr


def test_an_event_has_the_row_that_the_analyser_shows(here: Command, log: Path) -> None:
    (event,) = json.loads(here("log", "events", str(log), "--when", "left > 4.5", "--json").stdout)
    assert (event["value"], event["row"]) == (5.0, 6)


def test_log_reckon_without_noise_is_exact(here: Command) -> None:
    here("run", "square", "-M", "300")
    here("log", "reckon", "last", "--out", "reckoned.csv")
    assert pd.read_csv("reckoned.csv").error_mm.max() < 0.01
    lines = here("log", "reckon", "last").stdout.splitlines()
    assert lines[-1].startswith("dead reckoning: 0.00 mm off at the end, at most 0.00 mm")


def test_log_reckon_is_wrong_where_the_robot_drifts(here: Command) -> None:
    here("run", "square", "--drift", "typical")
    rows = [
        json.loads(line) for line in here("log", "reckon", "last", "--json").stdout.splitlines()
    ]
    assert len(rows) > 500 and rows[-1]["error_mm"] > 1
    head, real, reckoned, error, summary = here("log", "reckon", "last").stdout.splitlines()
    assert head.split() == ["AT", "THE", "END", "X", "MM", "Y", "MM", "HEADING", "DEG"]
    for name, line in (("x_mm", 1), ("y_mm", 2)):
        assert real.split()[line] == f"{rows[-1][name]:.2f}"
        assert reckoned.split()[line] == f"{rows[-1][f'reckoned_{name}']:.2f}"
        assert error.split()[line] == f"{rows[-1][f'reckoned_{name}'] - rows[-1][name]:.2f}"
    assert summary.startswith(
        f"dead reckoning: {rows[-1]['error_mm']:.2f} mm off at the end, at most "
    )


def test_log_derive_prints_json_with_every_digit(here: Command, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("time_s,v\n0,0.30000000000000004\n300000,1.3\n300000,inf\n")
    rows = [
        json.loads(line) for line in here("log", "derive", str(path), "--json").stdout.splitlines()
    ]
    assert [row["value"] for row in rows] == [0.1 + 0.2, 1.3, None]
    assert rows[0]["derivative"] == (1.3 - (0.1 + 0.2)) / 3e5
