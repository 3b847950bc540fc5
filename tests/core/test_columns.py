"""Columns: the name that the chart shows can be typed wherever a value over time is asked for."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.goals.recorded import goals_of
from tuisim.app.timeline import Timeline, find
from tuisim.cli import run_command
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.core.columns import column_name
from tuisim.core.sensors import columns_of
from tuisim.core.spec import RobotSpec
from tuisim.goals.judge import judge
from tuisim.runs.frames import telemetry_frame
from tuisim.runs.recorded_run import Recording
from tuisim.runs.run_folder import StoredRun, open_mat
from tuisim.runs.store import RunStore

ROBOT = build_run_spec(Settings()).robot
TRACES = [column.name for column in columns_of(ROBOT) if column.is_traced]
PROGRAM = "tank_drive.on_for_rotations(30, 30, 1)\nx = 1\n"


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
    return float(telemetry_frame(run, also=[name])[name].iloc[-1])


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_finds_an_instant(name: str, run: StoredRun) -> None:
    timeline = Timeline()
    timeline.switch_to(Recording(run))
    timeline.go(1)
    assert find(f"{name} > -1 first", timeline, open_mat(run)) == 0


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_is_a_condition_of_a_goal(name: str, run: StoredRun, tmp_path: Path) -> None:
    condition = f'when = "{name} == {value_of(run, name)!r}"'
    (judgement,) = judge(goals_of(tmp_path, f"[[goal]]\nname = 'it'\n{condition}\n"), run)
    assert judgement.state == "met"


@pytest.mark.parametrize("name", TRACES)
def test_the_name_of_a_trace_is_a_breakpoint_a_watch_and_an_event(
    name: str, run: StoredRun, home_of_runs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["run", str(home_of_runs / "a.py"), "--background", "Grey_bands", "--watch", name]
    assert run_command([*words, "--break", f"{name} > -1", "--break", "2", "--break-then", "go"]) == 0
    said = capsys.readouterr().err
    assert f"{name} > -1" in said
    values = [float(line.rpartition(" → ")[2]) for line in said.splitlines() if line.strip().startswith(f"{name} →")]
    assert values[-1] == value_of(run, name)
    assert run_command(["log", "events", "1", "--when", f"{name} > -1", "--json"]) == 0
    assert capsys.readouterr().out == "[]\n"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("left.red%", "left_red_pc"), ("left red %", "left_red_pc"), ("left sensor red %", "left_red_pc"),
        ("left.red", "left_red"), ("right.color", "right_color"), ("gyro", "gyro_deg"), ("gyro °", "gyro_deg"),
        ("gyro.rate", "gyro_rate_dps"), ("ultrasonic mm", "ultrasonic_mm"), ("x_mm", "x_mm"), ("gyro.x", None),
    ],
)  # fmt: skip
def test_names_of_before_are_understood(text: str, name: str | None) -> None:
    assert column_name(text, columns_of(RobotSpec())) == name
