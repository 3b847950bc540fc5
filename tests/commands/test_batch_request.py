"""What a batch is asked for: options over its file, and what is wrong is said before anything is run."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from tests.cases import cases
from tests.commands.conftest import SPEC, Batch
from tuisim.batch import sweep


@cases(
    "words, rows",
    {
        "seeds": (("--seeds", "7"), [[0, 7], [20, 7]]),
        "a parameter": (("--set", "noise.motor=5"), [[5, 0], [5, 1], [5, 2]]),
        "the option for the seed": (("--seed", "4"), [[0, 4], [20, 4]]),
    },
)
def test_options_override_the_batch_file(
    batch: Batch, words: tuple[str, ...], rows: list[list[int]]
) -> None:
    Path("spec.toml").write_text(SPEC)
    assert batch("spec.toml", *words) == 0
    assert pd.read_csv("rows.csv")[["noise.motor", "seed"]].to_numpy().tolist() == rows


def test_the_option_for_a_parameter_of_the_batch_file_replaces_it(batch: Batch) -> None:
    Path("spec.toml").write_text(SPEC)
    assert batch("spec.toml", "-M", "30") == 0
    frame = pd.read_csv("rows.csv")
    assert ("noise.motor" in frame.columns, frame["x_mm"].tolist()) == (False, [100, 130, 160])


@cases(
    "words, message",
    {
        "key": (("--set", "noise.motr=1"), "--set: noise.motr: no such key (did you mean motor?)"),
        "option": (("--set", "noise.motor=1", "-M", "5"), "noise.motor varies what an option sets"),
        "port": (
            ("--scheduler", "localhost"),
            "--scheduler: is not an address of a scheduler: 'localhost'",
        ),
        "seed option": (("--seeds", "1..3", "--seed", "5"), "seed varies what an option sets"),
        "two seeds": (("--seeds", "1..3", "--set", "seed=5"), "--seeds: cannot be combined with"),
        "twice": (("--set", "pen.down=on", "--set", "pen.down=off"), "pen.down is given twice"),
        "expression": (("--expr", "x"), "--expr: must be NAME=EXPR"),
        "column of an expression": (("--expr", "a=x_m"), "--expr a: there will be no column 'x_m'"),
        "resume nothing": (("--resume",), "--resume: needs the table"),
        "format": (("--out", "rows.txt"), "unknown format '.txt'"),
        "file": (("--picture", "a.svg"), "no such option: --picture (seaborn draws the table"),
        "picture": (("--picture-of", "poses"), "no such option: --picture-of (seaborn draws"),
        "goals": (("--goals", "none.toml"), "none.toml: there is no such file"),
        "jobs": (("--jobs", "0"), "--jobs: must be a whole number from 1"),
        "workers": (("--jobs", "2", "--workers", "2"), "--workers: cannot be combined with --jobs"),
        "cluster": (
            ("--scheduler", "tcp://a:1", "--workers", "2"),
            "--workers: cannot be combined with",
        ),
        "speed": (("--speed", "1"), "no such option: --speed"),
    },
)
def test_a_batch_with_wrong_options_is_refused_before_anything_is_run(
    batch: Batch,
    words: tuple[str, ...],
    message: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sweep, "run_many", None)
    assert batch("mine.py", *words) == 2
    assert message in capsys.readouterr().err


def test_a_batch_needs_a_program(batch: Batch, capsys: pytest.CaptureFixture[str]) -> None:
    assert batch("--seeds", "1") == 2
    assert "no program is named (tuisim batch PROGRAM…)" in capsys.readouterr().err
