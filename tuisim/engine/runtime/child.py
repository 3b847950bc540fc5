"""The child process of a run: its parts, and how they are connected."""

from __future__ import annotations

from tuisim.engine.runtime import wallclock  # isort: skip - must come first: it saves the real clock

import faulthandler
import fcntl
import os
import signal
import sys
import types
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from tuisim.base.atomic import private
from tuisim.base.source import Program
from tuisim.engine import protocol
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.simulation import Turn, build_simulation
from tuisim.engine.core.tick_record import NoRecording
from tuisim.engine.protocol import COMMAND_SIGNAL, STACK_SIGNAL, End
from tuisim.engine.runs.brick_state import build_motors_row
from tuisim.engine.runs.command_records import CommandsWriter
from tuisim.engine.runs.motor_records import MotorsWriter
from tuisim.engine.runs.readings import ReadingsWriter
from tuisim.engine.runs.records import (
    COMMANDS_FILE,
    MOTORS_FILE,
    OUTPUT_FILE,
    READINGS_FILE,
    TELEMETRY_FILE,
    MappedWriter,
    OutputWriter,
    Stream,
    TelemetryWriter,
    is_full,
)
from tuisim.engine.runs.side_files import STACK_FILE
from tuisim.engine.runtime.channel import Channel
from tuisim.engine.runtime.control import ATTENTION, STOPPING, RunControl
from tuisim.engine.runtime.loader import compile_program
from tuisim.engine.runtime.modules import remember_source
from tuisim.engine.runtime.output import OutputRecorder
from tuisim.engine.runtime.patches.clock import (
    finish_pandas,
    finish_resource,
    loop_hook,
    patch_datetime,
    patch_process_times,
    patch_time,
)
from tuisim.engine.runtime.patches.file_reads import FileReads
from tuisim.engine.runtime.patches.file_waits import FileWaits
from tuisim.engine.runtime.patches.randomness import finish_random, finish_uuid, patch_urandom
from tuisim.engine.runtime.patches.replacement import PatchedModules, replace
from tuisim.engine.runtime.run_config import RunConfig, derive_config, read_config
from tuisim.engine.runtime.scheduler import STACK_BYTES, limit_memory, refuse_processes
from tuisim.engine.runtime.session import RunLimits, Session
from tuisim.engine.runtime.stack import PACKAGE_FOLDER, finish_inspect, finish_traceback
from tuisim.engine.runtime.tracebacks import own_files

if TYPE_CHECKING:
    from tuisim.engine.core.commands.calls import Call
    from tuisim.engine.runtime.debugger.debugger import Debugger
    from tuisim.engine.runtime.program import ProgramRunner
    from tuisim.engine.runtime.scheduler import Scheduler

MAX_KNOWN = 8
MAX_CHARACTERS = 1 << 16
MAX_CPU_S = 1.0
"""CPU time of one compilation: if it takes longer, this process ends, and later runs are started as new processes."""
SPARE_FRAMES = 100
"""A program is compiled with this many frames less, so that the process of a run can compile it, too."""


class KnownPrograms:
    """A cache of the compiled code of programs, for programs that are run more than once.

    It has no code for a program that runs for the first time, or whose compilation gives an error or a warning: then
    the process of the run compiles the program itself, and reports the error.
    """

    def __init__(self) -> None:
        self._seen: set[tuple[str, str, bool]] = set()
        self._codes: dict[tuple[str, str, bool], types.CodeType | None] = {}

    def code(self, program: Program, drops_annotations: bool) -> types.CodeType | None:
        """Return the code of a program that is about to be run; None if the process of the run has to compile it.

        Args:
            program: The program.
            drops_annotations: Whether annotations are left out, not evaluated.
        """
        key = program.text, program.file, drops_annotations
        if len(program.text) > MAX_CHARACTERS:
            return None
        if key not in self._seen:
            if len(self._seen) >= MAX_KNOWN:
                self._seen.clear()
                self._codes.clear()
            self._seen.add(key)
            return None
        if key not in self._codes:
            self._codes[key] = _compile(*key)
        return self._codes[key]


def _compile(text: str, file: str, drops_annotations: bool) -> types.CodeType | None:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(before - SPARE_FRAMES)
    wallclock.set_timer(signal.ITIMER_VIRTUAL, MAX_CPU_S)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return compile_program(text, file, drops_annotations)
    except Exception:  # any error is reported by the program's own process
        return None
    finally:
        wallclock.set_timer(signal.ITIMER_VIRTUAL, 0.0)
        sys.setrecursionlimit(before)


# A handler of a signal may raise only in the program's own code. Inside the runtime it only sets a
# bit, so that core code is never unwound halfway; the frames show whose code is running.

RAISE_AGAIN_AFTER_S, RAISE_AGAIN_EVERY_S = 0.2, 0.02
LEFT_TO_OTHERS_S = 0.1
"""Real time in which the running thread can process a command before the waiting main thread does."""
STALL_LOOK_S = 1.0

# The real functions are stored here, because `faulthandler` gets other functions for the program.
_enable = faulthandler.enable
_register = faulthandler.register


def die_with_host(lifeline_fd: int) -> None:
    """Make the kernel kill this process and its group when the host ends, even during a long call of C code.

    Args:
        lifeline_fd: Read end of a pipe that nothing is ever written to. When the host ends, the pipe closes and the
            kernel sends SIGIO, whose default action is to kill.
    """
    fcntl.fcntl(lifeline_fd, fcntl.F_SETOWN, -os.getpgrp())
    fcntl.fcntl(lifeline_fd, fcntl.F_SETFL, fcntl.fcntl(lifeline_fd, fcntl.F_GETFL) | os.O_ASYNC)
    if wallclock.select_files([lifeline_fd], [], [], 0)[0]:
        # The host ended before the signal was requested.
        wallclock.exit_process(1)


class Interrupts:
    """The signal handlers of one run, through which the host reaches a program that is computing, such as to stop it.

    Args:
        session: The run.
        soft_codes: The functions of tuisim, as code objects, in which a signal handler may raise an exception. In all
            other functions of tuisim it must not.
    """

    def __init__(self, session: Session, soft_codes: frozenset[types.CodeType]) -> None:
        self._session = session
        self._soft_codes = soft_codes
        self._timer_on = False
        self._removed = False
        self.main_is_parked = False
        """Whether the main thread waits for its turn, where a handler may raise an exception."""
        self._stall_now, self._stall_s = -1, 0.0

    def install(self, folder: Path) -> None:
        """Install the signal handlers.

        Args:
            folder: Run folder; a signal writes the stack there, even during a long call of C code.
        """
        stack_fd = private(f"{folder}{os.sep}{STACK_FILE}", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        # The stack at a crash, such as by SIGSEGV, is written to the same file.
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
        """Disable the signal handlers at the end of the program.

        Any thread may call this. It does not remove the handlers, because only the main thread could.
        """
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
            # The thread that is running processes the command when it next checks; a thread that computes without end
            # never does, so the main thread processes the command after a while.
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
        """Return whether a signal handler that interrupts this frame may raise an exception in it.

        It may in code of the program, in code of a library that the program called, and while the program waits for
        simulated time. It must not in tuisim's own code, or if there is no frame.
        """
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


LOOP_TURNS = 500
LOOP_COST_NS = 5_000_000
"""Cost of `LOOP_TURNS` loop iterations in which no time passed."""


def main(arguments: list[str], prepared: Child | None = None) -> NoReturn:
    """Run the program that a run folder describes, then end the process.

    Args:
        arguments: The run folder; descriptors of the commands, the events, the lifeline, the lock of the folder and, of
            an isolated child, the files of `RawOutput`.
        prepared: The child, if it has been prepared already.
    """
    command_fd, event_fd, lifeline_fd, lock_fd, *raw_fds = map(int, arguments[1:])
    # The folder stays locked as long as this process or one that it forks lives.
    os.set_inheritable(lock_fd, False)
    die_with_host(lifeline_fd)
    channel = Channel(command_fd, event_fd)
    try:
        child = Child(read_config(Path(arguments[0]))) if prepared is None else prepared
        child.connect(channel, raw_fds)
    except OSError as error:
        for name in (TELEMETRY_FILE, OUTPUT_FILE, READINGS_FILE, MOTORS_FILE, COMMANDS_FILE):
            Path(arguments[0], name).unlink(missing_ok=True)
        end = protocol.End.DISK_FULL
        summary = _build_memory_error(error)
        if not is_full(error):
            end = protocol.End.CRASHED
            summary = f"the run cannot start: {error.strerror or error}"
        channel.send(protocol.Ended(end, 0, 0, 1, summary))
        wallclock.exit_process(0)
    child.run()


def _build_memory_error(error: OSError) -> str:
    return f"the recording cannot grow: {error.strerror}"


class Child:
    """One run with all its parts: first prepared for a robot in a world, then connected to a run folder and the host.

    Args:
        config: The configuration of the run, or of another run of this robot in this world; `expect` then sets the
            rest.
    """

    def __init__(self, config: RunConfig) -> None:
        self._config = config
        self._sim = build_simulation(config.spec, NoRecording())
        self._early_commands: list[tuple[int, int, Call, tuple[float, ...]]] = []
        """The commands of the prelude."""
        self._sim.on_command = lambda *command: self._early_commands.append(command)
        self._output = OutputRecorder()
        mat = config.field.open_field(has_floor=config.spec.world.is_open)
        self._session = session = Session(self._sim, mat, self._output)
        turn = loop_hook(session, LOOP_TURNS, LOOP_COST_NS)
        self._interrupts = Interrupts(session, frozenset({turn.__code__}))
        self._patch_modules(turn)
        self._runner.prepare(config.program.prelude)
        self._known_programs = KnownPrograms()

    def expect(self, folder: Path, changes: Mapping[str, Any]) -> None:
        """Set the configuration of the next run, and compile its program if an earlier run had the same one.

        Args:
            folder: The run folder.
            changes: What differs from the configuration before, as the host sends it; see `derive_config`.
        """
        self._config = config = derive_config(self._config, folder, changes)
        drops_annotations = config.spec.profile.motor_law.library.drops_annotations
        self._runner.code = self._known_programs.code(config.program, drops_annotations)

    def _patch_modules(self, turn: Callable[[], None]) -> None:
        """Replace functions of Python's modules, and create the objects that run the program.

        `turn` is the function that the program calls at the start of each loop body.
        """
        # Imported here: threads must be patched before anything else imports `threading`.
        from tuisim.engine.runtime.patches.signals import patch_signals
        from tuisim.engine.runtime.patches.threads import patch_threads
        from tuisim.engine.runtime.program import ProgramOutcome, ProgramRunner
        from tuisim.engine.runtime.scheduler import Scheduler
        from tuisim.engine.shim.files.open_files import OpenFiles
        from tuisim.engine.shim.install import install

        session = self._session
        interrupts = self._interrupts
        scheduler = Scheduler(session, lambda parked: setattr(interrupts, "main_is_parked", parked))
        patch_time(session)
        patch_datetime(session, lambda: self._config.own_folder)
        patch_process_times(session)
        patch_urandom(lambda: self._config.spec.seed)
        files = OpenFiles()
        waits = FileWaits(session, files)
        waits.patch_select()
        refuse_processes()
        patch_threads(scheduler, lambda *ended: self._runner.hooks.show_end_of_bare_thread(*ended))
        patch_signals(session, scheduler)
        wallclock.stack_size(STACK_BYTES)
        limit_memory()
        install(
            session,
            files,
            {
                "pandas": lambda module: finish_pandas(session, module),
                "random": lambda module: finish_random(self._config.spec.seed, module),
                "traceback": finish_traceback,
                "ctypes": lambda module: self._runner.raw.finish_ctypes(module),
                "inspect": finish_inspect,
                "resource": lambda module: finish_resource(session, module),
                "selectors": waits.finish_selectors,
                "socket": waits.finish_socket,
                "uuid": lambda module: finish_uuid(self._config.spec.seed, module),
            },
            replace,
            lambda file: own_files(session.program_file)(file),
        )
        sys.meta_path.insert(0, PatchedModules())
        self._reads = FileReads()
        self._reads.patch()

        def leave(outcome: ProgramOutcome) -> NoReturn:
            interrupts.remove()
            self._end(
                outcome.end, outcome.exit_code, outcome.summary, outcome.error, outcome.error_line
            )

        self._leave = leave
        self._runner = ProgramRunner(session, self._output, scheduler, turn, leave)
        session.make_debugger = lambda: _build_debugger(session, scheduler, self._runner)

    def connect(self, channel: Channel, raw_fds: Sequence[int] = ()) -> None:
        """Create the recording of the run, and connect all parts of the run to it.

        Args:
            channel: Pipes to the host.
            raw_fds: Files of `RawOutput` that the host has created.

        Raises:
            OSError: there is no space for the recording.
        """
        self._channel = channel
        config = self._config
        options = config.options
        self._pid = wallclock.getpid()
        session = self._session
        self._telemetry, self._output.writer = (
            TelemetryWriter(config.folder),
            OutputWriter(config.folder),
        )
        session.readings = ReadingsWriter(config.folder)
        self._motors = MotorsWriter(config.folder, config.spec.robot) if self._sim.notices else None
        self._sim.restart(config.spec, self._telemetry, self._motors)
        self._record_commands()
        steering = RunControl(
            channel,
            config.folder,
            options.live,
            options.speed,
            options.start_paused,
            options.actions,
        )
        limits = RunLimits(int(options.time_limit_s * NS_PER_S), options.stall_limit_s)
        session.connect(channel, steering, limits, config.program.file)
        session.replies = options.replies
        session.shown_ports = config.program.shown_ports
        self._stop_when_full(
            *(self._telemetry, self._motors, self._output.writer, session.readings, self._commands)
        )
        self._output.place = lambda: (self._sim.tick, session.now, session.program_line(3))
        self._output.after_write = self._handle_write
        self._sim.on_turns = self._write_turns
        remember_source(session.program_file, config.program.text)
        self._runner.connect(config)
        self._reads.begin(config.folder, config.own_folder, session.program_file)
        self._runner.raw.open(raw_fds)
        self._output.drain = self._runner.raw.drain

    def _record_commands(self) -> None:
        """Begin to record the commands that the robot gets.

        The record begins with those that were given earlier, while the predefined names such as `tank_drive` were
        created.
        """
        self._commands = CommandsWriter(self._config.folder)
        for command in self._early_commands:
            self._commands.add(*command)
        self._sim.on_command = self._commands.add

    def _stop_when_full(self, *writers: MappedWriter | None) -> None:
        """Make the run stop when one of its recordings finds no space on the disk."""
        for writer in filter(None, writers):
            writer.full = lambda error: self._session.request_stop(
                protocol.End.DISK_FULL, _build_memory_error(error)
            )

    def _write_turns(self, turns: tuple[Turn, ...]) -> None:
        sim = self._sim
        # The time is that of the tick, not the session's: in a paced run, the session's time advances in smaller steps.
        self._output.write_row(
            build_motors_row(turns), Stream.MOTORS, sim.tick, sim.compute_due_ns(sim.tick), sim.line
        )

    def _handle_write(self) -> None:
        if self._session.flags & (ATTENTION | STOPPING):
            self._session.check_stop()

    def run(self) -> NoReturn:
        """Run the program and end the process."""
        self._interrupts.install(self._config.folder)
        self._channel.send(protocol.Started(protocol.PROTOCOL_VERSION, os.getpid()))
        self._leave(self._runner.run())

    def _end(
        self, end: protocol.End, exit_code: int, summary: str, error: str, error_line: int
    ) -> NoReturn:
        if wallclock.getpid() != self._pid:
            # C code of the program has forked this copy of the process: only the original records and reports.
            wallclock.exit_process(0)
        self._telemetry.close()
        if self._motors is not None:
            self._motors.close(self._telemetry.count)
        self._output.writer.close()
        self._session.readings.close()
        self._commands.close()
        self._channel.send(protocol.Wheels(*(read() for read in self._session.wheel_registers)))
        self._reads.end()
        self._channel.send(
            protocol.Ended(
                end, self._sim.tick, self._session.now, exit_code, summary, error, error_line
            )
        )
        wallclock.exit_process(0)


def _build_debugger(session: Session, scheduler: Scheduler, runner: ProgramRunner) -> Debugger:
    from tuisim.engine.runtime.debugger.debugger import Debugger

    return Debugger(session, scheduler, runner.names, runner.prepared, runner.code)
