"""The machine that tries to break tuisim: what it has found, and a little of each kind."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from tests.proof import __main__, attempts, kind
from tests.proof.found import FOUND
from tests.proof.injection import killed_at
from tests.proof.kind import FaultError, Kind
from tests.proof.kinds import KINDS

CASES, FEWER = 30, {"clients": 3}
"""Of each kind, and of those whose cases take seconds; `python -m tests.proof` runs many more."""


@pytest.mark.parametrize(("name", "case"), FOUND, ids=lambda word: word)
def test_a_fault_that_was_found_is_mended(name: str, case: str) -> None:
    assert kind.fault_of(KINDS[name], case) == ""


@pytest.mark.proof
@pytest.mark.parametrize("name", KINDS)
def test_a_little_of_each_kind_shows_no_fault(name: str) -> None:
    seed = int(os.environ.get("PROOF_SEED") or int.from_bytes(os.urandom(4)))
    cases = KINDS[name].names(Random(f"{seed} {name}"))
    for _, case in zip(range(FEWER.get(name, CASES)), cases, strict=False):
        assert kind.fault_of(KINDS[name], case) == "", f"python -m tests.proof {name} --case {case} (seed {seed})"


@pytest.mark.proof
def test_a_command_is_killed_before_its_call(tmp_path: Path) -> None:
    ended = killed_at(("-c", "import os; os.mkdir('a'); os.mkdir('b')"), tmp_path, "mkdir", 2)
    assert (ended.code, [path.name for path in tmp_path.iterdir()]) == (-9, ["a"])


def _names(random: Random) -> Iterator[str]:
    yield from ("good", "bad", "odd", "endless")


def _check(name: str, folder: Path) -> None:
    assert Path.cwd() == folder
    assert Path(os.environ["TUISIM_HOME"]).parent == folder
    if name == "bad":
        raise FaultError("it broke")
    if name == "odd":
        raise ValueError("not expected")
    while name == "endless":
        pass


STAND_IN = Kind("for tests", _names, _check, limit_s=0.05)


def test_faults_are_counted_and_printed_with_their_names(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(KINDS, "stand-in", STAND_IN)
    monkeypatch.setattr(attempts, "watch_over", lambda: None)
    found = attempts.attempt("stand-in", 1, 60.0)
    assert (found.cases, found.faults) == (4, ("bad", "odd", "endless"))
    printed = capsys.readouterr().out
    assert [
        words
        for words in ("stand-in --case bad\nit broke", "ValueError: not expected", "has not ended after 0.05 s of CPU")
        if words not in printed
    ] == []


@pytest.mark.parametrize(("case", "code"), [("good", 0), ("bad", 1)])
def test_a_case_is_repeated_by_its_name(monkeypatch: pytest.MonkeyPatch, case: str, code: int) -> None:
    monkeypatch.setitem(KINDS, "stand-in", STAND_IN)
    assert __main__.main(["stand-in", "--case", case]) == code
