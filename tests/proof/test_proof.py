"""The machine that tries to break tuisim: what it has found, and a little of each kind."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from random import Random

import pytest

from tests.conftest import ROOT
from tests.proof import __main__, attempts, kind, run_model
from tests.proof.found import FOUND
from tests.proof.injection import killed_at
from tests.proof.kind import FaultError, Kind, TooLongError
from tests.proof.kinds import KINDS
from tests.proof.run_model import RunModel
from tests.running import PATIENCE_S, Run

CASES = 30
FEWER = {"clients": 3}
"""Of each kind, and of those whose cases take seconds; `python -m tests.proof` runs many more."""


@pytest.mark.slow_cases(
    "damage-run:3463462202:text",
    "damage-run:183:text",
    "damage-run:369608953:text",
    "damage-run:1180655197:text",
)
@pytest.mark.parametrize(("name", "case"), FOUND, ids=lambda word: word)
def test_each_case_that_once_found_a_fault_finds_none_now(name: str, case: str) -> None:
    assert kind.fault_of(KINDS[name], case) == ""


@pytest.mark.proof
@pytest.mark.usefixtures("real_mats")
@pytest.mark.parametrize("name", KINDS)
def test_a_few_random_cases_of_each_kind_of_proof_find_no_fault(name: str) -> None:
    seed = int(os.environ.get("PROOF_SEED") or int.from_bytes(os.urandom(4)))
    cases = KINDS[name].names(Random(f"{seed} {name}"))
    for _, case in zip(range(FEWER.get(name, CASES)), cases, strict=False):
        assert kind.fault_of(KINDS[name], case) == "", (
            f"python -m tests.proof {name} --case {case} (seed {seed})"
        )


@pytest.mark.proof
@pytest.mark.usefixtures("real_mats")
def test_the_proof_kills_a_command_right_before_the_chosen_system_call(tmp_path: Path) -> None:
    ended = killed_at(("-c", "import os; os.mkdir('a'); os.mkdir('b')"), tmp_path, "mkdir", 2)
    assert (ended.code, [path.name for path in tmp_path.iterdir()]) == (-9, ["a"])


def _names(random: Random) -> Iterator[str]:
    yield from ("good", "bad", "odd", "endless", "caught")


def _check(name: str, folder: Path) -> None:
    assert Path.cwd() == folder
    assert Path(os.environ["TUISIM_HOME"]).parent == folder
    if name == "bad":
        raise FaultError("it broke")
    if name == "odd":
        raise ValueError("not expected")
    while name == "endless":
        pass
    with suppress(TooLongError):
        while name == "caught":
            pass


def _grow(name: str, folder: Path) -> None:
    held = []
    while True:
        held.append(b"x" * (1 << 20))


STAND_IN = Kind("for tests", _names, _check, limit_s=0.05)


def test_faults_are_counted_and_printed_with_their_names(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(KINDS, "stand-in", STAND_IN)
    monkeypatch.setattr(attempts, "watch_over", lambda: None)
    found = attempts.attempt("stand-in", 1, 60.0)
    assert (found.cases, found.faults) == (5, ("bad", "odd", "endless", "caught"))
    printed = capsys.readouterr().out
    wanted = (
        "stand-in --case bad\nit broke",
        "ValueError: not expected",
        "TooLongError: has not ended after 0.05 s of CPU",
        "stand-in --case caught\nhas not ended after 0.05 s of CPU\n",
        'while name == "caught":',
    )
    assert [words for words in wanted if words not in printed] == []


def test_a_case_of_the_proof_that_uses_too_much_memory_is_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # It grows once what was free is used up: how long that takes depends on the tests before.
    monkeypatch.setattr(kind, "MOST_GROWTH_MB", 4)
    monkeypatch.setattr(kind, "LOOK_S", 0.05)
    fault = kind.fault_of(Kind("for tests", _names, _grow), "large")
    assert "TooLargeError: has grown by more than 4 MB" in fault


@pytest.mark.slow
def test_processes_of_the_proof_run_with_garbage_collection_enabled() -> None:
    words = "import gc, tests.proof.clients; print(gc.isenabled())"
    done = subprocess.run(
        [sys.executable, "-c", words], cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert done.stdout == "True\n", done.stderr


def test_a_rerun_that_has_not_ended_in_time_is_compared_as_far_as_it_came(
    monkeypatch: pytest.MonkeyPatch, run: Run
) -> None:
    done = run("import time\ntime.sleep(5_000)\n", time_limit_s=9_000.0)
    monkeypatch.setattr(run_model, "PATIENCE_S", 0.05)
    RunModel.check_replay(done.run.stored())


def test_fixed_seeds_of_the_proof_draw_the_same_cases_each_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def names(random: Random) -> Iterator[str]:
        while True:
            yield str(random.random())

    monkeypatch.setitem(KINDS, "stand-in", Kind("for tests", names, _check))
    first, second, fresh = (
        list(islice(attempts.case_names("stand-in", seed), 100)) for seed in (None, None, 1)
    )
    assert (first == second, len(first), len({*first, *fresh})) == (True, 24, 124)


@pytest.mark.parametrize("name", ["good", "bad"])
def test_a_fault_found_with_a_fixed_seed_makes_the_proof_fail(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    results = [attempts.Result("stand-in", 3, 1.0, ("bad",) * (name == "bad"))]
    monkeypatch.setattr(__main__, "attempts", lambda *_: results)
    assert __main__.main(["--fixed"]) == (name == "bad")


@pytest.mark.parametrize(("case", "code"), [("good", 0), ("bad", 1)])
def test_a_case_of_the_proof_can_be_repeated_by_its_name(
    monkeypatch: pytest.MonkeyPatch, case: str, code: int
) -> None:
    monkeypatch.setitem(KINDS, "stand-in", STAND_IN)
    assert __main__.main(["stand-in", "--case", case]) == code
