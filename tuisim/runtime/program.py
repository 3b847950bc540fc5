"""Runs the program: its streams, its input, its module, and how it ended."""

from __future__ import annotations

import atexit
import builtins
import gc
import io
import operator
import os
import re
import sys
import types
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, NoReturn

from tuisim.core.simulation import NS_PER_S
from tuisim.errors import LogError
from tuisim.protocol import NO_ANSWER, Answer, InputWanted
from tuisim.runs.records import INPUT, STDERR
from tuisim.runtime.loader import LOOP_HOOK, MissingPart, compile_prelude, compile_program, point_at_prelude
from tuisim.runtime.modules import find_modules_for
from tuisim.runtime.output import LineStream, Output
from tuisim.runtime.replacement import replace
from tuisim.runtime.run_config import RunConfig
from tuisim.runtime.scheduler import Scheduler
from tuisim.runtime.session import Session
from tuisim.runtime.stack import patch_faulthandler
from tuisim.runtime.stop import Deadlock, StopProgram
from tuisim.runtime.tracebacks import point_at_namesake, report_error


@dataclass(frozen=True, slots=True)
class Outcome:
    """How the program ended, as in `protocol.Ended`."""

    end: str
    exit_code: int = 0
    summary: str = ""
    error: str = ""
    error_line: int = 0


_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")


def _has_last_words(value: object) -> bool:
    """Whether something of the program's is run when a value goes."""
    words = hasattr(type(value), "__del__") or isinstance(value, types.GeneratorType | types.CoroutineType)
    return words and not isinstance(value, io.IOBase)


def _is_data(value: object) -> bool:
    """Whether a value is neither code nor a file that somebody may still write to."""
    return not isinstance(value, types.ModuleType | types.FunctionType | types.BuiltinFunctionType | type | io.IOBase)


def safe_text(write: Callable[[object], str], value: object) -> str:
    """Return the `str` or `repr` of a value, or that there is none."""
    try:
        return write(value)
    except BaseException:  # a program's own method may do anything
        return f"<{type(value).__name__}, whose {write.__name__}() failed>"


class ProgramRunner:
    """Everything the program sees of the process it runs in.

    Args:
        config: The run.
        session: The program's clock.
        output: Where its lines go.
        baton: Its threads.
        loop_hook: Called at the top of each loop body.
        leave: Ends the process at once, with an outcome.
    """

    def __init__(
        self,
        config: RunConfig,
        session: Session,
        output: Output,
        baton: Scheduler,
        loop_hook: Callable[[], None],
        leave: Callable[[Outcome], NoReturn],
    ) -> None:
        self._config, self._session, self._output, self._baton = config, session, output, baton
        self._leave = leave
        has_own_folder = bool(config.path or config.module_folder)
        self._starts_in_own_folder = config.spec.profile.starts_in_own_folder and has_own_folder
        # A relative path would mean another file from there.
        in_own_folder = os.path.join(config.own_folder, os.path.basename(session.program_file))
        self._file = in_own_folder if self._starts_in_own_folder else session.program_file
        self._answers = list(config.answers)
        self.stdout, self.stderr = LineStream(output), LineStream(output, STDERR)
        self._module = types.ModuleType("__main__")
        self.prepared: dict[str, int] = {}
        """By name, the identity of what the prelude has made."""
        self.code: types.CodeType | None = None
        """The program; None before it is compiled."""
        self.names = self._module.__dict__
        """The program's global names."""
        setattr(builtins, LOOP_HOOK, loop_hook)

    def run(self) -> Outcome:
        """Run prelude and program to their end, whatever it is."""
        try:
            return self._run()
        except StopProgram as stop:
            # What was written last had no room any more.
            return Outcome(stop.end, 0, stop.summary)

    def _run(self) -> Outcome:
        try:
            self._prepare()
            self._execute()
            self._baton.join_all()
            outcome = Outcome("finished")
        except BaseException as error:  # whatever a program lets escape is an outcome, not an error of ours
            outcome = self._outcome_of(error)
        outcome = self._hold_at_end(outcome)
        self._wind_up()
        self._finish_streams()
        # One that struck a thread, an exit function or a `__del__` need not have come here.
        stop = self._session.stop_reason
        return outcome if stop is None or outcome.end != "finished" else Outcome(stop.end, 0, stop.summary)

    def _hold_at_end(self, outcome: Outcome) -> Outcome:
        """Let the debugger hold a program that is over before the instant that was wanted."""
        if self._session.debugger is None or self._session.stop_reason is not None:
            return outcome
        try:
            self._session.debugger.at_end()
        except StopProgram as stop:
            return Outcome(stop.end, 0, stop.summary)
        return outcome

    def _wind_up(self) -> None:
        """Do what Python does at the end of a program: exit functions, open files, what is left of objects."""
        try:
            atexit._run_exitfuncs()
            if self._session.stop_reason is not None:
                # It holds on to the frames that it came through.
                self._session.stop_reason.with_traceback(None)
            self._let_go()
        except BaseException as error:  # the program is over: what still goes wrong in it is only told
            self._thread_error(type(error), error, None)

    def _let_go(self) -> None:
        """Empty the program's module: what is run when an object goes still finds as many of its names as can be."""
        for goes_now in (_has_last_words, _is_data):
            for name in [name for name, value in self.names.items() if goes_now(value) and not name.startswith("__")]:
                self.names.pop(name, None)
            gc.collect()
        self.names.clear()
        gc.collect()

    def _finish_streams(self) -> None:
        """Write what the program printed without a line end."""
        for stream in (self.stdout, self.stderr):
            try:
                stream.finish()
            except LogError:
                # The file is full, and says so itself.
                continue

    def _prepare(self) -> None:
        sys.stdout, sys.stderr = self.stdout, self.stderr
        # Also for whatever puts another stream in place of one and goes back to it.
        vars(sys).update(__stdout__=self.stdout, __stderr__=self.stderr)
        sys.argv = [self._file, *self._config.arguments]
        replace(sys, "excepthook", self._thread_error, (3, 3))
        replace(sys, "unraisablehook", self._ignored_error, (1, 1))
        vars(sys).update(__excepthook__=sys.excepthook, __unraisablehook__=sys.unraisablehook)
        patch_faulthandler()
        import threading

        replace(threading, "excepthook", lambda args: self._thread_error(*args[:3]), (1, 1))
        replace(builtins, "input", self._input, (0, 1))
        replace(os, "_exit", lambda status: self._exit_now(operator.index(status)))

    def _execute(self) -> None:
        self.code = program = compile_program(self._config.text, self._session.program_file)
        module = self._module
        module.__dict__.update(__file__=self._file, __builtins__=builtins)
        sys.modules["__main__"] = module
        # What is prepared for the program costs it nothing.
        self._session.free += 1
        for part, code in compile_prelude(self._config.prelude):
            try:
                exec(code, module.__dict__)
            except Exception as error:  # such as a sensor that this robot has not
                if not part:
                    raise
                module.__dict__[part] = MissingPart(part, error)
        self._session.free -= 1
        # Not before: a program called logging.py is not what the library means by `import logging`.
        folder = self._config.own_folder
        sys.path[:0] = [folder, *self._config.python_path]
        find_modules_for(self._config.folder)
        if self._starts_in_own_folder:
            # Of a run that is repeated after the folder was removed, only what it opens there is missing.
            with suppress(OSError):
                os.chdir(folder)
        self.prepared |= {name: id(value) for name, value in module.__dict__.items()}
        # What is there now stays; the program's own garbage is looked for from here on.
        gc.freeze()
        gc.enable()
        if self._config.debugged:
            self._session.debug().begin(self._config)
        exec(program, module.__dict__)

    # Ends

    def _outcome_of(self, error: BaseException) -> Outcome:
        stop = self._session.stop_reason
        if stop is not None:
            return Outcome(stop.end, 0, stop.summary)
        match error:
            case SystemExit():
                return self._exit_outcome(error.code)
            case LogError():
                return Outcome("output_limit", 0, error.message)
            case MemoryError():
                return self._raised(MemoryError("the program used up the memory it may have"), error.__traceback__)
        return self._raised(error, error.__traceback__)

    def _raised(self, error: BaseException, trace: types.TracebackType | None) -> Outcome:
        self.stdout.finish()
        point_at_prelude(error)
        point_at_namesake(error, self._session.program_file)
        report = report_error(error.with_traceback(trace), self._session.program_file, self._config.text)
        self._tell(report.text)
        end = "deadlock" if isinstance(error, Deadlock) else "raised"
        return Outcome(end, 1, report.summary, report.text, report.line)

    def _exit_outcome(self, code: object) -> Outcome:
        if code is None:
            number = 0
        elif isinstance(code, int):
            number = int.__index__(code)
            # As Python has it for what is no exit status at all.
            number = number if abs(number) < 1 << 31 else -1
        else:
            self._tell(safe_text(str, code))
            number = 1
        return Outcome("finished", number, f"the program ended itself with exit code {number}" if number else "")

    def _exit_now(self, status: int) -> NoReturn:
        self._finish_streams()
        self._leave(self._exit_outcome(status))

    def _thread_error(self, _kind: Any, error: BaseException | None, _trace: Any) -> None:
        if error is None or isinstance(error, StopProgram):
            return
        point_at_prelude(error)
        point_at_namesake(error, self._session.program_file)
        self._tell(report_error(error, self._session.program_file, self._config.text).text)

    def _ignored_error(self, ignored: Any) -> None:
        """Tell an error that Python cannot raise, such as in a `__del__`; a stop is raised again elsewhere."""
        if isinstance(ignored.exc_value, StopProgram):
            self._session.stop_lost()
            return
        # The address would be another one in every run.
        where = _ADDRESS.sub("", safe_text(repr, ignored.object))
        self._tell(f"{ignored.err_msg or 'Exception ignored in'}: {where}")
        self._thread_error(ignored.exc_type, ignored.exc_value, ignored.exc_traceback)

    def _tell(self, text: str) -> None:
        """Write down what went wrong."""
        try:
            for line in text.rstrip("\n").split("\n"):
                self._output.row(line, STDERR)
        except LogError:
            # The file is full, and says so itself.
            return

    # Input

    def _input(self, prompt: object = "") -> str:
        """The program's input(): scripted answers, or the user's."""
        self.stdout.write(str(prompt))
        asked = self.stdout.take_part()
        answer: str | None
        if self._answers:
            answer = self._answers.pop(0)
        elif not self._config.asks_user:
            answer = None
        else:
            answer = self._users_answer(asked)
        self._output.row(asked + (answer or ""), INPUT)
        # Answers that are there already let no time pass: a stop comes between them.
        self._output.after_write()
        if answer is None:
            raise EOFError(NO_ANSWER)
        return answer

    def _users_answer(self, asked: str) -> str | None:
        session, steering = self._session, self._session.steering
        if not steering.was_there(session, Answer):
            if self._config.time_waits:
                steering.stand_still_for(session, Answer, InputWanted(asked))
            else:
                session.channel.send(InputWanted(asked))
        tick_ns = NS_PER_S // session.sim.spec.profile.tick_hz
        while not steering.answers:
            session.spend(tick_ns)
        return steering.answers.popleft()
