"""Tasks in worker processes: results do not depend on who runs them, and none is lost."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.running import over
from tuisim.batch import pool
from tuisim.batch.execute import _prepared, execute
from tuisim.batch.pool import run_many
from tuisim.batch.task import Keep, Result, Task
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.errors import LogError
from tuisim.goals.judgement import GoalState
from tuisim.goals.spec import FinishCondition, Goal, ReachCondition
from tuisim.runs import store, temporary
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.store import RunStore
from tuisim.source import Program

LOGS = """
import random, time
tank_drive.on(30, 20 + random.randint(0, 9))
for _ in range(10):
    print('Light:', colorLeft.reflected_light_intensity_pc)
    time.sleep(0.1)
"""
ENDS = {
    "finished": ("print('A: 1')", 0, ""),
    "raised": ("x = 1\n1 / 0", 1, "ZeroDivisionError"),
    "crashed": ("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", 1, ""),
    "output_limit": ("while True: print('x' * 1000000)", 0, ""),
    "stalled": ("import signal\nsum(range(10**12))", 1, ""),
}


ORPHANS = """
import os, time
from multiprocessing import active_children
from tests.batch.test_pool import task
from tuisim.batch.pool import run_many

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


def test_a_task_gives_what_a_single_run_gives(tmp_path: Path) -> None:
    one = task(LOGS, 5, keep=Keep.ALL)
    result = execute(one, tmp_path)
    handle = start_run(one.program, one.spec, one.options)
    over(handle)
    kept = RunStore().load_run(result.run_id)
    for view in ("telemetry.bin", "output.bin"):
        assert (kept.folder / view).read_bytes() == (handle.folder / view).read_bytes()
    assert kept.end == handle.ended
    assert result.variables["Light"].count == 10


def test_a_prepared_mat_that_was_deleted_is_prepared_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _prepared.cache_clear()
    for home in ("first", "second"):
        monkeypatch.setenv("TUISIM_HOME", str(tmp_path / home))
        assert execute(task("x = 1"), tmp_path).end == "finished"
        shutil.rmtree(tmp_path / home)


@pytest.mark.slow_cases("output_limit", "stalled")
@pytest.mark.parametrize("end", ENDS)
def test_each_end_is_a_result(end: str, tmp_path: Path) -> None:
    text, code, error = ENDS[end]
    options = RunOptions(stall_limit_s=0.2 if end == "stalled" else 60.0)
    result = execute(task(text, prelude="none", options=options), tmp_path)
    assert (result.end, result.exit_code) == (end, code)
    assert error in result.error
    assert result.run_id == ""


@pytest.mark.parametrize(("text", "kept"), [("x = 1", False), ("1 / 0", True)], ids=["met", "missed"])
def test_failed_runs_are_kept(text: str, kept: bool, tmp_path: Path) -> None:
    goals = (Goal(name="end", condition=FinishCondition()),)
    result = execute(task(text, goals=goals, keep=Keep.FAILED), tmp_path)
    assert bool(result.run_id) is kept
    assert (result.judgements[0].state is GoalState.MET) is not kept


OWN_FILES = """
import os, shutil
links = ['/proc/self/fd/' + name for name in os.listdir('/proc/self/fd')]
files = [os.readlink(link) for link in links if os.path.exists(link)]
own = [file for file in files if 'tmp_path' in file and file.endswith('.bin')]
"""
HARM = {
    "writes into its recording": ("open(own[0], 'r+b').write(bytes(range(1, 60)))", "falsified", 1),
    "writes and crashes": ("open(own[0], 'r+b').write(bytes(range(1, 60)))\nos.kill(os.getpid(), 9)", "falsified", 1),
    "deletes its recording": ("shutil.rmtree(os.path.dirname(own[0]))", "falsified", 0),
}


@pytest.mark.parametrize(("harm", "end", "judged"), HARM.values(), ids=HARM)
def test_a_program_that_damages_its_recording_gets_a_result(tmp_path: Path, harm: str, end: str, judged: int) -> None:
    text = OWN_FILES.replace("tmp_path", tmp_path.name) + harm
    result = execute(task(text, goals=(Goal("far", ReachCondition(x_mm=1000, y_mm=100)),)), tmp_path)
    assert (result.end, [one.state for one in result.judgements]) == (end, [GoalState.MISSED] * judged)


@pytest.mark.parametrize("interrupted", ["shutil.copyfileobj", "write_run_file"])
def test_a_run_whose_storing_is_interrupted_is_not_listed(
    tmp_path: Path, home: Path, monkeypatch: pytest.MonkeyPatch, interrupted: str
) -> None:
    folder = tmp_path / "batch"
    folder.mkdir()
    where, _, name = interrupted.rpartition(".")
    real = getattr(shutil if where else store, name)

    def interrupt(*arguments: Any, **how: Any) -> None:
        real(*arguments, **how)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(f"tuisim.runs.store.{interrupted}", interrupt)
        with pytest.raises(KeyboardInterrupt):
            execute(task("x = 1", keep=Keep.ALL), folder)
    assert RunStore().runs() == []
    kept = execute(task("x = 1", keep=Keep.ALL), folder)
    assert [run.id for run in RunStore().runs()] == [kept.run_id]


def test_a_mat_that_does_not_exist_is_a_result(tmp_path: Path) -> None:
    one = task("x = 1")
    world = replace(one.spec.world, background="Nowhere")
    result = execute(replace(one, spec=replace(one.spec, world=world)), tmp_path)
    assert result.end == ""
    assert "Nowhere" in result.error


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
    with subprocess.Popen([sys.executable, script], cwd=root, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        workers = run.stdout.readline().split()
        run.kill()
        # The workers have the pipe, too: it is closed when the last one has ended.
        assert (len(workers), run.stdout.read()) == (2, "")


@pytest.mark.slow
def test_a_script_needs_no_guard(tmp_path: Path, root: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "from tests.batch.test_pool import task\nfrom tuisim.batch.pool import run_many\n"
        "print(sorted(one.end for one in run_many([task('x = 1', index) for index in range(3)], 2)))\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(root)}
    )
    assert (done.stdout, done.stderr) == ("['finished', 'finished', 'finished']\n", "")


def test_a_batch_without_a_folder_for_its_runs_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    missing = tmp_path / "missing"
    monkeypatch.setattr(temporary, "_parent", lambda: missing)
    with pytest.raises(LogError, match=r"missing: no folder for temporary runs can be created: No such file"):
        next(run_many([task("print(1)")], 1))


def test_a_run_without_a_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"missing: no folder for temporary runs can be created: No such file"):
        execute(task("print(1)"), tmp_path / "missing")


def test_a_run_whose_folder_is_gone_is_not_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(temporary, "RUN_FILE", "missing/run.json")
    result = execute(task("print(1)"), tmp_path)
    assert (result.end, result.exit_code) == ("", 2)
    assert "cannot be written: No such file" in result.summary
