"""Steering a run: commands from the host, pacing against the wall clock, user actions.

User actions take effect right before a tick and are written down with it, so that a
run can be repeated to the same bits.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim import protocol
from tuisim.atomic import private
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec
from tuisim.protocol import AFTER_TICK, BEFORE_NEXT_TICK, Answer, Message, Reply, ScriptedAction
from tuisim.runs.records import ACTIONS_FILE, STOP_FILE
from tuisim.runtime import wallclock
from tuisim.runtime.channel import Channel
from tuisim.runtime.stop import DISK_FULL

if TYPE_CHECKING:
    from tuisim.runtime.session import Session

LIVE = 1
"""Bit of `Session.slow`: the steering is asked before ticks."""
STOPPED = "stopped"
"""Why a run ends that the user stops."""
SLICE_S = 0.02
"""Longest uninterrupted real wait."""
BEHIND_S = 0.25
"""A run that has fallen further behind than this starts its pace anew."""
STOP_GRACE_S = 0.2
"""Real time that a program's own cleaning up gets."""
FAST_SLICE_TICKS = 64
"""Ticks between two looks at the commands in a run without pacing."""


class RunControl:
    """The host's hand on the run.

    Args:
        channel: Pipes to the host.
        folder: Run folder, for the user actions.
        live: Whether the run is paced and can be paused.
        speed: 1.0 is real time, 0 as fast as possible; a run that is not live is not paced.
        paused: Begin standing still.
        script: User actions that are known already, in the order of their ticks.
    """

    def __init__(
        self, channel: Channel, folder: Path, live: bool, speed: float, paused: bool, script: Iterable[ScriptedAction]
    ) -> None:
        self.live = live
        self._channel, self._folder = channel, folder
        self._speed = speed if live else 0.0
        self._script = deque(script)
        self._paused = paused
        self._steps = 0
        self._anchor: tuple[float, int] | None = None
        self._waiting: deque[Message] = deque()
        self._reason = "asked"
        self._rushing = False
        """Whether the pace is left aside until the run stands still."""
        self.debugged = False
        """Whether the debugger is to be asked before and after ticks."""
        self.holding = False
        """Whether the run stands still and commands are waited for."""
        self.between_ticks = False
        """While it stands still: whether no code of the program runs before the next tick, or since the last."""
        self._actions_fd = -1
        self._stop_asked_at: float | None = None
        self.answers: deque[str | None] = deque()
        """Answers to input() that have come in."""
        self.messages: list[Any] = []
        """What the host's responder has said so far."""

    # Commands

    def receive(self, session: Session) -> None:
        """Read the commands that have come in; user actions wait for the next tick."""
        for command in self._channel.receive():
            match command:
                case protocol.Stop():
                    session.ask_stop(STOPPED, STOPPED)
                case protocol.Pause():
                    self._paused, self._steps, self._reason = True, 0, "asked"
                    session.slow |= LIVE if self.live else 0
                    if session.debugger is not None:
                        session.debugger.pause()
                case protocol.Resume():
                    self._paused, self._steps = False, 0
                case protocol.StepTicks(ticks=ticks):
                    self._steps, self._reason = self._steps + max(0, ticks), "ticks"
                    self._forget_goals(session)
                case protocol.SetSpeed(speed=speed):
                    self._speed, self._anchor = max(0.0, speed), None
                case _ if isinstance(command, protocol.ACTIONS):
                    self._waiting.append(command)
                case _:
                    session.debug().take(command)

    def let_on(self, at_full_speed: bool = False) -> None:
        """Let the run go on, to the next moment at which the debugger holds it."""
        self._paused, self._steps, self._rushing = False, 0, at_full_speed

    @property
    def only_rushes(self) -> bool:
        """Whether there is nothing to do before the debugger's next goal."""
        return self._rushing and not self._script and not self._waiting

    @staticmethod
    def _forget_goals(session: Session) -> None:
        if session.debugger is not None:
            session.debugger.forget_goals()

    def stop_asked(self) -> None:
        """Begin the grace time."""
        self._stop_asked_at = wallclock.monotonic()

    def grace_is_over(self) -> bool:
        """Whether the program has had its real time for cleaning up."""
        return self._stop_asked_at is not None and wallclock.monotonic() - self._stop_asked_at > STOP_GRACE_S

    # Right before ticks

    @property
    def wanted(self) -> bool:
        """Whether it must be asked before ticks: the run is live, actions are still to come, or the debugger asks."""
        return self.live or self.debugged or bool(self._script)

    def before_ticks(self, session: Session, most: int) -> int:
        """Wait until ticks may be done.

        Args:
            session: The run.
            most: How many are wanted.

        Returns:
            How many to do now, at least 1.

        Raises:
            StopProgram: the run is to stop.
        """
        self.receive(session)
        self._apply_actions(session)
        if session.stop_reason is not None:
            session.checkpoint(before_tick=True)
            return most
        if self._script:
            # The next one must find its tick.
            most = min(most, self._script[0].tick - session.sim.tick)
        if self.debugged:
            debugger = session.debug()
            debugger.before_tick()
            most = debugger.most_ticks(most)
        if self._paused and not self._steps:
            sim = session.sim
            self.hold(session, protocol.Paused(sim.tick, session.now, sim.line, self._reason))
            session.checkpoint(before_tick=True)
        if self._steps:
            self._steps -= 1
            return 1
        if not self._speed or self._rushing:
            return min(most, FAST_SLICE_TICKS)
        return self._pace(session, most)

    def hold(self, session: Session, moment: protocol.Paused) -> None:
        """Stand still until told to go on, or to stop.

        Args:
            session: The run.
            moment: Where it stands. User actions take effect at once only right before a tick.
        """
        # From now on it is steered, however it began.
        self.live, session.slow = True, session.slow | LIVE
        self._paused, self._steps, self._rushing = True, 0, False
        self.holding, self.between_ticks = True, moment.ordinal in (AFTER_TICK, BEFORE_NEXT_TICK)
        self._forget_goals(session)
        self._channel.send(moment)
        while self._paused and not self._steps and session.stop_reason is None:
            self._channel.wait(1.0)
            self.receive(session)
            if moment.ordinal == BEFORE_NEXT_TICK:
                self._apply_actions(session)
            if session.debugger is not None:
                session.debugger.answer()
        self.holding = False
        if session.debugger is not None:
            session.debugger.go_on()
        self._anchor = None
        if not self._paused:
            self._channel.send(protocol.Resumed())

    def was_there(self, session: Session, kind: type[Answer | Reply]) -> bool:
        """Apply the next known action if it is of a kind, and came here when it was made: time stood still for it."""
        if not self._script or self._script[0].tick > session.sim.tick:
            return False
        action = self._script[0].action
        if not isinstance(action, kind) or (isinstance(action, Answer) and not action.at_once):
            return False
        self._script.popleft()
        self.apply(session, action)
        return True

    def stand_still_for(self, session: Session, kind: type[Answer | Reply], question: Message) -> None:
        """Ask the host, and let no simulated time pass until its answer is there and applied.

        Args:
            session: The run.
            kind: Of the answer.
            question: The event that asks for it.

        Raises:
            StopProgram: the run is to stop.
        """
        # Commands are taken here, not where the signal that announces them strikes.
        self.holding = True
        self._channel.send(question)
        while not (here := [one for one in self._waiting if isinstance(one, kind)]) and session.stop_reason is None:
            self._channel.wait(1.0)
            self.receive(session)
        self.holding = False
        self._anchor = None
        if here:
            self._waiting.remove(here[0])
            self.apply(session, here[0])
        session.checkpoint()

    def _pace(self, session: Session, most: int) -> int:
        sim = session.sim
        while True:
            wall, simulated = wallclock.monotonic(), sim.due_ns(sim.tick + 1)
            if self._anchor is None:
                self._anchor = (wall, sim.due_ns(sim.tick))
            wait_s = self._anchor[0] + (simulated - self._anchor[1]) / 1e9 / self._speed - wall
            if wait_s < -BEHIND_S:
                self._anchor = None
                return 1
            if wait_s <= 0.0:
                return 1
            if self._channel.wait(min(wait_s, SLICE_S)):
                self.receive(session)
                self._apply_actions(session)
                if session.stop_reason is not None:
                    session.checkpoint(before_tick=True)
                    return most
                if self._paused:
                    return self.before_ticks(session, most)

    # User actions

    def _apply_actions(self, session: Session) -> None:
        while self._script and self._script[0].tick <= session.sim.tick:
            self.apply(session, self._script.popleft().action)
        while self._waiting:
            self.apply(session, self._waiting.popleft())

    def apply(self, session: Session, action: Message) -> None:
        """Carry out a user action now, right before the next tick, and write it down.

        Raises:
            TypeError: the message is none.
        """
        sim = session.sim
        match action:
            case protocol.Stop():
                # No change of the world, and not counted as one.
                session.ask_stop(STOPPED, STOPPED)
                return
            case protocol.SetPose(x_mm=x, y_mm=y, heading_deg=heading):
                sim.place(Pose(x, y, heading))
            case protocol.SetNoise(light=light, motor=motor):
                sim.noise = NoiseSpec(light, motor)
            case protocol.SetPen(down=down):
                sim.pen_down = down
            case protocol.SetButtons(pressed=pressed):
                session.pressed = frozenset(pressed)
            case protocol.Answer(text=text):
                self.answers.append(text)
            case protocol.Reply(messages=messages):
                self.messages.extend(messages)
            case _:
                raise TypeError(f"not a user action: {action!r}")
        sim.actions += 1
        sim.rewrite_record()
        try:
            self._write_down(sim.tick, action)
        except OSError as error:
            # Not written down it would be no run that can be run again.
            session.ask_stop(DISK_FULL, f"what was done cannot be written down: {error.strerror}")

    def write_down_stop(self, tick: int) -> None:
        """Note that the stop reaches the program right before the tick after `tick`."""
        # Without it a re-run compares what there is.
        with suppress(OSError), open(self._folder / STOP_FILE, "w", encoding="utf-8", opener=private) as file:
            file.write(json.dumps({"tick": tick}))

    def _write_down(self, tick: int, action: Message) -> None:
        if self._actions_fd < 0:
            path = self._folder / ACTIONS_FILE
            self._actions_fd = private(str(path), os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.write(self._actions_fd, json.dumps(ScriptedAction(tick, action).to_plain()).encode() + b"\n")
