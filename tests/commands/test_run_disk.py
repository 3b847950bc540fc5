"""Disks that are full, folders that go, and ctrl-C while files are written: what was logged is not lost."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.running import PATIENCE_S, Start, over
from tuisim.base.errors import ExportError, LogError
from tuisim.commands import run as run_command
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tick_record import TICK_RECORD
from tuisim.engine.runs import run_folder
from tuisim.engine.runs import store as store_module
from tuisim.engine.runs.records import OUTPUT_FILE, TELEMETRY_CHUNK, TELEMETRY_FILE
from tuisim.engine.runs.run_folder import RUN_FILE, StoredRun, field_files
from tuisim.engine.runs.side_files import STACK_FILE
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import export_samples
from tuisim.logs.frames import read_log

ENDLESS = """
import time
n = 0
while True:
    time.sleep(0.5)
    n += 1
    print("n:", n)
"""
SPEC = RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)


@pytest.fixture
def endless(tmp_path: Path) -> Path:
    """A program that prints two samples a second for ever."""
    path = tmp_path / "endless.py"
    path.write_text(ENDLESS)
    return path


@pytest.fixture
def short(tmp_path: Path) -> Path:
    """A program that prints three samples."""
    path = tmp_path / "short.py"
    path.write_text("for n in range(3):\n    print('n:', n)\n")
    return path


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Let this process and those that it starts write no larger files: the end of a disk, without one."""
    # What the runs need of the mats is larger.
    for mat in ("Empty_Map", "Grey_bands"):
        field_files(replace(SPEC, world=WorldSpec(background=mat)))
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.mark.slow
def test_run_that_fills_the_disk_stops_and_keeps_its_rows(
    endless: Path, tuisim: Command, tmp_path: Path
) -> None:
    with files_of_at_most(TELEMETRY_CHUNK + 300_000):
        done = tuisim("run", endless, "--timeout", "1e5", "--export", "a.csv")
    assert (done.returncode, done.stderr.count("\n")) == (3, 2), done.stderr
    assert "disk full: the recording cannot grow" in done.stderr
    printed = [float(line.removeprefix("n: ")) for line in done.stdout.splitlines()]
    # The file did not have room for the double, but for what the limit leaves.
    assert len(printed) > 1.2 * TELEMETRY_CHUNK / TICK_RECORD.size / 50
    assert read_log(tmp_path / "a.csv")["value"].tolist() == printed
    assert RunStore().find("last").end == "disk_full"


@pytest.mark.usefixtures("real_start")
def test_a_program_cannot_catch_the_error_that_the_disk_is_full(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "import time\nwhile True:\n    try:\n        print('x' * 5000)\n    except Exception:\n        pass\n"
    with files_of_at_most(TELEMETRY_CHUNK + 5000):
        handle = start(text, time_limit_s=0.0)
    assert over(handle).ended.end == "disk_full"
    assert {len(row.text) for row in handle.output.read_all_rows()} == {5000}


@pytest.mark.usefixtures("real_start")
def test_run_without_room_to_begin_leaves_nothing_reserved(start: Start) -> None:
    with files_of_at_most(TELEMETRY_CHUNK):
        done = over(start("print(1)"))
    assert (done.ended.end, done.ended.tick) == ("disk_full", 0)
    assert not [name for name in (TELEMETRY_FILE, OUTPUT_FILE) if (done.run.folder / name).exists()]


def test_end_that_cannot_be_stored_costs_no_row(
    short: Path, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = run_folder.write_run_file

    def fail(folder: Path, data: dict[str, object]) -> None:
        if data["end"] is not None:
            raise LogError("cannot write: No space left on device", file="run.json")
        write(folder, data)

    monkeypatch.setattr(store_module, "write_run_file", fail)
    done = here("run", short, "--export", "a.csv")
    assert (done.returncode, done.stdout) == (2, "n: 0\nn: 1\nn: 2\n")
    assert (
        "short.py: finished: its end cannot be stored: run.json: cannot write: No space"
        in done.stderr
    )
    assert [line.partition(":")[0] for line in done.stderr.splitlines()] == ["short.py", "written"]
    assert len(read_log(tmp_path / "a.csv")) == 3


def test_an_export_that_fails_does_not_prevent_the_others(
    short: Path, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def export(runs: Sequence[StoredRun], target: str) -> None:
        if target in ("a.csv", "b.csv"):
            raise ExportError(f"cannot write {target}: No space left on device")
        export_samples(runs, target)

    monkeypatch.setattr(run_command, "export_samples", export)
    done = here("run", short, "--export", "a.csv", "--export", "b.csv", "--export", "c.csv")
    assert done.returncode == 2
    assert [line.partition(":")[2] for line in done.stderr.splitlines()[2:]] == [
        f" cannot write {name}: No space left on device" for name in ("b.csv", "a.csv")
    ]
    assert len(read_log(tmp_path / "c.csv")) == 3


def _delete_once_begun(home: Path, delete: Callable[[Path], None]) -> threading.Thread:
    def wait() -> None:
        give_up = time.monotonic() + PATIENCE_S
        # The last file that a run begins with; one that came into a folder as it is deleted would stay there.
        while (
            not (begun := list((home / "runs").glob(f"*/{STACK_FILE}")))
            and time.monotonic() < give_up
        ):
            time.sleep(0.01)
        delete(begun[0].parent)

    deleting = threading.Thread(target=wait)
    deleting.start()
    return deleting


def test_folder_that_is_deleted_in_mid_run_is_told_in_one_line(
    endless: Path, home: Path, here: Command
) -> None:
    field_files(SPEC)
    deleting = _delete_once_begun(
        home, lambda folder: shutil.rmtree(folder.parent, ignore_errors=True)
    )
    done = here("run", endless, "--speed", "1", "--export", "a.csv")
    deleting.join()
    assert done.returncode == 2
    assert (
        done.stderr
        == "tuisim: endless.py: run 1 was not stored: its folder was deleted while it ran\n"
    )
    assert not list(home.glob("runs/*"))
    assert RunStore().runs() == []


def test_a_run_file_that_is_deleted_in_mid_run_is_written_again(
    endless: Path, home: Path, here: Command
) -> None:
    field_files(SPEC)
    deleting = _delete_once_begun(home, lambda folder: (folder / RUN_FILE).unlink())
    done = here("run", endless, "--speed", "4", "--timeout", "12")
    deleting.join()
    assert done.returncode == 3
    assert RunStore().load_run("1").state == "time_limit"


@pytest.mark.parametrize("presses, rows", [(1, 3), (2, None)], ids=["once", "twice"])
def test_ctrl_c_while_an_export_is_written_finishes_it_and_twice_cancels_it(
    short: Path,
    here: Command,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    presses: int,
    rows: int | None,
) -> None:
    def export(runs: Sequence[StoredRun], target: str) -> None:
        for _ in range(presses):
            os.kill(os.getpid(), signal.SIGINT)
        export_samples(runs, target)

    monkeypatch.setattr(run_command, "export_samples", export)
    done = here("run", short, "--export", "a.csv")
    assert done.returncode == 130
    again = f"tuisim runs export {RunStore().find('last').number} --out a.csv"
    cancelled = f"a.csv was not written; the log is stored ({again})"
    assert (cancelled in done.stderr) == (rows is None)
    written = tmp_path / "a.csv"
    assert (len(read_log(written)) if written.exists() else None) == rows
