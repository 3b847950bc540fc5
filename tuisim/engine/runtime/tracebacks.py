"""Reports of a program's uncaught error: its own frames, without those of the runtime."""

from __future__ import annotations

import enum
import io
import os
import re
import sys
import traceback
import types
from collections.abc import Callable
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.base.meant import find_meant_names, map_functions, map_modules
from tuisim.base.source import source_lines
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.modules import OWN_FILES, is_own, remember_source
from tuisim.engine.runtime.stack import show_whole_stacks

_OUR_NAMES = ("tuisim.base.errors.", "tuisim.engine.runtime.session.")
MAX_LINKED = 10
"""Number of errors that are shown at either end of a long chain of causes."""
_MAX_CHARACTERS = 500_000
"""Longest traceback that is sent, because the host treats a longer message as falsified."""
_HEADING = "Traceback (most recent call last):\n"
_show = sys.excepthook
_SYNTAX_ERRORS: tuple[type[SyntaxError], ...] = (SyntaxError, IndentationError, TabError)
Trace = Any
"""`traceback.TracebackException`, some of whose attributes type checkers do not know."""


@dataclass(frozen=True, slots=True)
class ErrorReport:
    """The report of an uncaught error, as it is shown to the user."""

    text: str
    """The traceback as Python prints it, reduced to the program's frames."""
    line: int
    """Last line of the program in it; 0 if there is none."""
    summary: str
    """Error and location in one line."""


def report_error(error: BaseException, file: str, source: str, alone: bool = False) -> ErrorReport:
    """Return the report of an error, with the program's own frames only.

    Args:
        error: What the program raised.
        file: File name of the program's frames.
        source: The program's text.
        alone: Whether to leave out suggestions, notes, and the errors that led to it, as Python does where it cannot
            raise an error.
    """
    remember_source(file, source)
    _add_text(error, file, source)
    try:
        # All frames are read at first, because an error without any frame was created but never raised.
        with show_whole_stacks():
            trace: Trace = traceback.TracebackException.from_exception(
                error, limit=sys.maxsize, lookup_lines=False, compact=True
            )
        if alone:
            trace.__cause__ = trace.__context__ = trace.__notes__ = None
        elif sys.version_info < (3, 12):
            _add_suggestions(trace, error)
        chain = _keep_program_frames(trace, own_files(file))
        if not alone:
            _add_hint(trace, error)
        text = _format_chain(chain)
        summary = _summarize(trace)
    except Exception as problem:
        # Any error must be reported, also one that is nested too deeply for Python's own report.
        stack = traceback.StackSummary.from_list(
            [
                frame
                for frame in traceback.extract_tb(error.__traceback__)
                if own_files(file)(frame.filename)
            ]
        )
        summary = f"{_name_kind(error)}: <cannot be shown: {type(problem).__name__}>"
        text = _HEADING + "".join(stack.format()) + summary + "\n"
    for name in _OUR_NAMES:
        text = text.replace(name, "")
        summary = summary.replace(name, "")
    text = _cut(text)
    summary = _cut(summary)
    line = find_line(error.__traceback__, file) or _find_line(error)
    return ErrorReport(text, line, f"{summary} (line {line})" if line else summary)


def _cut(text: str) -> str:
    """Return a text for the host: if it is too long, only its beginning, with a note of its length."""
    if len(text) <= _MAX_CHARACTERS:
        return text
    return f"{text[:_MAX_CHARACTERS]}… (too long: {len(text):,} characters)"


def _add_text(error: BaseException, file: str, source: str) -> None:
    """Add the text of the program's line to a syntax error that lacks it.

    Python would look for the line in the file, which need not exist.
    """
    if type(error) in _SYNTAX_ERRORS and isinstance(error, SyntaxError) and error.text is None:
        lines = source_lines(source)
        line = _find_line(error)
        if error.filename == file and 0 < line <= len(lines):
            # Bytes that are not valid text are replaced, because they cannot be shown.
            error.text = (
                lines[line - 1].encode("utf-8", "surrogateescape").decode("utf-8", "replace") + "\n"
            )


def find_line(trace: Any, file: str) -> int:
    """Return the line number of the innermost frame of a file in a traceback; 0 if the file is not in it."""
    line = 0
    while trace is not None:
        line = trace.tb_lineno if trace.tb_frame.f_code.co_filename == file else line
        trace = trace.tb_next
    return line


# Up to Python 3.11, only the interpreter itself prints which names may have been meant, not the module `traceback`.


def _add_suggestions(trace: Trace, error: BaseException) -> None:
    """Add the names that Python suggests to the messages of an error and of the errors linked to it."""
    pairs: list[tuple[Trace, Any]] = [(trace, error)]
    for printed, real in pairs:
        if printed is None or real is None:
            continue
        kind = type(real)
        if kind is NameError or kind is AttributeError:
            printed._str = (printed._str or "") + _find_suggestion(real)
        elif kind in _SYNTAX_ERRORS:
            _print_as_python(printed, real)
        pairs += [(printed.__cause__, real.__cause__), (printed.__context__, real.__context__)]
        pairs += zip(printed.exceptions or (), getattr(real, "exceptions", ()), strict=False)


def _find_suggestion(error: Any) -> str:
    """Return the suggestion that Python adds to an error's message, such as `Did you mean: 'move'?`, or empty text.

    The error is a NameError or an AttributeError.
    """
    kind = type(error)
    # The copy of the error has no message, because the program may have written that.
    bare = kind(name=error.name) if kind is NameError else kind(name=error.name, obj=error.obj)
    bare.__traceback__ = error.__traceback__
    return _print_error(bare).removeprefix(kind.__name__).rstrip("\n")


def _print_as_python(trace: Trace, error: SyntaxError) -> None:
    """Make a traceback show a syntax error as Python itself prints it; `traceback` would set the carets differently."""
    bare: Any = type(error)()
    for name in (
        "msg",
        "filename",
        "lineno",
        "offset",
        "text",
        "end_lineno",
        "end_offset",
        "print_file_and_line",
    ):
        setattr(bare, name, getattr(error, name, None))
    printed = _print_error(bare)

    trace._format_syntax_error = lambda _kind: [printed]


def _print_error(error: BaseException) -> str:
    """Return the text that Python prints for an error, without its frames."""
    names = vars(sys)
    printed = io.StringIO()
    meanwhile = {"stderr": printed, "tracebacklimit": 0}
    before = {name: names[name] for name in meanwhile if name in names}
    names.update(meanwhile)
    try:
        _show(type(error), error, error.__traceback__)
    finally:
        for name in meanwhile:
            del names[name]
        names.update(before)
    return printed.getvalue()


def _name_kind(error: BaseException) -> str:
    """Return the name of an error's class, even if its metaclass redefines it."""
    return str(type.__dict__["__name__"].__get__(type(error)))


def _find_line(error: BaseException) -> int:
    """Return the line of a syntax error; 0 if it has none or is another error."""
    line = error.lineno if isinstance(error, SyntaxError) else None
    return line if isinstance(line, int) else 0


def _summarize(trace: Trace) -> str:
    only = source_lines("".join(trace.format_exception_only()).strip())
    # A syntax error starts with its location; of a message of several lines the first is the most useful.
    return only[-1] if only[0].startswith("File ") else only[0]


def own_files(file: str) -> Callable[[str], bool]:
    """Return a function that returns whether a file belongs to the program.

    Such a file is the program, lies beside the program, or was imported by it.
    """
    beside = os.path.dirname(wallclock.absolute(file)) + os.sep

    def own(name: str) -> bool:
        if name == file or name in OWN_FILES:
            return True
        path = wallclock.absolute(name)
        return path.startswith(beside) and is_own(path) and not name.startswith("<")

    return own


def add_namesake_note(error: BaseException, file: str) -> None:
    """Add a note to an error if a file beside the program has the name of a module of Python.

    Args:
        error: What the program raised.
        file: File name of the program.
    """
    if not isinstance(error, ImportError | AttributeError):
        return
    own = own_files(file)
    for name, module in list(sys.modules.items()):
        if name in sys.stdlib_module_names and own(
            str(getattr(module, "__file__", None) or "<builtin>")
        ):
            error.add_note(f"{name}.py beside the program shadows Python's own {name}: rename it.")


def _keep_program_frames(trace: Trace, own: Callable[[str], bool]) -> list[Trace]:
    """Remove frames that are not the program's from an error and from the errors that led to it.

    Args:
        trace: The error.
        own: Returns whether a file belongs to the program.

    Returns:
        The error, and the errors that led to it, newest first.
    """
    chains = [[trace]]
    limit = vars(sys).get("tracebacklimit")
    max_frames = max(limit, 0) if isinstance(limit, int) else sys.maxsize
    for chain in chains:
        for one in chain:
            was_raised = bool(one.stack)
            own_frames = [frame for frame in one.stack if own(frame.filename)]
            one.stack = traceback.StackSummary.from_list(
                own_frames[-max_frames:] if max_frames else []
            )
            chains += [[inner] for inner in getattr(one, "exceptions", None) or ()]
            before = chain[-2] if one is not chain[0] else None
            # An error without a frame of the program is a detail of the runtime or of the library, so it is not shown.
            if before is not None and was_raised and not own_frames:
                before.__cause__ = before.__context__ = None
                chain.pop()
            elif (linked := _find_linked(one)) is not None:
                chain.append(linked)
    return chains[0]


def _find_linked(trace: Trace) -> Trace | None:
    """Return the cause or context of an error, which is printed before it; None if there is none."""
    return trace.__cause__ or (None if trace.__suppress_context__ else trace.__context__)


def _format_chain(chain: list[Trace]) -> str:
    left_out = len(chain) - 2 * MAX_LINKED
    if left_out <= 0:
        return "".join(chain[0].format())
    last_told: Any = chain[MAX_LINKED - 1]
    last_told.__cause__ = last_told.__context__ = None
    oldest = "".join(chain[-MAX_LINKED].format())
    newest = "".join(chain[0].format())
    between = counted(left_out, "more error, which", "more errors, each of which")
    return f"{oldest}\n[{between} led to the next one]\n\n{newest}"


_LIBRARIES = frozenset({"ev3dev2", "pybricks"})
_PYBRICKS = ("parameters", "tools", "hubs", "ev3devices", "pupdevices", "robotics", "media.ev3dev")
"""Modules of Pybricks, those first that a name is looked for in first: some have names of others as well."""
_NO_MODULE = types.ModuleType("")
_TEXT_AND_NUMBER = re.compile(
    r'can only concatenate str \(not "(?:int|float)"\) to str'
    r"|unsupported operand type\(s\) for \+: '(?:int|float)' and 'str'"
)

_MAY_BE_TEXT = re.compile("'str'|by non-int")
_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)\s*")
_NO_FUNCTION = re.compile(r"'(?:int|float|str|bool)' object is not callable")
_EMPTY_CALL = re.compile(r"\.(\w+)\(\)")
"""A call of an attribute without arguments."""
_MAX_MEMBERS = 12
"""An enumeration with more members is not listed."""


def _add_hint(trace: Any, error: BaseException) -> None:
    """Add a hint to the message of an error, unless Python has already suggested something.

    Args:
        trace: The error as a `traceback.TracebackException`, with the program's frames only.
        error: The error itself.
    """
    hint = ""
    if type(error) is AttributeError:
        hint = "" if "Did you mean" in str(trace._str) else _find_meant(error)
    elif type(error) is NameError:
        hint = _find_import(error.name, str(trace._str))
    elif type(error) is TypeError and _TEXT_AND_NUMBER.fullmatch(str(trace._str)):
        hint = "`str(number)` makes text of a number, `float(text)` a number of text"
    elif type(error) is TypeError and _NO_FUNCTION.fullmatch(str(trace._str)) and trace.stack:
        names = _EMPTY_CALL.findall(trace.stack[-1].line or "")
        hint = f"{names[0]} is a value: leave out the ()" if len(names) == 1 else ""
    elif type(error) is TypeError and _MAY_BE_TEXT.search(str(trace._str)) and trace.stack:
        hint = _find_text(error, trace.stack[-1])
    if hint:
        words = str(trace._str)
        trace._str = f"{words}{'' if words.endswith('?') else '.'} {hint}"


def _find_text(error: BaseException, last: traceback.FrameSummary) -> str:
    """Return a hint that a variable in the line of an error is a text with a number, as `input` returns it.

    The hint names the variable; it is empty if there is no such variable.

    Args:
        error: The error.
        last: The frame of the program that raised it.
    """
    for frame, line in traceback.walk_tb(error.__traceback__):
        if (frame.f_code.co_filename, line) == (last.filename, last.lineno):
            values = frame.f_globals | frame.f_locals
            for name in re.findall(r"\w+", last.line or ""):
                value = values.get(name)
                if type(value) is str and _NUMBER.fullmatch(value):
                    return f"{name} is a text: float({name}) is its number"
    return ""


def _find_meant(error: AttributeError) -> str:
    """Return a question that suggests names similar to a wrong attribute of a library's object; empty if none.

    For an enumeration of Pybricks, such as `Port`, return a sentence that lists its members.
    """
    kind = type(error.obj)
    wrong = error.name
    if isinstance(error.obj, enum.EnumType) and "pybricks" in error.obj.__module__.split("."):
        members = [*error.obj.__members__]
        listed = ", ".join(members) if len(members) <= _MAX_MEMBERS else ""
        return f"{error.obj.__name__} has only {listed}" if listed else ""
    library = str(getattr(kind, "__module__", "")).partition(".")[0]
    if not isinstance(wrong, str) or library not in _LIBRARIES:
        return ""
    # Only names of classes are listed: to list those of the object may run code of the program.
    names = {name for base in kind.__mro__ for name in vars(base)}
    meant = find_meant_names(wrong, names)
    return f"Did you mean: {' or '.join(map(repr, meant))}?" if meant else ""


def _find_import(name: str | None, words: str) -> str:
    """Return a question that suggests the import that the program lacks for a name.

    It is empty if no module is known, or if Python suggests it already.

    Args:
        name: The name that is not defined.
        words: Python's message.
    """
    if not isinstance(name, str) or "import" in words:
        return ""
    has_suggestion = "Did you mean" in words
    begin = "Or did you forget" if has_suggestion else "Did you forget"
    if name in sys.stdlib_module_names:
        return f"{begin} to import '{name}'?"
    module = _find_module(name)
    return f"{begin} `from {module} import {name}`?" if module else ""


def _find_module(name: str) -> str:
    """Return the module of the library or of Python that defines a name; empty if none does."""
    if "pybricks" in sys.modules:
        # All modules of Pybricks are in `sys.modules` from the start, even if the program does not import them.
        for module in (f"pybricks.{part}" for part in _PYBRICKS):
            if name[0] != "_" and name in vars(sys.modules.get(module, _NO_MODULE)):
                return module
        return map_functions().get(name, "")
    return map_modules().get(name) or map_functions().get(name, "")
