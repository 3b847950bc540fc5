"""The measuring bench hangs together; nothing here says how fast anything is."""

from __future__ import annotations

import json

import pytest

from tests.bench.__main__ import BENCHES, main
from tests.bench.figures import QUICK, Figure, as_json, as_table
from tests.bench.starts import help_text


@pytest.mark.parametrize(
    ("value", "least", "most", "goal", "verdict"),
    [
        pytest.param(12.0, 10.0, None, ">= 10", "met", id="enough"),
        pytest.param(9.0, 10.0, None, ">= 10", "missed", id="too little"),
        pytest.param(9.0, None, 10.0, "<= 10", "met", id="little enough"),
        pytest.param(12.0, None, 10.0, "<= 10", "missed", id="too much"),
        pytest.param(12.0, None, None, "", "", id="only told"),
    ],
)
def test_a_figure_is_held_against_its_goal(
    value: float, least: float | None, most: float | None, goal: str, verdict: str
) -> None:
    figure = Figure("thing", value, "kB", least, most)
    assert (figure.goal, figure.verdict) == (goal, verdict)


def test_the_table_has_a_line_a_figure_and_json_says_the_same() -> None:
    figures = [Figure("one", 1234.5, "ms", most=10.0), Figure("another", 1.25, "kB")]
    heads, first, second = as_table(figures).splitlines()
    assert heads.split() == ["name", "figure", "goal"]
    assert first.split() == ["one", "1,234", "ms", "<=", "10", "missed"]
    assert second.split() == ["another", "1.25", "kB"]
    assert [line["verdict"] for line in json.loads(as_json(figures))] == ["missed", ""]


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
