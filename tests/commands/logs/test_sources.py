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


@pytest.mark.slow
def test_a_pipe(tmp_path: Path) -> None:
    command = f"{sys.executable} -m tuisim run log_greys | {sys.executable} -m tuisim log summary - --json"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command, shell=True, env=environment, cwd=tmp_path, capture_output=True, timeout=PATIENCE_S
    )
    assert json.loads(done.stdout)[0]["count"] == 51


def test_no_column_takes_the_place_of_another(here: Command, tmp_path: Path) -> None:
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
