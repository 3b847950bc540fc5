"""Compacting stored runs: by itself after a long run, by command, and never one that still goes on."""

from __future__ import annotations

import json
import os
import signal
from dataclasses import replace
from pathlib import Path

import pytest

from tests.running import Start, over, until_tick
from tests.runs.earlier_pack import pack_as_earlier
from tuisim.cli import run_command
from tuisim.errors import LogError
from tuisim.runs.handle import RunHandle, RunOptions, start_run
from tuisim.runs.packed_files import PACKED_SUFFIX
from tuisim.runs.records import TELEMETRY_FILE
from tuisim.runs.store import PACKERS, RunStore, compact_run

LONG = "tank_drive.on_for_seconds(20, 30, 61)\nprint('Far:', ultrasonic.distance_centimeters)\n"
SHORT = "tank_drive.on_for_seconds(20, 30, 1)\n"


def packed(folder: Path) -> bool:
    """Whether the telemetry is packed; if it is half done, neither answer would be right."""
    there = [(folder / name).exists() for name in (TELEMETRY_FILE, TELEMETRY_FILE + PACKED_SUFFIX)]
    assert there.count(True) == 1
    return there[1]


def settle() -> None:
    """Wait until nothing is packed any more."""
    for waiting in PACKERS:
        waiting.join()


@pytest.mark.slow
def test_a_long_run_is_packed_when_it_is_over(start: Start) -> None:
    handle = start(LONG, time_limit_s=100.0)
    over(handle)
    settle()
    assert packed(handle.folder)
    assert handle.telemetry.count == 6102
    stored = RunStore().load_run(handle.run_id)
    assert stored.telemetry.array().tobytes() == handle.telemetry.array().tobytes()
    assert [row.text for row in stored.output.rows()] == [
        row.text for row in handle.output.all_rows()
    ]
    assert run_command(["runs", "rerun", handle.run_id]) == 0


def test_short_runs_and_scratch_ones_stay_as_they_are(start: Start, tmp_path: Path) -> None:
    short = start(SHORT)
    options = RunOptions(time_limit_s=100.0)
    scratch = start_run(replace(short.program, text=LONG), short.spec, options, RunStore(tmp_path))
    for handle in (short, scratch):
        over(handle)
    settle()
    assert scratch.telemetry.count == 6102
    assert not packed(short.folder) and not packed(scratch.folder)


def test_command(home: Path, start: Start, capsys: pytest.CaptureFixture[str]) -> None:
    handles = [start(SHORT) for _ in range(2)]
    for handle in handles:
        over(handle)
    one, two = (handle.run_id for handle in handles)
    assert run_command(["runs", "compact", one]) == 0
    assert [packed(handle.folder) for handle in handles] == [True, False]
    capsys.readouterr()
    (handles[0].folder / (TELEMETRY_FILE + PACKED_SUFFIX)).write_bytes(b"rubbish")
    assert run_command(["runs", "compact", one, two, "--json"]) == 2
    said = capsys.readouterr()
    assert "telemetry.bin.packed: too short to be a packed recording" in said.err
    assert packed(handles[1].folder)
    told = json.loads(said.out)
    assert told["ticks"] == 101 and told["bytes_after"] < told["bytes_before"]
    assert run_command(["runs", "compact"]) == 2
    (handles[0].folder / (TELEMETRY_FILE + PACKED_SUFFIX)).unlink()
    third = start(SHORT)
    over(third)
    assert run_command(["runs", "compact", "--all"]) == 0
    assert packed(third.folder)


def killed(start: Start) -> RunHandle:
    """Return a run whose process was killed."""
    handle = start("while True:\n    tank_drive.on_for_seconds(20, 30, 1)\n", live=True)
    until_tick(handle, 10)
    os.kill(handle._process.pid, signal.SIGKILL)
    handle._process.wait()
    return handle


@pytest.mark.parametrize("is_killed", [False, True], ids=["finished", "killed"])
def test_what_an_earlier_tuisim_packed_is_made_again(
    start: Start, is_killed: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = (
        killed(start)
        if is_killed
        else start(SHORT + "print('Far:', ultrasonic.distance_centimeters)\n")
    )
    over(handle)
    settle()
    telemetry = pack_as_earlier(handle.folder)
    stored = RunStore().load_run(handle.run_id)
    assert (stored.program.text, stored.spec, stored.telemetry.count) == (
        handle.program.text,
        handle.spec,
        0,
    )
    assert run_command(["runs", "show", handle.run_id]) == 0
    assert (
        capsys.readouterr().out.count(
            "packed by an earlier tuisim and cannot be read: `tuisim runs rerun RUN`"
        )
        == 1
    )
    assert run_command(["log", "summary", handle.run_id]) == 2
    assert "packed by an earlier tuisim" in capsys.readouterr().err
    assert run_command(["runs", "rerun", handle.run_id]) == 0
    said = capsys.readouterr()
    assert ("is made again" in said.err, "identical" in said.out) == (True, True)
    again = RunStore().load_run(handle.run_id)
    assert (again.notes, again.telemetry.array().tobytes()) == ((), telemetry)
    assert packed(handle.folder)


def test_a_rerun_that_differs_replaces_no_recording(
    start: Start, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = start(SHORT)
    over(handle)
    pack_as_earlier(handle.folder, checksum_off=1)
    before = {path: path.read_bytes() for path in handle.folder.iterdir()}
    assert run_command(["runs", "rerun", handle.run_id]) == 2
    assert "a re-run has another recording than this one" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in handle.folder.iterdir()} == before


def test_not_while_it_runs_but_after_it_was_killed(start: Start) -> None:
    handle = start("while True:\n    tank_drive.on_for_seconds(20, 30, 1)\n", live=True)
    until_tick(handle, 10)
    stored = RunStore().load_run(handle.run_id)
    with pytest.raises(LogError, match="still running"):
        compact_run(stored)
    os.kill(handle._process.pid, signal.SIGKILL)
    handle.close()
    before = RunStore().load_run(handle.run_id).telemetry.array().tobytes()
    compact_run(RunStore().load_run(handle.run_id))
    assert packed(handle.folder)
    assert RunStore().load_run(handle.run_id).telemetry.array().tobytes() == before
