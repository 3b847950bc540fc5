"""Exports through the commands: from runs and from each other, equal to the last bit, with types and metadata."""

from __future__ import annotations

import io
from collections.abc import Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from tests.conftest import Command
from tuisim.cli import run_command
from tuisim.engine.runs.frames import build_samples_frame, build_telemetry_frame
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import EXPORTERS, find_companion
from tuisim.logs.frames import read_log
from tuisim.logs.reader import open_log

PROGRAM = """# %%sim_magic_preloaded -b Grey_bands -N 30 -M 20
tank_drive.on(10, 12)
for turn in range(8):
    print('NA: ' + repr(colorLeft.reflected_light_intensity_pc / 3))
    print(f'Größe: {turn}')
    print('Least: 5e-324'); print('Most: 1.7976931348623157e308'); print('Below: -0.0'); print('Own: 3 0.1')
"""
"""Nothing that it logs is easy to write."""


@dataclass(frozen=True)
class Kept:
    """A table of runs in the store, as frame and as files in every format."""

    runs: tuple[str, ...]
    """The words that name the runs for `tuisim log`."""
    frame: pd.DataFrame
    metadata: Mapping[str, Any]
    files: Path
    """Folder with `log.csv` and the like."""

    def check(self, path: Path) -> None:
        """Make sure that a file holds this and nothing else."""
        pd.testing.assert_frame_equal(read_log(path), self.frame, check_exact=True)
        assert open_log(path).metadata == self.metadata


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Kept]:
    """The samples of two runs, and the telemetry of the first, exported by `tuisim runs export`."""
    folder = tmp_path_factory.mktemp("kept")
    program = folder / "hard.py"
    program.write_text(PROGRAM, encoding="utf-8")
    store = RunStore()
    runs = []
    with redirect_stdout(io.StringIO()):
        for seed in ("0", "3"):
            assert run_command(["run", str(program), "--seed", seed]) == 0
            runs.append(store.load_run("last"))
    tables = {"samples": folder / "samples", "telemetry": folder / "telemetry"}
    for name, files in tables.items():
        files.mkdir()
        for suffix in EXPORTERS:
            target = str(files / f"log{suffix}")
            words = [run.id for run in runs] + ["--out", target]
            words = words if name == "samples" else [runs[0].id, "--telemetry", target]
            assert run_command(["runs", "export", *words]) == 0
    frames = {"samples": build_samples_frame(runs), "telemetry": build_telemetry_frame(runs[0])}
    words_of = {"samples": tuple(run.id for run in runs), "telemetry": (runs[0].id, "--telemetry")}
    return {
        name: Kept(words_of[name], frames[name], open_log(files / "log.parquet").metadata, files)
        for name, files in tables.items()
    }


each_table = pytest.mark.parametrize("table", ["samples", "telemetry"])
each_format = pytest.mark.parametrize("suffix", EXPORTERS)


@each_table
@each_format
def test_exports_read_back_to_the_last_bit(kept: dict[str, Kept], table: str, suffix: str) -> None:
    one = kept[table]
    one.check(one.files / f"log{suffix}")
    assert one.metadata["table"] == table
    assert [run["seed"] for run in one.metadata["runs"]] == [0, 3][: len(one.metadata["runs"])]
    if table == "samples":
        assert one.frame["index"].dtype == "timedelta64[ns]"


@each_table
def test_runs_exported_as_a_log_are_read_back_the_same(
    here: Command, tmp_path: Path, kept: dict[str, Kept], table: str
) -> None:
    assert here("log", "export", *kept[table].runs, "--out", "x.csv").returncode == 0
    kept[table].check(tmp_path / "x.csv")


@pytest.mark.quick_cases("*-samples")
@each_table
@each_format
def test_a_log_exported_to_one_format_can_be_exported_to_every_other(
    here: Command, tmp_path: Path, kept: dict[str, Kept], table: str, suffix: str
) -> None:
    for source in EXPORTERS:
        target = tmp_path / f"from{source}{suffix}"
        done = here("log", "export", kept[table].files / f"log{source}", "--out", target)
        assert (done.returncode, done.stdout) == (0, "")
        kept[table].check(target)


def test_a_csv_export_without_its_companion_file_keeps_its_types(
    here: Command, tmp_path: Path, kept: dict[str, Kept]
) -> None:
    alone = tmp_path / "alone.csv"
    alone.write_bytes((kept["samples"].files / "log.csv").read_bytes())
    assert not find_companion(alone).exists()
    here("log", "export", alone, "--out", "x.parquet")
    pd.testing.assert_frame_equal(
        read_log(tmp_path / "x.parquet"), kept["samples"].frame, check_exact=True
    )


def test_columns_index_and_line_of_other_programs_logs_stay_as_they_are(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "other.csv").write_text("time,index,line,a\n0,first,0.5,1\n1,second,,2\n")
    assert here("log", "export", "other.csv", "--out", "x.parquet").returncode == 0
    frame = read_log(tmp_path / "x.parquet")
    assert list(frame["index"]) == ["first", "second"]
    assert frame["line"][0] == 0.5 and np.isnan(frame["line"][1])


def test_an_export_holds_only_the_named_variables(
    here: Command, tmp_path: Path, kept: dict[str, Kept]
) -> None:
    one = kept["samples"]
    here(
        "log",
        "export",
        one.files / "log.csv",
        "--variable",
        "Größe",
        "--variable",
        "NA #2",
        "--out",
        "some.csv",
    )
    frame = one.frame
    wanted = (frame["variable"] == "Größe") | ((frame["variable"] == "NA") & (frame["run"] == 2))
    pd.testing.assert_frame_equal(
        read_log(tmp_path / "some.csv"), frame[wanted].reset_index(drop=True)
    )
    here("log", "export", *kept["telemetry"].runs, "--variable", "gyro_deg", "--out", "gyro.arrow")
    assert list(read_log(tmp_path / "gyro.arrow")) == ["time", "gyro_deg", "line"]
    assert set(open_log(tmp_path / "gyro.arrow").metadata["units"]) == {"time", "gyro_deg"}
