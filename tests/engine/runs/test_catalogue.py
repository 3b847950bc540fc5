"""The catalogue of runs: made again from the folders when it is lost, and used by two processes at once."""

from __future__ import annotations

import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.cases import cases
from tests.engine.runs.run_recorder import PROGRAM, Recorder
from tuisim.base.errors import LogError
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import End, Ended, Unended
from tuisim.engine.runs import catalogue
from tuisim.engine.runs.catalogue import CATALOGUE_FILE, Catalogue, RunInfo
from tuisim.engine.runs.run_folder import RUN_FILE
from tuisim.engine.runs.store import RunStore

FINISHED = Ended(End.FINISHED, 100, 1_000_000_000)

MANY = """
import sys
from pathlib import Path
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.protocol import End, Ended, Unended
from tuisim.engine.runs.store import RunStore
from tuisim.base.source import Program
store = RunStore(Path(sys.argv[1]))
spec = RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)
for _ in range(12):
    run = store.create_run(Program("p.py", ""), spec)
    store.runs()
    store.finish(run, Ended(End.FINISHED, 1, 1))
    print(run.number, flush=True)
"""


def _cut_in_half(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2 + 100])


def _scribble(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    content = bytearray(path.read_bytes())
    content[4096:] = b"\xa5" * (len(content) - 4096)
    path.write_bytes(bytes(content))


def _other_version(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA user_version = 77")


HARM: dict[str, Callable[[Path], object]] = {
    "missing": Path.unlink,
    "empty": lambda path: path.write_bytes(b""),
    "not a database": lambda path: path.write_bytes(b"rubbish" * 1000),
    "cut in half": _cut_in_half,
    "pages overwritten": _scribble,
    "other version": _other_version,
}


@cases("harm", HARM)
def test_catalogue_is_made_again_from_the_folders(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore, harm: Callable[[Path], object]
) -> None:
    for number in range(4):
        recorder = record(replace(spec, seed=number))
        recorder.print("a: 1")
        recorder.end(summary=f"run {number}")
    store.remove(store.find("2").id)
    before = store.runs()
    harm(store.home / CATALOGUE_FILE)
    assert store.runs() == before
    assert [info.number for info in before] == [1, 3, 4]
    assert store.create_run(PROGRAM, spec).number == 5


@pytest.mark.parametrize("ends", [True, False], ids=["ended", "running"])
def test_a_run_file_that_could_not_be_read_when_the_catalogue_was_made_is_read_again(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore, ends: bool
) -> None:
    recorder = record(spec)
    recorder.print("a: 1")
    if ends:
        recorder.end(summary="over")
    before = store.runs()
    path = recorder.run.folder / RUN_FILE
    content = path.read_bytes()
    path.write_bytes(b"{")
    (store.home / CATALOGUE_FILE).unlink()
    assert [info.end for info in store.runs()] == [Unended.DAMAGED]
    path.write_bytes(content)
    assert store.runs() == before
    assert RunStore(store.home).runs() == before


def test_runs_are_listed_and_removed_also_where_no_catalogue_can_be_written(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    for number in range(3):
        recorder = record(replace(spec, seed=number))
        recorder.print("a: 1")
        recorder.end(summary=f"run {number}")
    before = store.runs()
    catalogue = store.home / CATALOGUE_FILE
    catalogue.unlink()
    # Nothing can take its place, as on a disk that is full or can only be read.
    catalogue.mkdir()
    assert store.runs() == before
    assert store.find("last") == before[-1]
    store.remove(before[0].id)
    assert store.runs() == before[1:]


@cases("harm", HARM)
def test_damage_to_the_catalogue_does_not_keep_a_run_from_being_stored(
    store: RunStore, spec: RunSpec, harm: Callable[[Path], object]
) -> None:
    run = store.create_run(PROGRAM, spec)
    harm(store.home / CATALOGUE_FILE)
    store.finish(run, FINISHED)
    assert [(info.number, info.end) for info in store.runs()] == [(1, "finished")]


def test_seed_may_be_larger_than_the_integers_of_the_catalogue(
    store: RunStore, spec: RunSpec
) -> None:
    store.create_run(PROGRAM, replace(spec, seed=1 << 80))
    assert store.runs()[0].seed == 1 << 80


def _info(run_id: str) -> RunInfo:
    return RunInfo(0, run_id, "2026-01-01T00:00:00.000+00:00", "p.py", "Empty_Map", "robolab", 0)


def test_a_catalogue_that_another_process_has_made_meanwhile_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "home"
    other = tmp_path / "other"
    home.mkdir()
    Catalogue(other, lambda: ()).add(_info("a"))

    @contextmanager
    def locked(_: Path) -> Iterator[None]:
        shutil.copy(other / CATALOGUE_FILE, home)
        yield

    monkeypatch.setattr(catalogue, "lock_home", locked)
    assert Catalogue(home, lambda: ()).add(_info("b")) == 2


def test_what_sqlite_leaves_of_a_catalogue_that_cannot_be_made_is_removed(tmp_path: Path) -> None:
    readers = []

    def scan() -> Iterator[RunInfo]:
        # SQLite keeps its files while somebody reads, as where it cannot write to the end.
        for fresh in tmp_path.glob(".*.tmp"):
            readers.append(sqlite3.connect(fresh))
            readers[-1].execute("PRAGMA user_version").fetchone()
        yield _info("a")

    assert [info.id for info in Catalogue(tmp_path, scan).rows()] == ["a"]
    assert len(readers) == 1
    assert list(tmp_path.glob(".*")) == []
    readers[0].close()


@pytest.mark.slow
def test_runs_started_by_two_processes_at_once_get_different_numbers(tmp_path: Path) -> None:
    command = [sys.executable, "-c", MANY, str(tmp_path / "home")]
    children = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    numbers = [int(line) for child in children for line in child.communicate()[0].split()]
    assert [child.returncode for child in children] == [0, 0]
    assert sorted(numbers) == list(range(1, 25))
    infos = RunStore(tmp_path / "home").runs()
    assert [(info.number, info.end) for info in infos] == [
        (number, "finished") for number in range(1, 25)
    ]


def test_an_error_of_the_catalogue_names_a_full_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / CATALOGUE_FILE).mkdir()
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=0))
    with pytest.raises(
        LogError,
        match=r"no space left on device \(free some space, or TUISIM_HOME may name another folder\)",
    ):
        Catalogue(tmp_path, lambda: ()).remove(["r"])
