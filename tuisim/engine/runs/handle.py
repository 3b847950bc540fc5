"""Parent side of a run: starts the child, reads its events, sends commands, stops it.

Only methods named `wait…` block, and nothing depends on the display: the
child writes its recording by itself, and viewers read the run folder.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Hashable
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.errors import HostError, LogError, RobotError, counted
from tuisim.base.source import Program
from tuisim.engine.breakpoints import parse_breakpoints
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.core.profile import compute_due_ns
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.protocol import (
    CLEANUP_S,
    COMMAND_SIGNAL,
    STACK_SIGNAL,
    Answer,
    End,
    Ended,
    InputWanted,
    Message,
    Paused,
    Plugged,
    Reply,
    ReplyWanted,
    Resumed,
    SetBreaks,
    Started,
    Stop,
    UserAction,
    Wheels,
)
from tuisim.engine.runs.child.events import DEBUGGED, EventStream, build_part, list_allowed_events
from tuisim.engine.runs.child.isolation import Quota, is_readable
from tuisim.engine.runs.child.process import (
    FairClock,
    await_stack,
    describe_end,
    end_descendants,
    end_group,
    find_stuck_line,
    mark,
    prepare_template,
    start_child,
    write_command,
)
from tuisim.engine.runs.run_folder import RUN_FILE, StoredRun, add_plugged, field_files
from tuisim.engine.runs.run_options import DEFAULT_TIME_LIMIT_S as DEFAULT_TIME_LIMIT_S
from tuisim.engine.runs.run_options import RunOptions as RunOptions
from tuisim.engine.runs.side_files import (
    LOG_FILE,
    MAX_BYTES,
    STACK_FILE,
    copy_modules,
    read_actions,
    read_stop_tick,
)
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.views import TelemetryView, open_views

if TYPE_CHECKING:
    from tuisim.engine.runs.temporary import TemporaryRun

STUCK_AFTER_S = 0.3
"""Time after a stop at which a child that has not ended is killed; see `RunHandle.time_used_s`."""
WAIT_S = 0.15
"""Interval at which `RunHandle.wait` checks a child that sends nothing, unless the child has been asked to stop."""
LOOK_EVERY_S = 0.03
"""Interval of checks of a running child's recording: most runs are over before the first check."""
ENDED_CHILD_S = 0.2
"""Time for a child to exit after its last event."""
_BEYOND_LIMIT_S = CLEANUP_S + 1.0
STALL_FACTOR = 2.0
"""A headless child without progress for this many stall limits of real time is stuck in C code."""


def _build_template_key(program: Program, spec: RunSpec, field: FieldFiles) -> Hashable:
    """Return the key of a run's template. Runs with the same key can be forked from the same template.

    They may differ in the program, the options, the seed, the noise and the start, which are not part of the key.
    """
    world = [
        getattr(spec.world, value.name)
        for value in fields(spec.world)
        if value.name not in ("noise", "start")
    ]
    # The identities of the mat's files are part of the key, so that a template never uses files that were replaced.
    return program.prelude, field, field.identities(), spec.robot, spec.profile, *world


def _list_needs(program: Program, field: FieldFiles) -> list[Path]:
    """Return the folders of a program's modules and the files of its mat, which an isolated program needs to read."""
    own = [program.module_folder or os.path.dirname(program.path), *program.python_path]
    return [
        *(Path(os.path.abspath(folder)) for folder in own if folder),
        *field.paths,
    ]


class RunHandle:
    """The host's control of one run: its child process, its pipes and its recording. `start_run` creates it.

    The child is forked from a template if there is one: a process that is prepared for this robot and this world.

    Args:
        program: The program.
        spec: The run.
        field: The files of the prepared mat.
        options: How the run is executed.
        store: Where the run folder is created.
        of_many: Whether other runs of this robot and world follow soon. If so, a missing template is made now, and
            forks this child. If not, `prepare_next` can make one later.
        isolated: Whether the child runs in bubblewrap; no template forks it then.
    """

    ASK_AGAIN_S = 0.05
    """Interval at which a child that has been asked to stop is asked again."""

    def __init__(
        self,
        program: Program,
        spec: RunSpec,
        field: FieldFiles,
        options: RunOptions,
        store: RunStore | TemporaryRun,
        of_many: bool = False,
        isolated: bool = False,
    ) -> None:
        self.program = program
        self.first_spec = spec
        self.field = field
        self.spec, self.plugged = spec, list[PluggedPart]()
        """The spec of the run with the parts that have been plugged in, and these parts."""
        self._options = options
        self._store = store
        self._run = run = store.create_run(
            program, spec, field.to_plain(), options.to_plain(), options.live
        )
        self.run_id = run.id
        self.number = run.number
        self.folder = run.folder
        self._copy_modules()
        self.ended: Ended | None = None
        self.started = False
        """Whether the child has reached the program's first line."""
        self.paused = False
        self.waiting_for_input: str | None = None
        self.waiting_for_reply = False
        self.wheels = Wheels()
        """The registers of the wheel motors; known once the run has ended, unless it was killed."""
        self.telemetry, self.output = open_views(self.folder, is_checked=True)
        self._unsent: list[Message] = []
        """Commands kept until the child listens: before, the signal that announces a command would kill the child."""
        self._stop_at: float | None = None
        self._asked_at = self._announced_at = 0.0
        self._look_at_s = time.monotonic() + LOOK_EVERY_S
        self._is_followed = not of_many
        """Whether the recording is checked once more after the end of the process; for short runs of batches it is
        not."""
        self._progress = (0, 0.0)
        self._stack_asked = False
        self._announced: Ended | None = None
        self.unstored = ""
        """Why the run or its end could not be stored; empty if both are stored."""
        # The lock is held until the end of the run is stored, so that nobody else removes the run before.
        self._lock_fd = os.dup(run.lock_fd)
        self._start(of_many=of_many, isolated=isolated)
        self._mark = mark(self._process.pid)
        self._clock = FairClock(self._process.pid)
        allowed = list_allowed_events(options, plugs=program.shown_ports is not None)
        self._events = EventStream(self._event_fd, allowed)
        writable: list[str | Path] = [run.folder, program.working_directory]
        self._quota = Quota(self._process.pid, writable) if isolated else None
        self._exceeded = self._falsified = ""
        """Which limit an isolated program has exceeded, and why the child's data cannot come from the simulation; empty
        if neither."""

    def _start(self, *, of_many: bool, isolated: bool) -> None:
        """Start the child process; `of_many` and `isolated` are the arguments of the class."""
        program = self.program
        run = self._run
        try:
            self._process, self._command_fd, self._event_fd, self._lifeline_fd = start_child(
                run.folder,
                run.lock_fd,
                program.working_directory,
                run.data,
                _build_template_key(program, self.first_spec, self.field),
                of_many,
                _list_needs(program, self.field) if isolated else None,
            )
        except OSError as error:
            os.close(self._lock_fd)
            self._store.forget(run.id)
            raise HostError(
                f"the program's process cannot be started: {error.strerror or error}",
                str(run.folder),
            ) from error

    def _copy_modules(self) -> None:
        if self.program.modules_from is None:
            return
        try:
            copy_modules(self.program.modules_from, self.folder)
        except LogError:
            os.close(self._run.lock_fd)
            self._store.forget(self.run_id)
            raise

    @property
    def answers(self) -> tuple[str, ...]:
        """Answers that the run's options give in advance to calls of `input()`."""
        return self._options.answers

    @property
    def actions(self) -> tuple[UserAction, ...]:
        """The user's actions so far.

        Raises:
            LogError: their file is damaged.
        """
        return read_actions(self.folder)[0]

    # Events

    def fileno(self) -> int:
        """Return the event pipe's descriptor, for `select` or an event loop."""
        return self._event_fd

    def pump(self) -> list[Message]:
        """Return the events that have arrived, without blocking; `Ended` comes once, as the last.

        It must be called regularly while the run is active. It also kills a child that does not stop, and one that
        sends or records something that the simulation never sends or records: such a run ends as falsified.
        """
        if self.ended is not None:
            return []
        # This is checked before reading: if the child has exited, all its events are in the pipe by now.
        exited = self._process.poll() is not None
        events = self._events.read()
        for event in events:
            match event:
                case Started():
                    self.started = True
                    unsent = self._unsent
                    self._unsent = []
                    for command in unsent:
                        self.send(command)
                case Paused():
                    self.paused = True
                case Resumed():
                    self.paused = False
                case InputWanted(prompt=prompt):
                    self.waiting_for_input = prompt
                case ReplyWanted():
                    self.waiting_for_reply = True
                case Plugged():
                    self._note_plugged(event)
                case Wheels():
                    self.wheels = event
                case Ended():
                    self._announced, self._announced_at = event, time.monotonic()
        now_s = time.monotonic()
        # A view with `holds` set reads new data only in this check, so it is checked each time.
        is_due = now_s >= self._look_at_s or self.telemetry.holds or self.output.holds
        if is_due or self._events.falsified or (exited and self._is_followed):
            self._look_for_falsified()
        if is_due:
            self._is_followed = True
            self._look_at_s = now_s + LOOK_EVERY_S
            self._check_quota()
            self._look_for_stall()
        self._repeat_stop()
        final = self._build_final_event(exited)
        kept = [event for event in events if not isinstance(event, Ended)]
        if final is None:
            return kept
        self._finish(final)
        return [*kept, final]

    def _note_plugged(self, event: Plugged) -> None:
        self.plugged.append(build_part(event))
        try:
            self.spec = add_plugged(self.first_spec, self.plugged)
            self._store.note_plugged(self._run, self.plugged)
        except RobotError as error:
            self._events.falsified = f"it plugged in a part that does not fit: {error.message}"
        except LogError as error:
            self.unstored = self._describe_damage(error)

    def _look_for_falsified(self) -> None:
        """Kill a child that has sent or recorded something that cannot come from the simulation."""
        # A folder that was deleted need not be checked: its run is stopped.
        if not self._falsified and self.folder.is_dir():
            damages = self.telemetry.read_new(), self.output.read_new()
            self._falsified = (
                self._events.falsified
                or next(filter(None, damages), "")
                or self._find_excess(self.telemetry)
            )
            if self._falsified:
                end_group(self._process.pid)

    def _check_quota(self) -> None:
        if self._quota is not None and not self._exceeded:
            self._exceeded = self._quota.exceeded(time.monotonic())
            if self._exceeded:
                end_group(self._process.pid)

    def _find_excess(self, telemetry: TelemetryView) -> str:
        """Return which limit the recording exceeds, such as `it has recorded more than 20 s`; empty if none."""
        with suppress(OSError):
            if (self.folder / LOG_FILE).stat().st_size > MAX_BYTES:
                return f"it has written more than {MAX_BYTES >> 20} MiB to {LOG_FILE}"
        limit_s = self._options.time_limit_s
        hz = self.spec.profile.tick_hz
        # The host reads the recording into memory, so a program must not make it larger than the run can.
        if limit_s and telemetry.count > (limit_s + _BEYOND_LIMIT_S) * hz:
            return f"it has recorded more than {limit_s:g} s"
        return ""

    def _build_final_event(self, exited: bool) -> Ended | None:
        if (
            self._announced is not None
            and not exited
            and time.monotonic() - self._announced_at > ENDED_CHILD_S
        ):
            end_group(self._process.pid)
        if not exited:
            return None
        falsified = self._falsified or (self._find_falsified() if self.folder.is_dir() else "")
        if self._announced is not None and not falsified and not self._exceeded:
            return self._announced
        tick = max(0, self.telemetry.count - 1)
        time_ns = compute_due_ns(tick, self.spec.profile.tick_hz)
        if falsified:
            return Ended(End.FALSIFIED, tick, time_ns, 1, describe_falsified(falsified))
        if self._exceeded:
            return Ended(End.OUTPUT_LIMIT, tick, time_ns, 1, self._exceeded)
        line = find_stuck_line(self.folder, self.program.file)
        if self._stop_at is not None:
            where = f" in line {line}, where it was stuck" if line else ""
            return Ended(End.STOPPED, tick, time_ns, summary=f"stopped{where}", error_line=line)
        if self._stack_asked:
            where = f" in line {line}" if line else ""
            summary = f"stuck{where}: no simulated time passed"
            return Ended(End.STALLED, tick, time_ns, 1, summary, error_line=line)
        status = self._process.wait()
        return Ended(
            End.CRASHED, tick, time_ns, 1, describe_end(status, self.folder, line), error_line=line
        )

    def _find_falsified(self) -> str:
        """Return why the files of an ended run cannot all come from the simulation; an empty text if they can."""
        end = self._announced
        # A run that could not begin, or had no space on the disk, may have incomplete files.
        is_whole = end is not None and end.end not in (End.CRASHED, End.DISK_FULL)
        # New views read the files as anyone does who opens the run later: they may differ from what was read before.
        telemetry, output = open_views(self.folder, is_checked=True)
        # Reading each file once is enough, because the process has ended.
        damages = telemetry.hold(), output.hold()
        if wrong := next(filter(None, damages), "") or self._find_excess(telemetry):
            return wrong
        for view in (telemetry, output) if is_whole else ():
            if view.note or view.is_missing:
                return view.note or "a part of it was deleted"
        ticks = telemetry.count
        if is_whole and end is not None and end.tick != ticks - 1:
            return (
                f"it ends at tick {end.tick}, but {counted(ticks, 'tick is', 'ticks are')} recorded"
            )
        hz = self.spec.profile.tick_hz
        if (
            is_whole
            and end is not None
            and not compute_due_ns(end.tick, hz) <= end.time_ns <= compute_due_ns(end.tick + 1, hz)
        ):
            return f"its end at tick {end.tick} has another time"
        try:
            read_actions(self.folder)
            read_stop_tick(self.folder)
        except LogError as error:
            return error.message.replace(f"{self.folder}{os.sep}", "")
        return ""

    def _finish(self, final: Ended) -> None:
        self.ended = final
        self.paused = False
        self.waiting_for_input = None
        self.waiting_for_reply = False
        for fd in (self._event_fd, self._command_fd, self._lifeline_fd):
            os.close(fd)
        end_descendants(self._process.pid, self._mark)
        for name in (LOG_FILE, STACK_FILE):
            path = self.folder / name
            # The folder may be deleted by another process at this time.
            with suppress(OSError):
                if not path.stat().st_size:
                    path.unlink()
        try:
            self._store.finish(self._run, final)
        except LogError as error:
            self.unstored = self._describe_damage(error)
            summary = f"{final.summary}; its end" if final.summary else "its end"
            self.ended = replace(final, summary=f"{summary} cannot be stored: {self.unstored}")
        finally:
            os.close(self._lock_fd)

    def stored(self) -> StoredRun:
        """Return the run as it is stored.

        The result has the run's end, even if the end could not be written to the run folder.

        Raises:
            LogError: it no longer exists, or is damaged.
        """
        try:
            run = self._store.load_run(self.folder)
        except LogError as error:
            self.unstored = self._describe_damage(error)
            raise
        if run.end is None and self.ended is not None:
            return replace(run, end=self.ended)
        return run

    def _describe_damage(self, error: LogError) -> str:
        # If `run.json` is missing, the folder is being deleted, which is the reason for the error.
        return (
            str(error)
            if (self.folder / RUN_FILE).exists()
            else "its folder was deleted while it ran"
        )

    def wait(self, timeout_s: float | None = None) -> Ended | None:
        """Block until the run is over.

        Returns:
            How it ended; None if it is still running after `timeout_s`.
        """
        until = None if timeout_s is None else time.monotonic() + timeout_s
        while self.ended is None:
            now = time.monotonic()
            rest = WAIT_S if self._stop_at is None else RunHandle.ASK_AGAIN_S
            if until is not None:
                rest = min(rest, until - now)
            if rest <= 0:
                break
            if (
                self._stop_at is not None
                and (left := self._stop_at + STUCK_AFTER_S - self._clock.read_s()) > 0
            ):
                # Wait no longer than until a stuck child has to be killed.
                rest = min(rest, left)
            self.wait_for_event(rest)
            self.pump()
        return self.ended

    def wait_for_event(self, timeout_s: float) -> None:
        """Block until the child sends an event, exits, or the timeout is over."""
        if self._events.at_end:
            try:
                self._process.wait(timeout_s)
            except subprocess.TimeoutExpired:
                return
        else:
            is_readable(self._event_fd, timeout_s)

    # Commands

    def send(self, command: Message) -> None:
        """Send a command to the child; after the end of the run it is ignored.

        Raises:
            ConfigError: the command sets a breakpoint that is invalid.
        """
        if isinstance(command, SetBreaks):
            # Invalid breakpoints are rejected here, because the child could not report them to the user.
            parse_breakpoints(command.breaks)
        if self.ended is not None or self._announced is not None:
            return
        if not self.started:
            self._unsent.append(command)
            return
        match command:
            case Answer():
                self.waiting_for_input = None
            case Reply():
                self.waiting_for_reply = False
            case _ if not self._options.can_pause:
                # The command may pause a run that could not pause so far: accept a debugger's events from now on.
                self._events.allow(DEBUGGED)
        # If the command cannot be written completely, the child has ended or is stuck: `pump` handles that.
        if write_command(self._command_fd, command.encode()):
            self._send_signal(COMMAND_SIGNAL)

    def stop(self) -> None:
        """Ask the program to stop; if it does not, `pump` or `wait` kill its process."""
        if self._stop_at is None:
            self._stop_at = self._clock.read_s()
        self._asked_at = time.monotonic()
        self.send(Stop())

    def kill(self) -> None:
        """Kill the child immediately; what it has recorded is kept."""
        if self._stop_at is None:
            self._stop_at = self._clock.read_s()
        end_group(self._process.pid)

    def prepare_next(self) -> None:
        """Prepare a template for later runs of this robot and world, which then start sooner. Does not block."""
        prepare_template(
            _build_template_key(self.program, self.first_spec, self.field),
            self.folder,
            self._run.data,
        )

    def close(self) -> None:
        """Make sure that the child has ended, and that the end of the run is recorded."""
        if self.ended is None:
            self.kill()
            self._process.wait()
            while self.ended is None:
                self.pump()

    def _repeat_stop(self) -> None:
        """Send the request to stop again if the program has not stopped; if that takes too long, kill the child.

        If the run folder was deleted, request the stop.
        """
        if self._announced is not None:
            return
        if self._stop_at is None and not self.folder.is_dir():
            # The folder was deleted while the run goes on: nobody can see its results, so the run is stopped.
            self.stop()
        if self._stop_at is not None:
            if self._clock.read_s() - self._stop_at > STUCK_AFTER_S:
                self._read_stack_and_kill()
            elif self.started and time.monotonic() - self._asked_at > RunHandle.ASK_AGAIN_S:
                self._asked_at = time.monotonic()
                self._send_signal(COMMAND_SIGNAL)

    def _look_for_stall(self) -> None:
        """Kill the child if it has recorded no tick for too long."""
        if (
            self._announced is not None
            or self._stop_at is not None
            or not self._options.stall_limit_s
            or self.paused
        ):
            return
        tick = self.telemetry.count
        now = self._clock.read_s()
        if (
            tick != self._progress[0]
            or self.waiting_for_reply
            or self.waiting_for_input is not None
        ):
            self._progress = (tick, now)
        elif now - self._progress[1] > STALL_FACTOR * self._options.stall_limit_s:
            self._read_stack_and_kill()

    @property
    def time_used_s(self) -> float:
        """Real seconds since the start of the child, without those in which the child waited for a processor."""
        return self._clock.read_s()

    def _read_stack_and_kill(self) -> None:
        if not self._stack_asked:
            # At this signal, `faulthandler` writes the stack even during a call of C code.
            self._stack_asked = self._stop_at is None
            self._send_signal(STACK_SIGNAL)
            await_stack(self.folder, self._process.pid)
        end_group(self._process.pid)

    def _send_signal(self, number: int) -> None:
        if self._process.poll() is None:
            self._process.send_signal(number)


def describe_falsified(what: str) -> str:
    """Return the summary of a run whose program has falsified its recording.

    `what` names in words the part of the recording that cannot come from the simulation.
    """
    return f"the program has falsified its recording: {what}"


def start_run(
    program: Program, spec: RunSpec, options: RunOptions, store: RunStore | None = None
) -> RunHandle:
    """Start a program, and store its run. Does not block.

    Args:
        program: The program.
        spec: The run.
        options: How the run is executed.
        store: Where the run is stored; None for the user's store.

    Returns:
        The control of the run.

    Raises:
        BackgroundError: the mat does not exist.
        LogError: the run cannot be stored.
    """
    parse_breakpoints(options.breaks, spec)
    return RunHandle(
        program.add_surroundings(), spec, field_files(spec), options, store or RunStore()
    )
