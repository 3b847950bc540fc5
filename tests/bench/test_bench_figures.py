"""The measuring bench hangs together; nothing here says how fast anything is."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from tests.bench.__main__ import BENCHES, main
from tests.bench.figures import QUICK, Figure, as_json, as_table
from tests.bench.references import Cost, Ratio, bare_paint, bare_start, bare_ticks, one_tick
from tests.bench.starts import help_text


@pytest.mark.parametrize(
    ("value", "ratio", "least", "most", "goal", "verdict"),
    [
        pytest.param(12.0, None, 10.0, None, ">= 10", "met", id="enough"),
        pytest.param(9.0, None, 10.0, None, ">= 10", "missed", id="too little"),
        pytest.param(9.0, None, None, 10.0, "<= 10", "met", id="little enough"),
        pytest.param(12.0, None, None, 10.0, "<= 10", "missed", id="too much"),
        pytest.param(12.0, None, None, None, "", "", id="no goal"),
        pytest.param(12.0, 0.5, 0.4, None, ">= 0.4 x", "met", id="ratio: enough"),
        pytest.param(0.1, 3.5, None, 3.0, "<= 3 x", "missed", id="ratio: too much"),
    ],
)
def test_a_figure_or_its_ratio_is_compared_with_the_goal(
    value: float, ratio: float | None, least: float | None, most: float | None, goal: str, verdict: str
) -> None:
    compared = None if ratio is None else Ratio(ratio, "x something")
    figure = Figure("thing", value, "kB", least, most, compared)
    assert (figure.goal, figure.verdict) == (goal, verdict)


def test_the_bare_loop_drives_a_left_bend() -> None:
    x_mm, y_mm, heading = bare_ticks(100)
    assert 95 < x_mm < 101 and 0 < y_mm < 5 and 0 < heading < 0.1


@pytest.mark.quick_cases("bare_start")
@pytest.mark.parametrize("reference", [one_tick, bare_start, bare_paint], ids=lambda made: made.__name__)
def test_each_reference_costs_something(reference: Callable[[], Cost]) -> None:
    cost = reference()
    assert cost.cpu_s > 0 and cost.wall_s > 0


def test_the_table_has_a_line_a_figure_and_json_says_the_same() -> None:
    figures = [Figure("one", 1234.5, "ms", most=10.0, ratio=Ratio(12.0, "x app")), Figure("another", 1.25, "kB")]
    heads, first, second = as_table(figures).splitlines()
    assert heads.split() == ["name", "figure", "ratio", "goal"]
    assert first.split() == ["one", "1,234", "ms", "12.0", "x", "app", "<=", "10", "x", "missed"]
    assert second.split() == ["another", "1.25", "kB"]
    plain = json.loads(as_json(figures))
    assert [line["verdict"] for line in plain] == ["missed", ""]
    assert [line["ratio"] for line in plain] == [{"value": 12.0, "reference": "x app"}, None]


def test_an_unknown_bench_is_refused_with_those_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["nonsense"])
    assert left.value.code == 2
    said = capsys.readouterr().err
    assert all(name in said for name in BENCHES)


def test_a_cheap_bench_measures_cpu_time() -> None:
    (figure,) = help_text(QUICK)
    assert 5 < figure.value < 5000
    assert figure.unit == "ms CPU"
