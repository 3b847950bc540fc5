"""What the commands for logs read: runs, files, a pipe."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest

from tests.conftest import ROOT, Command
from tests.running import PATIENCE_S
from tuisim.analysis.source import LogRequest
from tuisim.logs.choices import ReadChoices


@pytest.mark.slow
def test_a_log_is_read_from_a_pipe(tmp_path: Path) -> None:
    command = f"{sys.executable} -m tuisim run log_greys | {sys.executable} -m tuisim log summary - --json"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command, shell=True, env=environment, cwd=tmp_path, capture_output=True, timeout=PATIENCE_S
    )
    assert json.loads(done.stdout)[0]["count"] == 51


def test_columns_of_the_same_name_in_log_calc_get_numbers(here: Command, tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    rows = ((0, None, 7), (1, "time", 5), (2, "result", 6))
    path.write_text(
        "".join(json.dumps({"time": t, "variable": n, "value": v}) + "\n" for t, n, v in rows)
    )
    frame = pd.read_csv(
        StringIO(here("log", "calc", str(path), "--expression", "2 * result").stdout)
    )
    assert list(frame.columns) == ["time", "time (2)", "result", "result (2)"]
    assert frame.iloc[-1].tolist() == [2, 5, 6, 12]


def test_empty_run_says_how_to_log(here: Command, tmp_path: Path) -> None:
    program = tmp_path / "quiet.py"
    program.write_text("x = 1\n")
    here("run", str(program))
    done = here("log", "bands", "last")
    assert (done.returncode, "Colour: 50" in done.stderr) == (2, True)
    assert not math.isnan(
        json.loads(here("log", "summary", "last", "--telemetry", "--json").stdout)[0]["mean"]
    )


def test_log_bands_has_a_column_of_strays_only_if_there_are_any(
    here: Command, tmp_path: Path
) -> None:
    for name, stray in (("clean.csv", 3), ("stray.csv", 50)):
        values = [3, 3, 3, 3, stray, 3, 3, 3, 3]
        rows = "".join(f"{at},{value}\n" for at, value in enumerate(values))
        (tmp_path / name).write_text("time,red\n" + rows)
    assert "STRAYS" not in here("log", "bands", "clean.csv").stdout
    heads, band, _ = here("log", "bands", "stray.csv").stdout.splitlines()
    assert "SAMPLES  STRAYS  LEVEL" in heads
    assert band.split()[4:7] == ["9", "1", "3.00"]


def test_log_commands_read_a_file_as_chosen_in_the_analyser_and_say_so(
    here: Command, tmp_path: Path, home: Path
) -> None:
    (tmp_path / "log.csv").write_text("boot;light\n0;1\n20;2\n")
    LogRequest("log.csv").remember(ReadChoices(time="boot", unit="ms"))
    note = "read as chosen in the analyser: --time boot --unit ms (giving one of these options replaces all of them)"
    done = here("log", "summary", "log.csv")
    assert (done.returncode, f"note: log.csv: {note}\n" in done.stderr) == (0, True)
    (row,) = json.loads(here("log", "summary", "log.csv", "--json").stdout)
    assert (row["variable"], row["last_s"], row["notes"]) == ("light", 0.02, [note])
    assert f"note: log.csv: {note}\n" in here("log", "bands", "log.csv", "--json").stderr
    done = here("log", "summary", "log.csv", "--time", "", "--json")
    assert [row["variable"] for row in json.loads(done.stdout)] == ["boot", "light"]
