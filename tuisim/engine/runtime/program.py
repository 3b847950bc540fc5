"""Runs the program: its streams, its input, its module, and how it ends."""

from __future__ import annotations

import atexit
import builtins
import gc
import io
import operator
import os
import signal
import sys
import types
from collections.abc import Callable, Collection
from contextlib import suppress
from dataclasses import replace as replace_fields
from typing import Any, NoReturn

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, NotSimulated
from tuisim.engine.brick_home import HOME, find_beside, parts_in_home, place_folder
from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import NO_ANSWER, Answer, End, InputWanted
from tuisim.engine.runs.records import Stream
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.hooks import ErrorHooks, flush_streams, format_safely
from tuisim.engine.runtime.loader import LOOP_HOOK, MissingPart, compile_prelude, compile_program
from tuisim.engine.runtime.modules import install_finder
from tuisim.engine.runtime.output import LineStream, OutputRecorder
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.raw_output import RawOutput
from tuisim.engine.runtime.run_config import RunConfig
from tuisim.engine.runtime.scheduler import Scheduler
from tuisim.engine.runtime.session import Deadlock, Session, StopProgram
from tuisim.engine.runtime.stack import patch_faulthandler
from tuisim.engine.runtime.tracebacks import find_line
from tuisim.engine.shim.waits import Wait, waits_for

_FILE_CALLS = ("open", "stat", "lstat", "access", "mkdir", "rmdir", "remove", "unlink")
_TWO_FILE_CALLS = ("rename", "replace")
_FOLDER_CALLS = ("listdir", "scandir", "chdir")
"""Functions of `os` that take the path of a folder; for a missing one they use the program's folder."""


class HomeFolder:
    """The replacement of functions that take paths: files of the brick's home folder are looked for beside the program.

    Args:
        own_folder: Returns the folder of the program.
    """

    def __init__(self, own_folder: Callable[[], str]) -> None:
        self._own_folder = own_folder

    def patch(self) -> None:
        """Replace Python's functions that take paths, so that they find files of the brick's home folder."""
        self._wrap(builtins, "open", self._find_file)
        vars(io)["open"] = builtins.open
        for name in _FILE_CALLS:
            self._wrap(os, name, self._find_file)
        for name in _TWO_FILE_CALLS:
            self._wrap(os, name, self._find_file, paths=2)
        for name in _FOLDER_CALLS:
            self._wrap(os, name, self._find_folder)

    @staticmethod
    def _wrap(module: Any, name: str, moved: Callable[[Any], Any], paths: int = 1) -> None:
        real = getattr(module, name)

        def call(*given: Any, **named: Any) -> Any:
            return real(*map(moved, given[:paths]), *given[paths:], **named)

        replace(module, name, call)

    def _find_file(self, path: Any) -> Any:
        """Return the path on this computer for a path in the brick's home folder; return any other path unchanged.

        If the file is missing, the result is a path in the program's folder.
        """
        if not (text := _parse_home_path(path)):
            return path
        own_folder = self._own_folder()
        if (parts := parts_in_home(text, own_folder)) is None:
            return path
        if known := find_beside(parts, own_folder):
            return known
        for first in range(len(parts) - 1):
            if os.path.isdir(folder := os.path.join(own_folder, *parts[first:-1])):
                return os.path.join(folder, parts[-1])
        return os.path.join(own_folder, parts[-1])

    def _find_folder(self, path: Any) -> Any:
        """Return the folder on this computer for a path in the brick's home folder; return any other path unchanged.

        If the folder is missing, the result is the program's folder.
        """
        return place_folder(text, self._own_folder()) if (text := _parse_home_path(path)) else path


def _parse_home_path(path: Any) -> str:
    """Return a path in the brick's home folder as text; empty for any other path, and for a descriptor."""
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    return text if isinstance(text, str) and text.startswith(HOME) else ""


# At the end of a program, a brick's driver goes on with moves that have an end, and the wheels come to rest.

MAX_REST_NS = NS_PER_S // 2
"""How long wheels may take to come to rest, in ns."""


def finish_moves(session: Session) -> str:
    """Run until all moves to a position or for a time have ended; then let the wheels come to rest.

    If a motor is still set to turn, which would never end, do not wait for the wheels.

    Returns:
        A text that names the motors that are still set to turn, such as `ended while outB was still set to turn`; empty
            if there are none.

    Raises:
        StopProgram: the time limit is reached, or the user stops the run.
    """
    sim = session.sim
    motors = {
        port: motor
        for port, motor in sim.motors_by_port.items()
        if isinstance(motor, SimulatedMotor)
    }
    if any(motor.ends_alone for motor in motors.values()):
        sim.line = 0
    while any(motor.ends_alone for motor in motors.values()):
        # The clock is advanced directly, without the scheduler, because the program's threads have ended.
        session.advance(session.now + NS_PER_S, True)
    turning = sorted(port for port, motor in motors.items() if motor.mode and motor.aim_dps)
    if not turning:
        _let_rest(session, motors.values())
        return ""
    *others, last = turning
    ports = f"{', '.join(others)} and {last}" if others else last
    return f"ended while {ports} {'were' if others else 'was'} still set to turn"


def _let_rest(session: Session, motors: Collection[SimulatedMotor]) -> None:
    """Run until all wheels have come to rest, at most for `MAX_REST_NS` or until the time limit.

    Args:
        session: The run.
        motors: The motors whose wheels must come to rest.
    """
    if all(motor.axle.stands for motor in motors):
        return
    end_ns = min(session.now + MAX_REST_NS, session.limits.time_ns or 1 << 62)
    while session.now < end_ns and not all(motor.resting for motor in motors):
        session.sim.line = 0
        session.advance(min(session.sim.compute_due_ns(session.sim.tick + 1), end_ns), True)


@dataclass(frozen=True, slots=True)
class ProgramOutcome:
    """How the program ended; fields as in `engine.protocol.Ended`."""

    end: End
    exit_code: int = 0
    summary: str = ""
    error: str = ""
    error_line: int = 0


_INTERRUPTED = 128 + signal.SIGINT
"""Exit status that a shell reports for a program that an interrupt has ended."""


def _has_finalizer(value: object) -> bool:
    """Return whether deleting a value runs code of the program."""
    words = hasattr(type(value), "__del__") or isinstance(
        value, types.GeneratorType | types.CoroutineType
    )
    return words and not isinstance(value, io.IOBase)


def _is_data(value: object) -> bool:
    """Return whether a value is data, such as a number or a list, and not code or an open file."""
    return not isinstance(
        value, types.ModuleType | types.FunctionType | types.BuiltinFunctionType | type | io.IOBase
    )


def _add(outcome: ProgramOutcome, words: str) -> ProgramOutcome:
    """Return an outcome with words added to its summary, after a semicolon; without words, an equal outcome."""
    return replace_fields(outcome, summary="; ".join(filter(None, (outcome.summary, words))))


def _add_caught(outcome: ProgramOutcome) -> ProgramOutcome:
    """Return an outcome whose summary also names the first NotSimulated error, if the program has caught one.

    Only the outcomes of programs that have finished, or reached their time limit, are changed.
    """
    if not NotSimulated.first or outcome.end not in (End.FINISHED, End.TIME_LIMIT):
        return outcome
    return _add(outcome, f"caught NotSimulated: {NotSimulated.first}")


class ProgramRunner:
    """The part of the child process that runs the program, with its predefined names, its streams and its end.

    Args:
        session: The program's clock.
        output: Receives the program's lines.
        scheduler: The program's threads.
        loop_hook: Called at the start of each loop body.
        leave: Ends the process immediately, with an outcome.
    """

    def __init__(
        self,
        session: Session,
        output: OutputRecorder,
        scheduler: Scheduler,
        loop_hook: Callable[[], None],
        leave: Callable[[ProgramOutcome], NoReturn],
    ) -> None:
        self._session = session
        self._output = output
        self._scheduler = scheduler
        self._leave = leave
        self.stdout, self.stderr = LineStream(output), LineStream(output, Stream.STDERR)
        self.raw = RawOutput(self.stdout.buffer.put, self.stderr.buffer.put)
        self.hooks = ErrorHooks(session, output, self.stderr, lambda: self._config.program.text)
        self._module = types.ModuleType("__main__")
        self._prelude_error: BaseException | None = None
        self.prepared: dict[str, int] = {}
        """Identities of the objects that the prelude has created, by name."""
        self.code: types.CodeType | None = None
        """The program; None before it is compiled."""
        self.names = self._module.__dict__
        """The program's global names."""
        output.names = lambda: self.names
        self._loop_hook = loop_hook

    def prepare(self, prelude: str) -> None:
        """Prepare for any program: replace streams and functions, and run a prelude, which makes the predefined names.

        `prelude` is its name.
        """
        vars(builtins)[LOOP_HOOK] = self._loop_hook
        self._patch()
        vars(self._module)["__builtins__"] = builtins
        sys.modules["__main__"] = self._module
        # The calls of the prelude take no simulated time.
        self._session.free += 1
        try:
            self._run_prelude(prelude)
        except BaseException as error:
            # An error of the prelude counts as the program's, and is raised when the program begins.
            self._prelude_error = error
        self._session.free -= 1

    def _run_prelude(self, prelude: str) -> None:
        for part, code in compile_prelude(prelude):
            try:
                exec(code, self.names)
            except Exception as error:  # such as a sensor that this robot does not have
                if not part:
                    raise
                self.names[part] = MissingPart(part, error)

    def connect(self, config: RunConfig) -> None:
        """Set the configuration of the run, with its program."""
        self._config = config
        session = self._session
        self._starts_in_own_folder = config.starts_in_own_folder
        # The program may start in another folder, from which a relative path would mean another file.
        in_own_folder = os.path.join(config.own_folder, os.path.basename(session.program_file))
        self._file = in_own_folder if self._starts_in_own_folder else session.program_file
        self._answers = list(config.options.answers)
        sys.argv = [self._file, *config.program.arguments]

    def run(self) -> ProgramOutcome:
        """Run the program to its end, and return how it ended; never raises."""
        try:
            return self._run()
        except StopProgram as stop:
            # The recording had no space for the last rows, which stops the run.
            return ProgramOutcome(stop.end, 0, stop.summary, error_line=stop.line)

    def _run(self) -> ProgramOutcome:
        outcome = self._run_part(self._execute)
        joins = self._config.spec.profile.motor_law.library.joins_threads
        if (
            joins
            and self._session.stop_reason is None
            and outcome.end in (End.FINISHED, End.RAISED)
        ):
            # As in Python, the other threads are waited for even after an error or an exit in the main thread.
            later = self._run_part(self._scheduler.join_all)
            outcome = outcome if later.end is End.FINISHED else later
        outcome = self._hold_at_end(outcome)
        self._shut_down()
        self._finish_streams()
        if outcome.end is End.FINISHED and self._session.stop_reason is None:
            outcome = self._finish_moves(outcome)
        # A stop in another thread, an exit function or a `__del__` may not have reached this thread.
        stop = self._session.stop_reason
        if stop is not None and outcome.end is End.FINISHED:
            outcome = ProgramOutcome(stop.end, 0, stop.summary)
        return _add_caught(outcome)

    def _run_part(self, part: Callable[[], None]) -> ProgramOutcome:
        try:
            part()
        except BaseException as error:  # any uncaught exception is an outcome of the program
            return self._build_outcome(error)
        return ProgramOutcome(End.FINISHED)

    def _hold_at_end(self, outcome: ProgramOutcome) -> ProgramOutcome:
        """Let the debugger pause after the end of the program, if the user has requested a pause at a later instant.

        Return how the run ended: `outcome`, or a stop if the user stops the run during the pause.
        """
        if self._session.debugger is None or self._session.stop_reason is not None:
            return outcome
        try:
            self._session.debugger.at_end()
        except StopProgram as stop:
            return ProgramOutcome(stop.end, 0, stop.summary, error_line=stop.line)
        return outcome

    def _finish_moves(self, outcome: ProgramOutcome) -> ProgramOutcome:
        """Let the program's moves end, as on a brick; return the outcome, which then names motors that still turn."""
        try:
            left = finish_moves(self._session)
        except StopProgram as stop:
            return ProgramOutcome(stop.end, 0, stop.summary)
        return _add(outcome, left)

    def _shut_down(self) -> None:
        """Do what Python does at the end of a program: call exit functions, close files, run finalizers."""
        try:
            atexit._run_exitfuncs()
            flush_streams((self.stdout, self.stderr))
            if self._session.stop_reason is not None:
                # The traceback of the stop would keep frames and their objects alive, so that finalizers do not run.
                self._session.stop_reason.with_traceback(None)
            if self._session.stop_reason is None or len(self._scheduler.tasks) == 1:
                # After a stop by the user, other threads may still compute, and need the program's names.
                self._clear_module()
        except BaseException as error:  # the program is over: later errors are only reported
            self.hooks.show(error)

    def _clear_module(self) -> None:
        """Delete the program's global names, in an order in which finalizers still find most of them."""
        # Trace functions and callbacks of the program would still be called and need its names: remove them first.
        gc.collect()
        wallclock.settrace(None)
        wallclock.setprofile(None)
        gc.callbacks.clear()
        for removable in (_has_finalizer, _is_data):
            for name in [
                name
                for name, value in self.names.items()
                if removable(value) and not name.startswith("__")
            ]:
                self.names.pop(name, None)
            gc.collect()
        self.names.clear()
        gc.collect()

    def _finish_streams(self) -> None:
        with suppress(LogError):
            self.raw.finish()
        for stream in (self.stdout, self.stderr):
            try:
                stream.finish()
            except LogError:
                # If the recording has no space left, that has ended the run and was reported elsewhere.
                continue

    @property
    def _has_brick_folder(self) -> bool:
        """Whether paths in the brick's home folder can mean files in the program's folder."""
        return self._session.sim.spec.profile.starts_in_own_folder

    def _patch(self) -> None:
        sys.stdout = self.stdout
        sys.stderr = self.stderr
        # Code that replaces a stream for a while restores it from these attributes.
        vars(sys).update(__stdout__=self.stdout, __stderr__=self.stderr)
        self.hooks.install()
        patch_faulthandler()
        replace(builtins, "input", self._read_input, (0, 1))
        replace(os, "write", self.raw.write, (2, 2))
        if self._has_brick_folder:
            HomeFolder(lambda: self._config.own_folder).patch()
        replace(os, "_exit", lambda status: self._exit_now(operator.index(status)))

    def _execute(self) -> None:
        drops_annotations = self._config.spec.profile.motor_law.library.drops_annotations
        if self.code is None:
            text = self._config.program.text
            file = self._session.program_file
            self.code = compile_program(text, file, drops_annotations)
        self.names["__file__"] = self._file
        if self._prelude_error is not None:
            raise self._prelude_error
        # The program's folder is added late: earlier, the library's `import logging` would find a program logging.py.
        folder = self._config.own_folder
        sys.path[:0] = [folder, *self._config.program.python_path]
        brick_folder = folder if self._has_brick_folder else ""
        install_finder(self._config.folder, brick_folder, drops_annotations)
        if self._starts_in_own_folder:
            # If a repeated run's folder no longer exists, only files that it opens there are missing.
            with suppress(OSError):
                os.chdir(folder)
        self.prepared |= {name: id(value) for name, value in self.names.items()}
        # All objects that exist now are exempt from garbage collection, which then takes less time.
        gc.freeze()
        gc.enable()
        if self._config.debugged:
            self._session.debug().begin(self._config.options)
        NotSimulated.first = ""
        exec(self.code, self.names)

    # Ends

    def _build_outcome(self, error: BaseException) -> ProgramOutcome:
        stop = self._session.stop_reason
        if stop is not None:
            return ProgramOutcome(stop.end, 0, stop.summary, error_line=stop.line)
        match error:
            case SystemExit():
                return self._exit_outcome(error.code)
            case LogError():
                line = find_line(error.__traceback__, self._session.program_file)
                return ProgramOutcome(End.OUTPUT_LIMIT, 0, error.message, error_line=line)
            case MemoryError():
                return self._report_error(
                    MemoryError("the program used all the memory that it may have"),
                    error.__traceback__,
                )
        return self._report_error(error, error.__traceback__)

    def _report_error(
        self, error: BaseException, trace: types.TracebackType | None
    ) -> ProgramOutcome:
        self.stdout.finish()
        try:
            report = self.hooks.show_uncaught(error.with_traceback(trace))
        except SystemExit as left:
            return self._exit_outcome(left.code)
        end = End.DEADLOCK if isinstance(error, Deadlock) else End.RAISED
        code = _INTERRUPTED if isinstance(error, KeyboardInterrupt) else 1
        return ProgramOutcome(end, code, report.summary, report.text, report.line)

    def _exit_outcome(self, code: object) -> ProgramOutcome:
        if code is None:
            number = 0
        elif isinstance(code, int):
            number = int.__index__(code)
            # Python, too, returns -1 for an exit status that is out of range.
            number = number if abs(number) < 1 << 31 else -1
        else:
            self.hooks.write(format_safely(str, code) + "\n")
            number = 1
        return ProgramOutcome(
            End.FINISHED,
            number,
            f"the program ended itself with exit code {number}" if number else "",
        )

    def _exit_now(self, status: int) -> NoReturn:
        self._finish_streams()
        self._leave(self._exit_outcome(status))

    # Input

    @waits_for(Wait.INPUT)
    def _read_input(self, prompt: object = "") -> str:
        """Return the next answer that the run's options give; without one, ask the user. It replaces `input`.

        Raises:
            EOFError: there is no answer.
        """
        self.stdout.write(str(prompt))
        (prompt_text,) = self._output.stabilize(self.stdout.take_part())
        answer: str | None
        if self._answers:
            answer = self._answers.pop(0)
        elif not self._config.options.asks_user:
            answer = None
        else:
            answer = self._await_answer(prompt_text)
        self._output.row(prompt_text + (answer or ""), Stream.INPUT)
        # If the answer is there already, no time passes, in which a stop would be noticed: check for one here.
        self._output.after_write()
        if answer is None:
            raise EOFError(NO_ANSWER)
        return answer

    def _await_answer(self, prompt_text: str) -> str | None:
        session = self._session
        steering = self._session.steering
        if not steering.replay_next(session, Answer):
            if self._config.options.time_waits:
                steering.wait_for_reply(session, Answer, InputWanted(prompt_text))
            else:
                session.channel.send(InputWanted(prompt_text))
        tick_ns = NS_PER_S // session.sim.spec.profile.tick_hz
        while not steering.answers:
            session.spend(tick_ns)
        return steering.answers.popleft()
