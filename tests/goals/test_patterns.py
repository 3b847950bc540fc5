"""Regular expressions of goals: what is found, and what takes too long."""

from __future__ import annotations

import errno
import re
import subprocess
from pathlib import Path

import pytest

from tests.goals.recorded import Run, goals_of, says, world
from tuisim.core.conditions import NUMBER
from tuisim.errors import LogError
from tuisim.goals import patterns
from tuisim.goals.judge import judge
from tuisim.goals.patterns import SlowPatternError, search_in
from tuisim.regular_file import of_the_machine
from tuisim.runs.samples import parse_sample
from tuisim.runs.store import RunStore

CARELESS = "^(a+)+$"
ENDLESS = "a" * 60 + "!"

HERE = {
    "black": ["a black band"] * 1000,
    r"(?i)dist.*\d+ *mm": ["Distance: 30 mm", "far"],
    r"^\s*\d+(?:\.\d+)?\s*$": ["3.5", "x"],
    r"(?<!not )black$": ["not black", "black"],
    r"(?:ab){2,5}c|d{3}": ["ababc", "ddd", "abc"],
}
ELSEWHERE = {
    "(?:black|white)+$": ["black", "blackwhite ", "grey"],
    r"(\w+,)*\w+;": ["a,b,c;", "a,b"],
    "(?=(a+))(?:b|a)+\\1$": ["aba", "bb"],
    "\ud800?(x+x+)+y": ["xxy", "\udcff xxy", "xx"],
}


@pytest.mark.parametrize("pattern", HERE)
def test_what_ends_in_time_is_searched_here(pattern: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(patterns, "_searched")
    search = search_in(pattern, HERE[pattern])
    assert [search(text) for text in HERE[pattern]] == [
        bool(re.search(pattern, text)) for text in HERE[pattern]
    ]


@pytest.mark.parametrize("pattern", ELSEWHERE)
def test_a_process_of_its_own_finds_the_same(pattern: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patterns, "_MOST_STEPS", 0)
    search = search_in(pattern, ELSEWHERE[pattern])
    assert [search(text) for text in ELSEWHERE[pattern]] == [
        bool(re.search(pattern, text)) for text in ELSEWHERE[pattern]
    ]


@pytest.mark.parametrize(
    "pattern, text",
    [
        (r"\d+x", "1" * 1_000_000),
        (r"(?:a?){30}a{30}", "a" * 30),
        (CARELESS, ENDLESS),
        ("a*a*a*b", "a" * 2000),
    ],
)
def test_what_may_take_long_is_not_searched_here(pattern: str, text: str) -> None:
    assert patterns._steps(pattern, [text]) > patterns._MOST_STEPS


def test_the_rest_of_a_class_of_goals_is_judged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(patterns, "LIMIT_S", 0)
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
        [[goal]]
        name = "none"
        none = ["careless"]
        [[goal]]
        name = "other"
        print = "!"
        """,
    )
    run = Run(RunStore(tmp_path / "home"), world(), "")
    run.do((says("aaa"), says("x"), says(ENDLESS), says("aa")))
    found = judge(goals, run.end())
    assert [(one.goal.name, one.state.value, one.is_unknown) for one in found] == [
        ("early", "met", False),
        ("careless", "missed", True),
        ("count", "missed", True),
        ("none", "missed", True),
        ("other", "met", False),
    ]
    assert found[1].reason.startswith(f"The regular expression {CARELESS!r} takes more than")


def test_a_search_that_cannot_end_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patterns, "_searched", lambda pattern, texts: {texts[0]: True})
    search = search_in(CARELESS, ["aaa", ENDLESS])
    assert search("aaa")
    with pytest.raises(SlowPatternError, match="that is a fault of the task"):
        search(ENDLESS)


@pytest.mark.parametrize("returncode", [-9, 1, None])
def test_a_search_that_the_machine_ends_is_no_fault_of_the_recording(
    returncode: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def run(command: list[str], **given: object) -> subprocess.CompletedProcess[bytes]:
        if returncode is None:
            raise OSError(errno.EAGAIN, "Resource temporarily unavailable")
        return subprocess.CompletedProcess(command, returncode, b"1")

    monkeypatch.setattr(subprocess, "run", run)
    with pytest.raises(LogError, match="what was printed cannot be searched") as caught:
        search_in(CARELESS, ["aaa", ENDLESS])
    assert isinstance(caught.value.__cause__, OSError) and of_the_machine(caught.value.__cause__)


def test_a_line_of_a_million_digits_is_read_at_once() -> None:
    assert parse_sample("A: " + "1" * 1_000_000 + "x") is None
    assert all(re.fullmatch(NUMBER, text) for text in ("1", "1.", "1.5", ".5", "-1e5", "+1.e-5"))
    assert not any(re.fullmatch(NUMBER, text) for text in (".", "1.5.", "e5", "1e", ""))
