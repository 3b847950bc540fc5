"""Exports: read back to the last bit, byte-identical between identical runs, whole or not at all."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from tests.cases import cases, for_each
from tests.engine.runs.run_recorder import Recorder
from tuisim.base.errors import ExportError, LogError
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.frames import build_samples_frame, build_telemetry_frame
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs.export import (
    EXPORTERS,
    build_typed_frame,
    check_target,
    export_frame,
    export_samples,
    export_telemetry,
    find_companion,
)
from tuisim.logs.frames import read_log
from tuisim.logs.metadata import read_spec
from tuisim.logs.reader import open_log

each_format = pytest.mark.parametrize("suffix", EXPORTERS)


def noisy_run(record: Callable[..., Recorder], spec: RunSpec, **options: object) -> StoredRun:
    """A run of which nothing is a round number."""
    recorder = record(spec, **options)
    for step in range(30):
        recorder.drive(300, 280, 4, line=3)
        recorder.print(f"Colour: {recorder.simulation.drive.x_mm!r}", line=step)
        recorder.print(f"Größe: {step}", line=step)
    return recorder.end()


# The contract of every format


@each_format
def test_exported_samples_are_read_back_to_the_last_bit(
    record: Callable[..., Recorder], noisy_spec: RunSpec, tmp_path: Path, suffix: str
) -> None:
    run = noisy_run(record, noisy_spec)
    target = tmp_path / f"log{suffix}"
    export_samples([run, run], target)
    pd.testing.assert_frame_equal(
        read_log(target), build_samples_frame([run, run]), check_exact=True
    )


@pytest.mark.quick_cases(".csv", ".parquet")
@each_format
def test_exported_telemetry_is_read_back_to_the_last_bit(
    record: Callable[..., Recorder], noisy_spec: RunSpec, tmp_path: Path, suffix: str
) -> None:
    run = noisy_run(record, noisy_spec)
    target = tmp_path / f"log{suffix}"
    export_telemetry(run, target)
    pd.testing.assert_frame_equal(read_log(target), build_telemetry_frame(run), check_exact=True)


@each_format
def test_extreme_numbers_and_odd_texts_are_exported_and_read_back(
    tmp_path: Path, suffix: str
) -> None:
    values = [0.1 + 0.2, 5e-324, 1.7976931348623157e308, -0.0, np.nan, 1e22, 100.0, 2 / 3]
    nanoseconds = [0, 1, 10**18 + 1, 999, 1_000_000, 86_400_000_000_000, 33_333_334, 5]
    frame = pd.DataFrame(
        {
            "index": np.array(nanoseconds, "m8[ns]"),
            "variable": pd.Series(
                ["NA", "nan", "None", "null", "true", "Größe", "x", "inf"], dtype="str"
            ),
            "value": values,
            "time": [np.nan] * len(values),
            "run": np.arange(1, len(values) + 1),
            "line": np.full(len(values), 2**40),
        }
    )
    export_frame(frame, tmp_path / f"x{suffix}", {})
    found = read_log(tmp_path / f"x{suffix}")
    pd.testing.assert_frame_equal(found, frame, check_exact=True)
    assert np.signbit(found["value"][3])


N = np.nan
OTHER_FRAMES: dict[str, tuple[dict[str, object], str]] = {
    "whole numbers": (
        {"a": [1, -2, 3], "b": [1.0, N, 3.0], "c": [2**53 + 1, 2**62, -(2**63)]},
        "int64 float64 int64",
    ),
    "whole at first": ({"a": [1.0, 2.0, 2.5], "b": [N, N, N]}, "float64 float64"),
    "infinite": ({"a": [np.inf, -np.inf, -0.0]}, "float64"),
    "separators": (
        {"a": ["b,c", 'd"e', "f\ng"], "b": ["a;b", "\tc", "e\r\nf"], "c": ["# 1", " x ", "'"]},
        "str str str",
    ),
    "texts like values": ({"a": ["NA", "1", "null"], "b": ["True", "False", "x"]}, "str str"),
    "truths": ({"a": [True, False], "b": [1, 0]}, "bool int64"),
    "truths with a gap": ({"a": [True, None, False]}, "object; .csv str; .jsonl float64"),
    "one column": ({"a;b": [1.5, N, 2.5]}, "float64"),
    "one column of texts": ({"word": ["a b", "", "c"]}, "str"),
    "numbers as names": ({"1": [1.5, 2.0], "2": [3, 4]}, "float64 int64"),
    "dates": (
        {"when": pd.to_datetime(["2024-01-01 00:00:00.5"])},
        "datetime64[us]; .csv str; .jsonl str",
    ),
    "small types": (
        {"a": np.array([1, 255], "uint8"), "b": np.array([0.1, 0.2], "float32")},
        "uint8 float32; .csv int64 float64; .jsonl int64 float64",
    ),
    "categories": ({"a": pd.Categorical(["x", "y", "x"])}, "category; .csv str; .jsonl str"),
    "no rows": (
        {"a": pd.Series([], dtype="str"), "line": np.array([], "int64")},
        "str int64; .csv float64 int64; .jsonl float64 int64",
    ),
}
"""Columns, and the types with which they come back, after `;` those of a format that has no such types."""


@pytest.mark.quick_cases("*-.csv", "*-.parquet")
@each_format
@cases("columns, types", OTHER_FRAMES)
def test_frames_that_are_no_logs_are_exported_and_read_back(
    tmp_path: Path, suffix: str, columns: dict[str, object], types: str
) -> None:
    frame = pd.DataFrame(columns)
    export_frame(frame, tmp_path / f"x{suffix}", {"columns": list(frame.columns)})
    found = read_log(tmp_path / f"x{suffix}")
    common, *others = types.split("; ")
    wanted = next(
        (other.split()[1:] for other in others if other.startswith(suffix)), common.split()
    )
    assert (list(found), [str(kind) for kind in found.dtypes]) == (list(frame), wanted)
    kept = [name for name in frame if found[name].dtype == frame[name].dtype]
    pd.testing.assert_frame_equal(found[kept], frame[kept], check_exact=True)


@each_format
def test_an_exported_frame_without_rows_is_read_back_with_its_types(
    record: Callable[..., Recorder], spec: RunSpec, tmp_path: Path, suffix: str
) -> None:
    run = record(spec).end()
    export_samples([run], tmp_path / f"x{suffix}")
    pd.testing.assert_frame_equal(read_log(tmp_path / f"x{suffix}"), build_samples_frame([run]))


@pytest.mark.quick_cases("samples-*")
@each_format
@pytest.mark.parametrize("table", ["samples", "telemetry"])
def test_identical_runs_give_identical_export_files(
    record: Callable[..., Recorder],
    noisy_spec: RunSpec,
    tmp_path: Path,
    suffix: str,
    table: str,
) -> None:
    written = []
    for name in ("one", "two"):
        run = noisy_run(record, noisy_spec, live=name == "two", options={"speed": len(name)})
        folder = tmp_path / name
        folder.mkdir()
        if table == "samples":
            export_samples([run], folder / f"log{suffix}")
        else:
            export_telemetry(run, folder / f"log{suffix}")
        written.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert written[0] == written[1]
    assert len(written[0]) == 1 + EXPORTERS[suffix].companion


@each_format
def test_an_export_holds_metadata_of_its_runs_and_units(
    logged: StoredRun, tmp_path: Path, suffix: str
) -> None:
    export_samples([logged], tmp_path / f"x{suffix}")
    found = open_log(tmp_path / f"x{suffix}").metadata
    (run,) = found["runs"]
    assert (found["table"], found["units"]["x_mm"], found["units"]["time"]) == (
        "samples",
        "mm",
        "s, simulated",
    )
    assert (run["program"]["sha256"], run["seed"]) == (logged.program.sha256, 3)
    assert (run["world"]["background"], run["profile"]["name"]) == ("Empty_Map", "robolab")
    text = json.dumps(found)
    assert not any(
        secret in text for secret in (logged.id, logged.created, logged.program.path, str(tmp_path))
    )


@each_format
def test_a_failed_export_leaves_the_old_file(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / f"x{suffix}"
    target.write_text("old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ExportError, match=f"cannot write .*x{suffix}: No space left on device"):
        export_frame(pd.DataFrame({"value": [1.0]}), target, {})
    assert [path.name for path in tmp_path.iterdir()] == [target.name]
    assert target.read_text() == "old"


@each_format
def test_an_export_suffix_in_capitals_means_the_same_format(
    logged: StoredRun, tmp_path: Path, suffix: str
) -> None:
    export_samples([logged], tmp_path / f"X{suffix.upper()}")
    assert len(read_log(tmp_path / f"X{suffix.upper()}")) == 4


@each_format
def test_a_damaged_export_is_refused_with_its_name(tmp_path: Path, suffix: str) -> None:
    target = tmp_path / f"x{suffix}"
    magic = {".parquet": b"PAR1", ".arrow": b"ARROW1"}.get(suffix, b"")
    target.write_bytes(magic + b'\xff\x00"rubbish\n{"')
    find_companion(target).write_text("{}")
    with pytest.raises(LogError, match=target.name):
        read_log(target)


# One format each


def test_a_csv_export_has_one_heading_and_plain_rows(logged: StoredRun, tmp_path: Path) -> None:
    export_samples([logged], tmp_path / "x.csv")
    lines = (tmp_path / "x.csv").read_text().split("\n")
    assert lines[0] == "index,variable,value,time,run,x_mm,y_mm,heading_deg,line"
    assert lines[1] == "0 days 00:00:00.000000,Colour,100.0,0.0,1,5.0,1110.0,-7.0,4"
    assert lines[2].startswith("0 days 00:00:00.100000,Colour,86.27450980392157,0.1,1,")
    assert (len(lines), lines[-1]) == (6, "")


def test_pandas_reads_the_same_rows_from_every_export_format(
    logged: StoredRun, tmp_path: Path
) -> None:
    for suffix in EXPORTERS:
        export_samples([logged], tmp_path / f"x{suffix}")
    parquet = pd.read_parquet(tmp_path / "x.parquet")
    pd.testing.assert_frame_equal(pd.read_feather(tmp_path / "x.arrow"), parquet)
    for text in (pd.read_csv(tmp_path / "x.csv"), pd.read_json(tmp_path / "x.jsonl", lines=True)):
        assert pd.to_timedelta(text["index"]).tolist() == parquet["index"].tolist()
        assert text["value"].tolist() == pytest.approx(parquet["value"].tolist())


def test_a_csv_export_without_its_companion_file_is_read_the_same(
    logged: StoredRun, tmp_path: Path
) -> None:
    export_samples([logged], tmp_path / "x.csv")
    find_companion(tmp_path / "x.csv").unlink()
    frame = read_log(tmp_path / "x.csv")
    pd.testing.assert_frame_equal(frame.reset_index(drop=True), build_samples_frame([logged]))
    assert open_log(tmp_path / "x.csv").metadata == {}


# Targets


def test_checking_a_good_export_target_creates_no_file(tmp_path: Path) -> None:
    assert check_target(tmp_path / "x.csv") == tmp_path / "x.csv"
    assert list(tmp_path.iterdir()) == []


BAD_TARGETS = {
    "unknown suffix": (
        "x.xlsx",
        re.escape(f"unknown format '.xlsx' (a file ends in {', '.join(EXPORTERS)})"),
    ),
    "no suffix": ("x", r"unknown format ''"),
    "only a suffix": (".csv", r"unknown format ''"),
    "no such folder": ("gone/x.csv", r"there is no folder .*gone"),
    "file as folder": ("file/x.csv", r"there is no folder .*file"),
    "folder": ("folder.csv", r"it is a folder"),
    "companion is a folder": ("y.csv", r"y\.csv\.json: it is a folder"),
    "pipe": ("pipe.csv", r"it exists and cannot be replaced"),
}


@cases("name, message", BAD_TARGETS)
def test_a_bad_export_target_is_refused_with_the_reason(
    tmp_path: Path, name: str, message: str
) -> None:
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "y.csv.json").mkdir()
    (tmp_path / "file").write_text("")
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(ExportError, match=message):
        check_target(tmp_path / name)


def test_an_export_into_a_folder_that_cannot_be_written_is_refused() -> None:
    # Nobody can make a file there, not even root.
    with pytest.raises(ExportError, match=r"cannot write /proc/self/x\.csv"):
        check_target("/proc/self/x.csv")


@pytest.mark.parametrize("lines, kind", [([1.0, 2.0], "int64"), ([1.5, 2.5], "float64")])
def test_a_column_of_line_numbers_has_whole_numbers_if_all_are_whole(
    lines: list[float], kind: str
) -> None:
    column = build_typed_frame(pa.table({"line": lines}))["line"]
    assert (column.tolist(), str(column.dtype)) == (lines, kind)


# Imports


@pytest.mark.quick_cases("logs.export", "engine.runs.store")
@pytest.mark.parametrize(
    "module",
    [
        "engine.runs.records",
        "engine.runs.samples",
        "engine.runs.side_files",
        "engine.runs.views",
        "engine.runs.store",
        "logs.export",
    ],
)
def test_importing_a_module_of_logs_loads_no_pandas(module: str) -> None:
    code = (
        f"import sys, tuisim.{module}\n"
        "heavy = {'numpy', 'pandas', 'pyarrow', 'PIL', 'platformdirs', 'msgspec'} & sys.modules.keys()\n"
        "sys.exit(', '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_log_of_a_run_is_read_without_pandas(
    record: Callable[..., Recorder], noisy_spec: RunSpec
) -> None:
    run = noisy_run(record, noisy_spec)
    code = (
        "import sys; from tuisim.engine.runs.store import load_run; from tuisim.logs.reader import build_log\n"
        f"log = build_log([load_run({str(run.folder)!r})])\n"
        "print([len(log.series(name).values) for name in log.names], 'pandas' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[30, 30] False\n"


@for_each(
    metadata=[
        {},
        {"runs": []},
        {"runs": 3},
        {"runs": [[]]},
        {"runs": ["x"]},
        {"runs": [{}]},
        {"runs": [{"robot": {}}]},
        {"runs": [{"world": {"noise": {"light": "?"}}}]},
    ]
)
def test_damaged_metadata_of_a_log_are_read_as_no_run(metadata: dict[str, Any]) -> None:
    assert read_spec(metadata) is None
