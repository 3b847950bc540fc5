"""Reading a recording while it is written, and after its writer was killed or the file cut off."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.engine.runs.run_recorder import Recorder
from tuisim.base.errors import LogError
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD
from tuisim.engine.runs import records
from tuisim.engine.runs.recorded_run import RowIndex
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    OUTPUT_ROW,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    OutputWriter,
    Stream,
    TelemetryWriter,
    pack_header,
)
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.views import OutputView, TelemetryView, TickRecord

CHILD = """
import sys
from pathlib import Path
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD
from tuisim.engine.runs.records import HEADER_BYTES, OutputWriter, TelemetryWriter
telemetry, output = TelemetryWriter(Path(sys.argv[1])), OutputWriter(Path(sys.argv[1]))
for tick in range(int(sys.argv[2])):
    at = HEADER_BYTES + 64 * tick
    telemetry.reserve(1)[at:at + 64] = TICK_RECORD.pack(tick, tick, *[float(tick)] * 5, 0, 0, 0, 0, 0)
    telemetry.publish(tick + 1)
    if tick % 10 == 0:
        output.write(b"n: %d" % tick, tick, tick, 1, 1)
print("written", flush=True)
sys.stdin.read()
"""

LIMITED = """
import resource, sys
from pathlib import Path
from tuisim.engine.runs.records import TelemetryWriter
used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + (48 << 20), resource.getrlimit(resource.RLIMIT_AS)[1]))
room = TelemetryWriter(Path(sys.argv[1])).reserve(1 << 20)
try:
    bytearray(64 << 20)
except MemoryError:
    print("limited")
"""
"""A process with little memory of its own that records much."""


def put(writer: TelemetryWriter, count: int) -> None:
    """Append records whose fields tell their tick."""
    for tick in range(writer.count, writer.count + count):
        at = HEADER_BYTES + tick * TICK_RECORD.size
        record = TICK_RECORD.pack(tick, 7, tick + 0.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 1, 2)
        writer.reserve(1)[at : at + TICK_RECORD.size] = record
        writer.publish(tick + 1)


def test_a_run_without_recorded_files_is_read_as_empty(tmp_path: Path) -> None:
    telemetry = TelemetryView(tmp_path)
    output = OutputView(tmp_path)
    assert (telemetry.count, telemetry.last(), len(telemetry.array())) == (0, None, 0)
    assert (output.read_new_rows(), output.read_all_rows(), output.length) == ([], [], 0)
    assert telemetry.array().dtype.names == tuple(name for name, _ in TICK_FIELDS)


@pytest.mark.parametrize("content", [b"", bytes(4096)], ids=["empty", "no header yet"])
def test_a_recording_that_was_just_created_is_read_as_empty(tmp_path: Path, content: bytes) -> None:
    (tmp_path / TELEMETRY_FILE).write_bytes(content)
    assert TelemetryView(tmp_path).count == 0


def test_a_view_opened_before_its_file_exists_reads_it_later(tmp_path: Path) -> None:
    view = TelemetryView(tmp_path)
    assert view.last() is None
    writer = TelemetryWriter(tmp_path)
    put(writer, 3)
    assert view.last() == TickRecord(2, 7, 2.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 1, 2)
    writer.close()


def test_a_view_of_a_growing_recording_makes_no_extra_copy(tmp_path: Path) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 20_000)
    view = TelemetryView(tmp_path)
    assert view.count == 20_000
    put(writer, 1)
    tracemalloc.start()
    try:
        assert view.count == 20_001
        # The memory of a large view is the system's, and is not counted.
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()
    assert view.array()["tick"].tolist() == list(range(20_001))
    writer.close()


def test_a_view_reads_records_added_beyond_its_memory_map(tmp_path: Path) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 10)
    view = TelemetryView(tmp_path)
    early = view.array()
    put(writer, 20_000)
    assert view.count == 20_010
    assert view.record(20_009).tick == 20_009
    writer.close()
    assert view.array()["tick"].tolist() == list(range(20_010))
    assert early["tick"].tolist() == list(range(10))


def test_last_record_written_anew_is_read_anew(tmp_path: Path) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 2)
    view = TelemetryView(tmp_path)
    array = view.array()
    at = HEADER_BYTES + TICK_RECORD.size + 4
    writer.reserve(0)[at : at + 4] = (99).to_bytes(4, "little")
    put(writer, 1)
    assert view.array()["line"].tolist()[1] == 99
    assert not array.flags.writeable
    writer.close()


@pytest.mark.parametrize("index", [-1, 2, 5000])
def test_a_record_beyond_the_end_raises(tmp_path: Path, index: int) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 2)
    writer.close()
    with pytest.raises(IndexError, match=f"no telemetry record {index}, there are 2"):
        TelemetryView(tmp_path).record(index)


def test_new_rows_of_output_are_read_once_and_in_portions(tmp_path: Path) -> None:
    writer = OutputWriter(tmp_path)
    view = OutputView(tmp_path)
    for number in range(5):
        writer.write(f"line {number} é".encode(), number, number * 10, number, Stream.STDOUT)
    assert [row.text for row in view.read_new_rows(2)] == ["line 0 é", "line 1 é"]
    assert view.read_new_rows(0) == []
    assert [row.tick for row in view.read_new_rows()] == [2, 3, 4]
    assert view.read_new_rows() == []
    writer.write(b"x" * 100_000, 9, 9, 9, Stream.STDOUT)
    assert [len(row.text) for row in view.read_new_rows()] == [100_000]
    writer.close()
    assert len(view.read_all_rows()) == 6


def test_cut_off_telemetry_keeps_whole_records(tmp_path: Path) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 10)
    writer.close()
    os.truncate(tmp_path / TELEMETRY_FILE, HEADER_BYTES + 7 * TICK_RECORD.size + 30)
    view = TelemetryView(tmp_path)
    assert view.array()["tick"].tolist() == list(range(7))
    assert view.note == "telemetry.bin was truncated: the last 3 of 10 records are lost"


def test_a_record_that_was_written_but_not_published_is_not_read(tmp_path: Path) -> None:
    writer = TelemetryWriter(tmp_path)
    put(writer, 4)
    writer.reserve(1)[HEADER_BYTES + 4 * 64 : HEADER_BYTES + 4 * 64 + 32] = b"\xff" * 32
    view = TelemetryView(tmp_path)
    assert (view.count, view.note) == (4, "")
    writer.close()


def test_nothing_is_lost_when_the_writer_is_killed(tmp_path: Path) -> None:
    command = [sys.executable, "-c", CHILD, str(tmp_path), "1003"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == b"written\n"
        child.send_signal(signal.SIGKILL)
    assert (tmp_path / TELEMETRY_FILE).stat().st_size > HEADER_BYTES + 64 * 1003
    assert TelemetryView(tmp_path).array()["tick"].tolist() == list(range(1003))
    assert len(OutputView(tmp_path).read_all_rows()) == 101


def test_runs_that_are_over_keep_no_files_open(
    record: Callable[..., Recorder], spec: RunSpec
) -> None:
    recorder = record(spec)
    recorder.drive(50, 50, 3)
    recorder.print("a: 1")
    recorder.end()
    before = len(os.listdir("/proc/self/fd"))
    views = [
        (TelemetryView(recorder.run.folder), OutputView(recorder.run.folder)) for _ in range(5)
    ]
    assert {(ticks.array().size, len(output.read_all_rows())) for ticks, output in views} == {
        (4, 1)
    }
    assert len(os.listdir("/proc/self/fd")) == before


@pytest.mark.parametrize("name, rows, ticks", [(TELEMETRY_FILE, 1, 0), (OUTPUT_FILE, 0, 11)])
def test_if_telemetry_or_output_is_damaged_the_other_is_still_read(
    name: str,
    rows: int,
    ticks: int,
    store: RunStore,
    spec: RunSpec,
    record: Callable[[RunSpec], Recorder],
) -> None:
    recorder = record(spec)
    recorder.print("A: 1")
    recorder.drive(100.0, 100.0, 10)
    file = recorder.end().folder / name
    with file.open("r+b") as handle:
        handle.write(b"no magic")
    run = store.load_run(file.parent.name)
    assert run.notes == (f"{name}: not a tuisim recording: it cannot be read",)
    assert (len(run.output.read_all_rows()), run.telemetry.count) == (rows, ticks)


@pytest.mark.parametrize("time_ns, most", [(0, 5), (2_000_000_000, 25)])
def test_printing_too_many_short_rows_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, time_ns: int, most: int
) -> None:
    monkeypatch.setattr(records, "MAX_OUTPUT_ROWS", 5)
    monkeypatch.setattr(records, "_NS_PER_ROW", 100_000_000)
    writer = OutputWriter(tmp_path)
    for _ in range(most):
        writer.write(b"a", 0, time_ns, 0, Stream.STDOUT)
    with pytest.raises(LogError, match="the program printed more than 5 lines and "):
        writer.write(b"a", 0, time_ns, 0, Stream.STDOUT)


def _as_new(file: Path) -> None:
    file.write_bytes(bytes(file.stat().st_size))


@pytest.mark.parametrize("harm", [Path.unlink, _as_new])
@pytest.mark.parametrize("name", [TELEMETRY_FILE, OUTPUT_FILE])
def test_a_missing_recording_of_a_finished_run_is_noted(
    name: str, harm: Callable[[Path], None], logged: StoredRun, store: RunStore
) -> None:
    harm(logged.folder / name)
    assert store.load_run(logged.id).notes == (f"{name} is missing",)


def test_a_run_with_fewer_ticks_than_it_had_is_noted(logged: StoredRun, store: RunStore) -> None:
    file = logged.folder / TELEMETRY_FILE
    whole = file.read_bytes()
    file.write_bytes(pack_header(TELEMETRY_MAGIC, TICK_RECORD.size, 17) + whole[HEADER_BYTES:])
    assert store.load_run(logged.id).notes == (f"{TELEMETRY_FILE} has 17 of 18 records",)


def test_a_stream_of_another_version_is_read_as_unknown(tmp_path: Path) -> None:
    writer = OutputWriter(tmp_path)
    writer.write(b"a", 0, 0, 0, Stream.MOTORS)
    writer.write(b"b", 1, 1, 0, Stream.STDOUT)
    writer.close()
    path = tmp_path / OUTPUT_FILE
    data = bytearray(path.read_bytes())
    data[HEADER_BYTES + OUTPUT_ROW.size - 4] = 99
    path.write_bytes(data)
    assert [(row.text, row.stream) for row in OutputView(tmp_path).rows()] == [
        ("a", Stream.UNKNOWN),
        ("b", Stream.STDOUT),
    ]


def test_a_long_recording_takes_nothing_from_the_memory_of_the_program(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("limited\n", "")


def drive_for(folder: Path, ticks: int) -> TelemetryWriter:
    """Write the telemetry of a robot that drives along x."""
    writer = TelemetryWriter(folder)
    extend(writer, ticks)
    return writer


def extend(writer: TelemetryWriter, ticks: int) -> None:
    for tick in range(writer.count, writer.count + ticks):
        at = HEADER_BYTES + TICK_RECORD.size * tick
        writer.reserve(1)[at : at + TICK_RECORD.size] = TICK_RECORD.pack(
            tick, 1, float(tick), *[0.0] * 4, 0, 0, 0, 0, 0
        )
        writer.publish(tick + 1)


LONG = 100_000


def followed(folder: Path) -> TelemetryView:
    """Follow a long run while it is written."""
    writer = drive_for(folder, 10)
    view = TelemetryView(folder, is_checked=True)
    for _ in range(10):
        extend(writer, LONG // 10)
        assert view.count == writer.count
    writer.close()
    return view


def test_a_long_run_takes_little_memory_and_is_read_again_from_its_file(tmp_path: Path) -> None:
    view = followed(tmp_path)
    assert len(view._copy) < 8 << 20 < LONG * TICK_RECORD.size * 2
    assert view.count - view._dropped >= view._kept
    assert [view.record(tick).x_mm for tick in (0, 1, LONG // 2, LONG)] == [
        0.0,
        1.0,
        LONG / 2,
        LONG,
    ]
    for first in (0, 5, LONG, LONG + 10, LONG + 50):
        assert view.array(first)["x_mm"].tolist() == [
            float(tick) for tick in range(first, LONG + 10)
        ]
    assert view.read_new() == ""


def test_a_long_run_outlives_its_file(tmp_path: Path) -> None:
    view = followed(tmp_path)
    (tmp_path / TELEMETRY_FILE).unlink()
    assert view.record(3).x_mm == 3.0
    assert len(view.array()) == LONG + 10


@pytest.mark.parametrize("cut", [False, True], ids=["overwritten", "cut off"])
def test_what_a_program_changes_later_is_damage_and_no_error(tmp_path: Path, cut: bool) -> None:
    view = followed(tmp_path)
    with (tmp_path / TELEMETRY_FILE).open("r+b") as stream:
        stream.seek(HEADER_BYTES + 7 * TICK_RECORD.size)
        stream.write(b"\xff" * 640)
        if cut:
            stream.truncate()
    assert view.record(6).x_mm == 6.0
    assert np.isfinite(view.record(7).x_mm)
    assert len(view.array()) == LONG + 10
    assert "record 7" in view.read_new()


LINES = 40_000


def printed(folder: Path) -> OutputView:
    """Follow a run that prints much, and one line of 100 kB."""
    writer = OutputWriter(folder)
    view = OutputView(folder, is_checked=True)
    for number in range(LINES):
        writer.write(
            b"x" * 100_000 if number == 100 else (b"line %d" % number).ljust(100),
            number,
            number,
            1,
            Stream.STDOUT,
        )
        if number % 1000 == 0:
            view.read_new_rows()
    view.read_new_rows()
    writer.close()
    return view


@pytest.mark.slow
def test_much_output_takes_little_memory_and_is_read_again_from_its_file(tmp_path: Path) -> None:
    view = printed(tmp_path)
    assert view._dropped > 0
    assert len(view._copy) < 5 << 20
    rows = view.read_all_rows()
    assert [row.tick for row in rows] == list(range(LINES))
    assert [rows[at].text.strip() for at in (0, 99, 101, LINES - 1)] == [
        "line 0",
        "line 99",
        "line 101",
        f"line {LINES - 1}",
    ]
    assert len(rows[100].text) == 100_000
    assert sum(1 for _ in view.read_raw_rows()) == LINES
    assert view.read_new() == ""


@pytest.mark.slow
def test_output_that_a_program_changes_later_is_damage_and_no_error(tmp_path: Path) -> None:
    view = printed(tmp_path)
    index = RowIndex(view)
    index.take(LINES)
    with (tmp_path / OUTPUT_FILE).open("r+b") as stream:
        stream.seek(HEADER_BYTES)
        stream.write(b"\xff" * 5000)
    assert len(index) == LINES
    assert index.row(0).text == ""
    assert index.row(LINES - 1).text.strip() == f"line {LINES - 1}"
    assert view.read_all_rows() == []
    assert "was changed" in view.read_new()


@pytest.mark.parametrize(
    "mode, is_damage", [(0o600, False), (0o000, True)], ids=["by the machine", "by its program"]
)
def test_a_recording_without_read_permission_is_named(
    mode: int, is_damage: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(path: Path) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    (tmp_path / "output.bin").write_bytes(b"x" * 100)
    (tmp_path / "output.bin").chmod(mode)
    monkeypatch.setattr("tuisim.engine.runs.views.open_regular", forbidden)
    view = OutputView(tmp_path)
    if is_damage:
        assert view.note == "output.bin cannot be read: Permission denied"
        return
    with pytest.raises(LogError, match="cannot be read: Permission denied"):
        list(view.rows())
