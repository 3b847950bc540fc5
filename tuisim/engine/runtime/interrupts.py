"""Signal handlers: a command has arrived, a stop must be repeated, an instant takes too long.

A handler may raise only in the program's own code. Inside the runtime it only sets a
bit, so that core code is never unwound halfway; the frames show whose code is running.
"""

from __future__ import annotations

import faulthandler
import fcntl
import os
import signal
import types
from pathlib import Path

from tuisim.base.atomic import private
from tuisim.engine.protocol import COMMAND_SIGNAL, STACK_SIGNAL, End
from tuisim.engine.runs.side_files import STACK_FILE
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.control import ATTENTION
from tuisim.engine.runtime.session import Session
from tuisim.engine.runtime.stack import PACKAGE_FOLDER

RAISE_AGAIN_AFTER_S, RAISE_AGAIN_EVERY_S = 0.2, 0.02
LEFT_TO_OTHERS_S = 0.1
"""Real time that a thread has to take a command before the main thread, which waits for its turn, does."""
STALL_LOOK_S = 1.0

# Saved: the program's `faulthandler` gets other functions.
_enable = faulthandler.enable
_register = faulthandler.register


def die_with_host(lifeline_fd: int) -> None:
    """Make the kernel kill this process and its group when the host ends, even inside a long C call.

    Args:
        lifeline_fd: Read end of a pipe that nothing is ever written to. When the host
            ends, the pipe closes and the kernel sends SIGIO, whose default action is to kill.
    """
    fcntl.fcntl(lifeline_fd, fcntl.F_SETOWN, -os.getpgrp())
    fcntl.fcntl(lifeline_fd, fcntl.F_SETFL, fcntl.fcntl(lifeline_fd, fcntl.F_GETFL) | os.O_ASYNC)
    if wallclock.select_files([lifeline_fd], [], [], 0)[0]:
        # The host ended before the signal was requested.
        wallclock.exit_process(1)


class Interrupts:
    """Signal handlers of one run.

    Args:
        session: The run.
        soft_codes: Code objects of the runtime in which a handler may raise, unlike in the rest of the runtime.
    """

    def __init__(self, session: Session, soft_codes: frozenset[types.CodeType]) -> None:
        self._session = session
        self._soft_codes = soft_codes
        self._timer_on = False
        self._removed = False
        self.main_is_parked = False
        """Whether the main thread waits for its turn, where raising is harmless."""
        self._stall_now, self._stall_s = -1, 0.0

    def install(self, folder: Path) -> None:
        """Install the handlers.

        Args:
            folder: Run folder; a signal writes the stack there, even inside a long C call.
        """
        stack_fd = private(f"{folder}{os.sep}{STACK_FILE}", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        # Crashes such as SIGSEGV are written there, too.
        _enable(stack_fd, all_threads=False)
        _register(STACK_SIGNAL, file=stack_fd, all_threads=False)
        signal.signal(COMMAND_SIGNAL, self._on_command)
        wallclock.set_signal(signal.SIGALRM, self._on_alarm)
        # The interrupt of the terminal is for the host; the program's own is simulated.
        wallclock.set_signal(signal.SIGINT, int(signal.SIG_IGN))
        if self._session.limits.stall_s:
            signal.signal(signal.SIGVTALRM, self._on_stall)
            wallclock.set_timer(signal.ITIMER_VIRTUAL, STALL_LOOK_S, STALL_LOOK_S)

    def remove(self) -> None:
        """Disarm the handlers when the program is over. Any thread may do so; only the main one could remove them."""
        self._removed = True
        wallclock.set_timer(signal.ITIMER_REAL, 0.0)
        wallclock.set_timer(signal.ITIMER_VIRTUAL, 0.0)

    def _on_command(self, _number: int, frame: types.FrameType | None) -> None:
        session = self._session
        if self._removed:
            return
        session.flags |= ATTENTION
        if session.steering.holding:
            # The run waits for commands, maybe in another thread, which reads them from the pipe itself.
            return
        if self.main_is_parked:
            # The thread whose turn it is takes the command in its turn, unless it computes without end.
            if not self._timer_on:
                wallclock.set_timer(signal.ITIMER_REAL, LEFT_TO_OTHERS_S)
        elif self._can_raise(frame):
            self._check_stop()

    def _on_alarm(self, _number: int, frame: types.FrameType | None) -> None:
        session = self._session
        if self._removed or session.steering.holding:
            return
        session.flags |= ATTENTION
        if self._can_raise(frame):
            self._check_stop()

    def _check_stop(self) -> None:
        try:
            self._session.check_stop()
        finally:
            self._raise_again_later()

    def _raise_again_later(self) -> None:
        # A program that catches the stop gets it again and again, until the host kills it.
        if self._session.stop_reason is not None and not self._timer_on:
            self._timer_on = True
            wallclock.set_timer(signal.ITIMER_REAL, RAISE_AGAIN_AFTER_S, RAISE_AGAIN_EVERY_S)

    def _on_stall(self, _number: int, frame: types.FrameType | None) -> None:
        session = self._session
        if self._removed:
            return
        if session.now != self._stall_now:
            self._stall_now, self._stall_s = session.now, 0.0
            return
        self._stall_s += STALL_LOOK_S
        if self._stall_s < session.limits.stall_s:
            return
        line = session.program_line()
        summary = f"no simulated time passed in {self._stall_s:g} s of computing, in line {line}"
        session.ask_stop(End.STALLED, summary, line)
        if self._can_raise(frame):
            self._raise_again_later()
            session.check_stop()

    def _can_raise(self, frame: types.FrameType | None) -> bool:
        """Return whether a handler may raise: in code of the program or of a library that it called, or in a wait."""
        if self.main_is_parked or (frame is not None and frame.f_code in self._soft_codes):
            return True
        while frame is not None:
            file = frame.f_code.co_filename
            if file == self._session.program_file:
                return True
            if file.startswith(PACKAGE_FOLDER):
                return False
            frame = frame.f_back
        return False
