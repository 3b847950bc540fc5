"""Hints of errors for which Python has none: a name that was meant or not imported, and text that numbers become."""

from __future__ import annotations

import re
import sys
import types
from typing import Any

from tuisim.base.meant import find_meant_names, map_functions, map_modules

_LIBRARIES = frozenset({"ev3dev2", "pybricks"})
_PYBRICKS = ("parameters", "tools", "hubs", "ev3devices", "pupdevices", "robotics", "media.ev3dev")
"""Modules of Pybricks, those first that a name is looked for in first: some have names of others as well."""
_NO_MODULE = types.ModuleType("")
_TEXT_AND_NUMBER = re.compile(
    r'can only concatenate str \(not "(?:int|float)"\) to str'
    r"|unsupported operand type\(s\) for \+: '(?:int|float)' and 'str'"
)


def add_hint(trace: Any, error: BaseException) -> None:
    """Add a hint to the message of an error, unless Python has already suggested something.

    Args:
        trace: The error as a `traceback.TracebackException`.
        error: The error itself.
    """
    hint = ""
    if type(error) is AttributeError:
        hint = "" if "Did you mean" in str(trace._str) else _find_meant(error)
    elif type(error) is NameError:
        hint = _find_import(error.name, str(trace._str))
    elif type(error) is TypeError and _TEXT_AND_NUMBER.fullmatch(str(trace._str)):
        hint = "`str(number)` makes text of a number"
    if hint:
        words = str(trace._str)
        trace._str = f"{words}{'' if words.endswith('?') else '.'} {hint}"


def _find_meant(error: AttributeError) -> str:
    """Return a suggestion of similar names for a wrong attribute of a library's object; empty if there are none."""
    kind = type(error.obj)
    wrong = error.name
    library = str(getattr(kind, "__module__", "")).partition(".")[0]
    if not isinstance(wrong, str) or library not in _LIBRARIES:
        return ""
    # The names of classes only: to list those of an object may run code.
    names = {name for base in kind.__mro__ for name in vars(base)}
    meant = find_meant_names(wrong, names)
    return f"Did you mean: {' or '.join(map(repr, meant))}?" if meant else ""


def _find_import(name: str | None, words: str) -> str:
    """Return the import that the program lacks for a name; empty if none is known, or if Python names it.

    Args:
        name: The name that is not defined.
        words: What Python says.
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
    """Return the module of the library of the program, or of Python, that has a name; empty if none has."""
    if "pybricks" in sys.modules:
        # All modules of the library are there from the start, whatever the program imports.
        for module in (f"pybricks.{part}" for part in _PYBRICKS):
            if name[0] != "_" and name in vars(sys.modules.get(module, _NO_MODULE)):
                return module
        return map_functions().get(name, "")
    return map_modules().get(name) or map_functions().get(name, "")
