"""`tuisim batch`: its table, its pictures, and what interrupts it and goes on."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pandas as pd
import pytest

import tuisim
from tests.batch.stand_in import result_of
from tests.cases import cases
from tests.commands.conftest import PROGRAM, SPEC, Batch
from tuisim.batch import sweep
from tuisim.cli import run_command
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.task import Result, Task


def interrupt_after(count: int) -> Callable[..., Iterator[Result]]:
    def run(tasks: Iterable[Task], jobs: int = 0) -> Iterator[Result]:
        for number, task in enumerate(tasks):
            if number == count:
                os.kill(os.getpid(), signal.SIGINT)
            yield result_of(task)

    return run


def test_rows_of_a_batch_are_in_the_order_of_its_parameters(batch: Batch) -> None:
    assert batch("mine.py", "--set", "noise.motor=0,20", "--seeds", "1,2", "--out", "rows.csv") == 0
    frame = pd.read_csv("rows.csv")
    assert frame[["run", "noise.motor", "seed", "x_mm"]].to_numpy().tolist() == [
        [1, 0, 1, 100],
        [2, 0, 2, 100],
        [3, 20, 1, 120],
        [4, 20, 2, 140],
    ]


def test_the_summary_names_ends_and_quantiles(
    batch: Batch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert batch("mine.py", "--seeds", "11..13", "--expr", "far_mm=x_mm + 1") == 1
    ends, reason, heads, first = capsys.readouterr().out.split("\n")[:4]
    assert (ends, reason) == ("3 runs: 2 finished, 1 raised", "  1 × ValueError: 13")
    assert heads.split() == [
        "COLUMN",
        "MEAN",
        "STD",
        "MIN",
        "Q5",
        "Q25",
        "Q50",
        "Q75",
        "Q95",
        "MAX",
    ]
    assert first.split() == ["far_mm", "101", "0", *["101"] * 7]


def test_a_batch_whose_seeds_change_nothing_says_so(
    batch: Batch, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    note = "every seed gave the same results"
    batch("mine.py", "--seeds", "1,2")
    assert note not in capsys.readouterr().err
    same = {"y_mm": 200.0, "time_s": 1.0, "variables": {}}

    def run(tasks: Iterable[Task], _: int = 0) -> Iterator[Result]:
        yield from (result_of(task, **same) for task in tasks)

    monkeypatch.setattr(sweep, "run_many", run)
    batch("mine.py", "--set", "noise.motor=0,20")
    assert note not in capsys.readouterr().err
    batch("mine.py", "--seeds", "1,2")
    assert note in capsys.readouterr().err


def test_batch_prints_its_rows_as_json(batch: Batch, capsys: pytest.CaptureFixture[str]) -> None:
    assert batch("mine.py", "--seeds", "13,14", "--json") == 1
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [(row["run"], row["end"], row["Colour_last"]) for row in rows] == [
        (1, "raised", None),
        (2, "finished", 14.1),
    ]


def test_a_batch_file_holds_everything(batch: Batch) -> None:
    Path("spec.toml").write_text(SPEC)
    assert batch("spec.toml") == 0
    frame = pd.read_csv("rows.csv")
    assert (len(frame), "far_mm" in frame.columns) == (6, True)


GOALS = 'program = "mine.py"\n[[goal]]\nname = "end"\nsay = "End."\npoints = 2\nfinish = true\n'


@pytest.mark.parametrize(
    "words", [("goals.toml",), ("mine.py", "--goals", "goals.toml"), ("--goals", "goals.toml")]
)
def test_a_batch_with_goals_runs_in_the_world_of_the_goals(
    words: tuple[str, ...],
    batch: Batch,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("goals.toml").write_text(f'background = "Loop"\n{GOALS}')

    def judged(tasks: Iterable[Task], jobs: int = 0) -> Iterator[Result]:
        for task in tasks:
            assert task.spec.world.background == "Loop"
            met = Change(3, 0.1, GoalState.MET, 0, 0)
            yield result_of(
                task,
                judgements=tuple(
                    Judgement(goal, (met,) * (task.spec.seed < 2)) for goal in task.goals
                ),
            )

    monkeypatch.setattr(sweep, "run_many", judged)
    assert batch(*words, "--seeds", "0..2", "--out", "rows.csv") == 0
    assert pd.read_csv("rows.csv")[["goal_end", "points"]].to_numpy().tolist() == [
        [True, 2],
        [True, 2],
        [False, 0],
    ]
    assert "end: met in 2 of 3 (67 %)" in capsys.readouterr().out


def test_a_batch_of_several_programs_summarizes_each(
    batch: Batch, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("other.py").write_text(PROGRAM)
    assert batch("mine.py", "other.py", "--seeds", "0..1", "--out", "rows.csv") == 0
    assert pd.read_csv("rows.csv")["program"].tolist() == ["mine.py"] * 2 + ["other.py"] * 2
    lines = [line.split()[:2] for line in capsys.readouterr().out.split("\n")[2:4]]
    assert lines == [["x_mm", "mine.py"], ["x_mm", "other.py"]]


def test_an_interrupted_batch_keeps_what_is_done(
    batch: Batch, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sweep, "run_many", interrupt_after(2))
    assert batch("mine.py", "--seeds", "0..4", "--out", "rows.csv") == 130
    assert pd.read_csv("rows.csv")["seed"].tolist() == [0, 1]
    assert (
        "interrupted after 2 of 5 runs; rows.csv has these rows, and --resume continues"
        in capsys.readouterr().err
    )


def test_a_resumed_batch_runs_the_rest_and_gives_the_same_bytes(
    batch: Batch, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("mine.py", "--seeds", "0..4", "--set", "noise.motor=0,9", "--out")
    assert batch(*words, "whole.csv") == 0
    with monkeypatch.context() as patch:
        patch.setattr(sweep, "run_many", interrupt_after(3))
        assert batch(*words, "rows.csv") == 130
    run: list[int] = []

    def rest(tasks: Iterable[Task], jobs: int = 0) -> Iterator[Result]:
        for task in tasks:
            run.append(task.index)
            yield result_of(task)

    monkeypatch.setattr(sweep, "run_many", rest)
    assert batch(*words, "rows.csv", "--resume") == 0
    assert run == [3, 4, 5, 6, 7, 8, 9]
    assert Path("rows.csv").read_bytes() == Path("whole.csv").read_bytes()
    assert list(Path().glob("*.part")) == []


def test_resuming_a_complete_batch_leaves_its_table_unchanged(batch: Batch) -> None:
    assert batch("mine.py", "--seeds", "0..1", "--out", "rows.csv") == 0
    whole = Path("rows.csv").read_bytes()
    assert batch("mine.py", "--seeds", "0..1", "--out", "rows.csv", "--resume") == 0
    assert Path("rows.csv").read_bytes() == whole


def test_a_complete_batch_is_not_run_again(
    batch: Batch, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = (
        "mine.py",
        "--seeds",
        "10..14",
        "--set",
        "robot.weight=light,heavy",
        "--expr",
        "a=x_mm + 1",
        "--out",
    )
    assert batch(*words, "rows.csv") == 1
    summary = capsys.readouterr().out
    whole = Path("rows.csv").read_bytes()
    monkeypatch.setattr(sweep, "run_many", lambda tasks, jobs: (1 / 0 for _ in tasks))
    assert batch(*words, "rows.csv", "--resume") == 1
    assert (capsys.readouterr().out, Path("rows.csv").read_bytes()) == (summary, whole)


@cases(
    "words, message",
    {
        "again": ((), "rows.csv.part: holds the rows of an interrupted batch (--resume continues"),
        "another batch": (("--resume", "-M", "5"), "rows.csv.part: is of another batch"),
    },
)
def test_the_rows_of_an_interrupted_batch_are_not_lost(
    batch: Batch,
    words: tuple[str, ...],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sweep, "run_many", interrupt_after(2))
    batch("mine.py", "--seeds", "0..4", "--out", "rows.csv")
    part = Path("rows.csv.part").read_bytes()
    assert batch("mine.py", "--seeds", "0..4", "--out", "rows.csv", *words) == 2
    assert message in capsys.readouterr().err
    assert Path("rows.csv.part").read_bytes() == part


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim", "ev3"])
def test_a_row_of_a_batch_equals_a_single_run_with_its_settings(
    profile: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, home: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(PROGRAM)
    how = ("--profile", profile, "-M", "50")
    words = ("--seeds", "0..2", "--out", "rows.parquet", "--jobs", "2", "--keep", "all")
    assert run_command(["batch", "mine.py", *how, *words]) == 0
    frame = pd.read_parquet("rows.parquet")
    for at, seed in enumerate(range(3)):
        assert run_command(["run", "mine.py", *how, "--seed", str(seed)]) == 0
        alone, kept = (RunStore().load_run(word) for word in ("last", frame.loc[at, "id"]))
        last = alone.telemetry.last()
        assert last is not None
        assert frame.loc[at, ["x_mm", "y_mm", "heading_deg"]].tolist() == [
            last.x_mm,
            last.y_mm,
            last.heading_deg,
        ]
        assert (kept.program, kept.spec) == (alone.program, alone.spec)
        for name in ("telemetry.bin", "output.bin"):
            assert (kept.folder / name).read_bytes() == (alone.folder / name).read_bytes()


@pytest.mark.slow
def test_an_experiment_gives_the_rows_of_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(PROGRAM)
    assert (
        run_command(
            [
                "batch",
                "mine.py",
                "--seeds",
                "0..3",
                "--set",
                "noise.motor=0,50",
                "--out",
                "rows.parquet",
            ]
        )
        == 0
    )
    frame = tuisim.experiment(
        "mine.py", seeds=range(4), parameters={"noise.motor": [0, 50]}, jobs=2
    )
    assert frame.equals(pd.read_parquet("rows.parquet"))
