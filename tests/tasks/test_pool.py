"""Tasks in worker processes: results do not depend on who runs them, and none is lost."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.protocol import End
from tuisim.engine.runs import store, temporary
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks import pool
from tuisim.tasks.execute import build_unknown_result, execute
from tuisim.tasks.pool import run_many
from tuisim.tasks.task import Keep, Result, Task

LOGS = """
import random, time
tank_drive.on(30, 20 + random.randint(0, 9))
for _ in range(10):
    print('Light:', colorLeft.reflected_light_intensity_pc)
    time.sleep(0.1)
"""


ORPHANS = """
import os, time
from multiprocessing import active_children
from tests.tasks.test_pool import task
from tuisim.tasks.pool import run_many

results = run_many((task("print('A: 1')", index) for index in range(1000)), 2)
next(results)
print(*(child.pid for child in active_children()), flush=True)
time.sleep(600)
"""


def task(text: str, index: int = 0, prelude: str = "preloaded", **changes: object) -> Task:
    spec = replace(build_run_spec(Settings({"noise.light": 20, "noise.motor": 50})), seed=index)
    program = Program("p.py", text, prelude=prelude, working_directory=os.getcwd())
    return replace(Task(index, program, spec), **changes)  # type: ignore[arg-type]


def by_index(results: list[Result]) -> list[Result]:
    return sorted(results, key=lambda one: one.index)


@pytest.mark.slow
def test_results_do_not_depend_on_the_number_of_jobs() -> None:
    tasks = [task(LOGS, index) for index in range(12)]
    alone, together = (by_index(list(run_many(tasks, jobs))) for jobs in (1, 3))
    assert alone == together
    assert len({one.x_mm for one in alone}) == 12


@pytest.mark.parametrize(
    "interrupted", ["shutil.copyfileobj", "tuisim.engine.runs.store.write_run_file"]
)
def test_a_run_whose_storing_is_interrupted_is_not_listed(
    tmp_path: Path, home: Path, monkeypatch: pytest.MonkeyPatch, interrupted: str
) -> None:
    folder = tmp_path / "batch"
    folder.mkdir()
    where, _, name = interrupted.rpartition(".")
    real = getattr(shutil if where == "shutil" else store, name)

    def interrupt(*arguments: Any, **how: Any) -> None:
        real(*arguments, **how)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(interrupted, interrupt)
        with pytest.raises(KeyboardInterrupt):
            execute(task("x = 1", keep=Keep.ALL), folder)
    assert RunStore().runs() == []
    kept = execute(task("x = 1", keep=Keep.ALL), folder)
    assert [run.id for run in RunStore().runs()] == [kept.run_id]


def test_one_batch_result_that_cannot_be_sent_does_not_lose_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def submit(running: pool._Pool, chunk: list[Task]) -> None:
        future = Future[list[Result]]()
        if any(one.index == 2 for one in chunk):
            future.set_exception(MemoryError())
        else:
            future.set_result([build_unknown_result(one, End.KILLED, "") for one in chunk])
        running._pending[future] = chunk

    monkeypatch.setattr(pool._Pool, "_start", lambda _: None)
    monkeypatch.setattr(pool._Pool, "_submit", submit)
    results = pool._Pool(1, tmp_path).results(task("x = 1", index) for index in range(7))
    ends = [one.end for one in by_index(list(results))]
    assert ends == ["killed", "killed", "", "killed", "killed", "killed", "killed"]


@pytest.mark.slow
def test_tasks_of_a_worker_that_was_killed_are_executed_again(tmp_path: Path) -> None:
    tasks = [task(LOGS, index) for index in range(12)]
    expected = [execute(one, tmp_path) for one in tasks]
    running = pool._Pool(2, tmp_path)
    try:
        results = running.results(iter(tasks))
        found = [next(results)]
        os.kill(running._context.processes[0].pid or 0, signal.SIGKILL)
        found += results
    finally:
        running.stop()
    assert by_index(found) == expected


@pytest.mark.slow
def test_workers_end_with_the_process_that_was_killed(tmp_path: Path, root: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(ORPHANS)
    with subprocess.Popen(
        [sys.executable, script], cwd=root, stdout=subprocess.PIPE, text=True
    ) as run:
        assert run.stdout is not None
        workers = run.stdout.readline().split()
        run.kill()
        # The workers have the pipe, too: it is closed when the last one has ended.
        assert (len(workers), run.stdout.read()) == (2, "")


@pytest.mark.slow
def test_a_script_can_run_a_batch_without_a_main_guard(tmp_path: Path, root: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "from tests.tasks.test_pool import task\nfrom tuisim.tasks.pool import run_many\n"
        "print(sorted(one.end for one in run_many([task('x = 1', index) for index in range(3)], 2)))\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(root)},
    )
    assert (done.stdout, done.stderr) == ("['finished', 'finished', 'finished']\n", "")


def test_a_batch_without_a_folder_for_its_runs_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    missing = tmp_path / "missing"
    monkeypatch.setattr(temporary, "_find_parent", lambda: missing)
    with pytest.raises(
        LogError, match=r"missing: no folder for temporary runs can be created: No such file"
    ):
        next(run_many([task("print(1)")], 1))
