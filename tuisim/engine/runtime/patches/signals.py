"""Signals of a program: the interrupt that it sends to itself, in simulated time; alarms are refused."""

from __future__ import annotations

import _thread
import os
import signal
import types
from sys import _getframe
from typing import Any, NoReturn

from tuisim.base.errors import NotSimulated
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.scheduler import Scheduler
from tuisim.engine.runtime.session import Session

ALARMS = ("alarm", "setitimer", "getitimer")


class Interrupt:
    """The interrupt (SIGINT) that a program sends to itself, such as with `os.kill`.

    Its handler is called in the main thread, at an instant that is the same in every run. The real signal is not used,
    so the program's handler is only stored here.

    Args:
        session: Knows the program's lines.
        scheduler: Calls the handler in the main thread.
    """

    def __init__(self, session: Session, scheduler: Scheduler) -> None:
        self._session = session
        self._scheduler = scheduler
        self.handler: Any = signal.default_int_handler
        """The program's handler, or the number of a standard action."""

    def send(self) -> None:
        """Call the handler: immediately in the main thread, or from another thread when the main thread next waits."""
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
        self.handler(int(signal.SIGINT), self._find_program_frame())

    def _find_program_frame(self) -> types.FrameType | None:
        frame: types.FrameType | None = _getframe(1)
        while frame is not None and frame.f_code.co_filename != self._session.program_file:
            frame = frame.f_back
        return frame


def patch_signals(session: Session, scheduler: Scheduler) -> None:
    """Replace the functions of `signal`, `os` and `_thread` that send interrupts, handle signals or set alarms."""
    interrupt = Interrupt(session, scheduler)
    for name in ALARMS:
        replace(signal, name, lambda *_: _refuse_alarm())
    replace(signal, "pause", scheduler.pause, (0, 0))
    _patch_sending(interrupt)
    _patch_handlers(interrupt)


def _refuse_alarm() -> NoReturn:
    raise NotSimulated(
        "an alarm is not part of the simulated brick",
        "use threading.Timer, or compare time.time() in the loop",
    )


def _patch_sending(interrupt: Interrupt) -> None:
    def divert(module: types.ModuleType, name: str, takes: tuple[int, int], is_ours: Any) -> None:
        """Replace a function by one that sends the interrupt where `is_ours` is true of its arguments."""
        real = getattr(module, name)
        replace(
            module,
            name,
            lambda *given: interrupt.send() if is_ours(*given) else real(*given),
            takes,
        )

    divert(
        os,
        "kill",
        (2, 2),
        lambda pid, number: number == signal.SIGINT and pid == wallclock.getpid(),
    )
    divert(signal, "raise_signal", (1, 1), lambda number: number == signal.SIGINT)
    divert(_thread, "interrupt_main", (0, 1), lambda number=signal.SIGINT: number == signal.SIGINT)


def _patch_handlers(interrupt: Interrupt) -> None:
    real_signal, real_getsignal = wallclock.set_signal, wallclock.signals.getsignal

    def set_handler(number: Any, handler: Any) -> Any:
        if number == signal.SIGALRM:
            _refuse_alarm()
        before = real_signal(number, handler)
        if number != signal.SIGINT:
            return before
        # The real function has checked the handler. The signal goes back to the runtime, which uses it itself.
        real_signal(number, before)
        before = interrupt.handler
        interrupt.handler = handler
        return before

    def get_handler(number: Any) -> Any:
        return interrupt.handler if number == signal.SIGINT else real_getsignal(number)

    # The functions of `signal` call these, and convert numbers to enum members and back.
    replace(wallclock.signals, "signal", set_handler, (2, 2))
    replace(wallclock.signals, "getsignal", get_handler, (1, 1))
