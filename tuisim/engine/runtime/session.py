"""The session: the program's clock, and what happens when simulated time passes.

Time advances only in `_advance`. In a headless run with one thread the path to it is short;
any mode that needs more (live pacing, threads, a command, stopping) sets a bit in
`flags`, so that it costs nothing while it is off.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Sequence
from sys import _getframe
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.field import Field
from tuisim.engine.core.profile import MS, NS_PER_S
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.protocol import (
    CLEANUP_S,
    End,
    MotorRegisters,
    Plugged,
    Reply,
    ReplyWanted,
    Spoke,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.channel import Channel
from tuisim.engine.runtime.control import (
    ATTENTION,
    DEBUG,
    LIVE,
    STOPPING,
    THREADS,
    DebugHooks,
    RunControl,
)
from tuisim.engine.runtime.output import OutputRecorder
from tuisim.engine.shim.waits import Wait, waits_for

if TYPE_CHECKING:
    from tuisim.engine.core.pen_marks import PenMarks
    from tuisim.engine.core.plugged import PluggedPart
    from tuisim.engine.runs.readings import ReadingsWriter

COMMANDS_AN_INSTANT = 100
COMMAND_BURST_NS = 10 * MS
"""Simulated time that passes once a program has made `COMMANDS_AN_INSTANT` calls without a cost at one instant."""

REPEATED_WAIT_NS = 10 * NS_PER_S
"""Consecutive identical waits are combined into one of this length."""

CHUNK_TICKS = 2000
"""A long wait is split into parts of this number of ticks, to check for commands in between."""


@dataclass(frozen=True, slots=True)
class RunLimits:
    """The limits of simulated and of processor time that end a run; 0 is no limit."""

    time_ns: int = 0
    stall_s: float = 0.0
    """CPU seconds that may pass in one instant of simulated time."""


class StopProgram(BaseException):
    """Raised in the program to end it.

    It is not an `Exception`, so that no `except Exception` of the program catches it.

    Args:
        end: How the run ends.
        summary: One line for the user.
        line: The program's line that the summary is about; 0 for none.
    """

    def __init__(self, end: End, summary: str, line: int = 0) -> None:
        super().__init__(summary)
        self.end = end
        self.summary = summary
        self.line = line


class Deadlock(RuntimeError):
    """Raised when every thread of the program waits for another one."""


class Session:
    """The clock of one run. When simulated time passes, it runs the ticks that are due.

    It is created without a run; time may pass only after `connect`.

    Args:
        sim: The simulation.
        field: The mat.
        output: Receives printed lines.
    """

    channel: Channel
    """Pipes to the host."""
    steering: RunControl
    """Processes the host's commands: pause, speed, user actions."""
    limits: RunLimits
    """Limits of the run."""
    readings: ReadingsWriter
    """Receives what the program reads."""

    def __init__(self, sim: Simulation, field: Field, output: OutputRecorder) -> None:
        self.sim = sim
        self.output = output
        self._field = field
        self._pen: PenMarks | None = None
        self.program_file = ""
        """File name of the program's own frames."""
        self.now = 0
        self.free = 0
        self.flags = 0
        """Bits such as `LIVE` of `runtime.control`."""
        self.held_up = ""
        self.shown_ports: tuple[str, ...] | None = None
        self.pressed: frozenset[str] = frozenset()
        """The brick's buttons that are pressed."""
        self.stop_buttons: frozenset[str] = frozenset()
        self._due = sim.compute_due_ns(1)
        hz = sim.spec.profile.tick_hz
        self._hz = hz
        self._tick_ns = 0 if NS_PER_S % hz else NS_PER_S // hz
        """Length of a tick; 0 if it is not a whole number."""
        self._limit_ns = self._quick_ns = 1 << 62
        """Up to this time a wait only runs ticks, if no bit of `flags` is set."""
        self._commands = 0
        self._commands_at = -1
        self.replies = False
        """Whether the host answers with `messages`."""
        self.wheel_registers: tuple[Callable[[], MotorRegisters], ...] = ()
        self.stop_reason: StopProgram | None = None
        self._stop_raised_at: int | None = None
        self.stop_raised_in: int | None = None
        """Identity of the thread that the stop was raised in first."""
        self.debugger: DebugHooks | None = None
        self.make_debugger: Callable[[], DebugHooks] | None = None
        """Set once there is a program to debug."""
        self.sleep_threaded: Callable[[int, bool], object] | None = None
        """Set by the scheduler: blocks until a time (or a motor change) while other threads run."""
        self.spawn_daemon: Callable[[Callable[[], None]], None]
        """Set by the scheduler: runs a function in the background while the program continues."""

    def connect(
        self, channel: Channel, steering: RunControl, limits: RunLimits, program_file: str
    ) -> None:
        """Connect the session to the run that is about to begin.

        Args:
            channel: The pipes to the host.
            steering: The control of the run.
            limits: The limits that end the run.
            program_file: The file name of the program.
        """
        self.channel = channel
        self.steering = steering
        self.limits = limits
        self.program_file = program_file
        self._limit_ns = self._quick_ns = limits.time_ns or 1 << 62
        self.flags |= LIVE if steering.wanted else 0
        if self.sim.spec.world.pen_marks:
            # Imported on demand: most programs start faster without it.
            from tuisim.engine.core.pen_marks import PenMarks

            self._pen = PenMarks(self._field, self.sim.spec)

    # Methods that the simulated devices call

    @property
    def field(self) -> Field:
        """The mat in its present state, with pen marks if sensors can see them."""
        if self._pen is None:
            return self._field
        self._pen.add_records(self.sim.read_records(self._pen.records))
        return self._pen.field

    def spend(self, duration_ns: int, code: int = -1) -> None:
        """Let simulated time pass; unlike `charge`, do so even in phases in which the program's calls take no time.

        Args:
            duration_ns: How long.
            code: What the program reads in this time, one of `READING_CODES`; -1 for nothing.
        """
        until = self.now + duration_ns
        line = 0
        if self.flags or until > self._quick_ns:
            self._pass(until, False)
        elif until < self._due:
            self.now = until
            if code >= 0:
                # Time has passed since the last reading, so this one cannot be a repetition: record it without a check.
                self.readings.add(code, until, self.program_line(3))
            return
        else:
            self.output.drain()
            sim = self.sim
            sim.line = line = self.program_line(3)
            # Most readings make exactly one tick due. The tick after it is due at `compute_due_ns(sim.tick + 2)`.
            # This time is computed here, because that is faster than a call.
            following = (
                self._due + self._tick_ns
                if self._tick_ns
                else -(-(sim.tick + 2) * NS_PER_S // self._hz)
            )
            if until < following:
                sim.tick_once()
                self.now = until
                self._due = following
                if code >= 0:
                    self.readings.add(code, until, line)
                return
            ticks = sim.count_ticks(until) - sim.tick
            if ticks > CHUNK_TICKS:
                self.advance(until, False)
            else:
                sim.advance(ticks)
                self.now, self._due = until, sim.compute_due_ns(sim.tick + 1)
        if code >= 0:
            self.note_reading(code, line)

    def note_reading(self, code: int, line: int = 0) -> None:
        """Record that the program has read something; a repetition while no time passes is not recorded again.

        Args:
            code: What it has read, one of `READING_CODES`.
            line: The line of the program; 0 for the present one.
        """
        readings = self.readings
        now = self.now
        # While no time passes, a loop may read the same value again and again: record it once.
        if now == readings.newest_ns and readings.has(code):
            return
        readings.add(code, now, line or self.program_line(3))

    def charge(self, cost_ns: int) -> None:
        """Let the simulated time of a call pass; do nothing while calls are free of charge."""
        if not self.free:
            self.spend(cost_ns)

    def command(self) -> None:
        """Count a call that takes no simulated time.

        After many such calls at the same time, a little time passes, so that a loop of them cannot run forever.
        """
        if self._commands_at != self.now:
            self._commands_at = self.now
            self._commands = 0
        self._commands += 1
        if self._commands >= COMMANDS_AN_INSTANT:
            self._commands = 0
            self.spend(COMMAND_BURST_NS)
        elif self.flags & (ATTENTION | STOPPING):
            self.check_stop()

    def wait_for_motor(self, timeout_ns: int, again: bool = False) -> None:
        """Block until a motor ends a move or the timeout is over.

        Args:
            timeout_ns: The timeout.
            again: Whether the caller repeats this call after the timeout, and does nothing else. The timeout may then
                be made longer, which is faster and has the same effect.
        """
        if again and not self.flags & THREADS:
            # Nothing else can change during the wait, so many short waits are equivalent to one long wait.
            timeout_ns *= max(1, REPEATED_WAIT_NS // max(1, timeout_ns))
        self._pass(self.now + timeout_ns, True)

    def describe_part(self, port: str, part: str, role: str = "") -> PluggedPart:
        """Return a description of a part that is plugged in now, with the present tick and line of the program.

        Args:
            port: The port, such as `in1`.
            part: The name of the part's class, such as `ColorSensor`.
            role: Which wheel a motor drives, as in `PluggedPart`; empty for none.
        """
        from tuisim.engine.core.plugged import PluggedPart

        return PluggedPart(port, part, self.sim.tick, self.program_line(), role)

    def tell_plugged(self, parts: Sequence[PluggedPart]) -> None:
        """Report to the host, the process that started the run, which parts have been plugged in."""
        for part in parts:
            self.channel.send(Plugged(part.port, part.part, part.tick, part.line, part.role))

    def is_tried(self, error: type[Exception]) -> bool:
        """Return whether the program would catch an error that is raised now.

        If it would, the program probably only tries whether a device is connected.
        """
        # Imported on demand: few programs look for a device that is missing.
        from tuisim.engine.runtime.handlers import is_caught

        return is_caught(error, _getframe(1), self.program_file)

    @waits_for(Wait.SOUND)
    def speak(self, text: str, wait_ns: int, tones: str = "", file: str = "") -> None:
        """Record a sound, and block for `wait_ns` of simulated time.

        Args:
            text: The spoken text; in brackets for other sounds.
            wait_ns: How long the call blocks.
            tones: Successive tones as JSON, as in `engine.protocol.Spoke`; empty for speech.
            file: Absolute path of the sound file; empty for other sounds.
        """
        self.output.row(text, Stream.SPEECH)
        self.channel.send(Spoke(text, self.now, tones, file))
        self.spend(wait_ns)

    def show(self, row: str, stream: Stream) -> None:
        """Record what the brick shows, as a row of output in the format of `engine.runs.brick_state`.

        Args:
            row: The text of the row.
            stream: The stream of the row, which says what part of the brick it is about.
        """
        self.output.row(row, stream)

    def messages(self) -> list[Any]:
        """Return all answers that the notebook's responder has given to calls of `pyState()`, oldest first.

        A responder is a function of the notebook that answers the program. If it has still to answer, block until it
        has; no simulated time passes.
        """
        self.command()
        steering = self.steering
        if not steering.replay_next(self, Reply) and self.replies and self.stop_reason is None:
            steering.wait_for_reply(self, Reply, ReplyWanted())
        return list(steering.messages)

    # Passing time

    def _pass(self, until: int, on_change: bool) -> None:
        if self.flags & (ATTENTION | STOPPING):
            self.check_stop()
        if self.flags & DEBUG:
            self.flags &= ~DEBUG
            self.debug().enter()
        if until > self.now:
            self.output.drain()
            self.sim.line = self.program_line(3)
        if self.flags & THREADS and self.sleep_threaded is not None:
            self.sleep_threaded(until, on_change)
        else:
            self.advance(until, on_change)

    def advance(self, until: int, on_change: bool) -> bool:
        """Advance the clock, and run the ticks that are due.

        Args:
            until: Simulated time in ns.
            on_change: Whether to return early when a motor ends a move.

        Returns:
            Whether a motor ended the wait.

        Raises:
            StopProgram: the time limit is reached, or the time for the program's cleanup after a stop is over.
        """
        if until > self._limit_ns and not self.stop_reason:
            changed = self._run_ticks(self._limit_ns, on_change)
            if not changed:
                self.now = self._limit_ns
                limit_s = self._limit_ns / NS_PER_S
                limit = f"stopped at the limit of {limit_s:g} s simulated time"
                raise self.request_stop(
                    End.TIME_LIMIT, "; ".join(filter(None, (limit, self.held_up)))
                )
        elif self._stop_raised_at is not None and until > (
            last := self._stop_raised_at + CLEANUP_S * NS_PER_S
        ):
            changed = self._run_ticks(last, on_change)
            if not changed:
                self.now = max(self.now, last)
                assert self.stop_reason is not None
                raise self.stop_reason
        else:
            changed = self._run_ticks(until, on_change)
        # A wait that a motor ended is over at the tick in which the motor stopped, or when its driver noticed the stop.
        sim = self.sim
        self.now = max(self.now, sim.compute_due_ns(sim.tick), sim.changed_ns) if changed else until
        self._due = self.sim.compute_due_ns(self.sim.tick + 1)
        return changed

    def _run_ticks(self, until: int, on_change: bool) -> bool:
        sim = self.sim
        if until > self._quick_ns:
            self._quick_ns = self._limit_ns
            self.flags |= LIVE
        if self.flags & LIVE and not self.stop_reason:
            return self._run_live(until, on_change)
        sim.changed = False
        target = sim.count_ticks(until)
        while sim.tick < target:
            sim.advance(min(target - sim.tick, CHUNK_TICKS), on_change)
            if on_change and sim.changed:
                return True
            if self.flags & ATTENTION:
                self.now = max(self.now, sim.compute_due_ns(sim.tick))
                self.check_stop(before_tick=True)
        return False

    def _run_live(self, until: int, on_change: bool) -> bool:
        sim = self.sim
        steering = self.steering
        sim.changed = False
        target = sim.count_ticks(until)
        if not steering.wanted:
            self.flags &= ~LIVE
        while sim.tick < target:
            # User actions take effect right before a tick. If a motor's change lets the program go on now, no tick
            # comes next, so they wait.
            if on_change and sim.notice_change():
                return True
            # The clock shows the last tick, but never goes back.
            self.now = max(self.now, sim.compute_due_ns(sim.tick))
            ticks = steering.await_ticks(self, target - sim.tick)
            sim.advance(ticks, on_change)
            if steering.debugged:
                self.debug().check_breakpoints()
            if on_change and sim.changed:
                return True
        return False

    def skip_control(self, tick: int) -> None:
        """Run ticks at full speed until `tick` is due, without a call of the run's control before each of them."""
        self.flags &= ~LIVE
        self._quick_ns = min(self._limit_ns, self.sim.compute_due_ns(tick) - 1)

    def debug(self) -> DebugHooks:
        """Return the debugger; it is created on first use."""
        if self.debugger is None:
            assert self.make_debugger is not None
            self.debugger = self.make_debugger()
        return self.debugger

    # Stopping

    def check_stop(self, before_tick: bool = False) -> None:
        """Process commands of the host, and raise an exception if the program has to stop.

        Args:
            before_tick: Whether a tick is about to run, and no code of the program comes before it. The tick is then
                recorded, so that a re-run can stop at the same instant.

        Raises:
            StopProgram: when a stop is requested, and again once the time for cleanup is over.
        """
        self.flags &= ~ATTENTION
        self.steering.receive(self)
        reason = self.stop_reason
        if reason is None:
            return
        if self._stop_raised_at is None:
            self._stop_raised_at, self.stop_raised_in = self.now, wallclock.get_ident()
            if before_tick and reason.end is End.STOPPED:
                self.steering.write_down_stop(self.sim.tick)
            raise reason
        if self.steering.has_grace_ended():
            raise reason

    def request_stop(self, end: End, summary: str) -> StopProgram:
        """Record that the run ends and why, unless a reason is known already; return the exception to raise."""
        if self.stop_reason is None:
            self.stop_reason = StopProgram(end, summary)
            self.steering.begin_grace()
        self._stop_raised_at = self.now if self._stop_raised_at is None else self._stop_raised_at
        self.flags |= STOPPING
        return self.stop_reason

    def ask_stop(self, end: End, summary: str, line: int = 0) -> None:
        """Record that the run has to end at the next call that checks for a stop.

        Args:
            end: How the run ends.
            summary: One line for the user.
            line: The program's line that the summary is about; 0 for none.
        """
        if self.stop_reason is None:
            self.stop_reason = StopProgram(end, summary, line)
            self.steering.begin_grace()
        self.flags |= STOPPING

    def stop_lost(self) -> None:
        """Make the next check raise `StopProgram` again, because Python has dropped it, such as in a `__del__`."""
        self._stop_raised_at = None

    def program_line(self, skipped: int = 1) -> int:
        """Return the number of the program's line that is running; 0 if there is none.

        Args:
            skipped: How many frames are certainly not the program's: this one, and some of its callers.
        """
        frame: types.FrameType | None = _getframe(skipped)
        file = self.program_file
        while frame is not None:
            if frame.f_code.co_filename == file:
                return frame.f_lineno
            frame = frame.f_back
        return 0
