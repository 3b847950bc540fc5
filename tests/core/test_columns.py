"""Columns: the name that the chart shows can be typed wherever a value over time is asked for."""

from __future__ import annotations

import json
import os
import shutil
import site
import subprocess
from pathlib import Path
from venv import EnvBuilder

import pytest

from tests.conftest import ROOT
from tests.goals.recorded import goals_of
from tests.running import PATIENCE_S
from tuisim.analysis.events import events_of, thresholds_of
from tuisim.analysis.model import Model, derive
from tuisim.analysis.source import LogRequest, opening
from tuisim.analysis.table import conditions_of
from tuisim.app.timeline import Timeline, find
from tuisim.cli import run_command
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.core.columns import column_name
from tuisim.core.sensors import columns_of
from tuisim.goals.judge import judge
from tuisim.runs.frames import column_values
from tuisim.runs.recorded_run import Recording
from tuisim.runs.run_folder import StoredRun, open_mat
from tuisim.runs.store import RunStore

RUN = build_run_spec(Settings())
TRACES = [column.name for column in columns_of(RUN) if column.is_traced]
PROGRAM = "tank_drive.on_for_rotations(30, 20, 1)\nx = 1\n"


@pytest.fixture(scope="module")
def home_of_runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("columns")


@pytest.fixture
def run(home_of_runs: Path, monkeypatch: pytest.MonkeyPatch) -> StoredRun:
    """A run on the grey bands; one for all tests of this module."""
    monkeypatch.setenv("TUISIM_HOME", str(home_of_runs / "home"))
    program = home_of_runs / "a.py"
    if not program.exists():
        program.write_text(PROGRAM)
        assert run_command(["run", str(program), "--background", "Grey_bands"]) == 0
    return RunStore().load_run("1")


def value_of(run: StoredRun, name: str) -> float:
    values = column_values([name], run.telemetry.array(), run, run.actions, open_mat(run))
    return float(values[name][-1])


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_finds_an_instant(name: str, run: StoredRun) -> None:
    timeline = Timeline()
    timeline.switch_to(Recording(run))
    timeline.go(1)
    assert find(f"{name} > -1 first", timeline, open_mat(run)) == 0


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_is_a_condition_of_a_goal(
    name: str, run: StoredRun, tmp_path: Path
) -> None:
    condition = f'when = "{name} == {value_of(run, name)!r}"'
    (judgement,) = judge(goals_of(tmp_path, f"[[goal]]\nname = 'it'\n{condition}\n"), run)
    assert judgement.state == "met"


@pytest.mark.parametrize("name", ["left_red_pc", "gyro_deg"])
def test_the_name_of_a_trace_is_a_breakpoint_a_watch_and_an_event(
    name: str, run: StoredRun, home_of_runs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["run", str(home_of_runs / "a.py"), "--background", "Grey_bands", "--watch", name]
    assert (
        run_command([*words, "--break", f"{name} > -1", "--break", "2", "--break-then", "go"]) == 0
    )
    said = capsys.readouterr().err
    assert f"{name} > -1" in said
    values = [
        float(line.rpartition(" → ")[2])
        for line in said.splitlines()
        if line.strip().startswith(f"{name} →")
    ]
    assert values[-1] == value_of(run, name)
    assert run_command(["log", "events", "1", "--when", f"{name} > -1", "--json"]) == 0
    assert capsys.readouterr().out == "[]\n"


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_is_an_event_a_filter_and_a_variable_of_the_analyser(
    name: str, run: StoredRun
) -> None:
    *_, opened = opening(LogRequest(runs=("1",), telemetry=True))
    model = Model(opened)
    model.add_named_columns(f"{name} changes")
    assert len(events_of(model.log, thresholds_of(f"{name} changes", model.log))) > 5
    conditions = conditions_of(f"{name} == {value_of(run, name)!r}", model.log.table.column_names)
    model.rows.view = model.rows.filtered(tuple(conditions))
    assert 0 < len(model.rows) < model.log.rows
    derive(model, f"half = {name} / 2")
    assert model.log.series("half").values[-1] == value_of(run, name) / 2


@pytest.mark.parametrize("name", ["left_red_pc", "gyro_deg"])
def test_the_name_of_a_trace_is_a_variable_of_every_log_command(
    name: str, run: StoredRun, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["log", "summary", "1", "--variable", name, "--json"]) == 0
    assert f'"variable": "{name}"' in capsys.readouterr().out
    assert run_command(["log", "calc", "1", "--expression", f"{name} + 1"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert float(out[-1].rpartition(",")[2]) == value_of(run, name) + 1
    assert (
        run_command(["log", "export", "1", "--variable", name, "--out", str(tmp_path / "a.csv")])
        == 0
    )
    assert set((tmp_path / "a.csv").read_text().splitlines()[0].split(",")) == {
        "time",
        "line",
        name,
    }
    assert name in json.loads((tmp_path / "a.csv.json").read_text())["units"]
    assert (
        run_command(["log", "plot", "1", "--telemetry", "--variable", "x_mm", "--against", name])
        == 0
    )
    assert f"x_mm against {name}" in capsys.readouterr().out


def test_a_name_that_is_nearly_a_column_is_told(
    run: StoredRun, capsys: pytest.CaptureFixture[str]
) -> None:
    said = []
    for words in (
        ["events", "1", "--when", "left_red_p < 50"],
        ["summary", "1", "--variable", "gyro_d"],
    ):
        assert run_command(["log", *words, "--telemetry"]) == 2
        said.append(capsys.readouterr().err)
    assert "did you mean 'left_red_pc'?" in said[0]
    assert "did you mean 'gyro_deg'?" in said[1]


def test_a_name_of_before_is_the_column_in_the_commands_for_logs(
    run: StoredRun, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["log", "events", "1", "--when", "left.red% changes", "--json"]) == 0
    assert '"variable": "left_red_pc"' in capsys.readouterr().out


NEW = """\
    Column("right_speed_dps"),
    Column("speed_mm_s", lambda ticks, run: [(tick[5] + tick[6]) * 28 * 3.14159 / 360 for tick in ticks], True),
"""


TRACED = """\
from tuisim.app.feed import Feed
from tuisim.runs.recorded_run import Recording
from tuisim.runs.run_folder import open_mat
from tuisim.runs.store import RunStore
run = RunStore().load_run("last")
print(*Feed(Recording(run)).chart_series(open_mat(run)))
"""


@pytest.mark.slow
def test_a_new_value_is_added_by_one_line(tmp_path: Path) -> None:
    shutil.copytree(
        ROOT / "tuisim", tmp_path / "tuisim", ignore=shutil.ignore_patterns("__pycache__")
    )
    table = tmp_path / "tuisim" / "core" / "columns.py"
    before = table.read_text()
    assert before.count(NEW.splitlines()[0]) == 1
    table.write_text(before.replace(f"{NEW.splitlines()[0]}\n", NEW))
    (tmp_path / "a.py").write_text(
        "tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 1)\n"
    )
    (tmp_path / "g.toml").write_text('[[goal]]\nname = "fast"\nwhen = "speed_mm_s > 100"\n')

    # An environment of its own: the processes of programs know no PYTHONPATH.
    python = tmp_path / "venv" / "bin" / "python"
    EnvBuilder(symlinks=True).create(tmp_path / "venv")
    (folder,) = (tmp_path / "venv").glob("lib/python*/site-packages")
    (folder / "copy.pth").write_text("\n".join((str(tmp_path), *map(str, site.getsitepackages()))))

    def said(*words: str, start: tuple[str, ...] = ("-m", "tuisim")) -> str:
        environment = {
            **os.environ,
            "TUISIM_HOME": str(tmp_path / "home"),
            "TUISIM_ASSETS": str(ROOT),
        }
        done = subprocess.run(
            [python, *start, *words],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout + done.stderr

    run = said(
        "run", "a.py", "--break", "speed_mm_s > 100", "--break-then", "go", "--watch", "speed_mm_s"
    )
    assert "break speed_mm_s > 100" in run
    assert "speed_mm_s → 1" in run
    assert "speed_mm_s" in said(TRACED, start=("-c",))
    assert "rises" in said("log", "events", "last", "--when", "speed_mm_s > 100")
    said("log", "export", "last", "--variable", "speed_mm_s", "--out", "speed.csv")
    assert (tmp_path / "speed.csv").read_text().startswith("time,line,speed_mm_s\n")
    said("log", "export", "last", "--telemetry", "--out", "all.csv")
    assert "speed_mm_s" not in (tmp_path / "all.csv").read_text()
    assert "1 of 1 goal" in said("goals", "check", "g.toml", "last")
    assert "speed_mm_s" in said("guide", "breakpoints")


@pytest.mark.parametrize(
    "text, name",
    [
        ("left.red%", "left_red_pc"),
        ("left red %", "left_red_pc"),
        ("left sensor red %", "left_red_pc"),
        ("left.red", "left_red"),
        ("right.color", "right_color"),
        ("gyro", "gyro_deg"),
        ("gyro °", "gyro_deg"),
        ("gyro.rate", "gyro_rate_dps"),
        ("ultrasonic mm", "ultrasonic_mm"),
        ("x_mm", "x_mm"),
        ("gyro.x", None),
    ],
)
def test_names_of_before_are_understood(text: str, name: str | None) -> None:
    assert column_name(text, columns_of(RUN)) == name
