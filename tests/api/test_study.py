"""Experiments from Python."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
import pandas as pd
import pytest

import tuisim
from tests.cases import for_rows
from tuisim.api.measures import describe
from tuisim.base.errors import ConfigError
from tuisim.batch.sweep import Workers
from tuisim.commands.guide import find_page

PROGRAM = """\
GAIN = 1.2
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30 * GAIN), 0.5)
print("Gain:", GAIN)
"""


@pytest.mark.slow
def test_an_experiment_varies_constants_and_applies_metrics_to_each_run() -> None:
    frame = tuisim.experiment(
        PROGRAM,
        seeds=range(2),
        motornoise=np.linspace(0, 20, 2),
        constants={"GAIN": [0.5, np.float64(2)]},
        metrics={"end_mm": lambda run: run.pose.x_mm, "ticks": lambda run: len(run.telemetry)},
        jobs=2,
    )
    assert [*frame.columns[:4]] == ["run", "motornoise", "GAIN", "seed"]
    assert frame["Gain_last"].tolist() == [0.5, 0.5, 2, 2] * 2
    assert frame["end_mm"].equals(frame["x_mm"].rename("end_mm"))
    assert frame["ticks"].dtype == np.int64 and (frame["ticks"] > 50).all()


@pytest.mark.slow
def test_an_experiment_with_columns_gives_each_runs_values_over_time() -> None:
    columns = ["x_mm", "left_red", "line"]
    with_time = ["time", *columns]
    how: dict[str, Any] = {"background": "Grey_bands", "x": 100}
    frame = tuisim.experiment(
        PROGRAM, seeds=[4, 2], sensornoise=[0, 20], columns=with_time, jobs=2, **how
    )
    assert [*frame.columns] == ["run", "sensornoise", "seed", "time", *columns]
    for run, noise, seed in ((1, 0, 4), (2, 0, 2), (3, 20, 4), (4, 20, 2)):
        single = tuisim.simulate(PROGRAM, seed=seed, sensornoise=noise, **how).telemetry
        part = frame[frame["run"] == run].reset_index(drop=True)
        assert part[["time", "x_mm", "line"]].equals(single[["time", "x_mm", "line"]])
        assert {*part["sensornoise"]} == {noise} and {*part["seed"]} == {seed}
        assert part["left_red"].equals(single["left_red"])


def build_metric(goal_mm: float, share: float = 1) -> Callable[[Any], float]:
    def measure(run: Any) -> float:
        return float(sum(abs(x_mm - goal_mm) for x_mm in run.xs_mm) * share)

    return measure


def test_two_metrics_have_equal_descriptions_only_if_they_compute_the_same() -> None:
    texts = [describe(build_metric(goal_mm)) for goal_mm in (3, 3, 4)]
    assert texts[0] == texts[1] != texts[2]
    lambdas: list[Any] = [lambda run: run.a + 1, lambda run: run.a + 2, lambda run: run.b + 1]
    assert len({*map(describe, lambdas)}) == 3


def test_a_stored_run_of_an_experiment_opens_by_its_number() -> None:
    tuisim.simulate("print('A: 0')\n")
    frame = tuisim.experiment("print('A: 1')\n", seeds=[3, 5], keep="all", jobs=1)
    runs = [tuisim.load_run(number) for number in frame["run"]]
    assert [run.stored.spec.seed for run in runs] == [3, 5]
    assert [run.output for run in runs] == ["A: 1\n"] * 2


GOALS = """\
background = "Loop"
[[goal]]
name = "far"
when = "x_mm > 3000"
points = 2
[[goal]]
name = "printed"
print = "A: 1"
"""


def test_a_run_is_judged_by_the_goals_of_its_world(tmp_path: Path) -> None:
    (file := tmp_path / "goals.toml").write_text(GOALS)
    run = tuisim.simulate("print('A: 1')\n", world=file)
    judged = run.judge(file)
    assert judged[["goal", "state", "points"]].to_numpy().tolist() == [
        ["far", "missed", 0],
        ["printed", "met", 1],
    ]
    assert run.stored.spec.world.background == "Loop" and judged["reason"][0]


@pytest.mark.parametrize("wait", ["", "tank_drive.on_for_seconds(1, 1, 0.5)\n"])
def test_samples_in_a_file_are_read_back(tmp_path: Path, wait: str) -> None:
    samples = tuisim.simulate(f"print('A: 1')\n{wait}print('A: 2')\n").samples
    samples.to_csv(tmp_path / "samples.csv", index=False)
    assert tuisim.read_log(tmp_path / "samples.csv")["index"].tolist() == samples["index"].tolist()


def test_the_spread_of_samples_is_that_of_pandas() -> None:
    frame = tuisim.experiment("print('A: 1')\nprint('A: 4')\n", seeds=[0], jobs=1)
    assert frame["A_std"].tolist() == [pd.Series([1, 4]).std()]


@pytest.mark.slow
def test_an_experiment_gives_the_same_table_with_any_number_of_processes() -> None:
    first, second = (
        tuisim.experiment(PROGRAM, seeds=range(6), motornoise=20, columns=["x_mm"], jobs=jobs)
        for jobs in (1, 2)
    )
    pd.testing.assert_frame_equal(first, second, check_exact=True)


@pytest.mark.parametrize("columns", [[], ["x_mm", "left_red"]])
def test_an_interrupted_experiment_resumes_with_the_missing_runs(
    columns: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "runs.parquet"
    run = Workers.run

    def stop_soon(workers: Workers, tasks: Any) -> Any:
        for number, result in enumerate(run(workers, tasks)):
            if number == 2:
                raise KeyboardInterrupt
            yield result

    measured: Counter[str] = Counter()

    how: dict[str, Any] = {
        "seeds": range(5),
        "metrics": {"end_mm": lambda run: measured.update("m") or run.pose.x_mm},
        "columns": columns,
        "jobs": 1,
    }
    with monkeypatch.context() as patch:
        patch.setattr(Workers, "run", stop_soon)
        with pytest.raises(KeyboardInterrupt) as stop:
            tuisim.experiment(PROGRAM, **how, out=out)
    assert stop.value.__notes__ == [f"2 runs done, in {out}.part; the same call goes on"]
    with pytest.raises(ConfigError, match="is of another batch"):
        tuisim.experiment(PROGRAM, **how | {"seeds": range(6)}, out=out)
    frame = tuisim.experiment(PROGRAM, **how, out=out)
    assert (measured.total(), frame["run"].nunique()) == (5, 5)
    assert (
        frame.groupby("run").last()["x_mm"].tolist()
        == frame.groupby("run").last()["end_mm"].tolist()
    )
    pd.testing.assert_frame_equal(frame, tuisim.experiment(PROGRAM, **how), check_exact=True)
    pd.testing.assert_frame_equal(frame, tuisim.read_log(out), check_exact=True)


def test_an_experiment_with_a_changed_metric_runs_everything_again(tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    how: dict[str, Any] = {"seeds": [0, 1], "out": out, "jobs": 1}
    with pytest.raises(ZeroDivisionError):
        tuisim.experiment(PROGRAM, metrics={"y": lambda run: 1 / 0}, **how)
    with pytest.warns(UserWarning, match="of other metrics or columns: the experiment begins anew"):
        frame = tuisim.experiment(PROGRAM, metrics={"y": lambda run: 1}, **how)
    assert frame["y"].tolist() == [1, 1]


def test_an_experiment_warns_when_it_replaces_another_table(tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    how: dict[str, Any] = {"out": out, "jobs": 1}
    tuisim.experiment(PROGRAM, **how)
    with catch_warnings():
        simplefilter("error")
        tuisim.experiment(PROGRAM, **how)
    with pytest.warns(UserWarning, match="runs.csv has another table, which is replaced"):
        tuisim.experiment(PROGRAM, seeds=[0, 1], **how)


def test_an_experiment_can_vary_the_world(tmp_path: Path) -> None:
    (file := tmp_path / "lab.toml").write_text('background = "Loop"\n')
    worlds: list[Path | tuisim.World] = [file, tuisim.World(x=300)]
    frame = tuisim.experiment("A = 1\n", world=worlds, jobs=1)
    assert frame["world"].tolist() == [str(file), "x=300"]
    assert frame["x_mm"].tolist() == [500, 300]


def test_an_option_given_as_a_list_has_a_column_even_with_a_single_value() -> None:
    how: dict[str, Any] = {"constants": {"A": 3}, "motornoise": [20], "background": "Loop"}
    program = "A = 1\nprint('A:', A)\n"
    frame = tuisim.experiment([program, f"{program}#"], **how, jobs=1)
    assert [*frame][:4] == ["run", "motornoise", "A", "program"]
    assert frame["program"].tolist() == ["program", "program 2"]


TURNS = """\
from pybricks.hubs import PrimeHub
from pybricks.parameters import Direction, Port
from pybricks.pupdevices import Motor
from pybricks.robotics import DriveBase
TRACK = 112
base = DriveBase(Motor(Port.A, Direction.COUNTERCLOCKWISE), Motor(Port.B), 56, TRACK)
base.turn(90)
"""


def test_an_experiment_builds_the_same_robot_for_every_value_of_a_constant() -> None:
    frame = tuisim.experiment(TURNS, constants={"TRACK": [56, 112, 168]}, jobs=1)
    assert frame["heading_deg"].tolist() == pytest.approx([-45, -90, -135], abs=1)


@pytest.mark.slow
def test_an_experiment_stops_adding_seeds_once_the_mean_is_precise_enough() -> None:
    how: dict[str, Any] = {"metrics": {"end_mm": lambda run: run.pose.x_mm}, "jobs": 2}
    with pytest.warns(UserWarning, match="1 mean known only to"):
        frame = tuisim.experiment(
            PROGRAM, seeds=range(12), motornoise=[0, 500], until="end_mm ± 0.0001", **how
        )
    assert frame.groupby("motornoise").size().tolist() == [10, 12]


@for_rows(
    "given, words",
    {
        "column": ({"columns": ["x_m"]}, "this robot has no 'x_m'"),
        "metric": ({"metrics": {"x_mm": len}}, "'x_mm' is a column already"),
        "until": ({"until": "n ± 1"}, "until: there will be no column 'n'"),
        "seeds twice": ({"parameters": {"seed": [1]}}, "the seed varies by seeds="),
        "a table": (
            {"parameters": {"obstacle": [[{"x_mm": 9}]]}},
            r"^obstacle: varies numbers, texts and truth values, got .*obstacles by world=",
        ),
        "no values": ({"sensornoise": []}, "sensornoise: has no values"),
        "no constants": (
            {"program": "print(1)", "constants": {"K": 1}},
            r"no constant K \(it uses none\)",
        ),
        "constant": ({"constants": {"GAINS": 1}}, "has no constant GAINS"),
        "no seeds": ({"seeds": []}, "seeds: has no values"),
        "no function": ({"metrics": {"n": 3}}, "metrics: must be functions of a run"),
        "no value": (
            {"metrics": {"n": lambda run: [1, 2]}, "jobs": 1},
            "n of run 1 is a list .a metric",
        ),
        "expression": ({"expressions": {"x_mm": "1"}}, "^expressions x_mm: cannot be"),
        "letters": ({"answers": "yes"}, "answers: must be a list of texts, got 'yes'"),
        "mat": ({"background": ["Loop", "Lop"]}, "^background: no such mat 'Lop'"),
        "array": ({"constants": {"GAIN": [np.eye(2)]}}, "constants: array.* cannot go along"),
        "keep": ({"keep": "some"}, "keep: no such value 'some'"),
        "no program": ({"program": []}, "no program is named"),
        "seeds": ({"seeds": "0..4"}, "seeds: must be several"),
    },
)
def test_an_experiment_with_wrong_arguments_is_refused_before_anything_runs(
    given: dict[str, Any], words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        tuisim.experiment(**{"program": PROGRAM, **given})


@pytest.mark.slow
def test_an_experiment_warns_once_of_what_varies_without_effect() -> None:
    robots = [tuisim.Robot(wheel_diameter_mm=43.2), tuisim.Robot("Small_Robot", weight="heavy")]
    with pytest.warns(UserWarning) as warnings:
        frame = tuisim.experiment("print(1)", seeds=[0, 1], robot=robots, profile="ev3", jobs=1)
    texts = [str(warning.message) for warning in warnings]
    assert texts == ["weight has no effect under profile ev3 (only robolab, nbev3devsim)"]
    assert warnings[0].filename == __file__
    labels = ["wheel_diameter_mm=43.2", "Small_Robot, weight=heavy"]
    assert [*dict.fromkeys(frame["robot"])] == labels


def test_an_experiment_warns_of_runs_that_raised_and_takes_no_mean_of_them() -> None:
    how: dict[str, Any] = {"seeds": range(20), "until": "x_mm ± 1", "jobs": 1}
    with pytest.warns(UserWarning) as warnings:
        frame = tuisim.experiment("print('A: 1')\n\nslep(1)\n", **how)
    first, second = (str(warning.message) for warning in warnings)
    assert "1 mean known not at all" in first
    assert second.startswith("10 of 10 runs raised; the first: NameError: name 'slep'")
    assert second.endswith("(line 3)") and warnings[1].filename == __file__
    assert len(frame) == 10


def test_a_metric_of_a_run_that_raised_before_is_missing() -> None:
    program = "N = 1\nprint('A: 1') if N > 1 else slep(1)\n"
    metrics: dict[str, Any] = {"a": lambda run: run.samples["value"].iloc[-1]}
    how: dict[str, Any] = {"constants": {"N": [1, 2]}, "metrics": metrics, "jobs": 1}
    with pytest.warns(UserWarning, match="2 of 4 runs raised"):
        frame = tuisim.experiment(program, seeds=range(2), **how)
    assert frame["a"].isna().tolist() == [True, True, False, False]
    with pytest.warns(UserWarning) as warnings:
        tuisim.experiment(program, seeds=range(12), until="a ± 1", **how)
    assert "1 mean known not at all" in str(warnings[0].message)


def test_an_error_in_a_metric_ends_the_experiment_and_names_it() -> None:
    def fail(run: object) -> None:
        raise LookupError("nothing there")

    with pytest.raises(LookupError, match="nothing there") as raised:
        tuisim.experiment(PROGRAM, seeds=[0], metrics={"n": fail}, jobs=1)
    assert raised.value.__notes__ == ["in the metric 'n' of run 1"]


@pytest.mark.slow
def test_the_experiments_of_the_page_measure_what_noise_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    page = find_page("python").source
    blocks = [part.partition("```")[0] for part in page.split("```python\n")[1:]]
    names: dict[str, Any] = {"tuisim": tuisim}
    for number, block in enumerate(blocks):
        if "def drive" in block or "aside_mm" in block:
            (tmp_path / f"block_{number}.py").write_text(block)
            exec(compile(block, str(tmp_path / f"block_{number}.py"), "exec"), names)
    spread_mm = names["asides_mm"].std()
    assert (spread_mm[0] == 0).all() and (spread_mm[20] > 1).all()
