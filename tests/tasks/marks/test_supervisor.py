"""What a program has stopped is continued by a process that it has not stopped."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable

import pytest

from tests.running import PATIENCE_S
from tuisim.base.errors import HostError
from tuisim.tasks.marks import supervisor

STOPPED_CHILD = """
import subprocess, sys
with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]):
    print("started", flush=True)
"""


def _until(is_true: Callable[[], bool]) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while not is_true():
        assert time.monotonic() < give_up
        time.sleep(0.01)


def test_the_supervisor_resumes_processes_found_stopped_twice() -> None:
    command = [sys.executable, "-c", STOPPED_CHILD]
    with subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True) as parent:
        try:
            # Before that its parent waits for the child's new program, and cannot be stopped.
            assert parent.stdout is not None and parent.stdout.readline() == b"started\n"
            every = set(supervisor.walk_processes(parent.pid, supervisor.list_processes()))
            assert len(every) == 2
            for pid in every:
                os.kill(pid, signal.SIGSTOP)
            _until(
                lambda: (
                    {supervisor.list_processes()[pid][1] for pid in every} == {supervisor.STOPPED}
                )
            )
            first = supervisor.continue_stopped(parent.pid, set())
            assert first == every
            supervisor.continue_stopped(parent.pid, first)
            _until(
                lambda: (
                    supervisor.STOPPED not in {supervisor.list_processes()[pid][1] for pid in every}
                )
            )
        finally:
            os.killpg(parent.pid, signal.SIGKILL)


SUPERVISED = """
import os, signal
from tuisim.tasks.marks.supervisor import keep_running
with keep_running():
    os.kill(os.getpid(), signal.SIGSTOP)
    print("goes on")
"""


def test_a_marking_stopped_by_a_program_is_resumed_and_leaves_no_supervisor() -> None:
    done = subprocess.run(
        [sys.executable, "-c", SUPERVISED], capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert (done.stdout, done.stderr, done.returncode) == ("goes on\n", "", 0)


SUSPENDED = """
import os, signal, sys
from tuisim.tasks.marks.supervisor import LOOK_EVERY_S, keep_running
with keep_running():
    print("ready", flush=True)
    os.kill(os.getpid(), signal.SIGTSTP)
    print("goes on", flush=True)
"""


def test_a_marking_that_the_user_suspends_stays_suspended() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", SUSPENDED], stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == b"ready\n"
            _until(lambda: supervisor.list_processes()[process.pid][1] == supervisor.STOPPED)
            # Its supervisor looks twice before it would continue it.
            looks = [supervisor.continue_stopped(process.pid, set()) for _ in range(2)]
            assert looks[1] == {process.pid}
            os.kill(process.pid, signal.SIGCONT)
            assert process.stdout.read() == b"goes on\n"
        finally:
            os.killpg(process.pid, signal.SIGKILL)


def test_marking_says_so_if_the_supervisor_cannot_be_started(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*words: object, **more: object) -> None:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    monkeypatch.setattr(subprocess, "Popen", refuse)
    with (
        pytest.raises(HostError, match="cannot be started: Too many open files"),
        supervisor.keep_running(),
    ):
        pass
