"""The warm process: forked children are as those that were started by themselves."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from tests.running import Start, over, until_tick
from tuisim.base.source import Program
from tuisim.engine.runs.child import process
from tuisim.engine.runs.child import warm as process_warm
from tuisim.engine.runs.child.warm import ForkedChild, WarmProcess
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

pytestmark = pytest.mark.usefixtures("real_forks")


def printed(text: str, of_many: bool = False, prelude: str = "none") -> list[str]:
    spec = build_run_spec(Settings({"seed": 3, "noise.light": 10}))
    store = RunStore()
    program = Program("p.py", text, prelude=prelude)
    handle = RunHandle(program, spec, field_files(spec), RunOptions(), store, of_many=of_many)
    over(handle)
    assert handle.ended is not None
    assert handle.ended.end == "finished", handle.ended.error
    return [row.text for row in handle.output.read_all_rows()]


def _start(text: str = "import time\ntime.sleep(1e6)\n") -> RunHandle:
    return start_run(
        Program("p.py", text), build_run_spec(Settings()), RunOptions(live=True, speed=1.0)
    )


@pytest.fixture
def warm(monkeypatch: pytest.MonkeyPatch) -> Iterator[WarmProcess]:
    """A warm process that the test may end."""
    monkeypatch.setattr(process._Starts, "warm", None)
    process.start_warm_process()
    mine = process._Starts.warm
    assert mine is not None
    yield mine
    process.end_warm_process()


def test_a_script_that_has_started_the_warm_process_leaves_nothing_open() -> None:
    code = (
        "from tuisim.engine.runs.child import process\n"
        "process.start_warm_process()\n"
        "print(process._Starts.warm._process.pid)\n"
    )
    ended = subprocess.run(
        [sys.executable, "-X", "dev", "-c", code], capture_output=True, text=True, check=True
    )
    assert ended.stderr == ""
    with pytest.raises(ProcessLookupError):
        os.kill(int(ended.stdout), 0)


def test_without_its_warm_process_a_run_is_started_by_itself(warm: WarmProcess) -> None:
    os.kill(warm._process.pid, signal.SIGKILL)
    warm._process.wait()
    assert printed("print('on')") == ["on"]


def test_a_run_whose_warm_process_was_killed_is_not_left_behind(warm: WarmProcess) -> None:
    with closing(_start()) as handle:
        until_tick(handle, 1)
        assert isinstance(handle._process, ForkedChild)
        os.kill(warm._process.pid, signal.SIGKILL)
        over(handle)
    assert handle.ended is not None
    assert handle.ended.end == "crashed"


def _parent(handle: RunHandle) -> int:
    return int(Path(f"/proc/{handle._process.pid}/stat").read_text().rpartition(")")[2].split()[1])


def test_a_run_is_forked_from_the_process_that_an_earlier_one_has_prepared(
    warm: WarmProcess,
) -> None:
    with closing(_start()) as first:
        first.prepare_next()
        until_tick(first, 1)
        with closing(_start()) as second:
            until_tick(second, 1)
            (template,) = process._Starts.templates.values()

            assert (_parent(first), _parent(second)) == (warm._process.pid, template._process.pid)


SLOW = "import os, time; lead = os.setsid; os.setsid = lambda: (time.sleep(0.2), lead()); "


@pytest.mark.usefixtures("warm")
def test_a_child_that_was_just_forked_can_be_killed_with_its_group(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process.end_warm_process()
    monkeypatch.setattr(process, "BOOT", SLOW + process.BOOT)
    process.start_warm_process()
    handle = _start()
    leads = os.getpgid(handle._process.pid) == handle._process.pid
    handle._process.send_signal(signal.SIGKILL)
    handle.close()
    assert leads


@pytest.mark.slow
def test_a_process_that_was_forked_does_not_use_the_warm_process_of_the_other(
    warm: WarmProcess,
) -> None:
    pid = os.fork()
    if not pid:
        os._exit(7 if warm.is_usable else 0)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0


def test_the_signal_that_killed_a_forked_run_is_known(warm: WarmProcess) -> None:
    with closing(_start()) as handle:
        until_tick(handle, 1)
        os.kill(handle._process.pid, signal.SIGSEGV)
        ended = over(handle).ended
    assert (ended.end, handle._process.returncode) == ("crashed", -signal.SIGSEGV)


@pytest.mark.slow
def test_the_warm_process_ends_with_its_host(warm: WarmProcess) -> None:
    warm.close()
    assert warm._process.returncode == 0


@pytest.mark.slow
@pytest.mark.parametrize("harm", ["SIGSTOP", "SIGKILL"])
def test_a_program_that_harms_its_parent_does_not_keep_the_next_one_from_running(
    start: Start, monkeypatch: pytest.MonkeyPatch, harm: str
) -> None:
    monkeypatch.setattr(process_warm, "ANSWER_S", 0.5)
    over(start("print('A: 1')"))
    over(start(f"import os, signal\nos.kill(os.getppid(), signal.{harm})"))
    assert over(start("print('A: 1')")).lines == ["A: 1"]


@pytest.mark.parametrize(
    "text", ["print(1)", "1 / 0", "import os; os._exit(3)", "while True: pass"]
)
def test_runs_that_are_over_leave_no_descriptor_open(text: str) -> None:
    def one_run() -> None:
        handle = _start(text)
        if "while" in text:
            handle.stop()
        over(handle)
        _ = handle.stored().telemetry.array(), handle.output.read_all_rows()

    one_run()
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(4):
        one_run()
    assert len(os.listdir("/proc/self/fd")) == before
