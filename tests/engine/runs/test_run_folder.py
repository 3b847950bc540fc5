"""Runs that another version has stored are refused in one sentence; those of this version keep their profile."""

from __future__ import annotations

import json
import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.running import Run
from tuisim.base.errors import LogError
from tuisim.engine.runs.catalogue import CATALOGUE_FILE
from tuisim.engine.runs.run_folder import read_run
from tuisim.engine.runs.store import RunStore

REFUSED = "stored by another version of tuisim: format 1, this one reads 3 (run its program again)"


@pytest.fixture
def earlier(run: Run) -> Path:
    """The folder of a run in an earlier format, with a recording that had been packed."""
    folder: Path = run("tank_drive.on_for_seconds(50, 50, 0.1)").run.folder
    data = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps(data | {"format": 1}))
    (folder / "telemetry.bin").rename(folder / "telemetry.bin.packed")
    with closing(sqlite3.connect(folder.parent.parent / CATALOGUE_FILE)) as catalogue:
        catalogue.execute("PRAGMA user_version = 1")
    return folder


@pytest.mark.parametrize(
    "words",
    [
        "runs rerun RUN",
        "log summary RUN",
        "open --run RUN",
    ],
)
def test_a_run_folder_of_another_format_is_refused_in_one_sentence(
    earlier: Path, here: Command, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    for stream in (sys.stdin, sys.stdout):
        monkeypatch.setattr(stream, "isatty", lambda: True)
    done = here(*words.replace("RUN", str(earlier)).split())
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"tuisim: {earlier / 'run.json'}: {REFUSED}\n"


def test_the_list_of_runs_names_folders_of_another_format(earlier: Path) -> None:
    (info,) = (info for info in RunStore(earlier.parent.parent).runs() if info.id == earlier.name)
    assert info.end == "damaged"
    assert info.summary == "stored by another version of tuisim: format 1, this one reads 3"


def test_a_run_file_with_an_unknown_motor_law_is_called_damaged(run: Run) -> None:
    folder = run("pass").run.folder
    data = json.loads((folder / "run.json").read_text())
    data["spec"]["profile"]["motor_law"] = "magnetic"
    (folder / "run.json").write_text(json.dumps(data))
    with pytest.raises(LogError, match="damaged: 'magnetic' is not a valid MotorLaw"):
        read_run(folder)
