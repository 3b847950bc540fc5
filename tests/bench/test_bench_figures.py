"""The measuring bench hangs together; nothing here says how fast anything is."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from math import inf

import pytest

from tests.bench.__main__ import BENCHES, main
from tests.bench.figures import NOT_MEASURED, Figure, as_json, as_table
from tests.bench.frozen_ticks import drive
from tests.bench.references import (
    Ratio,
    fork_s,
    paint_cpu_s,
    paint_wall_s,
    start_cpu_s,
    start_wall_s,
    tick_cpu_s,
    tick_speed,
)
from tests.bench.sampling import QUICK, MeasuringError
from tests.bench.starts import help_text


@pytest.mark.parametrize(
    ("value", "ratio", "least", "most", "goal", "verdict"),
    [
        pytest.param(12.0, None, 10.0, None, ">= 10", "met", id="enough"),
        pytest.param(16.0, None, 10.0, None, ">= 10", "loose", id="far more than enough"),
        pytest.param(6.0, None, None, 10.0, "<= 10", "loose", id="far less than allowed"),
        pytest.param(9.0, None, 10.0, None, ">= 10", "missed", id="too little"),
        pytest.param(9.0, None, None, 10.0, "<= 10", "met", id="little enough"),
        pytest.param(12.0, None, None, 10.0, "<= 10", "missed", id="too much"),
        pytest.param(12.0, None, None, None, "", "", id="no goal"),
        pytest.param(12.0, 0.5, 0.4, None, ">= 0.4 x", "met", id="ratio: enough"),
        pytest.param(0.1, 3.5, None, 3.0, "<= 3 x", "missed", id="ratio: too much"),
    ],
)
def test_a_figure_or_its_ratio_is_compared_with_the_goal(
    value: float,
    ratio: float | None,
    least: float | None,
    most: float | None,
    goal: str,
    verdict: str,
) -> None:
    compared = None if ratio is None else Ratio(ratio, "x something")
    figure = Figure("thing", value, "kB", least, most, compared)
    assert (figure.goal, figure.verdict) == (goal, verdict)


@pytest.mark.parametrize("value", [0.0, -1.0, inf])
def test_an_impossible_figure_such_as_nan_is_an_error(value: float) -> None:
    with pytest.raises(MeasuringError):
        Figure("thing", value, "ms", most=1.0)
    with pytest.raises(MeasuringError):
        Figure("thing", 1.0, "ms", most=1.0, ratio=Ratio(value, "x something"))


def test_a_figure_that_may_be_zero_meets_its_goal_at_zero() -> None:
    assert Figure("at rest", 0.0, "B/s", most=0.0, may_be_zero=True).verdict == "met"


def test_a_speed_that_no_program_can_have_is_an_error() -> None:
    assert tick_speed(4000.0, 1e-6).value == pytest.approx(0.4)
    with pytest.raises(MeasuringError):
        tick_speed(600_000_000.0, 1e-6)


def test_the_frozen_ticks_of_a_bench_drive_along_the_bands() -> None:
    world = drive(1000)
    assert world.tick == 1000
    assert world.drive.x_mm > 1100
    assert 1000 < world.left.position_deg < 2500


@pytest.mark.quick_cases("start_cpu_s", "fork_s")
@pytest.mark.parametrize(
    "reference",
    [tick_cpu_s, start_cpu_s, start_wall_s, paint_cpu_s, paint_wall_s, fork_s],
    ids=lambda at: at.__name__,
)
def test_each_reference_workload_takes_measurable_time(reference: Callable[[], float]) -> None:
    assert 0 < reference() < 60


def test_the_table_has_a_line_a_figure_and_json_says_the_same() -> None:
    figures = [
        Figure("one", 1234.5, "ms", most=10.0, ratio=Ratio(12.0, "x app")),
        Figure("another", 1.25, "kB"),
        Figure("absent", NOT_MEASURED, ""),
    ]
    heads, first, second, third = as_table(figures).splitlines()
    assert heads.split() == ["name", "figure", "ratio", "goal"]
    assert first.split() == ["one", "1,234", "ms", "12.0", "x", "app", "<=", "10", "x", "missed"]
    assert (second.split(), third.split()) == (["another", "1.25", "kB"], ["absent", "–"])
    plain = json.loads(as_json(figures))
    assert [line["verdict"] for line in plain] == ["missed", "", ""]
    assert [line["ratio"] for line in plain] == [{"value": 12.0, "reference": "x app"}, None, None]
    assert [line["value"] for line in plain] == [1234.5, 1.25, None]


def test_an_unknown_bench_is_refused_with_those_there_are(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as left:
        main(["nonsense"])
    assert left.value.code == 2
    said = capsys.readouterr().err
    assert all(name in said for name in BENCHES)


def test_a_cheap_bench_measures_cpu_time() -> None:
    (figure,) = help_text(replace(QUICK, least_cpu_s=0.1))
    assert 5 < figure.value < 5000
    assert figure.unit == "ms CPU"
