"""Programs give the same exports, telemetry and JSON, to the byte, as before values were modelled as they are."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.config.golden.fixture import differences
from tests.config.golden.programs import PROGRAMS, read_runs, run_golden


@pytest.mark.quick_cases("read_once", "a cell of a notebook", "everything in a world")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_gives_what_it_gave(
    name: str, tmp_path: Path, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "80")
    assert differences(read_runs()[name], run_golden(PROGRAMS[name], folder)) == []
    # In a home of its own a run is the first.
    assert home.is_dir()


def test_the_programs_are_those_of_the_golden_file() -> None:
    recorded = read_runs()
    assert list(recorded) == list(PROGRAMS)
    assert len(recorded) >= 30
    assert {run["json"]["profile"] for run in recorded.values()} == {
        "robolab",
        "nbev3devsim",
        "ev3",
    }
    # Files without rows would tell nothing.
    assert all(run["files"]["t.csv"]["rows"] for run in recorded.values())
    assert sum(bool(run["files"]["s.csv"]["rows"]) for run in recorded.values()) >= 12
