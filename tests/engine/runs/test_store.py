"""The run store: what is kept of a run, how it is found again, and what happens to runs without an end."""

from __future__ import annotations

import errno
import json
import os
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from fcntl import LOCK_EX, LOCK_NB, flock
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.cases import cases
from tests.engine.runs.run_recorder import PROGRAM, Recorder
from tests.running import Start
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.protocol import End, Ended, SetNoise, SetPen, Unended, UserAction
from tuisim.engine.runs import side_files
from tuisim.engine.runs.catalogue import CATALOGUE_FILE, RunInfo
from tuisim.engine.runs.records import OUTPUT_FILE
from tuisim.engine.runs.run_folder import RUN_FILE, StoredRun, find_noise, write_run_file
from tuisim.engine.runs.side_files import ACTIONS_FILE, LOCK_FILE, hold, is_held
from tuisim.engine.runs.store import NewRun, RunStore, load_run

FINISHED = Ended(End.FINISHED, 100, 1_000_000_000)


def test_a_stored_run_is_loaded_as_it_was_recorded(
    record: Callable[..., Recorder], noisy_spec: RunSpec
) -> None:
    recorder = record(noisy_spec, live=True, options={"speed": 2.0}, field={"width_px": 3})
    recorder.drive(100, 100, 5)
    recorder.print("a: 1", line=2)
    recorder.act("set_pen", down=True)
    run = recorder.end(End.RAISED, "NameError: x")
    assert (run.id, run.number, run.folder) == (recorder.run.id, 1, recorder.run.folder)
    assert (run.program, run.spec) == (PROGRAM, noisy_spec)
    assert (run.live, run.options, run.field) == (True, {"speed": 2.0}, {"width_px": 3})
    assert run.end == Ended(End.RAISED, 5, 50_000_000, summary="NameError: x")
    assert run.state == "raised"
    assert run.actions == (UserAction(5, SetPen(True)),)
    assert (run.telemetry.count, len(run.output.read_all_rows()), run.notes) == (6, 1, ())
    assert run.output.may_contain("a: 1")
    assert not run.output.may_contain("a: 2")


def test_the_list_of_runs_has_the_facts_and_end_of_a_run(
    logged: StoredRun, store: RunStore
) -> None:
    (info,) = store.runs()
    assert info == RunInfo(
        1,
        logged.id,
        logged.created,
        "log.py",
        "Empty_Map",
        "robolab",
        3,
        End.FINISHED,
        17,
        0.17,
        4,
        "",
        "",
    )


def test_the_run_file_has_its_documented_keys_and_no_temporary_neighbours(
    logged: StoredRun,
) -> None:
    data = json.loads((logged.folder / RUN_FILE).read_bytes())
    assert list(data) == [
        "format",
        "id",
        "number",
        "created",
        "live",
        "program",
        "spec",
        "plugged",
        "field",
        "options",
        "tags",
        "end",
    ]
    assert data["program"]["sha256"] == PROGRAM.sha256
    assert data["end"]["end"] == "finished"
    assert not list(logged.folder.glob("*.tmp")) + list(logged.folder.glob(".*"))


@pytest.mark.parametrize(
    "how", ["id", "start of the id", "number", "last", "folder", "folder as text"]
)
def test_a_run_is_found_by_id_number_folder_or_last(
    logged: StoredRun, store: RunStore, how: str
) -> None:
    names: dict[str, str | Path] = {
        "id": logged.id,
        "start of the id": logged.id[:-2],
        "number": "1",
        "last": "last",
        "folder": logged.folder,
        "folder as text": str(logged.folder),
    }
    assert store.load_run(names[how]).id == logged.id


def test_a_run_is_found_by_number_before_the_start_of_an_id(store: RunStore, spec: RunSpec) -> None:
    for _ in range(2):
        store.finish(store.create_run(PROGRAM, spec), FINISHED)
    assert store.find("2").number == 2


@pytest.mark.parametrize("text", ["", "7", "nothing", "..", "lastly"])
def test_unknown_run_is_an_error_that_says_what_there_is(
    logged: StoredRun, store: RunStore, text: str
) -> None:
    with pytest.raises(LogError, match=r"no run .*a number from 1 to 1, an id, or last"):
        store.load_run(text)


def test_the_start_of_an_id_that_fits_several_runs_is_an_error(
    store: RunStore, spec: RunSpec
) -> None:
    ids = [store.create_run(PROGRAM, spec).id for _ in range(2)]
    with pytest.raises(LogError, match=f"2 runs: {ids[0]}, {ids[1]}"):
        store.find(ids[0][:4])


def test_an_empty_store_says_that_no_runs_are_stored(store: RunStore) -> None:
    assert store.runs() == []
    assert not store.home.exists()
    with pytest.raises(LogError, match="no runs are stored"):
        store.find("last")


def test_home_comes_from_the_environment(home: Path, spec: RunSpec) -> None:
    run = RunStore().create_run(PROGRAM, spec)
    assert run.folder.parent == home / "runs"
    assert load_run("last").id == run.id


def test_home_is_the_user_data_folder_by_default(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("TUISIM_HOME")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert home_folder().name == "tuisim"


def test_home_that_cannot_be_written_is_named(tmp_path: Path, spec: RunSpec) -> None:
    (tmp_path / "file").write_text("")
    store = RunStore(tmp_path / "file" / "home")
    with pytest.raises(LogError, match=r"file/home: runs cannot be stored here.*TUISIM_HOME"):
        store.create_run(PROGRAM, spec)


def test_run_that_could_not_be_listed_leaves_no_folder(tmp_path: Path, spec: RunSpec) -> None:
    (tmp_path / CATALOGUE_FILE).mkdir()
    with pytest.raises(LogError, match=CATALOGUE_FILE):
        RunStore(tmp_path).create_run(PROGRAM, spec)
    assert list((tmp_path / "runs").iterdir()) == []


# Runs without an end


def test_a_run_whose_process_lives_is_listed_as_running(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    recorder = record(spec)
    lock = hold(recorder.run.folder)
    recorder.drive(50, 50, 3)
    recorder.print("a: 1")
    (info,) = store.runs()
    assert (info.end, info.ticks, info.time_s, info.samples) == (Unended.RUNNING, 3, 0.03, 1)
    with pytest.raises(LogError, match="still running"):
        store.remove(recorder.run.id)
    os.close(lock)
    assert store.load_run("last").state == Unended.INTERRUPTED


def test_a_runs_lock_file_appears_only_once_it_is_locked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = []

    def lock(descriptor: int, operation: int) -> None:
        found.append((tmp_path / LOCK_FILE).exists())
        flock(descriptor, operation)

    monkeypatch.setattr(
        side_files, "fcntl", SimpleNamespace(flock=lock, LOCK_EX=LOCK_EX, LOCK_NB=LOCK_NB)
    )
    os.close(hold(tmp_path))
    assert found == [False]


def test_a_run_is_running_from_the_start_of_its_process(start: Start) -> None:
    handle = start("while True:\n    pass")
    assert is_held(handle.folder) is True


def test_a_run_is_running_before_its_process_starts(store: RunStore, spec: RunSpec) -> None:
    run = store.create_run(PROGRAM, spec)
    assert is_held(run.folder) is True
    assert (store.runs()[0].end, store.runs()[0].ticks) == (Unended.RUNNING, 0)
    with pytest.raises(LogError, match="still running"):
        store.remove(run.id)


def test_runs_are_listed_where_no_lock_can_be_asked_for(
    store: RunStore, spec: RunSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = store.create_run(PROGRAM, spec)
    os.close(run.lock_fd)

    def fail(descriptor: int, operation: int) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(side_files, "fcntl", SimpleNamespace(flock=fail, LOCK_SH=0, LOCK_NB=0))
    assert [info.end for info in store.runs()] == [Unended.INTERRUPTED]


def test_a_killed_run_keeps_the_rows_that_it_printed(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    recorder = record(spec)
    os.close(hold(recorder.run.folder))
    recorder.drive(50, 50, 3)
    recorder.print("a: 1")
    recorder.print("a: 2")
    (info,) = store.runs()
    assert (info.end, info.ticks, info.samples) == (Unended.INTERRUPTED, 3, 2)
    assert store.runs() == [info]
    run = store.load_run("1")
    assert (run.end, run.state, len(run.output.read_all_rows()), run.telemetry.count) == (
        None,
        Unended.INTERRUPTED,
        2,
        4,
    )
    assert run.time_s == info.time_s
    assert run.time_s > 0


def test_an_end_recorded_after_a_run_was_listed_as_interrupted_counts(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    recorder = record(spec)
    os.close(hold(recorder.run.folder))
    assert store.runs()[0].end == Unended.INTERRUPTED
    recorder.end(End.KILLED)
    assert store.runs()[0].end == "killed"


@pytest.mark.parametrize(
    "listed", ["", Unended.INTERRUPTED], ids=["not listed", "listed as interrupted"]
)
def test_a_runs_end_that_the_catalogue_lacks_is_taken_from_the_run_file(
    logged: StoredRun, store: RunStore, listed: str
) -> None:
    (before,) = store.runs()
    _change_catalogue(store, f"UPDATE runs SET end = '{listed}', ticks = NULL, samples = NULL")
    assert store.runs() == [before]
    assert _change_catalogue(store, "SELECT end, ticks, samples FROM runs") == [("finished", 17, 4)]


def _change_catalogue(store: RunStore, sql: str) -> list[object]:
    with closing(sqlite3.connect(store.home / CATALOGUE_FILE)) as connection, connection:
        return connection.execute(sql.replace(" end", ' "end"')).fetchall()


def test_long_output_is_counted_when_the_run_is_listed(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    recorder = record(spec)
    recorder.print("a: 1")
    recorder.print("x" * (1 << 20))
    recorder.end()
    assert _change_catalogue(store, "SELECT samples FROM runs") == [(None,)]
    assert store.runs()[0].samples == 1
    assert _change_catalogue(store, "SELECT samples FROM runs") == [(1,)]


def test_a_run_with_cut_off_files_says_what_is_lost(
    record: Callable[..., Recorder], spec: RunSpec, store: RunStore
) -> None:
    recorder = record(spec)
    recorder.print("a: 1")
    recorder.print("a: 2")
    recorder.act("set_pen", down=True)
    with open(recorder.run.folder / ACTIONS_FILE, "a", encoding="utf-8") as handle:
        handle.write('{"tick": 9, "ki')
    recorder.output.close()
    path = recorder.run.folder / OUTPUT_FILE
    with open(path, "r+b") as torn:
        torn.truncate(path.stat().st_size - 1)
    run = store.load_run(recorder.run.id)
    assert [row.text for row in run.output.read_all_rows()] == ["a: 1"]
    assert len(run.actions) == 1
    assert run.notes == (
        "output.bin was truncated: its last 1 byte is lost",
        "actions.jsonl: the last line is incomplete and is ignored",
    )


DAMAGED = {
    "no JSON": b"{",
    "no run": b"[]",
    "other version": b'{"format": 99}',
    "key missing": b'{"format": 1, "id": "x"}',
    "not text": b"\xff\xfe",
}


@cases("content", DAMAGED)
def test_a_damaged_run_file_is_named_and_does_not_hide_other_runs(
    logged: StoredRun, store: RunStore, spec: RunSpec, content: bytes
) -> None:
    bad = store.create_run(PROGRAM, spec)
    (bad.folder / RUN_FILE).write_bytes(content)
    with pytest.raises(LogError, match=RUN_FILE):
        store.load_run(bad.id)
    assert [info.id for info in store.runs()] == [logged.id, bad.id]


def test_a_damaged_user_action_of_a_run_is_named_by_its_row(logged: StoredRun) -> None:
    (logged.folder / ACTIONS_FILE).write_text('{"tick": 1, "kind": "set_pen", "down": true}\n5\n')
    run = load_run(logged.folder)
    assert run.actions == ()
    assert "actions.jsonl, row 2: not a user action" in run.notes[-1]


# Changing the store


def test_removed_run_is_gone_and_its_number_is_not_used_again(
    store: RunStore, spec: RunSpec
) -> None:
    runs = [store.create_run(PROGRAM, spec) for _ in range(3)]
    for run in runs:
        store.finish(run, FINISHED)
    store.remove(runs[2].id)
    assert [info.number for info in store.runs()] == [1, 2]
    assert {path.name for path in (store.home / "runs").iterdir()} == {run.id for run in runs[:2]}
    assert store.create_run(PROGRAM, spec).number == 4


def test_what_a_program_has_put_into_its_folder_is_not_copied_into_the_store(
    logged: StoredRun, tmp_path: Path
) -> None:
    mine = tmp_path / "mine"
    mine.write_text("mine")
    os.mkfifo(logged.folder / "pipe")
    os.mkfifo(logged.folder / "stack.txt")
    (logged.folder / "link").symlink_to(mine)
    (logged.folder / "reads.jsonl").symlink_to(mine)
    (logged.folder / "nowhere").symlink_to(tmp_path / "nothing")
    adopted = RunStore(tmp_path / "other").add_folder(logged.folder)
    assert {path.name for path in adopted.folder.iterdir()} == {
        "run.json",
        "telemetry.bin",
        "output.bin",
        "readings.bin",
        "lock",
    }


def test_a_run_cannot_be_removed_while_it_is_copied_into_the_store(
    logged: StoredRun, store: RunStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The lock file of the process that has run it.
    os.close(hold(logged.folder))
    there = RunStore(tmp_path / "other")
    seen = []

    def remove_and_write(folder: Path, data: dict[str, Any]) -> None:
        seen.append([row.id for row in there.runs()])
        with pytest.raises(LogError, match="still running"):
            there.remove(folder.name)
        write_run_file(folder, data)

    monkeypatch.setattr("tuisim.engine.runs.store.write_run_file", remove_and_write)
    adopted = there.add_folder(logged.folder)
    assert seen == [[adopted.id]]
    assert [row.end for row in there.runs()] == [End.FINISHED]
    there.remove(adopted.id)


@pytest.mark.parametrize("change", ["finish", "tag", "remove"])
def test_run_that_is_not_there_cannot_be_changed(store: RunStore, change: str) -> None:
    changes: dict[str, Callable[[], None]] = {
        "finish": lambda: store.finish(NewRun("x", 1, store.folder("x")), FINISHED),
        "tag": lambda: store.tag("x", ["y"]),
        "remove": lambda: store.remove("x"),
    }
    with pytest.raises(LogError, match="no run 'x'"):
        changes[change]()


def test_tags_stay_when_the_run_ends_and_the_catalogue_is_lost(
    store: RunStore, spec: RunSpec
) -> None:
    run = store.create_run(PROGRAM, spec)
    store.tag(run.id, ["good", "fast"])
    store.finish(run, FINISHED)
    (store.home / CATALOGUE_FILE).unlink()
    assert store.runs()[0].tags == "good fast"
    assert store.load_run(run.id).tags == ("good", "fast")
    with pytest.raises(LogError, match="one word"):
        store.tag(run.id, ["two words"])


def test_folder_deleted_or_copied_by_hand_is_noticed(
    logged: StoredRun, store: RunStore, spec: RunSpec
) -> None:
    shutil.copytree(logged.folder, store.folder("copy"))
    shutil.copytree(logged.folder, store.folder("copy").with_name(".copy"))
    gone = store.create_run(PROGRAM, spec)
    shutil.rmtree(gone.folder)
    assert [(info.number, info.id, info.samples) for info in store.runs()] == [
        (1, logged.id, 4),
        (3, "copy", 4),
    ]


# Noise


@pytest.mark.slow
def test_the_noise_of_a_tick_is_found_also_after_65536_user_actions(logged: StoredRun) -> None:
    actions = [UserAction(tick, SetNoise(tick % 100, 0)) for tick in range(1, 70_001)]
    for tick in (2, 32_768, 65_536, 69_990):
        # A record may count actions that are due a little later or earlier.
        for count in (tick - 2, tick, tick + 3):
            record = replace(logged.telemetry.record(0), tick=tick, actions=count & 0xFFFF)
            expected = NoiseSpec(count % 100, 0) if count else logged.spec.world.noise
            assert find_noise(logged.spec, actions, record) == expected
