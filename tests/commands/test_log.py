"""`tuisim log` from the command line: figures, bands, events and signals of runs, files and pipes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest

from tests.cases import cases, for_rows
from tests.conftest import Command
from tests.running import told
from tuisim.analysis.chart import build_spans
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.panes import pane_lines
from tuisim.cli import run_command
from tuisim.commands.log import OPTIONS, SUBCOMMANDS, Subcommand

FIVE = (100.0, 86.27450980392157, 82.74509803921568, 50.19607843137255, 0.0)
ORDER = ("white", "pale grey", "white", "light grey", "white", "grey", "white", "black")


@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim"])
def test_log_bands_names_each_grey_with_its_level(here: Command, profile: str) -> None:
    here("run", "log_greys", "--profile", profile)
    found = json.loads(here("log", "bands", "last", "--json").stdout)
    assert tuple(band["grey"] for band in found) == ORDER
    assert {band["level"] for band in found} == set(FIVE)
    said = here("log", "bands", "last").stdout
    assert (
        "5 levels: 100.00 white (4x), 86.27 pale grey, 82.75 light grey, 50.20 grey, 0.00 black"
        in said
    )


def test_bands_under_noise_keep_their_names_and_order(here: Command) -> None:
    here("run", "log_greys", "-N", "20")
    found = json.loads(here("log", "bands", "last", "--json").stdout)
    assert tuple(band["grey"] for band in found) == ORDER
    for band in found:
        assert band["true_level"] == pytest.approx(band["grey_percent"], abs=2.0)


@pytest.mark.slow
def test_a_bands_level_and_true_level_are_the_same_in_shell_report_and_app(
    here: Command, tmp_path: Path
) -> None:
    here("run", "log_greys", "-N", "20")
    first = json.loads(here("log", "bands", "last", "--json").stdout)[0]
    level, true_level = f"{first['level']:.2f}", f"{first['true_level']:.2f}"
    assert level != true_level

    head, row, *_ = here("log", "bands", "last").stdout.splitlines()
    assert row[: head.index("LEVEL") + len("LEVEL")].endswith(f" {level}")
    assert row[: head.index("TRUE LEVEL") + len("TRUE LEVEL")].endswith(f" {true_level}")

    here("log", "report", "last", "--out", str(tmp_path / "r.html"))
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert re.findall("<th[^>]*>(level|true level)</th>", page) == ["level", "true level"]

    *_, opened = LogRequest(runs=("last",)).open_pieces()
    model = AnalysisModel(opened)
    model.find_bands(model.list_unsearched())
    head, row, *_ = (
        "".join(text for text, _ in line) for line in pane_lines("bands", model, 0, 120, 20)
    )
    columns = [part.strip() for part in re.split("  +", head)]
    cells = [part.strip() for part in re.split("  +", row)]
    assert cells[columns.index("level")] == level
    assert cells[columns.index("true level")] == true_level
    assert build_spans(model.bands())[0].texts[0] == f"{first['level']:.4g} {first['grey']}"


def test_log_bands_has_no_column_true_level_without_known_noise(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "own.csv").write_text(
        "time,Colour\n" + "".join(f"{row / 10},{50 + row % 2}\n" for row in range(20))
    )
    said = here("log", "bands", str(tmp_path / "own.csv")).stdout
    assert " LEVEL " in said and "TRUE LEVEL" not in said


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A log of two variables."""
    path = tmp_path / "two.csv"
    path.write_text("time,left,right\n" + "".join(f"{at / 2},{at},{10 - at}\n" for at in range(10)))
    return path


def frame_of(text: str) -> pd.DataFrame:
    return pd.read_csv(StringIO(text))


SIGNALS: dict[str, tuple[tuple[str, ...], Callable[[pd.DataFrame], bool]]] = {
    "derive": ((), lambda f: bool((f[f.variable == "left"].derivative - 2.0).abs().max() < 1e-9)),
    "integrate": (
        ("--between", "linear"),
        lambda f: f[f.variable == "left"].integral.iloc[-1] == 20.25,
    ),
    "average": (("--width", "3"), lambda f: f[f.variable == "right"].average.iloc[1] == 9.0),
    "resample": (("--period", "1"), lambda f: list(f.left) == [0, 2, 4, 6, 8]),
    "calc": (("--expression", "left + right"), lambda f: list(f.result) == [10.0] * 10),
}


@pytest.mark.parametrize("action, how", SIGNALS.items(), ids=SIGNALS)
def test_integrals_resamples_and_crossings_are_printed(
    here: Command, log: Path, action: str, how: tuple[tuple[str, ...], Callable[..., bool]]
) -> None:
    assert how[1](frame_of(here("log", action, str(log), *how[0]).stdout))


def test_log_events_lists_crossings_with_their_times(here: Command, log: Path) -> None:
    found = json.loads(here("log", "events", str(log), "--at", "4.5", "--json").stdout)
    assert [(event["variable"], event["time_s"], event["crossing"]) for event in found] == [
        ("left", 2.25, "rises"),
        ("right", 2.75, "falls"),
    ]


BAD = {
    "no log": (("bands",), "no log given"),
    "no subcommand": (("bnads", "last"), "did you mean bands"),
    "no such run": (("bands", "999"), "no run"),
    "no such file": (("bands", "x.csv"), "no such file"),
    "an option of another": (
        ("bands", "last", "--width", "3"),
        "no such option: --width (see `tuisim log bands --help`)",
    ),
    "no threshold": (("events", "{log}"), "takes one threshold"),
    "no such variable": (("summary", "{log}", "--variable", "up"), "no variable 'up'"),
    "no such column": (("summary", "{log}", "--time", "clock"), "no column 'clock'"),
    "an expression": (("calc", "{log}", "--expression", "left +"), "cannot read the expression"),
    "a column in it": (("calc", "{log}", "--expression", "lft"), "no column 'lft'"),
    "an even width": (("average", "{log}", "--width", "4"), "odd"),
    "no period": (("resample", "{log}", "--period", "0"), "above 0"),
    "no numbers": (("derive", "{words}"), "no numeric column (its columns are time, said)"),
    "a name too long for the file system": (("summary", "x" * 300 + ".csv"), "File name too long"),
    "no such format": (
        ("export", "{log}", "--out", "x.xls"),
        "unknown format '.xls' (a file ends in .csv, .parquet, .jsonl, .arrow, .mcap)",
    ),
    "no wheels": (("reckon", "{log}"), "no column 'left_position_deg' with numbers"),
}


@cases("words, expected", BAD)
def test_wrong_words_for_log_are_refused_in_one_line(
    here: Command, log: Path, words: tuple[str, ...], expected: str
) -> None:
    text = log.with_name("words.csv")
    text.write_text("time,said\n0,a\n1,b\n")
    done = here("log", *(word.format(log=log, words=text) for word in words))
    assert done.returncode == 2
    assert expected in done.stderr
    assert len(told(done)) == 1


def test_help_lists_every_subcommand(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["log", "--help"]) == 0
    said = capsys.readouterr().out
    assert all(f"  {name} " in said for name in SUBCOMMANDS)


@for_rows("entry", SUBCOMMANDS)
def test_each_subcommand_of_log_is_documented_and_has_declared_options(entry: Subcommand) -> None:
    assert (entry.load().__doc__ or "").strip()
    assert set(entry.options) <= set(OPTIONS)


def test_each_declared_option_of_log_is_used_by_a_subcommand() -> None:
    assert {option for entry in SUBCOMMANDS.values() for option in entry.options} == set(OPTIONS)
