"""One task of a batch: what becomes of it, and what is kept."""

from __future__ import annotations

import errno
import shutil
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from unittest.mock import MagicMock

import pytest

from tests.cases import cases
from tests.running import over
from tests.tasks.test_pool import LOGS, task
from tuisim.base.errors import LogError
from tuisim.base.faults import report_file
from tuisim.engine.runs import temporary
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.store import RunStore
from tuisim.tasks import execute as execute_module
from tuisim.tasks.execute import _prepare_field, _run_to_end, execute
from tuisim.tasks.goals.judgement import GoalState
from tuisim.tasks.goals.spec import FinishCondition, Goal, ReachCondition
from tuisim.tasks.pool import _take_results
from tuisim.tasks.task import Keep, Result

ENDS = {
    "finished": ("print('A: 1')", 0, ""),
    "raised": ("x = 1\n1 / 0", 1, "ZeroDivisionError"),
    "crashed": ("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", 1, ""),
    "output_limit": ("while True: print('x' * 1000000)", 0, ""),
    "stalled": ("import signal\nsum(range(10**12))", 1, ""),
}


def test_a_batch_task_records_the_same_bytes_as_a_single_run(tmp_path: Path) -> None:
    one = task(LOGS, 5, keep=Keep.ALL)
    result = execute(one, tmp_path)
    handle = start_run(one.program, one.spec, one.options)
    over(handle)
    kept = RunStore().load_run(result.run_id)
    for view in ("telemetry.bin", "output.bin"):
        assert (kept.folder / view).read_bytes() == (handle.folder / view).read_bytes()
    assert kept.end == handle.ended
    assert result.variables["Light"].count == 10


def test_a_prepared_mat_that_was_deleted_is_prepared_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _prepare_field.cache_clear()
    for home in ("first", "second"):
        monkeypatch.setenv("TUISIM_HOME", str(tmp_path / home))
        assert execute(task("x = 1"), tmp_path).end == "finished"
        shutil.rmtree(tmp_path / home)


@pytest.mark.slow_cases("output_limit", "stalled")
@pytest.mark.parametrize("end", ENDS)
def test_each_end_of_a_program_gives_a_batch_result_with_its_exit_code(
    end: str, tmp_path: Path
) -> None:
    text, code, error = ENDS[end]
    options = RunOptions(stall_limit_s=0.2 if end == "stalled" else 60.0)
    result = execute(task(text, prelude="none", options=options), tmp_path)
    assert (result.end, result.exit_code) == (end, code)
    assert error in result.error
    assert result.run_id == ""


@pytest.mark.parametrize("text, kept", [("x = 1", False), ("1 / 0", True)], ids=["met", "missed"])
def test_keep_failed_stores_only_runs_that_failed(text: str, kept: bool, tmp_path: Path) -> None:
    goals = (Goal(name="end", condition=FinishCondition()),)
    result = execute(task(text, goals=goals, keep=Keep.FAILED), tmp_path)
    assert bool(result.run_id) is kept
    assert (result.judgements[0].state is GoalState.MET) is not kept


def test_keep_failed_does_not_store_a_run_with_too_much_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert execute_module.MAX_OUTPUT_BYTES == 16 << 20
    monkeypatch.setattr(execute_module, "MAX_OUTPUT_BYTES", 100)
    for keep, kept in ((Keep.FAILED, False), (Keep.ALL, True)):
        assert bool(execute(task("print('x' * 100)\n1 / 0", keep=keep), tmp_path).run_id) is kept


OWN_FILES = """
import os, shutil
links = ['/proc/self/fd/' + name for name in os.listdir('/proc/self/fd')]
files = [os.readlink(link) for link in links if os.path.exists(link)]
own = [file for file in files if 'tmp_path' in file and file.endswith('.bin')]
"""


HARM = {
    "writes into its recording": ("open(own[0], 'r+b').write(bytes(range(1, 60)))", "falsified", 1),
    "writes and crashes": (
        "open(own[0], 'r+b').write(bytes(range(1, 60)))\nos.kill(os.getpid(), 9)",
        "falsified",
        1,
    ),
    "deletes its recording": ("shutil.rmtree(os.path.dirname(own[0]))", "falsified", 0),
}


@cases("harm, end, judged", HARM)
def test_a_program_that_damages_its_recording_still_gets_a_batch_result(
    tmp_path: Path, harm: str, end: str, judged: int
) -> None:
    text = OWN_FILES.replace("tmp_path", tmp_path.name) + harm
    result = execute(
        task(text, goals=(Goal("far", ReachCondition(x_mm=1000, y_mm=100)),)), tmp_path
    )
    assert (result.end, [one.state for one in result.judgements]) == (
        end,
        [GoalState.MISSED] * judged,
    )


def test_a_mat_that_does_not_exist_is_a_result(tmp_path: Path) -> None:
    one = task("x = 1")
    world = replace(one.spec.world, background="Nowhere")
    result = execute(replace(one, spec=replace(one.spec, world=world)), tmp_path)
    assert result.end == ""
    assert "Nowhere" in result.error


def test_a_run_without_a_folder_is_told(tmp_path: Path) -> None:
    report_file().unlink(missing_ok=True)
    result = execute(task("print(1)"), tmp_path / "missing")
    assert (result.end, result.exit_code) == ("", 2)
    assert result.summary == (
        "could not be judged: no folder for temporary runs can be created: No such file or directory"
    )
    assert not report_file().exists()


@pytest.mark.parametrize("error", [ZeroDivisionError("ours"), OSError(5, "broken")])
def test_a_fault_of_tuisim_in_a_batch_becomes_a_result_and_a_report_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    monkeypatch.setattr(execute_module, "_judge", MagicMock(side_effect=error))
    result = execute(task("print(1)"), tmp_path)
    why = error.strerror if isinstance(error, OSError) else error
    assert (result.end, result.summary) == (
        "",
        f"could not be judged: {type(error).__name__}: {why}",
    )
    assert "in _run_task" in report_file().read_text()
    assert not list(tmp_path.iterdir())


def test_a_kept_run_has_the_tags_of_its_task(tmp_path: Path) -> None:
    result = execute(replace(task("1 / 0"), keep=Keep.ALL, tags=("student:ada",)), tmp_path)
    assert RunStore().load_run(result.run_id).tags == ("student:ada",)
    assert RunStore().find(result.run_id).tags == "student:ada"


@pytest.mark.parametrize("step", ["write_end", "add_folder"])
def test_a_run_that_cannot_be_stored_is_judged_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    """Its program could have seen to that."""
    owner = {"write_end": temporary.TemporaryRun, "add_folder": RunStore}[step]
    monkeypatch.setattr(owner, step, MagicMock(side_effect=LogError("cannot be stored")))
    result = execute(replace(task("1 / 0"), keep=Keep.ALL), tmp_path)
    assert (result.end, result.run_id) == ("raised", "")


def test_a_run_that_a_full_disk_refuses_is_not_judged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refusal = LogError("cannot be stored")
    refusal.__cause__ = OSError(errno.ENOSPC, "no space")
    monkeypatch.setattr(RunStore, "add_folder", MagicMock(side_effect=refusal))
    result = execute(replace(task("1 / 0"), keep=Keep.ALL), tmp_path)
    assert (result.end, result.exit_code) == ("", 2)


def test_a_batch_result_that_cannot_be_sent_between_processes_is_reported() -> None:
    future: Future[list[Result]] = Future()
    future.set_exception(MemoryError())
    (result,) = _take_results(future, [task("print(1)")])
    assert (result.end, result.summary) == ("", "could not be judged: MemoryError: ")


def test_a_batch_run_whose_folder_is_gone_is_not_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(temporary, "RUN_FILE", "missing/run.json")
    result = execute(task("print(1)"), tmp_path)
    assert (result.end, result.exit_code) == ("", 2)
    assert "cannot be written: No such file" in result.summary


def test_a_run_is_stopped_when_it_has_used_its_time() -> None:
    done: list[float | str | None] = []
    handle = MagicMock(time_used_s=3.0)

    def wait(limit_s: float | None = None) -> str | None:
        done.append(limit_s)
        if len(done) == 2:
            handle.time_used_s = 5.0
        return "ended" if "stop" in done else None

    handle.wait, handle.stop = wait, lambda: done.append("stop")
    assert str(_run_to_end(handle, 5.0)) == "ended"
    assert done == [5.0, 2.0, "stop", None]


MOVES = """\
import builtins, time
from tuisim.engine.protocol import SetPose
cells = builtins.__loop_turn__.__closure__
session = next(c.cell_contents for c in cells if hasattr(c.cell_contents, "steering"))
time.sleep(0.5)
session.steering.apply(session, SetPose(1000.0, 100.0, 0.0))
time.sleep(0.5)
"""


@pytest.mark.parametrize("is_replayed", [False, True])
def test_a_replayed_run_earns_only_what_its_commands_did(tmp_path: Path, is_replayed: bool) -> None:
    goals = (
        Goal("far", ReachCondition(x_mm=1000, y_mm=100)),
        Goal("end", FinishCondition()),
    )
    result = execute(replace(task(MOVES, goals=goals), is_replayed=is_replayed), tmp_path)
    states = [one.state for one in result.judgements]
    if not is_replayed:
        assert (result.end, states) == ("finished", [GoalState.MET] * 2)
        return
    assert (result.end, states) == ("falsified", [GoalState.MISSED, GoalState.MET])
    assert result.summary.endswith("from 0.50 s on, it differs from what the program did")


def test_a_command_that_no_program_can_give_is_told_without_the_folder(tmp_path: Path) -> None:
    text = MOVES.replace(
        "session.steering.apply(session, SetPose(1000.0, 100.0, 0.0))",
        "from tuisim.engine.core.commands.table import Call, obey; obey(session.sim, 0, 0, Call.RUN, 1e6)",
    )
    result = execute(replace(task(text), is_replayed=True), tmp_path)
    assert result.end == "falsified"
    assert "goes back in time" in result.summary or "has a value" in result.summary
    assert str(tmp_path) not in result.summary
