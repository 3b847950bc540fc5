"""The child process of a run: its parts, and how they are connected."""

from __future__ import annotations

from tuisim.engine.runtime import wallclock  # isort: skip - must come first: it saves the real clock

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from tuisim.engine import protocol
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.simulation import Turn, build_simulation
from tuisim.engine.core.tick_record import NoRecording
from tuisim.engine.mat_cache import open_field
from tuisim.engine.runs.brick_state import build_motors_row
from tuisim.engine.runs.command_records import CommandsWriter
from tuisim.engine.runs.motor_records import MotorsWriter
from tuisim.engine.runs.readings import ReadingsWriter
from tuisim.engine.runs.records import (
    OUTPUT_FILE,
    TELEMETRY_FILE,
    MappedWriter,
    OutputWriter,
    Stream,
    TelemetryWriter,
    is_full,
)
from tuisim.engine.runs.side_files import COMMANDS_FILE, MOTORS_FILE, READINGS_FILE
from tuisim.engine.runtime.channel import Channel
from tuisim.engine.runtime.control import ATTENTION, STOPPING, RunControl
from tuisim.engine.runtime.interrupts import Interrupts, die_with_host
from tuisim.engine.runtime.known_programs import KnownPrograms
from tuisim.engine.runtime.limits import STACK_BYTES, limit_memory, refuse_processes
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
from tuisim.engine.runtime.session import RunLimits, Session
from tuisim.engine.runtime.stack import finish_inspect, finish_traceback
from tuisim.engine.runtime.tracebacks import own_files

if TYPE_CHECKING:
    from tuisim.engine.core.commands.calls import Call
    from tuisim.engine.runtime.debugger.debugger import Debugger
    from tuisim.engine.runtime.program import ProgramRunner
    from tuisim.engine.runtime.scheduler import Scheduler

LOOP_TURNS = 500
LOOP_COST_NS = 5_000_000
"""Cost of `LOOP_TURNS` loop iterations in which no time passed."""


def main(arguments: list[str], prepared: Child | None = None) -> NoReturn:
    """Run the program that a run folder describes, then end the process.

    Args:
        arguments: The run folder; descriptors of the commands, the events, the lifeline, the lock of the folder
            and, of an isolated child, the files of `RawOutput`.
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
    """One run with all its parts: prepared for a robot in a world, then connected with the run.

    Args:
        config: The run, or another one that differs at most in what `expect` changes.
    """

    def __init__(self, config: RunConfig) -> None:
        self._config = config
        self._sim = build_simulation(config.spec, NoRecording())
        self._early_commands: list[tuple[int, int, Call, tuple[float, ...]]] = []
        """The commands of the prelude."""
        self._sim.on_command = lambda *command: self._early_commands.append(command)
        self._output = OutputRecorder()
        mat = open_field(config.field, has_floor=config.spec.world.is_open)
        self._session = session = Session(self._sim, mat, self._output)
        turn = loop_hook(session, LOOP_TURNS, LOOP_COST_NS)
        self._interrupts = Interrupts(session, frozenset({turn.__code__}))
        self._patch_modules(turn)
        self._runner.prepare(config.program.prelude)
        self._known_programs = KnownPrograms()

    def expect(self, folder: Path, changes: Mapping[str, Any]) -> None:
        """Prepare for a run without executing anything of its program; arguments as of `derive_config`."""
        self._config = config = derive_config(self._config, folder, changes)
        drops_annotations = config.spec.profile.motor_law.library.drops_annotations
        self._runner.code = self._known_programs.code(config.program, drops_annotations)

    def _patch_modules(self, turn: Callable[[], None]) -> None:
        """Replace functions of Python's modules, and make the objects that run the program."""
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
        """Create the recording of the run, and connect all parts with it.

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
        """Record the program's commands from now on, and those that the prelude has given."""
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
        # Not at the session's time: in a paced run it advances in smaller steps.
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
            # This is a copy that the program has forked below Python: only the original records and reports.
            wallclock.exit_process(0)
        self._telemetry.close()
        if self._motors is not None:
            self._motors.close(self._telemetry.count)
        self._output.close()
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
