"""Trace and profile functions of a program: they see its own frames and those of its libraries, none of the runtime."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from functools import wraps
from typing import Any

from tuisim.runtime import wallclock
from tuisim.runtime.patches.replacement import replace
from tuisim.runtime.stack import PACKAGE_FOLDER

Trace = Callable[[types.FrameType, str, Any], Any]


def patch_traces() -> None:
    """Replace `sys.settrace`, `sys.setprofile`, and the functions that return what they have set."""
    for which in ("trace", "profile"):
        setter, getter = getattr(sys, f"set{which}"), getattr(sys, f"get{which}")
        replace(sys, f"set{which}", _setter(setter), (1, 1))
        replace(sys, f"get{which}", _getter(getter), (0, 0))


def stop_traces() -> None:
    """Trace nothing in this thread any more."""
    wallclock.settrace(None)
    wallclock.setprofile(None)


def _setter(real: Callable[[Trace | None], None]) -> Callable[[Trace | None], None]:
    def set_function(function: Trace | None) -> None:
        real(None if function is None else _filtered(function))

    return set_function


def _getter(real: Callable[[], Any]) -> Callable[[], Any]:
    def get_function() -> Any:
        found = real()
        return getattr(found, "__wrapped__", found)

    return get_function


def _filtered(function: Trace) -> Trace:
    @wraps(function, assigned=(), updated=())
    def filtered(frame: types.FrameType, event: str, arg: Any) -> Any:
        if _file_of(frame).startswith(PACKAGE_FOLDER):
            return None
        # For a trace function, the calls of lines go to what this one returns.
        return function(frame, event, arg)

    return filtered


def _file_of(frame: types.FrameType) -> str:
    file, caller = frame.f_code.co_filename, frame.f_back
    # The methods that Python generates for data classes and named tuples belong to where they are called.
    return caller.f_code.co_filename if file == "<string>" and caller is not None else file
