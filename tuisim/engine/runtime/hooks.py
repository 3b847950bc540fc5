"""Shows the program's errors where Python shows them, through the hooks that a program may replace."""

from __future__ import annotations

import os
import sys
import types
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from tuisim.base.errors import LogError
from tuisim.engine.runs.records import Stream
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.loader import add_prelude_note
from tuisim.engine.runtime.output import LineStream, OutputRecorder
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.session import Session, StopProgram
from tuisim.engine.runtime.tracebacks import ErrorReport, add_namesake_note, report_error
from tuisim.engine.shim.evdev.devices import point_at_gamepads
from tuisim.engine.shim.unsupported.modules import point_at_keys, point_at_package


def format_safely(write: Callable[[object], str], value: object) -> str:
    """Return a value as text, or a placeholder if the value's own code raises an error.

    `write` is `str` or `repr`.
    """
    try:
        return write(value)
    except BaseException:  # a program's own method may do anything
        return f"<{type(value).__name__}, whose {write.__name__}() failed>"


class ErrorHooks:
    """Functions that replace the hooks of `sys` and `threading` through which Python shows errors.

    Args:
        session: The program's clock.
        output: Receives the rows of error texts.
        stderr: The program's error output, unless the program replaces it.
        source: Returns the program's text.
    """

    def __init__(
        self,
        session: Session,
        output: OutputRecorder,
        stderr: LineStream,
        source: Callable[[], str],
    ) -> None:
        self._session = session
        self._output = output
        self._stderr = stderr
        self._source = source

    def install(self) -> None:
        """Replace the hooks of `sys` and `threading` through which Python shows errors."""
        # Imported here because the functions that `threading` uses must be patched before.
        import threading

        replace(sys, "excepthook", lambda _kind, error, _trace: self.show(error), (3, 3))
        replace(sys, "unraisablehook", self._show_ignored, (1, 1))
        vars(sys).update(__excepthook__=sys.excepthook, __unraisablehook__=sys.unraisablehook)
        replace(threading, "excepthook", self._show_of_thread, (1, 1))
        vars(threading)["__excepthook__"] = threading.excepthook
        self._own = sys.excepthook

    def report(self, error: BaseException, alone: bool = False) -> ErrorReport:
        """Return the report of an error, with notes that may help.

        Args:
            error: The error.
            alone: Whether to leave out notes, suggestions, and the errors that led to it.
        """
        if not alone:
            add_prelude_note(error, self._source())
            add_namesake_note(error, self._session.program_file)
            point_at_package(error, os.path.dirname(self._session.program_file) or os.curdir)
            point_at_gamepads(error)
            point_at_keys(error, self._session.sim.spec.profile.motor_law.library)
        report = report_error(error, self._session.program_file, self._source(), alone)
        text, summary = self._output.stabilize(report.text, report.summary)
        return ErrorReport(text, report.line, summary)

    def show_uncaught(self, error: BaseException) -> ErrorReport:
        """Show the error that ended the program, through the program's own hook if it has one, and return its report.

        Raises:
            SystemExit: the hook of the program has raised it.
        """
        report = self.report(error)
        hook = vars(sys).get("excepthook", self)
        if hook is self:
            self.write("sys.excepthook is missing\n" + report.text)
        elif hook is self._own:
            self.write(report.text)
        else:
            try:
                hook(type(error), error, error.__traceback__)
            except (SystemExit, StopProgram, LogError):
                raise
            except BaseException as further:  # as in Python, both are shown
                further.__context__ = None
                error_text = self.report(further).text
                self.write(
                    f"Error in sys.excepthook:\n{error_text}\nOriginal exception was:\n{report.text}"
                )
        return report

    def show(self, error: BaseException | None) -> None:
        """Write the report of an error that does not end the program; do nothing for None and for a stop of the run."""
        if error is not None and not isinstance(error, StopProgram):
            self.write(self.report(error).text)

    def _show_of_thread(self, args: Any) -> None:
        kind, error, _trace, thread = args
        if error is None or issubclass(kind, SystemExit | StopProgram):
            # As in Python, such an exception ends the thread without a message.
            return
        name = thread.name if thread is not None else wallclock.get_ident()
        self.write(f"Exception in thread {name}:\n{self.report(error).text}")

    def _show_ignored(self, ignored: Any) -> None:
        """Show an error that Python cannot raise, such as one in a `__del__`.

        If it is the exception that stops the run, do not show it: it will be raised again.
        """
        error = ignored.exc_value
        if isinstance(error, StopProgram):
            self._session.stop_lost()
            return
        what = "" if ignored.object is None else f": {format_safely(repr, ignored.object)}"
        text = "" if error is None else self.report(error, alone=True).text
        self.write(f"{ignored.err_msg or 'Exception ignored in'}{what}\n{text}")

    def show_end_of_bare_thread(
        self, function: Callable[..., object], error: BaseException
    ) -> None:
        """Show the error that ended a thread that was started with `_thread`."""
        hook = vars(sys).get("unraisablehook")
        message = "Exception ignored in thread started by"
        ignored = types.SimpleNamespace(
            exc_type=type(error),
            exc_value=error,
            exc_traceback=error.__traceback__,
            err_msg=message,
            object=function,
        )
        (hook if callable(hook) else self._show_ignored)(ignored)

    def write(self, text: str) -> None:
        """Write an error text to the program's error output."""
        file = vars(sys).get("stderr")
        if file is None:
            # As in Python, nothing is shown if the program has set `sys.stderr` to None.
            return
        if file is not self._stderr:
            try:
                file.write(text)
                file.flush()
            except Exception:  # the program's own stream may raise anything; write the text below
                pass
            else:
                return
        with suppress(LogError):
            # If the recording has no space left, that ends the run and is reported elsewhere.
            for line in (self._stderr.take_part() + text).rstrip("\n").split("\n"):
                self._output.row(line, Stream.STDERR)


def flush_streams(own: tuple[LineStream, LineStream]) -> None:
    """Flush streams with which the program has replaced `sys.stdout` or `sys.stderr`, as Python does at the end.

    Args:
        own: The streams that the program had at its start, which need no flush.
    """
    for stream in (vars(sys).get("stdout"), vars(sys).get("stderr")):
        if stream is not None and not any(stream is own_stream for own_stream in own):
            # The program has ended, so errors of its own streams do not matter.
            with suppress(Exception):
                stream.flush()
