"""What killed processes have left in the store goes when runs are listed; what a living process uses does not."""

from __future__ import annotations

import os

import pytest

from tests.engine.runs.run_recorder import PROGRAM
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.side_files import hold
from tuisim.engine.runs.store import RunStore

FINISHED = Ended(End.FINISHED, 100, 1_000_000_000)


def test_what_a_killed_removal_has_left_goes_when_runs_are_listed(
    store: RunStore, spec: RunSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs = [store.create_run(PROGRAM, spec) for _ in range(3)]
    for run in runs:
        store.finish(run, FINISHED)
    with monkeypatch.context() as killed:
        killed.setattr("tuisim.engine.runs.store.remove_tree", lambda *_, **__: None)
        store.remove(runs[0].id)
    assert len(list((store.home / "runs").iterdir())) == 3
    assert [info.id for info in store.runs()] == [run.id for run in runs[1:]]
    assert {path.name for path in (store.home / "runs").iterdir()} == {run.id for run in runs[1:]}


def test_a_folder_of_a_run_that_did_not_begin_goes_when_no_process_holds_it(
    store: RunStore, spec: RunSpec
) -> None:
    run = store.create_run(PROGRAM, spec)
    held, dead, mine, link = (run.folder.with_name(name) for name in ("held", "dead", "my", "link"))
    for folder in (held, dead, mine):
        folder.mkdir()
    lock_fd = hold(held)
    os.close(hold(dead))
    link.symlink_to(store.home)
    os.close(hold(store.home))
    assert [info.id for info in store.runs()] == [run.id]
    os.close(lock_fd)
    assert {*run.folder.parent.iterdir()} == {run.folder, held, mine, link}
