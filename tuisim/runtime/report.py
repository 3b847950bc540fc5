"""How a program's uncaught error is told: its own frames, nothing of the runtime."""

from __future__ import annotations

import traceback
from dataclasses import dataclass

_OUR_NAMES = ("tuisim.errors.", "tuisim.runtime.halt.")


@dataclass(frozen=True, slots=True)
class ErrorReport:
    """An uncaught error."""

    text: str
    """The traceback as Python prints it, without frames that are not the program's."""
    line: int
    """Last line of the program in it, 0 if there is none."""
    summary: str
    """One line: what and where."""


def report_error(error: BaseException, file: str, source: str) -> ErrorReport:
    """Return how to tell an error.

    Args:
        error: What the program raised.
        file: File name of the program's frames.
        source: The program's text.
    """
    import linecache

    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    told = traceback.TracebackException.from_exception(error, compact=True)
    _keep_program_frames(told, file)
    text = "".join(told.format())
    for name in _OUR_NAMES:
        text = text.replace(name, "")
    line = told.stack[-1].lineno or 0 if told.stack else getattr(error, "lineno", 0) or 0
    last = text.strip().rsplit("\n", 1)[-1]
    return ErrorReport(text, line, f"{last} (line {line})" if line else last)


def _keep_program_frames(told: traceback.TracebackException, file: str) -> None:
    told.stack = traceback.StackSummary.from_list([frame for frame in told.stack if frame.filename == file])
    for name in ("__cause__", "__context__"):
        linked = getattr(told, name)
        if linked is None:
            continue
        _keep_program_frames(linked, file)
        # An error that never touched the program's code is a detail of ours or of the library.
        if not linked.stack:
            setattr(told, name, None)
    for inner in getattr(told, "exceptions", None) or ():
        _keep_program_frames(inner, file)
