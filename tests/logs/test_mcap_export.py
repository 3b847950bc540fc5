"""MCAP files, read back with the library's own reader: counts, values, poses and units."""

from __future__ import annotations

import json
import math
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.conftest import Command
from tests.engine.runs.run_recorder import Recorder
from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.core.spec import RunSpec
from tuisim.logs.log import Log
from tuisim.logs.mcap_export import POSE, export_mcap
from tuisim.logs.reader import build_log, build_telemetry_log, open_log

pytest.importorskip("mcap.reader", reason="needs the extra mcap")


def read_back(path: Path) -> tuple[dict[str, list[tuple[int, dict[str, Any]]]], dict[str, Any]]:
    """Return the messages of each topic with their times in ns, and the schema of each topic."""
    from mcap.reader import make_reader

    messages = defaultdict(list)
    schemas = {}
    with path.open("rb") as handle:
        times_ns = []
        for schema, channel, message in make_reader(handle).iter_messages(log_time_order=False):
            assert schema is not None
            assert (channel.message_encoding, schema.encoding) == ("json", "jsonschema")
            messages[channel.topic].append((message.log_time, json.loads(message.data)))
            schemas[channel.topic] = {"name": schema.name, **json.loads(schema.data)}
            times_ns.append(message.log_time)
    assert times_ns == sorted(times_ns)
    return dict(messages), schemas


def export(log: Log, path: Path, *, has_pose: bool = True) -> int:
    parts: list[float] = []
    count = export_mcap(log, log.names, path, parts.append, has_pose=has_pose)
    assert parts == sorted(parts) and (not parts or 0 <= parts[-1] < 1)
    return count


def check_values(log: Log, path: Path, names: set[str]) -> None:
    """See that a file has the values of some variables and no other, each at its time."""
    messages, schemas = read_back(path)
    assert {f"/{name}" for name in names} == {topic for topic in messages if "/pose" not in topic}
    for name in names:
        series = log.series(name)
        known = np.isfinite(series.values)
        read = messages[f"/{name}"]
        assert [message["value"] for _, message in read] == series.values[known].tolist()
        assert [message["time"] for _, message in read] == series.time_s[known].tolist()
        assert [time_ns / 1e9 for time_ns, _ in read] == pytest.approx(series.time_s[known])
        assert schemas[f"/{name}"]["name"] == f"tuisim.{name}"


def test_telemetry_reads_back_from_mcap(
    record: Callable[..., Recorder], noisy_spec: RunSpec, tmp_path: Path
) -> None:
    recorder = record(noisy_spec)
    recorder.drive(300, 280, 40, line=3)
    log = build_telemetry_log(recorder.end())
    assert not export(log, tmp_path / "a.mcap")
    check_values(log, tmp_path / "a.mcap", {*log.sampled_names} - {*POSE})
    messages, schemas = read_back(tmp_path / "a.mcap")
    assert schemas["/gyro_deg"]["properties"]["value"]["description"] == "degrees"
    assert schemas["/pose"]["name"] == "foxglove.PoseInFrame"
    x_mm, y_mm, heading_deg = (log.series(name).values for name in POSE)
    assert len(messages["/pose"]) == log.rows
    for at, (time_ns, message) in enumerate(messages["/pose"]):
        stamp = message["timestamp"]
        pose = message["pose"]
        assert stamp["sec"] * 10**9 + stamp["nsec"] == time_ns
        assert message["frame_id"] == "mat"
        assert pose["position"] == {"x": x_mm[at] / 1000, "y": y_mm[at] / 1000, "z": 0}
        turn = pose["orientation"]
        yaw_deg = math.degrees(2 * math.atan2(turn["z"], turn["w"]))
        assert math.remainder(yaw_deg - heading_deg[at], 360) == pytest.approx(0, abs=1e-9)


def test_each_run_has_its_own_channels_in_an_mcap_export(
    record: Callable[..., Recorder], spec: RunSpec, tmp_path: Path
) -> None:
    runs = []
    for _ in range(2):
        recorder = record(spec)
        for value in (0.1, 2 / 3, 5e-324):
            recorder.drive(300, 280, 2, line=3)
            recorder.print(f"Größe: {value!r}", line=4)
        runs.append(recorder.end())
    log = build_log(runs)
    assert log.names == ("Größe #1", "Größe #2")
    export(log, tmp_path / "a.mcap")
    check_values(log, tmp_path / "a.mcap", {*log.names})
    messages, _ = read_back(tmp_path / "a.mcap")
    assert {topic: len(read) for topic, read in messages.items() if "pose" in topic} == {
        "/pose #1": 3,
        "/pose #2": 3,
    }
    export(log, tmp_path / "again.mcap", has_pose=False)
    assert set(read_back(tmp_path / "again.mcap")[0]) == {"/Größe #1", "/Größe #2"}
    first = (tmp_path / "a.mcap").read_bytes()
    export(log, tmp_path / "a.mcap")
    assert (tmp_path / "a.mcap").read_bytes() == first


def test_missing_and_infinite_values_are_left_out_of_an_mcap_export(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,red,blue\n0,1,\n1,inf,6\n2,,7\n3,-inf,8\n")
    log = open_log(tmp_path / "a.csv")
    assert export(log, tmp_path / "a.mcap") == 2
    check_values(log, tmp_path / "a.mcap", {"red", "blue"})


def test_the_export_command_writes_mcap(tmp_path: Path, here: Command) -> None:
    (tmp_path / "a.csv").write_text("time,red,blue\n0,1,5\n1,inf,6\n")
    done = here("log", "export", "a.csv", "--variable", "red", "--out", "a.MCAP")
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert "a.MCAP: 1 value is infinite, which JSON does not have: left out" in done.stderr
    assert set(read_back(tmp_path / "a.MCAP")[0]) == {"/red"}


def test_an_mcap_export_of_times_before_0_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,red\n-1,1\n0,2\n")
    (tmp_path / "a.mcap").write_text("old")
    with pytest.raises(ExportError, match="no times before 0"):
        export(open_log(tmp_path / "a.csv"), tmp_path / "a.mcap")
    assert (tmp_path / "a.mcap").read_text() == "old"


def test_a_failed_mcap_export_leaves_the_old_file(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,red\n0,1\n1,2\n")
    (tmp_path / "a.mcap").write_text("old")

    def fail(_: float) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(ExportError, match=r"cannot write .*a\.mcap: No space left on device"):
        export_mcap(open_log(tmp_path / "a.csv"), ["red"], tmp_path / "a.mcap", fail, has_pose=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.mcap"]
    assert (tmp_path / "a.mcap").read_text() == "old"


def test_an_mcap_export_without_its_library_says_what_to_install(
    tmp_path: Path, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.csv").write_text("time,red\n0,1\n1,2\n")
    monkeypatch.setitem(sys.modules, "mcap.writer", None)
    with pytest.raises(ConfigError, match=r"pip install -e '\.\[mcap\]'"):
        export(open_log(tmp_path / "a.csv"), tmp_path / "a.mcap")
    done = here("log", "export", "a.csv", "--out", "a.mcap")
    assert (done.returncode, done.stdout) == (2, "")
    assert "MCAP files need the library mcap" in done.stderr
    assert not (tmp_path / "a.mcap").exists()
