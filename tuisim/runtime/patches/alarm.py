"""Signals that the runtime simulates: alarms in simulated time, and the interrupt that a program sends to itself."""

from __future__ import annotations

import _thread
import errno
import operator
import os
import signal
import types
from collections.abc import Mapping
from sys import _getframe
from typing import Any

from tuisim.core.profile import NS_PER_S
from tuisim.errors import NotSimulated
from tuisim.runtime import wallclock
from tuisim.runtime.patches.replacement import replace
from tuisim.runtime.scheduler import FOREVER, ScheduledThread, Scheduler
from tuisim.runtime.session import Session


class Alarm:
    """The alarm of a program.

    The signal itself belongs to the runtime: the program's handler is only stored here, and a hidden thread
    waits for the time of the alarm.

    Args:
        session: The program's clock.
        scheduler: Calls the handler in the main thread.
    """

    def __init__(self, session: Session, scheduler: Scheduler) -> None:
        self._session = session
        self._scheduler = scheduler
        self._task: ScheduledThread | None = None
        self._due_ns = FOREVER
        self._interval_ns = 0
        self.handler: Any = int(signal.SIG_DFL)
        """The program's handler, or the number of a standard action."""

    def left_ns(self) -> tuple[int, int]:
        """Return the time until the alarm, 0 if there is none, and its interval."""
        left = 0 if self._due_ns == FOREVER else max(self._due_ns - self._session.now, 1)
        return left, self._interval_ns

    def set(self, after_ns: int, interval_ns: int) -> None:
        """Set the alarm; 0 cancels it."""
        self._due_ns = self._session.now + after_ns if after_ns else FOREVER
        self._interval_ns = interval_ns if after_ns else 0
        if self._task is not None:
            self._scheduler.wake(self._task)
        elif after_ns:
            self._task = self._scheduler.spawn(self._wait, daemon=True)

    def _wait(self) -> None:
        while True:
            if self._scheduler.wait(self._due_ns) or self._session.now < self._due_ns:
                # It has been set again.
                continue
            self._due_ns = self._due_ns + self._interval_ns if self._interval_ns else FOREVER
            if self.handler != signal.SIG_IGN:
                self._scheduler.interrupt_main(self._call)

    def _call(self) -> None:
        if self.handler == signal.SIG_DFL:
            wallclock.set_signal(signal.SIGALRM, self.handler)
            signal.raise_signal(signal.SIGALRM)
        self.handler(int(signal.SIGALRM), _program_frame(self._session))


class Interrupt:
    """The interrupt of a program, otherwise sent by a terminal: it reaches the main thread at a fixed instant.

    Args:
        session: Knows the program's lines.
        scheduler: Calls the handler in the main thread.
    """

    def __init__(self, session: Session, scheduler: Scheduler) -> None:
        self._session, self._scheduler = session, scheduler
        self.handler: Any = signal.default_int_handler
        """The program's handler, or the number of a standard action."""

    def send(self) -> None:
        """Call the handler at once in the main thread; otherwise as soon as that waits."""
        if self.handler in (signal.SIG_IGN, None):
            return
        if self._scheduler.current is self._scheduler.main:
            self._call()
        else:
            self._scheduler.interrupt_main(self._call)

    def _call(self) -> None:
        if self.handler == signal.SIG_DFL:
            wallclock.set_signal(signal.SIGINT, self.handler)
            wallclock.signals.raise_signal(signal.SIGINT)
        self.handler(int(signal.SIGINT), _program_frame(self._session))


def _program_frame(session: Session) -> types.FrameType | None:
    frame: types.FrameType | None = _getframe(1)
    while frame is not None and frame.f_code.co_filename != session.program_file:
        frame = frame.f_back
    return frame


def patch_signals(session: Session, scheduler: Scheduler) -> None:
    """Replace the functions of `signal`, `os` and `_thread` that have to do with alarms and interrupts."""
    alarm, interrupt = Alarm(session, scheduler), Interrupt(session, scheduler)
    _patch_alarm(alarm, scheduler)
    _patch_interrupt(interrupt)
    _patch_handlers({signal.SIGALRM: alarm, signal.SIGINT: interrupt})


def _patch_alarm(alarm: Alarm, scheduler: Scheduler) -> None:
    real_getitimer = signal.getitimer

    def set_alarm(seconds: Any) -> int:
        length = operator.index(seconds) % 2**32
        before, _ = alarm.left_ns()
        alarm.set(length * NS_PER_S, 0)
        # Whole seconds, and not 0 while an alarm is pending.
        return max(round(before / NS_PER_S), 1) if before else 0

    def getitimer(which: Any) -> tuple[float, float]:
        if which != signal.ITIMER_REAL:
            return real_getitimer(which)
        left, interval = alarm.left_ns()
        return left / NS_PER_S, interval / NS_PER_S

    def setitimer(which: Any, seconds: Any, interval: Any = 0.0) -> tuple[float, float]:
        before = getitimer(which)
        if which != signal.ITIMER_REAL:
            raise NotSimulated(
                "this timer is not part of the simulated brick", "use signal.ITIMER_REAL"
            )
        lengths = [round(float(length) * NS_PER_S) for length in (seconds, interval)]
        if min(lengths) < 0:
            raise signal.ItimerError(errno.EINVAL, os.strerror(errno.EINVAL))
        alarm.set(*lengths)
        return before

    replace(signal, "alarm", set_alarm, (1, 1))
    replace(signal, "setitimer", setitimer, (2, 3))
    replace(signal, "getitimer", getitimer, (1, 1))
    replace(signal, "pause", scheduler.pause, (0, 0))


def _patch_interrupt(interrupt: Interrupt) -> None:
    real_kill, real_raise, real_interrupt = (
        os.kill,
        wallclock.signals.raise_signal,
        _thread.interrupt_main,
    )

    def kill(pid: Any, number: Any) -> None:
        if number == signal.SIGINT and pid == wallclock.getpid():
            interrupt.send()
        else:
            real_kill(pid, number)

    def raise_signal(number: Any) -> None:
        if number == signal.SIGINT:
            interrupt.send()
        else:
            real_raise(number)

    def interrupt_main(number: Any = signal.SIGINT) -> None:
        if number == signal.SIGINT:
            interrupt.send()
        else:
            real_interrupt(number)

    replace(os, "kill", kill, (2, 2))
    replace(signal, "raise_signal", raise_signal, (1, 1))
    replace(_thread, "interrupt_main", interrupt_main, (0, 1))


def _patch_handlers(simulated: Mapping[int, Alarm | Interrupt]) -> None:
    real_signal, real_getsignal = wallclock.set_signal, wallclock.signals.getsignal

    def set_handler(number: Any, handler: Any) -> Any:
        before = real_signal(number, handler)
        if number not in simulated:
            return before
        # The handler was valid for the signal, which the runtime itself uses.
        real_signal(number, before)
        one = simulated[number]
        before, one.handler = one.handler, handler
        return before

    def handler_of(number: Any) -> Any:
        return simulated[number].handler if number in simulated else real_getsignal(number)

    # Those of `signal` call them, and convert numbers to enum members and back.
    replace(wallclock.signals, "signal", set_handler, (2, 2))
    replace(wallclock.signals, "getsignal", handler_of, (1, 1))
