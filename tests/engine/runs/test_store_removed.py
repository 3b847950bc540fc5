"""A run that another process removes meanwhile is gone, and not damaged."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.engine.runs.run_recorder import PROGRAM
from tuisim.base.errors import LogError
from tuisim.commands.rerun import rerun
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs import run_folder
from tuisim.engine.runs import store as store_module
from tuisim.engine.runs.catalogue import CATALOGUE_FILE, RunInfo
from tuisim.engine.runs.store import NewRun, RunStore

READ = run_folder.read_run_file


@pytest.fixture
def run(home: Path) -> NewRun:
    """A run that was interrupted."""
    found = RunStore().create_run(PROGRAM, RunSpec(RobotSpec(), WorldSpec(), ROBOLAB))
    os.close(found.lock_fd)
    return found


def remove_before_reading(folder: Path) -> dict[str, Any]:
    shutil.rmtree(folder, ignore_errors=True)
    return READ(folder)


@pytest.mark.parametrize(
    "is_made_again", [False, True], ids=["a list", "a list that is made again"]
)
def test_a_removed_run_is_not_listed(
    home: Path, run: NewRun, monkeypatch: pytest.MonkeyPatch, is_made_again: bool
) -> None:
    if is_made_again:
        (home / CATALOGUE_FILE).unlink()
    monkeypatch.setattr(store_module, "read_run_file", remove_before_reading)
    assert RunStore().runs() == []


def test_loading_a_run_that_was_just_removed_says_so(
    run: NewRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    def find(store: RunStore, _: str) -> RunInfo:
        shutil.rmtree(run.folder)
        return store._catalogue.rows()[0]

    monkeypatch.setattr(RunStore, "find", find)
    with pytest.raises(LogError, match="no run '1'"):
        RunStore().load_run("1")


def test_removing_a_removed_run_says_so(run: NewRun, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.rmtree(run.folder)
    monkeypatch.setattr(os.path, "isdir", lambda _: True)
    with pytest.raises(LogError, match="no run '"):
        RunStore().remove(run.id)


def test_rerunning_a_removed_run_says_so(run: NewRun) -> None:
    stored = RunStore().load_run("1")
    shutil.rmtree(run.folder)
    with pytest.raises(LogError, match="no run '1': it has been removed"):
        rerun(stored, RunStore())
