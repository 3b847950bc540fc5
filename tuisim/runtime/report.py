"""How a program's uncaught error is told: its own frames, nothing of the runtime."""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable
from dataclasses import dataclass

from tuisim.runtime.interrupts import PACKAGE_FOLDER
from tuisim.source import source_lines

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

    linecache.cache[file] = (len(source), None, [line + "\n" for line in source_lines(source)], file)
    told = traceback.TracebackException.from_exception(error, compact=True)
    _keep_program_frames(told, own_files(file))
    text = "".join(told.format())
    for name in _OUR_NAMES:
        text = text.replace(name, "")
    lines = [frame.lineno or 0 for frame in told.stack if frame.filename == file]
    line = lines[-1] if lines else getattr(error, "lineno", 0) or 0
    summary = _summary(told)
    for name in _OUR_NAMES:
        summary = summary.replace(name, "")
    return ErrorReport(text, line, f"{summary} (line {line})" if line else summary)


def _summary(told: traceback.TracebackException) -> str:
    """Kind and message in one line."""
    only = source_lines("".join(told.format_exception_only()).strip())
    # A syntax error shows its place first; of a message of several lines the first says most.
    return only[-1] if only[0].startswith("File ") else only[0]


def own_files(file: str) -> Callable[[str], bool]:
    """Return a function that says which files are the program's: itself, and modules that lie beside it."""
    folder = os.path.dirname(os.path.abspath(file)) + os.sep
    foreign = (PACKAGE_FOLDER, os.path.dirname(traceback.__file__) + os.sep)

    def own(name: str) -> bool:
        path = os.path.abspath(name)
        beside = path.startswith(folder) and "site-packages" not in path and not path.startswith(foreign)
        return name == file or (beside and not name.startswith("<"))

    return own


def _keep_program_frames(told: traceback.TracebackException, own: Callable[[str], bool]) -> None:
    told.stack = traceback.StackSummary.from_list([frame for frame in told.stack if own(frame.filename)])
    for name in ("__cause__", "__context__"):
        linked = getattr(told, name)
        if linked is None:
            continue
        _keep_program_frames(linked, own)
        # An error that never touched the program's code is a detail of ours or of the library.
        if not linked.stack:
            setattr(told, name, None)
    for inner in getattr(told, "exceptions", None) or ():
        _keep_program_frames(inner, own)
