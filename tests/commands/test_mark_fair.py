"""Programs that strain what runs them have one end: in every host, and beside whatever else the machine does."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import islice
from pathlib import Path

import pytest

from tests.hosts import Stored, hosted
from tests.tasks.marks.fair import FAIR

QUICK = ("plain", "busy_daemon", "raises", "exits", "condition")


@pytest.fixture(scope="module")
def in_run(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Stored]:
    """What `tuisim run` makes of them all."""
    return dict(hosted("run", FAIR, tmp_path_factory.mktemp("run") / "place").runs)


@pytest.mark.slow
def test_honest_programs_end_as_expected_when_run_alone(in_run: dict[str, Stored]) -> None:
    assert in_run.keys() == FAIR.keys()
    ends = {
        "raises": "raised",
        "raises_a_group": "raised",
        "a_long_chain": "raised",
        "endless_recursion": "raised",
    }
    assert {name: run.end for name, run in in_run.items()} == {
        name: ends.get(name, "finished") for name in FAIR
    }
    assert {name: run.exit_code for name, run in in_run.items() if run.exit_code not in (0, 1)} == {
        "exits": 3
    }


@pytest.mark.slow
@pytest.mark.parametrize("host, first", [("batch", 0), ("mark", 1), ("app", 0), ("notebook", 1)])
def test_honest_programs_end_the_same_in_batch_marking_app_and_notebook(
    host: str, first: int, in_run: dict[str, Stored], tmp_path: Path
) -> None:
    """Every program is run without anybody who looks on, by one of two commands, and live, in the app or a notebook."""
    programs = dict(islice(FAIR.items(), first, None, 2))
    found = hosted(host, programs, tmp_path / "place").runs
    assert {name: found.get(name) for name in programs if found.get(name) != in_run[name]} == {}


@pytest.mark.slow_cases("mark")
@pytest.mark.parametrize("host", ["batch", "mark"])
def test_a_few_honest_programs_end_the_same_in_run_batch_and_marking(
    host: str, tmp_path: Path
) -> None:
    few = {name: FAIR[name] for name in QUICK}
    assert hosted(host, few, tmp_path / "place").runs == hosted("run", few, tmp_path / "run").runs


@pytest.fixture
def busy() -> Iterator[None]:
    """Four processes that compute all the time."""
    with ExitStack() as stack:
        for _ in range(4):
            process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
            stack.callback(process.wait)
            stack.callback(process.kill)
        yield


@pytest.mark.slow
def test_honest_programs_end_the_same_beside_four_busy_processes(
    in_run: dict[str, Stored], busy: None, tmp_path: Path
) -> None:
    programs = dict(islice(FAIR.items(), 0, None, 8))
    runs = hosted("mark", programs, tmp_path / "place").runs
    assert runs == {name: in_run[name] for name in programs}
