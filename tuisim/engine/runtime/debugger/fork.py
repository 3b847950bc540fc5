"""Runs a function in a forked copy of the process, so that it has no side effects.

A `__repr__`, property or comparison of the program may loop, print, change state or use up
memory: that happens only in the copy, which is discarded.
"""

from __future__ import annotations

import builtins
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

from tuisim.engine.protocol import COMMAND_SIGNAL, STACK_SIGNAL
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.channel import Channel
from tuisim.engine.runtime.loader import LOOP_HOOK
from tuisim.engine.runtime.raw_output import silence_descriptors
from tuisim.engine.runtime.scheduler import Scheduler
from tuisim.engine.runtime.session import Session

MAX_BYTES = 4 << 20
"""Largest size of an answer of the copy: a longer one is discarded."""
BLOCKED_LIMIT_S = 2.0
"""Real seconds after which a copy that uses no CPU time is killed, for instance when it waits for a lock."""


class TooLong(BaseException):
    """Raised when evaluating a value takes too long.

    It is not an `Exception`, so that no `except Exception` of the program catches it.
    """


def run_apart(
    session: Session,
    scheduler: Scheduler,
    work: Callable[[], bytes],
    limit_s: float,
    go_on: Callable[[], bool],
) -> bytes | None:
    """Call a function in a copy of this process, and return its result.

    Args:
        session: The run, frozen in the copy.
        scheduler: The program's threads.
        work: The function to call in the copy.
        limit_s: CPU seconds after which the copy is killed. As real time does not count, a slow machine changes no
            result.
        go_on: Called when a command has arrived; returns whether to continue to wait for the result.

    Returns:
        The result; None if it did not come in time.
    """
    try:
        answer_fd, answer_write = os.pipe()
    except OSError:
        # The program has no file descriptors left.
        return None
    try:
        pid = wallclock.fork()
    except OSError:
        # The machine has no processes left.
        os.close(answer_fd)
        os.close(answer_write)
        return None
    if not pid:
        _run_copy(session, scheduler, work, answer_write, limit_s)
    os.close(answer_write)
    try:
        return _answer(session.channel, answer_fd, wallclock.monotonic() + BLOCKED_LIMIT_S, go_on)
    finally:
        os.close(answer_fd)
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)


def _answer(channel: Channel, fd: int, until_s: float, go_on: Callable[[], bool]) -> bytes | None:
    data = b""
    while (rest_s := until_s - wallclock.monotonic()) > 0:
        ready = wallclock.select_files([fd, channel.command_fd], [], [], rest_s)[0]
        if channel.command_fd in ready and not go_on():
            return None
        if fd in ready:
            chunk = os.read(fd, 1 << 16)
            if not chunk:
                return data or None
            data += chunk
            if len(data) > MAX_BYTES:
                return None
    return None


def _run_copy(
    session: Session,
    scheduler: Scheduler,
    work: Callable[[], bytes],
    answer_fd: int,
    limit_s: float,
) -> NoReturn:
    try:
        # These timers end the copy in any case, even during a long call of C code.
        for number, timer, seconds in (
            (signal.SIGPROF, signal.ITIMER_PROF, limit_s),
            (signal.SIGALRM, signal.ITIMER_REAL, 2 * BLOCKED_LIMIT_S),
        ):
            wallclock.set_signal(number, int(signal.SIG_DFL))
            wallclock.set_timer(timer, seconds)
        wallclock.settrace(None)
        _freeze(session, scheduler)
        data = work()
        while data:
            data = data[os.write(answer_fd, data) :]
    except BaseException:  # the parent handles a missing answer
        pass
    finally:
        wallclock.exit_process(0)


def _freeze(session: Session, scheduler: Scheduler) -> None:
    """Disable everything in the copy that lets time pass, moves motors or writes; reading takes no time there."""
    frozen: Any = session
    threads: Any = scheduler
    session.free = 1
    for name in ("spend", "advance", "command", "wait_for_motor", "speak", "show", "_pass"):
        setattr(frozen, name, _refuse)
    for name in ("wait", "give_way", "spawn"):
        setattr(threads, name, _refuse)
    setattr(builtins, LOOP_HOOK, lambda: None)
    frozen.note_reading = lambda *_: None
    silent: Any = session.output
    silent.row = lambda *_: None
    silent.after_write = lambda: None
    silent.drain = lambda: None
    silence_descriptors()
    for number in (COMMAND_SIGNAL, STACK_SIGNAL, signal.SIGVTALRM):
        signal.signal(number, signal.SIG_IGN)


def _refuse(*_args: object, **_kwargs: object) -> NoReturn:
    raise RuntimeError(
        "the program is paused: no time can pass and nothing can move while it is inspected"
    )


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Return a context in whose body `TooLong` is raised after `seconds` of CPU time, and then repeatedly.

    It may only be used in a copy of the process.
    """

    def raise_too_long(_number: int, _frame: object) -> None:
        raise TooLong

    signal.signal(signal.SIGVTALRM, raise_too_long)
    wallclock.set_timer(signal.ITIMER_VIRTUAL, seconds, seconds / 10)
    try:
        yield
    finally:
        wallclock.set_timer(signal.ITIMER_VIRTUAL, 0.0)
