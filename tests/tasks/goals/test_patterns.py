"""Regular expressions of goals: what is found, and what takes too long."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from tests.cases import for_each
from tests.tasks.goals.recorded import Run, goals_of, says, world
from tuisim.engine.core.conditions import NUMBER
from tuisim.engine.runs.samples import parse_sample
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals import patterns
from tuisim.tasks.goals.condition import UnjudgedError
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.judgement import compute_points
from tuisim.tasks.goals.patterns import build_search

CARELESS = "^((a|aa)+)+$"
ENDLESS = "a" * 60 + "!"

TEXTS = {
    "black": ["a black band"],
    r"(?i)dist.*\d+ *mm": ["Distance: 30 mm", "far"],
    r"^\s*\d+(?:\.\d+)?\s*$": ["3.5", "x"],
    r"(?<!not )black$": ["not black", "black"],
    r"(?:ab){2,5}c|d{3}": ["ababc", "ddd", "abc"],
    "(?:black|white)+$": ["black", "blackwhite ", "grey"],
    r"(\w+,)*\w+;": ["a,b,c;", "a,b"],
    "(?=(a+))(?:b|a)+\\1$": ["aba", "bb"],
    "\ud800?(x+x+)+y": ["xxy", "\udcff xxy", "xx"],
}


@for_each(pattern=TEXTS)
def test_patterns_find_the_same_as_the_re_module(pattern: str) -> None:
    search = build_search(pattern)
    assert [search(text) for text in TEXTS[pattern]] == [
        bool(re.search(pattern, text)) for text in TEXTS[pattern]
    ]


def test_a_pattern_that_takes_the_re_module_for_ever_is_searched_at_once() -> None:
    search = build_search("^(a+)+$")
    assert [search(text) for text in ("aaa", ENDLESS)] == [True, False]


def test_the_time_limit_of_a_pattern_covers_all_texts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patterns, "LIMIT_S", 0.02)
    search = build_search(CARELESS)
    assert search("aaa")
    for text in (ENDLESS, "aaa"):
        with pytest.raises(UnjudgedError, match=r"takes more than 0\.02 s .* a fault of the task"):
            search(text)


def test_a_pattern_that_cannot_be_searched_for_is_called_a_fault_of_the_task() -> None:
    with pytest.raises(UnjudgedError, match=r"cannot be searched for: .* a fault of the task"):
        build_search("[[:foo:]]")


def test_a_goal_with_a_faulty_pattern_does_not_keep_other_goals_from_being_judged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(patterns, "LIMIT_S", 0.02)
    goals = goals_of(
        tmp_path,
        f"""
        [[goal]]
        name = "early"
        print = '{CARELESS}'
        [[goal]]
        name = "careless"
        print = ["x", '{CARELESS}']
        [[goal]]
        name = "count"
        count = {{ of = 'print matches {CARELESS}', at_least = 1 }}
        points = 0
        [[goal]]
        name = "none"
        none = ["careless"]
        [[goal]]
        name = "all"
        all = ["careless", "other"]
        [[goal]]
        name = "all of which one is missed"
        all = ["careless", "never"]
        [[goal]]
        name = "any of which one is met"
        any = ["careless", "other"]
        [[goal]]
        name = "later"
        print = "!"
        after = "careless"
        [[goal]]
        name = "sooner"
        print = "!"
        before = "careless"
        [[goal]]
        name = "never"
        print = "never"
        [[goal]]
        name = "other"
        print = "!"
        """,
    )
    run = Run(RunStore(tmp_path / "home"), world(), "")
    run.do((says("aaa"), says("x"), says(ENDLESS), says("aa")))
    judgements = judge(goals, run.end())
    assert {each.goal.name: each.state.value for each in judgements} == {
        "early": "met",
        "careless": "unknown",
        "count": "unknown",
        "none": "unknown",
        "all": "unknown",
        "all of which one is missed": "missed",
        "any of which one is met": "met",
        "later": "unknown",
        "sooner": "unknown",
        "never": "missed",
        "other": "met",
    }
    assert judgements[1].reason.startswith(f"The regular expression {CARELESS!r} takes more than")
    assert not judgements[1].is_good
    assert math.isnan(compute_points(judgements))
    assert compute_points(each for each in judgements if each.goal.name in ("count", "other")) == 1


def test_a_line_of_a_million_digits_is_read_at_once() -> None:
    assert parse_sample("A: " + "1" * 1_000_000 + "x") is None
    assert all(re.fullmatch(NUMBER, text) for text in ("1", "1.", "1.5", ".5", "-1e5", "+1.e-5"))
    assert not any(re.fullmatch(NUMBER, text) for text in (".", "1.5.", "e5", "1e", ""))
