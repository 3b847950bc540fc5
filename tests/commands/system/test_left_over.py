"""What killed processes leave behind is found, and removed when asked; what a living process uses is not."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.runs.run_recorder import PROGRAM
from tuisim.commands.system.left_over import left_over
from tuisim.core.profile import ROBOLAB
from tuisim.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.runs.side_files import LOCK_FILE, hold
from tuisim.runs.store import RunStore
from tuisim.runs.temporary import owned_folder

RUN = "20260102T030405-a1b2c3"
SPEC = RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)


def aged(path: Path) -> Path:
    """Let a file or a folder seem to be untouched for two hours."""
    then = time.time() - 7200
    os.utime(path, (then, then))
    return path


def file_at(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"half")
    return aged(path)


def lone_lock(home: Path) -> Path:
    return file_at(home / "runs" / RUN / LOCK_FILE).parent


def empty_folder(home: Path) -> Path:
    (home / "runs" / RUN).mkdir(parents=True)
    return aged(home / "runs" / RUN)


def lock_without_its_name(home: Path) -> Path:
    return file_at(home / "runs" / RUN / f".{LOCK_FILE}-1234").parent


def half_of_a_run(home: Path) -> Path:
    return RunStore().new_run(PROGRAM, SPEC).folder


def half_of_a_file_of_a_run(home: Path) -> Path:
    run = RunStore().new_run(PROGRAM, SPEC)
    os.close(run.lock_fd)
    return file_at(run.folder / ".run.json.0a0b0c0d.tmp")


LEFT: dict[str, Callable[[Path], Path]] = {
    "a folder with a lone lock": lone_lock,
    "an empty folder": empty_folder,
    "a lock without its name": lock_without_its_name,
    "a removed run": lambda home: (
        file_at(home / "runs" / f".{RUN}.0a0b.removed" / "output.bin").parent
    ),
    "a half-written list": lambda home: file_at(home / ".runs.db.0a0b0c0d.tmp"),
    "a journal of a half-written list": lambda home: file_at(home / ".runs.db.0a0b0c0d.tmp-wal"),
    "half-written preferences": lambda home: file_at(home / ".preferences.json.0a0b0c0d.tmp"),
    "a half-written mat": lambda home: file_at(home / "cache" / "fields" / ".x.rgb.0a0b0c0d.tmp"),
    "half-written progress": lambda home: file_at(home / "lessons" / ".progress.json.0a0b0c0d.tmp"),
    "a half-written file of a run": half_of_a_file_of_a_run,
}


@pytest.fixture(autouse=True)
def _own_temporary_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(
        "tuisim.commands.system.left_over.places", lambda: (tmp_path / "temporary",)
    )


@pytest.mark.parametrize("leave", LEFT.values(), ids=LEFT)
def test_what_is_left_over_is_listed_and_removed_when_asked(
    home: Path, here: Command, leave: Callable[[Path], Path]
) -> None:
    path = leave(home)
    run = RunStore().new_run(PROGRAM, SPEC).folder
    told = here("doctor").stdout
    assert f"{path}: " in told
    assert "--clean" in told
    assert path.exists()
    assert f"removed {path}: " in here("doctor", "--clean").stdout
    assert not path.exists()
    assert json.loads(here("doctor", "--json").stdout)["left_over"] == []
    assert (run / "run.json").exists()


@contextmanager
def held(home: Path) -> Iterator[Path]:
    """A folder of a run that is about to begin."""
    folder = empty_folder(home)
    lock_fd = hold(folder)
    yield aged(folder)
    os.close(lock_fd)


@contextmanager
def being_written(home: Path) -> Iterator[Path]:
    path = file_at(home / ".runs.db.0a0b0c0d.tmp")
    with path.open("rb"):
        yield path


@contextmanager
def written_just_now(home: Path) -> Iterator[Path]:
    path = file_at(home / ".runs.db.0a0b0c0d.tmp")
    os.utime(path)
    yield path


@contextmanager
def just_made(home: Path) -> Iterator[Path]:
    path = empty_folder(home)
    os.utime(path)
    yield path


@contextmanager
def of_another(home: Path) -> Iterator[Path]:
    """A folder that the user has put there."""
    path = home / "runs" / "my notes"
    path.mkdir(parents=True)
    yield aged(path)


USED = {
    "a run that begins": held,
    "an open file": being_written,
    "a new file": written_just_now,
    "a new folder": just_made,
    "a folder of the user": of_another,
}


@pytest.mark.parametrize("use", USED.values(), ids=USED)
def test_what_may_be_in_use_stays(
    home: Path, here: Command, use: Callable[[Path], AbstractContextManager[Path]]
) -> None:
    with use(home) as path:
        assert "0 left-overs removed" in here("doctor", "--clean").stdout
        assert path.exists()


def test_temporary_runs_are_left_over_when_their_process_has_ended(
    home: Path, tmp_path: Path
) -> None:
    place = tmp_path / "temporary"
    living = owned_folder(parent=place)
    (place / "tuisim-of-something-else").mkdir()
    code = "import os, tuisim.runs.temporary as t; t.owned_folder('tuisim-batch-'); os.kill(os.getpid(), 9)"
    subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={**os.environ, "TMPDIR": str(place)},
        check=False,
    )
    (dead,) = place.glob("tuisim-batch-*")
    assert [found.path for found in left_over(home)] == [dead]
    assert living.exists()
