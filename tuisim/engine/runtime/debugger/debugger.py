"""The debugger of one run: its commands, and when the run pauses."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from sys import _getframe
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.engine import protocol
from tuisim.engine.breakpoints import Breakpoint, LineBreak, parse_breakpoints
from tuisim.engine.protocol import (
    AFTER_TICK,
    BEFORE_NEXT_TICK,
    LineStep,
    Message,
    Paused,
    PauseReason,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.runtime.control import ATTENTION, DEBUG, LIVE
from tuisim.engine.runtime.debugger.conditions import LineCondition, Watcher
from tuisim.engine.runtime.debugger.fork import run_apart
from tuisim.engine.runtime.debugger.inspection import Inspector
from tuisim.engine.runtime.debugger.tracer import Tracer
from tuisim.engine.runtime.scheduler import ScheduledThread, Scheduler
from tuisim.engine.runtime.session import Session

if TYPE_CHECKING:
    from tuisim.engine.runs.run_options import RunOptions


@dataclass(frozen=True, slots=True)
class Step:
    """A step over lines of the program that is not complete yet."""

    task: ScheduledThread | None
    """Thread that is stepped; None: the next line of any thread completes the step."""
    most_depth: int
    """The step is complete at a line with at most this many open calls of the program's own code."""

    def is_done(self, task: ScheduledThread, depth: int) -> bool:
        """Return whether a line that is about to run completes the step; True if the thread of the step has ended.

        Args:
            task: The thread that is about to run the line.
            depth: Number of open calls of the program's own code in it.
        """
        if self.task is None or self.task.done:
            return True
        return task is self.task and depth <= self.most_depth


ENDLESS_DEPTH = 1 << 30
"""Larger than the depth of any stack."""


NEXT_LINE = Step(None, ENDLESS_DEPTH)
"""Complete at the next line of any thread."""


def find_code_line(program: types.CodeType | None, line: int) -> int:
    """Return the first line with code from `line` on, because the program never pauses at a line without code.

    Return `line` itself if there is no such line, or if it is 0.
    """
    if program is None or not line:
        return line
    return min((code_line for code_line in _list_lines(program) if code_line >= line), default=line)


def _list_lines(code: types.CodeType) -> Iterator[int]:
    left = [code]
    while left:
        code_ = left.pop()
        yield from (line for _, _, line in code_.co_lines() if line)
        left += [part for part in code_.co_consts if isinstance(part, types.CodeType)]


CONDITION_LIMIT_S = 0.2
"""Time limit of a condition, in real seconds."""

Instant = tuple[int, int]
"""Tick, and ordinal of the line in that tick."""


class Debugger:
    """The debugger of one run: it processes the user's commands, and pauses the run.

    Args:
        session: The run.
        scheduler: The program's threads.
        module: Holds the program's global names.
        prepared: Identities of the objects that existed before the program, by name.
        code: The program itself.
    """

    def __init__(
        self,
        session: Session,
        scheduler: Scheduler,
        module: Mapping[str, Any],
        prepared: Mapping[str, int],
        code: types.CodeType | None,
    ) -> None:
        self._session = session
        self._scheduler = scheduler
        self._code = code
        self._tracer = Tracer(session, scheduler, self._handle_line)
        self._looker = Inspector(session, scheduler, self._tracer, module, prepared)
        self._watcher = Watcher(session)
        self._by_line: dict[int, list[tuple[Breakpoint, LineCondition | None]]] = {}
        self._step: Step | None = None
        self._step_reason = PauseReason.STEP
        self._line = 0
        self._instant: Instant | None = None
        self._trace_from: int | None = None
        self._looks: list[Message] = []

    def begin(self, options: RunOptions) -> None:
        """Apply those run options that concern the debugger, before the program's first line."""
        self._set_breaks(parse_breakpoints(options.breaks))
        self._trace_from = options.trace_from_tick
        if options.hold_at is not None:
            self._set_instant(*options.hold_at)
            self._session.steering.resume(at_full_speed=True)
        self._trace(at_tick=True)
        self._update_session()
        if self._instant == (0, AFTER_TICK):
            self._hold(Paused(0, 0, 0, PauseReason.INSTANT, ordinal=AFTER_TICK))

    # Commands

    def take(self, command: Message) -> None:
        """Process a command of the user to the debugger; the caller handles pausing and resuming."""
        steering = self._session.steering
        match command:
            case protocol.StepLine(how=how):
                self._forget_goals()
                # A paused run waits for commands in the paused thread, so this frame belongs to that thread.
                depth = self._tracer.count_depth(_getframe())
                depths = {
                    LineStep.INTO: ENDLESS_DEPTH,
                    LineStep.OVER: depth,
                    LineStep.OUT: depth - 1,
                }
                step = Step(self._scheduler.current, depths[how])
                self._step = step if steering.holding else NEXT_LINE
                steering.resume()
            case protocol.RunToLine(line=line):
                self._forget_goals()
                self._line = find_code_line(self._code, line)
                steering.resume()
            case protocol.RunToInstant(tick=tick, ordinal=ordinal):
                self._forget_goals()
                self._set_instant(tick, ordinal)
                steering.resume(at_full_speed=True)
            case protocol.SetBreaks(breaks=texts):
                self._set_breaks(parse_breakpoints(texts))
            case protocol.Inspect() | protocol.RequestHistory():
                if steering.holding:
                    self._looks.append(command)
        if not steering.holding:
            self._trace(at_tick=False)
            self._update_session()

    def go_on(self) -> None:
        """Update tracing before the run resumes from a pause."""
        # After a pause between ticks, the lines that the program runs are those of the next tick.
        self._trace(at_tick=self._session.steering.between_ticks)
        self._update_session()

    def answer(self) -> None:
        """Answer the requests that have arrived while the run is paused."""
        looks = self._looks
        self._looks = []
        for request in looks:
            if isinstance(request, protocol.Inspect):
                self._session.channel.send(self._looker.look(request, self._take_more))
            elif isinstance(request, protocol.RequestHistory):
                lines = self._tracer.history(max(0, request.count), self._looker.name_thread)
                self._session.channel.send(protocol.LineHistory(lines))

    def _take_more(self) -> bool:
        """Process commands that arrive during an inspection; return False if the run stops and needs no result."""
        self._session.steering.receive(self._session)
        return self._session.stop_reason is None

    def forget_goals(self) -> None:
        """Cancel steps and requested lines and instants, because the user has requested something else."""
        self._forget_goals()
        if not self._session.steering.holding:
            self._trace(at_tick=False)
            self._update_session()

    def pause(self) -> None:
        """Pause at the next line of the program; if a tick comes first, the control pauses there instead."""
        self.forget_goals()
        if self._tracer.on and not self._session.steering.holding:
            self._step = NEXT_LINE
            self._step_reason = PauseReason.ASKED
            self._trace(at_tick=False)

    def _forget_goals(self) -> None:
        self._step = None
        self._step_reason = PauseReason.STEP
        self._line = 0
        self._instant = None

    def _set_instant(self, tick: int, ordinal: int) -> None:
        self._instant = (tick, ordinal)
        if ordinal > AFTER_TICK:
            self._trace_from = tick if self._trace_from is None else min(tick, self._trace_from)

    def _set_breaks(self, breaks: Iterable[Breakpoint]) -> None:
        enabled = [break_point for break_point in breaks if not break_point.disabled]
        before = {
            break_point.text: condition
            for line_breaks in self._by_line.values()
            for break_point, condition in line_breaks
        }
        self._by_line = {}
        for break_point in enabled:
            if isinstance(break_point.rule, LineBreak):
                text = break_point.rule.condition
                condition = before.get(break_point.text) or (LineCondition(text) if text else None)
                line = find_code_line(self._code, break_point.rule.line)
                self._by_line.setdefault(line, []).append((break_point, condition))
        self._watcher.set(enabled)
        self._session.output.watch = self._handle_row if self._watcher.rows else None

    def _trace(self, at_tick: bool) -> None:
        tracer = self._tracer
        tick = self._session.sim.tick
        counting = self._trace_from is not None and tick >= self._trace_from
        line_goal = bool(self._line or self._step)
        tracer.lines = frozenset({*self._by_line, *((self._line,) if self._line else ())})
        tracer.closely = self._step is not None or self._instant is not None
        tracer.switch(bool(self._by_line) or line_goal or counting, at_tick)

    def _update_session(self) -> None:
        """Make the session call the debugger at ticks only if breakpoints or requested instants need it."""
        session = self._session
        goals = self._list_goal_ticks()
        session.steering.debugged = self._watcher.ticks or bool(goals)
        session.flags |= DEBUG
        if (
            goals
            and session.steering.only_rushes
            and not self._watcher.ticks
            and min(goals) > session.sim.tick
        ):
            session.skip_control(min(goals))
        elif session.steering.debugged:
            session.flags |= LIVE

    def _list_goal_ticks(self) -> list[int]:
        goals = [] if self._instant is None else [self._instant[0]]
        return goals if self._trace_from is None or self._tracer.on else [*goals, self._trace_from]

    # Ticks

    def limit_ticks(self, most: int) -> int:
        """Return the number of ticks, at most `most`, that may run before `check_breakpoints` has to be called."""
        tick = self._session.sim.tick
        if self._watcher.ticks:
            return 1
        return min([most, *(goal - tick for goal in self._list_goal_ticks() if goal > tick)])

    def check_goal(self) -> None:
        """Pause if the run has reached the requested instant; called right before a tick, after user actions."""
        tick = self._session.sim.tick
        if self._instant is not None and self._instant <= (tick, BEFORE_NEXT_TICK):
            self._hold_at_tick(PauseReason.INSTANT, BEFORE_NEXT_TICK)

    def check_breakpoints(self) -> None:
        """Pause if a breakpoint matches the tick that was just run."""
        tick = self._session.sim.tick
        met = self._watcher.match_tick() if self._watcher.ticks else None
        self._trace(at_tick=True)
        if met is not None:
            self._hold_at_tick(PauseReason.BREAK, AFTER_TICK, *met)
        elif self._instant is not None and self._is_past(tick):
            self._hold_at_tick(PauseReason.INSTANT, AFTER_TICK)

    def _is_past(self, tick: int) -> bool:
        assert self._instant is not None
        return self._instant == (tick, AFTER_TICK) or self._instant[0] < tick

    def at_end(self) -> None:
        """Pause at the end of the program if a requested instant was never reached."""
        if self._instant is not None:
            self._hold_at_tick(PauseReason.END, self._tracer.ordinal)

    def enter(self) -> None:
        """Switch tracing on or off in the current thread, as the debugger needs it."""
        self._tracer.enter()

    # Pauses at lines and at printed rows

    def _handle_line(self, frame: types.FrameType, line: int) -> None:
        session = self._session
        if session.flags & ATTENTION:
            session.check_stop()
        if session.stop_reason is not None:
            return
        own = frame.f_code.co_filename == session.program_file
        reason: PauseReason | None = None
        text = value = ""
        depth = self._tracer.count_depth(frame) if self._step is not None else 0
        if self._instant is not None and self._is_reached(self._tracer.ordinal):
            reason = PauseReason.INSTANT
        elif self._step is not None and self._step.is_done(self._scheduler.current, depth):
            reason = self._step_reason
        elif own and line == self._line:
            reason = PauseReason.LINE
        elif own:
            for break_point, condition in self._by_line.get(line, ()):
                value = condition.holds(frame, self._run_apart) if condition is not None else ""
                if condition is None or value:
                    reason = PauseReason.BREAK
                    text = break_point.text
                    break
        if reason is not None:
            file = "" if own else frame.f_code.co_filename
            moment = self._build_moment(line, reason, text, value, self._tracer.ordinal, file)
            self._hold(moment)

    def _is_reached(self, ordinal: int) -> bool:
        assert self._instant is not None
        tick, goal_ordinal = self._instant
        now = self._session.sim.tick
        return now > tick or (now == tick and goal_ordinal > AFTER_TICK and ordinal >= goal_ordinal)

    def _handle_row(self, row: str, stream: Stream) -> None:
        met = self._watcher.match_row(row, stream)
        if met is not None and self._session.stop_reason is None:
            line = self._session.program_line()
            self._hold(self._build_moment(line, PauseReason.BREAK, *met, self._tracer.ordinal))

    def _run_apart(self, work: Callable[[], bytes]) -> bytes | None:
        return run_apart(self._session, self._scheduler, work, CONDITION_LIMIT_S, self._take_more)

    # Pausing

    def _build_moment(
        self,
        line: int,
        reason: PauseReason,
        text: str = "",
        value: str = "",
        ordinal: int = 0,
        file: str = "",
    ) -> Paused:
        session = self._session
        thread = self._looker.name_thread(self._scheduler.current)
        return Paused(
            session.sim.tick, session.now, line, reason, text, value, ordinal, thread, file
        )

    def _hold_at_tick(
        self, reason: PauseReason, ordinal: int, text: str = "", value: str = ""
    ) -> None:
        session = self._session
        session.now = max(session.now, session.sim.compute_due_ns(session.sim.tick))
        self._hold(self._build_moment(session.sim.line, reason, text, value, ordinal))

    def _hold(self, moment: Paused) -> None:
        session = self._session
        self._trace_from = None if self._tracer.on else self._trace_from
        session.steering.hold(session, moment)
