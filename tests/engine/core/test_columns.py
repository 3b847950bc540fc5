"""Columns: the name that the chart shows can be typed wherever a value over time is asked for."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import for_rows
from tests.tasks.goals.recorded import goals_of
from tuisim.analysis.events import find_events, parse_events
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest
from tuisim.cli import run_command
from tuisim.engine.core.columns import find_column_name
from tuisim.engine.core.sensors import list_columns
from tuisim.engine.runs.frames import compute_column_values
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks.goals.judge import judge

RUN = build_run_spec(Settings())
TRACES = [column.name for column in list_columns(RUN) if column.is_traced]
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
    values = compute_column_values([name], run.telemetry.array(), run, run.actions, run.open_mat())
    return float(values[name][-1])


@pytest.mark.parametrize("name", TRACES)
def test_each_column_name_can_be_used_in_a_goals_condition(
    name: str, run: StoredRun, tmp_path: Path
) -> None:
    condition = f'when = "{name} == {value_of(run, name)!r}"'
    (judgement,) = judge(goals_of(tmp_path, f"[[goal]]\nname = 'it'\n{condition}\n"), run)
    assert judgement.state == "met"


@pytest.mark.parametrize("name", ["left_red_pc", "gyro_deg"])
def test_each_column_name_can_be_used_in_breakpoints_watches_and_go_to(
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
def test_each_column_name_can_be_used_in_events_and_filters_of_the_analyser(
    name: str, run: StoredRun
) -> None:
    *_, opened = LogRequest(runs=("1",), telemetry=True).open_pieces()
    model = AnalysisModel(opened)
    model.add_named_columns(f"{name} changes")
    assert len(find_events(model.log, parse_events(f"{name} changes", model.log))) > 5
    conditions = model.rows.parse_conditions(f"{name} == {value_of(run, name)!r}")
    model.rows.view = model.rows.build_filtered_view(conditions)
    assert 0 < len(model.rows) < model.log.rows
    model.derive(f"half = {name} / 2")
    assert model.log.series("half").values[-1] == value_of(run, name) / 2


@pytest.mark.parametrize("name", ["left_red_pc", "gyro_deg"])
def test_each_column_name_can_be_used_in_every_log_command(
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


def test_log_commands_name_the_column_that_a_misspelt_name_is_near(
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


def test_log_commands_understand_former_column_names(
    run: StoredRun, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["log", "events", "1", "--when", "left.red% changes", "--json"]) == 0
    assert '"variable": "left_red_pc"' in capsys.readouterr().out


@for_rows(
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
def test_former_column_names_are_understood(text: str, name: str | None) -> None:
    assert find_column_name(text, list_columns(RUN)) == name
