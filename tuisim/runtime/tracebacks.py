"""Reports of a program's uncaught error: its own frames, without those of the runtime."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tuisim.errors import counted
from tuisim.runtime import wallclock
from tuisim.runtime.modules import OWN_FILES, is_own
from tuisim.runtime.stack import every_frame
from tuisim.source import source_lines

_OUR_NAMES = ("tuisim.errors.", "tuisim.runtime.session.")
MOST_LINKED = 10
"""Of a longer chain of causes, this many are shown at either end."""
_HEADING = "Traceback (most recent call last):\n"


@dataclass(frozen=True, slots=True)
class ErrorReport:
    """An uncaught error."""

    text: str
    """The traceback as Python prints it, reduced to the program's frames."""
    line: int
    """Last line of the program in it; 0 if there is none."""
    summary: str
    """Error and location in one line."""


def report_error(error: BaseException, file: str, source: str) -> ErrorReport:
    """Return the report of an error.

    Args:
        error: What the program raised.
        file: File name of the program's frames.
        source: The program's text.
    """
    remember_source(file, source)
    try:
        # All frames: an error without any was created but never raised.
        with every_frame():
            trace = traceback.TracebackException.from_exception(error, compact=True)
        chain = _keep_program_frames(trace, own_files(file))
        text, stack, summary = _text_of(chain), trace.stack, _summary(trace)
    except Exception as problem:  # an error may be anything, and nested too deeply: it is reported nevertheless
        stack = traceback.StackSummary.from_list(
            [frame for frame in traceback.extract_tb(error.__traceback__) if own_files(file)(frame.filename)]
        )
        summary = f"{_kind_of(error)}: <cannot be shown: {type(problem).__name__}>"
        text = _HEADING + "".join(stack.format()) + summary + "\n"
    for name in _OUR_NAMES:
        text, summary = text.replace(name, ""), summary.replace(name, "")
    lines = [frame.lineno or 0 for frame in stack if frame.filename == file]
    line = lines[-1] if lines else _line_of(error)
    return ErrorReport(text, line, f"{summary} (line {line})" if line else summary)


def remember_source(file: str, source: str) -> None:
    """Make tracebacks show the text that runs, not the current contents of the file."""
    import linecache

    linecache.cache[file] = (len(source), None, [line + "\n" for line in source_lines(source)], file)


def _kind_of(error: BaseException) -> str:
    """Return the name of an error's class, even if its metaclass redefines it."""
    return str(type.__dict__["__name__"].__get__(type(error)))


def _line_of(error: BaseException) -> int:
    """Return the line of a syntax error; 0 if it has none or is another error."""
    line = error.lineno if isinstance(error, SyntaxError) else None
    return line if isinstance(line, int) else 0


def _summary(trace: traceback.TracebackException) -> str:
    only = source_lines("".join(trace.format_exception_only()).strip())
    # A syntax error starts with its location; of a message of several lines the first is the most useful.
    return only[-1] if only[0].startswith("File ") else only[0]


def own_files(file: str) -> Callable[[str], bool]:
    """Return a function that tests for the program's files: itself, those beside it, and those it has imported."""
    beside = os.path.dirname(wallclock.absolute(file)) + os.sep

    def own(name: str) -> bool:
        if name == file or name in OWN_FILES:
            return True
        path = wallclock.absolute(name)
        return path.startswith(beside) and is_own(path) and not name.startswith("<")

    return own


Trace = traceback.TracebackException


def point_at_namesake(error: BaseException, file: str) -> None:
    """Add a note to an error if a module beside the program shadows one of Python's.

    Args:
        error: What the program raised.
        file: File name of the program.
    """
    if not isinstance(error, ImportError | AttributeError):
        return
    own = own_files(file)
    for name, module in list(sys.modules.items()):
        if name in sys.stdlib_module_names and own(str(getattr(module, "__file__", None) or "<builtin>")):
            error.add_note(f"{name}.py beside the program shadows Python's own {name}: rename it.")


def _keep_program_frames(trace: Trace, own: Callable[[str], bool]) -> list[Trace]:
    """Remove all other frames from an error and the errors linked to it; return it and its causes, newest first."""
    chains = [[trace]]
    for chain in chains:
        for one in chain:
            was_raised = bool(one.stack)
            one.stack = traceback.StackSummary.from_list([frame for frame in one.stack if own(frame.filename)])
            chains += [[inner] for inner in getattr(one, "exceptions", None) or ()]
            before = chain[-2] if one is not chain[0] else None
            # An error that never touched the program's code is a detail of the runtime or of the library.
            if before is not None and was_raised and not one.stack:
                before.__cause__ = before.__context__ = None
                chain.pop()
            elif (linked := _linked(one)) is not None:
                chain.append(linked)
    return chains[0]


def _linked(trace: Trace) -> Trace | None:
    """Return the error that is printed before this one."""
    return trace.__cause__ or (None if trace.__suppress_context__ else trace.__context__)


def _text_of(chain: list[Trace]) -> str:
    left_out = len(chain) - 2 * MOST_LINKED
    if left_out <= 0:
        return "".join(chain[0].format())
    last_told: Any = chain[MOST_LINKED - 1]
    last_told.__cause__ = last_told.__context__ = None
    oldest, newest = "".join(chain[-MOST_LINKED].format()), "".join(chain[0].format())
    between = counted(left_out, "more error, which", "more errors, each of which")
    return f"{oldest}\n[{between} led to the next one]\n\n{newest}"
