"""Continues what a program has stopped: `python supervisor.py PID` watches a process and all that it has started.

A program that is not isolated can send SIGSTOP to the processes that wait for it, which then wait for ever. The
supervisor is a process of its own, so that its clock goes on. It ends with the process that it watches. It imports
nothing of the package: it starts in milliseconds.

Its standard input tells it that the user has suspended the watched process (`s`), and that it goes on (`c`).
"""

from __future__ import annotations

import os
import select
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

LOOK_EVERY_S = 0.5
STOPPED = "T"


def list_processes() -> dict[int, tuple[int, str]]:
    """Return the parent's id and the state of each process of this machine, by process id."""
    states = {}
    for name in os.listdir("/proc"):
        if name.isdigit():
            try:
                with open(f"/proc/{name}/stat", "rb") as file:
                    # The process name in parentheses may contain any characters, so the last parenthesis ends it.
                    state, parent = file.read().rpartition(b")")[2].split()[:2]
            except (OSError, ValueError):
                continue
            states[int(name)] = int(parent), state.decode("latin-1")
    return states


def walk_processes(root: int, known: dict[int, tuple[int, str]]) -> Iterator[int]:
    """Yield the ids of a process and of all its descendants.

    Args:
        root: Id of the process.
        known: All processes, from `list_processes`.
    """
    children: dict[int, list[int]] = {}
    for pid, (parent, _) in known.items():
        children.setdefault(parent, []).append(pid)
    pending = [root] if root in known else []
    while pending:
        pid = pending.pop()
        yield pid
        pending += children.get(pid, [])


def continue_stopped(root: int, before: set[int]) -> set[int]:
    """Continue (SIGCONT) the processes that are stopped now and were stopped at the previous call of this function.

    Args:
        root: Only this process and its descendants are continued.
        before: The result of the previous call.

    Returns:
        The ids of the processes that are stopped now.
    """
    known = list_processes()
    stopped = {
        pid
        for pid in walk_processes(root, known)
        if known[pid][1] == STOPPED and pid != os.getpid()
    }
    for pid in stopped & before:
        try:
            os.kill(pid, signal.SIGCONT)
        except OSError:
            continue
    return stopped


def supervise(root: int) -> None:
    """Continue a process and its descendants whenever a program stops them, until stdin is closed. This blocks."""
    stopped: set[int] = set()
    is_suspended = False
    while True:
        if select.select([sys.stdin], [], [], LOOK_EVERY_S)[0]:
            command = os.read(sys.stdin.fileno(), 1)
            if not command:
                return
            is_suspended = command == b"s"
        stopped = set() if is_suspended else continue_stopped(root, stopped)


@contextmanager
def keep_running() -> Iterator[None]:
    """In a `with` block, continue this process and its descendants whenever a program stops them.

    Without `/proc` nothing is continued.

    Raises:
        HostError: the supervisor cannot be started.
    """
    if not os.path.isdir("/proc/self"):
        yield
        return
    # Imported on demand: the supervisor process itself does not need it.
    import subprocess

    command = [sys.executable, "-I", "-S", __file__, str(os.getpid())]
    try:
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
        )
    except OSError as error:
        from tuisim.base.errors import HostError

        raise HostError(
            f"the process that supervises programs cannot be started: {error.strerror or error}"
        ) from error
    with process:
        assert process.stdin is not None
        fd = process.stdin.fileno()

        def suspend(number: int, frame: FrameType | None) -> None:
            # The user suspends this process: the supervisor must not continue it.
            with suppress(OSError):
                os.write(fd, b"s")
            os.kill(os.getpid(), signal.SIGSTOP)
            with suppress(OSError):
                os.write(fd, b"c")

        before = signal.signal(signal.SIGTSTP, suspend)
        try:
            yield
        finally:
            signal.signal(signal.SIGTSTP, before)


if __name__ == "__main__":
    supervise(int(sys.argv[1]))
