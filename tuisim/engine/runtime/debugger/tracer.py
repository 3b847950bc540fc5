"""Counts the program's lines and finds those at which it has to pause.

Trace functions are installed only while they are needed: otherwise a program runs as if
there were no debugger. Only code in the program's own files gets line events.
"""

from __future__ import annotations

import os
import types
from collections import deque
from collections.abc import Callable
from sys import _getframe
from typing import Any

from tuisim.engine.protocol import UNKNOWN_ORDINAL, ExecutedLine
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.modules import OWN_FILES
from tuisim.engine.runtime.scheduler import ScheduledThread, Scheduler
from tuisim.engine.runtime.session import Session
from tuisim.engine.runtime.tracebacks import own_files

HISTORY_LINES = 2000

LineCheck = Callable[[types.FrameType, int], None]


class Tracer:
    """The trace functions of one run, which count the program's lines and check some of them.

    Args:
        session: The run.
        scheduler: Knows the current thread, and calls back when a thread starts to run.
        check: Called for the lines whose numbers are in `lines`, or for every line while `closely` is True; may pause
            the run.
    """

    def __init__(self, session: Session, scheduler: Scheduler, check: LineCheck) -> None:
        self._session = session
        self._scheduler = scheduler
        self._check = check
        self._sim = session.sim
        self._own = own_files(session.program_file)
        self._own_by_file: dict[str, bool] = {}
        self.on = False
        self.closely = False
        """Whether every line is checked."""
        self.lines: frozenset[int] = frozenset()
        """Lines that are always checked."""
        self._tick = -1
        self._ordinal = 0
        self._uncounted_tick = -1
        """The tick in which counting of lines started too late, so that its lines have no ordinals; -1 for none."""
        self._frame_id = 0
        self._depth = 0
        self._met: deque[tuple[int, int, int, ScheduledThread, int]] = deque(maxlen=HISTORY_LINES)
        scheduler.entered = self.enter

    # On and off

    def switch(self, on: bool, at_tick: bool) -> None:
        """Switch tracing on or off.

        Args:
            on: Whether to trace.
            at_tick: Whether a tick has just been run or is about to run, so that lines can be counted from its start.
        """
        if on == self.on:
            return
        self.on = on
        self._frame_id = 0
        if on:
            self._tick = self._session.sim.tick
            self._ordinal = 0
            self._uncounted_tick = -1 if at_tick else self._tick
        self.enter()

    def enter(self) -> None:
        """Switch tracing on or off in the thread that starts to run."""
        trace_function = wallclock.gettrace()
        if trace_function is not None and getattr(trace_function, "__self__", None) is not self:
            # The program has its own trace function, which stays.
            return
        self._frame_id = 0
        if not self.on:
            if trace_function is not None:
                wallclock.settrace(None)
            return
        frame: types.FrameType | None = _getframe(1)
        while frame is not None:
            if self.is_own(frame):
                frame.f_trace = self._on_event
            frame = frame.f_back
        if trace_function is None:
            wallclock.settrace(self._on_call)

    def is_own(self, frame: types.FrameType) -> bool:
        """Return whether a frame belongs to the program's own files."""
        file = frame.f_code.co_filename
        own = self._own_by_file.get(file)
        if own is None:
            # Generated code may claim any file; lines that the user cannot see are not shown.
            seen = file == self._session.program_file or file in OWN_FILES
            own = seen or (self._own(file) and os.path.isfile(file))
            self._own_by_file[file] = own
        return own

    # Events

    def _on_call(self, frame: types.FrameType, _event: str, _arg: Any) -> Any:
        # The look-up of `is_own` is inlined here, because this is called for every call in the library, too.
        own = self._own_by_file.get(frame.f_code.co_filename)
        if own or (own is None and self.is_own(frame)):
            self._frame_id = 0
            return self._on_event
        return None

    def _on_event(self, frame: types.FrameType, event: str, _arg: Any) -> Any:
        line = frame.f_lineno
        if event == "line" and line:
            tick = self._sim.tick
            if tick != self._tick:
                self._tick = tick
                self._ordinal = 0
            self._ordinal += 1
            if id(frame) != self._frame_id:
                # Every call and return resets `_frame_id`, so that no frame is mistaken for another with the same id.
                self._frame_id, self._depth = id(frame), self.count_depth(frame)
            self._met.append((tick, self._ordinal, line, self._scheduler.current, self._depth))
            if self.closely or line in self.lines:
                self._check(frame, line)
        elif event == "return":
            self._frame_id = 0
        return self._on_event

    # State

    @property
    def ordinal(self) -> int:
        """Number of the program's lines since the last tick; `UNKNOWN_ORDINAL` if they were not all counted."""
        tick = self._session.sim.tick
        if not self.on or tick == self._uncounted_tick:
            return UNKNOWN_ORDINAL
        return self._ordinal if tick == self._tick else 0

    def count_depth(self, frame: types.FrameType | None) -> int:
        """Return the number of open calls of the program's own code in the thread whose innermost frame is `frame`."""
        depth = 0
        while frame is not None:
            depth += self.is_own(frame)
            frame = frame.f_back
        return depth

    def own_frames(self, frame: types.FrameType | None) -> list[types.FrameType]:
        """Return those of a frame and its callers that belong to the program's own files, innermost first."""
        frames = []
        while frame is not None:
            if self.is_own(frame):
                frames.append(frame)
            frame = frame.f_back
        return frames

    def history(
        self, count: int, name_of: Callable[[ScheduledThread], str]
    ) -> tuple[ExecutedLine, ...]:
        """Return the last executed lines, at most `count`, oldest first.

        Lines of a tick in which tracing began too late to count them are left out. `name_of` returns the name of a
        thread.
        """
        met = [row for row in self._met if row[0] != self._uncounted_tick]
        return tuple(
            ExecutedLine(tick, ordinal, line, name_of(task), depth)
            for tick, ordinal, line, task, depth in met[max(0, len(met) - count) :]
        )
