"""Replacements for builtins that look like builtins: in class bodies, in `inspect` and `pickle`, and in their repr."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from functools import wraps
from importlib.machinery import ModuleSpec
from typing import Any

_patched: dict[str, types.ModuleType] = {}
"""The modules in which a function was replaced, by name."""

_SAME = ("__name__", "__qualname__", "__module__", "__doc__", "__self__", "__text_signature__")


class Replacement:
    """Base class of callables that replace builtins. Like a builtin, they do not become methods in a class body.

    Args:
        real: The builtin that it replaces.
    """

    def __init__(self, real: Any) -> None:
        self._real = real
        for name in _SAME:
            if hasattr(real, name):
                setattr(self, name, getattr(real, name))

    @property
    def __class__(self) -> Any:
        # `__class__` instead of `type`, because the replaced function may itself be a replacement.
        return self._real.__class__

    @__class__.setter
    def __class__(self, _other: object) -> None:
        raise TypeError(
            "__class__ assignment only supported for mutable types or ModuleType subclasses"
        )

    def __repr__(self) -> str:
        return repr(self._real)

    def __reduce_ex__(self, _protocol: object) -> str:
        # It is pickled by its name, as builtins are, so that unpickling gives the same object.
        return str(self._real.__qualname__)


def build_replacement(
    real: Any, does: Callable[..., Any], takes: tuple[int, int] | None = None
) -> Any:
    """Return a callable that replaces a builtin function.

    Args:
        real: The builtin.
        does: The function to call instead.
        takes: Smallest and largest number of positional arguments; with any others, the builtin is called and raises
            its error. None if `does` checks its arguments itself.
    """
    if takes is None:
        does.__qualname__ = real.__qualname__
        call = does
    else:
        min_count, max_count = takes

        def call(*given: Any, **named: Any) -> Any:
            if named or not min_count <= len(given) <= max_count:
                return real(*given, **named)
            return does(*given)

    return type(real.__class__.__name__, (Replacement,), {"__call__": staticmethod(call)})(real)


def replace(
    module: types.ModuleType,
    name: str,
    does: Callable[..., Any],
    takes: tuple[int, int] | None = None,
) -> None:
    """Replace a function in a module, and in the module that defines it.

    Args:
        module: A module such as `os`, most of whose functions come from `posix`.
        name: Name of the function, a builtin or one in Python.
        does: The function to call instead.
        takes: Smallest and largest number of positional arguments of a builtin; see `build_replacement`.
    """
    real = getattr(module, name)
    replacement = (
        wraps(real)(does)
        if isinstance(real, types.FunctionType)
        else build_replacement(real, does, takes)
    )
    for place in (module, sys.modules.get(real.__module__)):
        if place is not None and getattr(place, name, None) is real:
            setattr(place, name, replacement)
            _patched[place.__name__] = place


class PatchedModules:
    """Module finder for patched modules that a program has removed from `sys.modules`.

    Otherwise the program would import a new module without patches, such as one with the real clock.
    """

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        """Return the spec of a patched module; None for any other module."""
        loader: Any = self
        return ModuleSpec(fullname, loader) if fullname in _patched else None

    def create_module(self, spec: ModuleSpec) -> types.ModuleType:
        """Return the patched module."""
        return _patched[spec.name]

    def exec_module(self, module: types.ModuleType) -> None:
        """Do nothing: the module has been executed before."""
