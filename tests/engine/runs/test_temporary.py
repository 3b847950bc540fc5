"""Folders of runs that are not listed: deleted when they are over, and found when their process was killed."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from tests.conftest import ROOT
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs import temporary
from tuisim.engine.runs.run_folder import RUN_FILE
from tuisim.engine.runs.side_files import hold, is_held
from tuisim.engine.runs.temporary import (
    TemporaryRun,
    create_batch_folder,
    create_owned_folder,
    create_temporary_home,
)

SPEC = RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which temporary ones are created."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(temporary, "_MEMORY", tmp_path / "no such file system")
    return tmp_path


def test_a_temporary_home_is_locked_and_deleted_after_its_block() -> None:
    with create_temporary_home() as folder:
        assert is_held(folder)
        (folder / "file").write_text("x")
    assert not folder.exists()


def test_threads_create_homes_at_the_same_time(place: Path) -> None:
    count = 8
    ready = Barrier(count)

    def create_and_remove(_: int) -> None:
        ready.wait()
        for _ in range(10):
            with create_temporary_home() as folder:
                assert is_held(folder)

    before_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(count) as threads:
            list(threads.map(create_and_remove, range(count)))
    finally:
        sys.setswitchinterval(before_s)
    assert list(place.iterdir()) == []


def test_the_first_folder_of_a_process_deletes_what_killed_ones_have_left(place: Path) -> None:
    code = (
        "import os, tempfile, tuisim.engine.runs.temporary as t; tempfile.tempdir = os.getcwd(); "
        "t.create_owned_folder(); os.kill(os.getpid(), 9)"
    )
    subprocess.run(
        [sys.executable, "-c", code], cwd=place, env={"PYTHONPATH": str(ROOT)}, check=False
    )
    (dead,) = place.iterdir()
    (place / "tuisim-of-something-else").mkdir()
    held = place / "tuisim-held"
    held.mkdir()
    lock_fd = hold(held)
    (elsewhere := place / "elsewhere").mkdir()
    create_owned_folder(parent=elsewhere)
    os.close(lock_fd)
    assert not dead.exists()
    assert {path.name for path in place.iterdir()} == {
        "elsewhere",
        "tuisim-held",
        "tuisim-of-something-else",
    }


def test_where_no_folder_can_be_created_it_is_told(place: Path) -> None:
    (place / "file").write_text("")
    with pytest.raises(LogError, match="no folder for temporary runs"):
        TemporaryRun(place / "file")


def test_a_temporary_run_is_loaded_as_begun_though_its_file_was_changed(place: Path) -> None:
    with TemporaryRun(place) as runs:
        new = runs.create_run(Program("p.py", "x = 1\n"), SPEC)
        (new.folder / RUN_FILE).write_text("rubbish")
        assert runs.load_run(new.folder).program.text == "x = 1\n"
        (new.folder / RUN_FILE).unlink()
        new.folder.rename(place / "elsewhere")
        with pytest.raises(LogError, match="deleted while it ran"):
            runs.load_run(new.folder)


def test_a_batchs_folder_is_in_memory_only_if_there_is_room(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory = place / "memory"
    memory.mkdir()
    monkeypatch.setattr(temporary, "_MEMORY", memory)
    for free, parent in ((0, memory), (1 << 60, place)):
        monkeypatch.setattr(temporary, "_FREE_BYTES", free)
        assert create_batch_folder().parent == parent
