"""Control of a run: commands from the host, pacing against the wall clock, user actions.

User actions take effect right before a tick and are recorded with it, so that a
run can be repeated bit by bit.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from tuisim.base.atomic import private
from tuisim.engine import protocol
from tuisim.engine.protocol import (
    AFTER_TICK,
    BEFORE_NEXT_TICK,
    Answer,
    End,
    Message,
    PauseReason,
    Reply,
    UserAction,
)
from tuisim.engine.runs.side_files import ACTIONS_FILE, write_stop_tick
from tuisim.engine.runs.user_changes import change_simulation
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.channel import Channel

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation
    from tuisim.engine.runs.run_options import RunOptions


# The bits of `Session.flags`. Each bit makes the session do more than run ticks when time passes. They are plain
# numbers: every reading of a sensor tests some, and an enumeration computes ten times slower.

LIVE = 1
"""The control is called before ticks."""
ATTENTION = 2
"""A command has arrived."""
THREADS = 4
"""The program has several threads."""
STOPPING = 8
"""The program has to end."""
DEBUG = 16
"""Tracing has been switched."""

SLICE_S = 0.02
"""Longest uninterrupted wait in real time."""
BEHIND_S = 0.25
"""A run that is later than this restarts its pace."""
STOP_GRACE_S = 0.2
"""Real time for the program's cleanup after a stop of a live run."""
STOP_GRACE_CPU_S = 2.0
"""CPU time of the process for the program's cleanup after a stop of a headless run."""
FAST_SLICE_TICKS = 64
"""Ticks between two checks for commands in a run without pacing."""


class DebugHooks(Protocol):
    """The methods of the debugger that the session and the control of the run call."""

    def begin(self, options: RunOptions) -> None:
        """Apply those run options that concern the debugger, before the program's first line."""

    def take(self, command: Message) -> None:
        """Process a command of the user to the debugger; the caller handles pausing and resuming."""

    def enter(self) -> None:
        """Switch tracing on or off in the current thread, as the debugger needs it."""

    def check_goal(self) -> None:
        """Pause if the run has reached the requested instant; called right before a tick, after user actions."""

    def limit_ticks(self, most: int) -> int:
        """Return the number of ticks, at most `most`, that may run before `check_breakpoints` has to be called."""

    def check_breakpoints(self) -> None:
        """Pause if a breakpoint matches the tick that was just run."""

    def at_end(self) -> None:
        """Pause at the end of the program if a requested instant was never reached."""

    def pause(self) -> None:
        """Pause at the next line of the program; if a tick comes first, the control pauses there instead."""

    def answer(self) -> None:
        """Answer the requests that have arrived while the run is paused."""

    def forget_goals(self) -> None:
        """Cancel steps and requested lines and instants, because the user has requested something else."""

    def go_on(self) -> None:
        """Update tracing before the run resumes from a pause."""


class ControlledRun(Protocol):
    """The part of `Session` that the control of a run uses; see `Session`."""

    sim: Simulation
    now: int
    flags: int
    pressed: frozenset[str]
    stop_buttons: frozenset[str]
    debugger: DebugHooks | None

    @property
    def stop_reason(self) -> BaseException | None:
        """Why the run stops; None if it is not stopping."""

    def debug(self) -> DebugHooks:
        """Return the debugger; it is created on first use."""

    def check_stop(self, before_tick: bool = False) -> None:
        """Raise `StopProgram` if the program has to stop.

        `before_tick` says whether a tick is about to run, and no code of the program comes before it.
        """

    def ask_stop(self, end: End, summary: str) -> None:
        """Record that the run has to end at the next call that checks for a stop.

        Args:
            end: How the run ends.
            summary: One line for the user.
        """


class RunControl:
    """The control of a run by the host: pauses, speed and user actions.

    Args:
        channel: Pipes to the host.
        folder: Run folder, for the user actions.
        live: Whether the run is paced and can be paused.
        speed: 1.0 is real time, 0 as fast as possible; a run that is not live is not paced.
        paused: Whether to start paused.
        script: User actions that are known before the run starts, in the order of their ticks.
    """

    def __init__(
        self,
        channel: Channel,
        folder: Path,
        live: bool,
        speed: float,
        paused: bool,
        script: Iterable[UserAction],
    ) -> None:
        self.live = live
        self._channel = channel
        self._folder = folder
        self._speed = speed if live else 0.0
        self._script = deque(script)
        self._paused = paused
        self._steps = 0
        self._anchor: tuple[float, int] | None = None
        self._waiting: deque[Message] = deque()
        self._reason = PauseReason.ASKED
        self._rushing = False
        """Whether pacing is suspended until the run pauses."""
        self.debugged = False
        """Whether the debugger must be called before and after ticks."""
        self.holding = False
        """Whether the run is paused and waits for commands."""
        self.between_ticks = False
        """While paused: whether no code of the program runs before the next tick, or has run since the last."""
        self._actions_fd = -1
        self._stop_asked_at: float | None = None
        self.answers: deque[str | None] = deque()
        """Answers to input() that have arrived."""
        self.messages: list[Any] = []
        """All answers of the host's responder to printed lines."""

    # Commands

    def receive(self, session: ControlledRun) -> None:
        """Process the commands that have arrived; user actions are stored for the next tick."""
        for command in self._channel.receive():
            match command:
                case protocol.Stop():
                    session.ask_stop(End.STOPPED, "stopped")
                case protocol.Pause():
                    self._paused = True
                    self._steps = 0
                    self._reason = PauseReason.ASKED
                    session.flags |= LIVE if self.live else 0
                    if session.debugger is not None:
                        session.debugger.pause()
                case protocol.Resume():
                    self._paused = False
                    self._steps = 0
                case protocol.StepTicks(ticks=ticks):
                    self._steps = self._steps + max(0, ticks)
                    self._reason = PauseReason.TICKS
                    self._forget_goals(session)
                case protocol.SetSpeed(speed=speed):
                    self._speed = max(0.0, speed)
                    self._anchor = None
                case _ if isinstance(command, protocol.ACTIONS):
                    self._waiting.append(command)
                case _:
                    session.debug().take(command)

    def resume(self, at_full_speed: bool = False) -> None:
        """Resume the run until the debugger pauses it again.

        Args:
            at_full_speed: Whether the run goes as fast as possible until then, regardless of its set speed.
        """
        self._paused = False
        self._steps = 0
        self._rushing = at_full_speed

    @property
    def only_rushes(self) -> bool:
        """Whether the run goes at full speed to a requested instant or line, and no user action is pending."""
        return self._rushing and not self._script and not self._waiting

    @staticmethod
    def _forget_goals(session: ControlledRun) -> None:
        if session.debugger is not None:
            session.debugger.forget_goals()

    def begin_grace(self) -> None:
        """Start the time that the program has for its cleanup after a stop."""
        self._stop_asked_at = self._read_grace_clock()

    def has_grace_ended(self) -> bool:
        """Return whether the time that the program has for its cleanup after a stop is over."""
        most_s = STOP_GRACE_S if self.live else STOP_GRACE_CPU_S
        return (
            self._stop_asked_at is not None
            and self._read_grace_clock() - self._stop_asked_at > most_s
        )

    def _read_grace_clock(self) -> float:
        # With a user, real time matters. In a batch, the result of a program must not depend on the load of the
        # machine.
        return wallclock.monotonic() if self.live else wallclock.process_time()

    # Work right before ticks

    @property
    def wanted(self) -> bool:
        """Whether the control must be called before ticks: the run is live, debugged, or has pending user actions."""
        return self.live or self.debugged or bool(self._script)

    def await_ticks(self, session: ControlledRun, most: int) -> int:
        """Block until ticks may run.

        Args:
            session: The run.
            most: Number of ticks that the caller wants.

        Returns:
            Number of ticks to run now, at least 1.

        Raises:
            StopProgram: the run has to stop.
        """
        self.receive(session)
        self._apply_actions(session)
        if session.stop_reason is not None:
            session.check_stop(before_tick=True)
            return most
        if self._script:
            # Run no further than to the tick before which the next known action takes effect.
            most = min(most, self._script[0].tick - session.sim.tick)
        if self.debugged:
            debugger = session.debug()
            debugger.check_goal()
            most = debugger.limit_ticks(most)
        if self._paused and not self._steps:
            sim = session.sim
            self.hold(session, protocol.Paused(sim.tick, session.now, sim.line, self._reason))
        if self._steps:
            self._steps -= 1
            return 1
        if not self._speed or self._rushing:
            return min(most, FAST_SLICE_TICKS)
        return self._keep_pace(session, most)

    def hold(self, session: ControlledRun, moment: protocol.Paused) -> None:
        """Pause the run, and block until it is resumed or stopped.

        Args:
            session: The run.
            moment: The instant at which the run pauses. If it is right before a tick, user actions take effect during
                the pause; otherwise they wait for the next tick.

        Raises:
            StopProgram: the run has to stop.
        """
        # From here on the run is live, even if it was started without a user.
        self.live = True
        session.flags = session.flags | LIVE
        self._paused = True
        self._steps = 0
        self._rushing = False
        self.holding = True
        self.between_ticks = moment.ordinal in (AFTER_TICK, BEFORE_NEXT_TICK)
        self._forget_goals(session)
        self._channel.send(moment)
        while self._paused and not self._steps and session.stop_reason is None:
            self._channel.wait(1.0)
            self.receive(session)
            if moment.ordinal == BEFORE_NEXT_TICK:
                self._apply_actions(session)
            if session.debugger is not None:
                session.debugger.answer()
        self.holding = session.stop_reason is not None
        if session.debugger is not None:
            session.debugger.go_on()
        self._anchor = None
        if not self._paused:
            self._channel.send(protocol.Resumed())
        self._raise_here(session, before_tick=moment.ordinal == BEFORE_NEXT_TICK)

    def _raise_here(self, session: ControlledRun, before_tick: bool = False) -> None:
        """Raise `StopProgram` in this thread if a stop is requested.

        This thread has waited for commands of the host. Without this call, the main thread would raise the exception.

        Args:
            session: The run.
            before_tick: Whether a tick is about to run and no code of the program comes before it.
        """
        try:
            session.check_stop(before_tick)
        finally:
            self.holding = False

    def replay_next(self, session: ControlledRun, kind: type[Answer | Reply]) -> bool:
        """Apply the next known user action if it answers the question that the program asks now.

        An answer that was given only after some simulated time is not applied here, but at its tick.

        Args:
            session: The run.
            kind: The class of answers to this question.

        Returns:
            Whether the action was applied.
        """
        if not self._script or self._script[0].tick > session.sim.tick:
            return False
        action = self._script[0].command
        if not isinstance(action, kind) or (isinstance(action, Answer) and not action.at_once):
            return False
        self._script.popleft()
        self.apply(session, action)
        return True

    def wait_for_reply(
        self, session: ControlledRun, kind: type[Answer | Reply], question: Message
    ) -> None:
        """Send a question to the host, and block until its answer is applied. No simulated time passes.

        Args:
            session: The run.
            kind: Type of the answer.
            question: Event that asks for it.

        Raises:
            StopProgram: the run has to stop.
        """
        # Commands are processed here, not in the handler of the signal that announces them.
        self.holding = True
        self._channel.send(question)
        while (
            not (here := [reply for reply in self._waiting if isinstance(reply, kind)])
            and session.stop_reason is None
        ):
            self._channel.wait(1.0)
            self.receive(session)
        self.holding = session.stop_reason is not None
        self._anchor = None
        if here:
            self._waiting.remove(here[0])
            self.apply(session, here[0])
        self._raise_here(session)

    def _keep_pace(self, session: ControlledRun, most: int) -> int:
        sim = session.sim
        # A command that arrives while this waits can change the speed, also to full speed.
        while speed := self._speed:
            wall = wallclock.monotonic()
            simulated = sim.compute_due_ns(sim.tick + 1)
            # The handler of a signal may set `_anchor` to None at any moment.
            anchor = self._anchor = self._anchor or (wall, sim.compute_due_ns(sim.tick))
            wait_s = anchor[0] + (simulated - anchor[1]) / 1e9 / speed - wall
            if wait_s < -BEHIND_S:
                self._anchor = None
                return 1
            if wait_s <= 0.0:
                return 1
            if self._channel.wait(min(wait_s, SLICE_S)):
                self.receive(session)
                self._apply_actions(session)
                if session.stop_reason is not None:
                    session.check_stop(before_tick=True)
                    return most
                if self._paused:
                    return self.await_ticks(session, most)
        return min(most, FAST_SLICE_TICKS)

    # User actions

    def _apply_actions(self, session: ControlledRun) -> None:
        while self._script and self._script[0].tick <= session.sim.tick:
            self.apply(session, self._script.popleft().command)
        while self._waiting:
            self.apply(session, self._waiting.popleft())

    def apply(self, session: ControlledRun, action: Message) -> None:
        """Apply a user action now, right before the next tick, and record it.

        Raises:
            TypeError: the message is not a user action.
        """
        sim = session.sim
        match action:
            case protocol.Stop():
                # A stop does not change the world, and is not counted as an action.
                session.ask_stop(End.STOPPED, "stopped")
                return
            case protocol.SetButtons(pressed=pressed):
                session.pressed = frozenset(pressed)
                if session.stop_buttons and session.stop_buttons <= session.pressed:
                    session.ask_stop(End.FINISHED, "stopped by the hub's button")
            case protocol.Answer(text=text):
                self.answers.append(text)
            case protocol.Reply(messages=messages):
                self.messages.extend(messages)
        change_simulation(sim, action)
        try:
            self._write_down(sim.tick, action)
        except OSError as error:
            # Without a record of the action, the run could not be repeated, so it is stopped.
            session.ask_stop(
                End.DISK_FULL, f"the user's action cannot be recorded: {error.strerror}"
            )

    def write_down_stop(self, tick: int) -> None:
        """Record that `tick` was the last tick before the user's stop reached the program."""
        # If it cannot be written, a re-run is compared only as far as both runs go.
        with suppress(OSError):
            write_stop_tick(self._folder, tick)

    def _write_down(self, tick: int, action: Message) -> None:
        if self._actions_fd < 0:
            path = self._folder / ACTIONS_FILE
            self._actions_fd = private(str(path), os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.write(self._actions_fd, json.dumps(UserAction(tick, action).to_plain()).encode() + b"\n")
