"""What stands in for a builtin passes for one: in class bodies, in `inspect` and `pickle`, and when it is printed."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from functools import wraps
from typing import Any

_SAME = ("__name__", "__qualname__", "__module__", "__doc__", "__self__", "__text_signature__")


class _StandIn:
    """A callable that, as a builtin and unlike a function, does not become a method in a class body.

    Args:
        real: What it stands in for.
    """

    def __init__(self, real: Any) -> None:
        self._real = real
        for name in _SAME:
            if hasattr(real, name):
                setattr(self, name, getattr(real, name))

    @property
    def __class__(self) -> Any:
        return type(self._real)

    @__class__.setter
    def __class__(self, _other: object) -> None:
        raise TypeError("__class__ assignment only supported for mutable types or ModuleType subclasses")

    def __repr__(self) -> str:
        return repr(self._real)

    def __reduce_ex__(self, _protocol: object) -> str:
        # By its name, as builtins are pickled: a copy is the thing itself.
        return str(self._real.__qualname__)


def stand_in(real: Any, does: Callable[..., Any], takes: tuple[int, int] | None = None) -> Any:
    """Return what stands in for a builtin function.

    Args:
        real: The builtin.
        does: What is done instead.
        takes: Least and most arguments, all of them by position: for any others the builtin says what is wrong.
            Without it, `does` has a signature of its own.
    """
    if takes is None:
        does.__qualname__ = real.__qualname__
        call = does
    else:
        least, most = takes

        def call(*given: Any, **named: Any) -> Any:
            if named or not least <= len(given) <= most:
                return real(*given, **named)
            return does(*given)

    return type(type(real).__name__, (_StandIn,), {"__call__": staticmethod(call)})(real)


def replace(
    module: types.ModuleType, name: str, does: Callable[..., Any], takes: tuple[int, int] | None = None
) -> None:
    """Let a function of a module do something else, and that of the module that it comes from.

    Args:
        module: Such as `os`, which has most of its functions from `posix`.
        name: Of the function, a builtin or one in Python.
        does, takes: As for `stand_in`.
    """
    real = getattr(module, name)
    replacement = wraps(real)(does) if isinstance(real, types.FunctionType) else stand_in(real, does, takes)
    for place in (module, sys.modules.get(real.__module__)):
        if getattr(place, name, None) is real:
            setattr(place, name, replacement)
