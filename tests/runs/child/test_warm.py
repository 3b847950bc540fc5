"""The warm process: forked children are as those that were started by themselves."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from tests.running import Start, over, until_tick
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.runs.child import process
from tuisim.runs.child import warm as process_warm
from tuisim.runs.child.warm import ForkedChild, WarmProcess
from tuisim.runs.handle import RunHandle, RunOptions, start_run
from tuisim.runs.run_folder import field_files
from tuisim.runs.store import RunStore
from tuisim.source import Program

SURROUNDINGS = {
    "modules": "print(sorted(sys.modules))",
    "environment": "print(sorted(os.environ.items()))",
    # Another test may replace a file of the cache, which is then "(deleted)".
    "files": "print(sorted(os.path.basename(os.path.realpath(f'/proc/self/fd/{fd}')).partition(':')[0]"
    ".partition(' ')[0] for fd in os.listdir('/proc/self/fd') if os.path.exists(f'/proc/self/fd/{fd}')))",
    "limits": "print([resource.getrlimit(getattr(resource, n)) for n in dir(resource) if n.startswith('RLIMIT')])",
    "random": "print(random.random(), os.urandom(4), hash('a'), uuid.uuid4())",
    "interpreter": "print(sys.flags, sys.path, list(map(type, sys.meta_path)), gc.get_threshold(), gc.isenabled())",
    "signals": "print([(n, type(signal.getsignal(n))) for n in range(1, 32)], signal.pthread_sigmask(0, []))",
    "session": "print(os.getcwd(), os.getsid(0) == os.getpid(), os.getpgrp() == os.getpid(), os.umask(0o77))",
    "threads": "print(threading.active_count(), _thread._count(), os.listdir('/proc/self/task') == [str(os.getpid())])",
    "times": "print(time.time(), time.process_time(), datetime.datetime.now())",
}
IMPORTS = "import datetime, gc, os, random, resource, signal, sys, threading, time, uuid, _thread\n"


def _printed(text: str, of_many: bool = False, prelude: str = "none") -> list[str]:
    spec, store = build_run_spec(Settings({"seed": 3, "noise.light": 10})), RunStore()
    program = Program("p.py", text, prelude=prelude)
    handle = RunHandle(program, spec, field_files(spec), RunOptions(), store, of_many=of_many)
    over(handle)
    assert handle.ended is not None
    assert handle.ended.end == "finished", handle.ended.error
    return [row.text for row in handle.output.all_rows()]


@pytest.mark.quick_cases("modules-preloaded", "environment-preloaded", "random-preloaded")
@pytest.mark.parametrize("prelude", ["none", "preloaded"])
@pytest.mark.parametrize("name", SURROUNDINGS)
def test_a_program_cannot_tell_how_it_was_started(name: str, prelude: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # The kept one may be older than a limit of this process.
    process.cool_down()
    text = (IMPORTS if name != "modules" else "import os, sys\n") + SURROUNDINGS[name]
    _printed("print('prepares the template')", True, prelude)
    forked = _printed(text, False, prelude), _printed(text, True, prelude)
    monkeypatch.setattr(process, "_fork", lambda *_: None)
    alone = _printed(text, False, prelude)
    assert forked == (alone, alone)


def _start(text: str = "import time\ntime.sleep(1e6)\n") -> RunHandle:
    return start_run(Program("p.py", text), build_run_spec(Settings()), RunOptions(live=True, speed=1.0))


@pytest.fixture
def warm(monkeypatch: pytest.MonkeyPatch) -> Iterator[WarmProcess]:
    """A warm process that the test may end."""
    monkeypatch.setattr(process._Starts, "warm", None)
    process.warm_up()
    mine = process._Starts.warm
    assert mine is not None
    yield mine
    process.cool_down()


def test_without_its_warm_process_a_run_is_started_by_itself(warm: WarmProcess) -> None:
    os.kill(warm._process.pid, signal.SIGKILL)
    warm._process.wait()
    assert _printed("print('on')") == ["on"]


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


def test_a_run_is_forked_from_the_process_that_an_earlier_one_has_prepared(warm: WarmProcess) -> None:
    with closing(_start()) as first:
        first.prepare_next()
        until_tick(first, 1)
        with closing(_start()) as second:
            until_tick(second, 1)
            (template,) = process._Starts.templates.values()

            assert (_parent(first), _parent(second)) == (warm._process.pid, template._process.pid)


SLOW = "import os, time; lead = os.setsid; os.setsid = lambda: (time.sleep(0.2), lead()); "


@pytest.mark.usefixtures("warm")
def test_a_child_that_was_just_forked_can_be_killed_with_its_group(monkeypatch: pytest.MonkeyPatch) -> None:
    process.cool_down()
    monkeypatch.setattr(process, "BOOT", SLOW + process.BOOT)
    process.warm_up()
    handle = _start()
    leads = os.getpgid(handle._process.pid) == handle._process.pid
    handle._process.send_signal(signal.SIGKILL)
    handle.close()
    assert leads


@pytest.mark.slow
def test_a_process_that_was_forked_does_not_use_the_warm_process_of_the_other(warm: WarmProcess) -> None:
    pid = os.fork()
    if not pid:
        os._exit(7 if warm.is_usable else 0)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0


def test_how_a_child_ends_is_known(warm: WarmProcess) -> None:
    with closing(_start()) as handle:
        until_tick(handle, 1)
        os.kill(handle._process.pid, signal.SIGSEGV)
        ended = over(handle).ended
    assert (ended.end, handle._process.returncode) == ("crashed", -signal.SIGSEGV)


def test_the_warm_process_ends_with_its_host(warm: WarmProcess) -> None:
    warm.close()
    assert warm._process.returncode == 0


@pytest.mark.parametrize("harm", ["SIGSTOP", "SIGKILL"])
def test_a_program_that_harms_its_parent_does_not_keep_the_next_one_from_running(
    start: Start, monkeypatch: pytest.MonkeyPatch, harm: str
) -> None:
    monkeypatch.setattr(process_warm, "ANSWER_S", 0.5)
    over(start("print('A: 1')"))
    over(start(f"import os, signal\nos.kill(os.getppid(), signal.{harm})"))
    assert over(start("print('A: 1')")).lines == ["A: 1"]


@pytest.mark.usefixtures("real_mats", "home")
def test_a_template_does_not_keep_a_damaged_mat() -> None:
    text = "print(colorLeft.reflected_light_intensity_pc)"
    (seen,) = _printed(text, True, "preloaded")
    files = field_files(build_run_spec(Settings({"seed": 3, "noise.light": 10})))
    for path in (files.pixels, *(path for _, path in files.sums)):
        # In place: the template has mapped it.
        with path.open("r+b") as stream:
            stream.write(bytes(path.stat().st_size))
    assert _printed(text, True, "preloaded") == [seen]
    assert float(seen) > 0


@pytest.mark.parametrize("text", ["print(1)", "1 / 0", "import os; os._exit(3)", "while True: pass"])
def test_runs_that_are_over_leave_no_descriptor_open(text: str) -> None:
    def one_run() -> None:
        handle = _start(text)
        if "while" in text:
            handle.stop()
        over(handle)
        _ = handle.stored().telemetry.array(), handle.output.all_rows()

    one_run()
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(4):
        one_run()
    assert len(os.listdir("/proc/self/fd")) == before
