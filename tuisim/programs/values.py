"""Values as expressions of a program."""

from __future__ import annotations

import copy
import math
import sys
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import fields, is_dataclass
from enum import Enum
from inspect import unwrap
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any

from tuisim.base.errors import ConfigError
from tuisim.base.source import LIBRARIES

_IMPORTED = {*LIBRARIES, *sys.stdlib_module_names}
"""Packages that a program imports, as the function's own file does."""
_INSTALLED = {"site-packages", "dist-packages"}
_CONSTANTS = (bool, int, float, complex, str, bytes, type(None))


class ValueWriter:
    """Writes Python values as expressions.

    Attributes:
        names: The classes and functions that the expressions use, by name.
    """

    def __init__(self) -> None:
        self.names: dict[str, Any] = {}
        self._built: dict[int, object] = {}
        """The objects with a state of their own that are written, by their `id`."""

    def write(self, value: Any) -> str:
        """Return an expression with a given value; a NumPy number becomes a Python number.

        Raises:
            ConfigError: the same object would be created twice, or the value is of a kind that cannot be written. The
                kinds that can be written are constants, members of an Enum, functions and classes of the user or of
                Python, containers, and objects that consist of them.
        """
        if getattr(value, "shape", None) == ():
            value = value.item()
        kind = type(value)
        if kind is float and not math.isfinite(value):
            return f"float('{value}')"
        if kind in _CONSTANTS:
            return repr(value)
        if kind is dict:
            pairs = (f"{self.write(key)}: {self.write(each)}" for key, each in value.items())
            return f"{{{', '.join(pairs)}}}"
        if kind in (list, tuple, set, frozenset):
            items = [self.write(each) for each in value]
            if kind is tuple:
                return f"({', '.join(items)}{',' * (len(items) == 1)})"
            listed = f"[{', '.join(items if kind is list else sorted(items))}]"
            return listed if kind is list else f"{kind.__name__}({listed})"
        if isinstance(unwrap(value), type | FunctionType | BuiltinFunctionType):
            return self._write_name(value)
        if isinstance(value, Enum) and value.name in kind.__members__:
            return f"{self._write_name(kind)}.{value.name}"
        if names := list_parts(kind):
            parts = (f"{name}={self.write(getattr(value, name))}" for name in names)
            return f"{self._write_name(kind)}({', '.join(parts)})"
        return self._write_object(value)

    def _write_name(self, value: Any) -> str:
        """Return the name of a class or function, which the program must be able to define or import."""
        name = str(value.__name__)
        if value.__module__ != "builtins":
            is_known = write_import(name, value) or is_own(value.__module__)
            if not is_known or self.names.setdefault(name, value) is not value:
                raise build_value_error(value)
        return name

    def _write_object(self, value: Any) -> str:
        """Return an expression that creates a copy of an object.

        Like `copy.copy`, it creates a new object of the same class, and gives it the same state.
        """
        try:
            function, arguments, *states = value.__reduce_ex__(4)
        except Exception:  # Any error means that the object cannot be copied.
            raise build_value_error(value) from None
        if not any(states):
            return f"{self.write(function)}({', '.join(map(self.write, arguments))})"
        if id(value) in self._built:
            raise build_value_error(value)
        self._built[id(value)] = value
        state, *items = states
        parts = [function, arguments, state, *(each and [*each] for each in items)]
        build = self._write_name(copy._reconstruct)  # type: ignore[attr-defined]
        return f"{build}(None, None, {', '.join(map(self.write, parts))})"


def build_value_error(value: object) -> ConfigError:
    """Return the error for a value that cannot be written as an expression."""
    text = repr(value).partition("\n")[0]
    return ConfigError(f"{text} cannot go along", "such as a number, text or list", key="constants")


def write_value(value: object, known: Collection[str] = ()) -> str:
    """Return an expression with a given value that uses only Python's own names and the names in `known`.

    Args:
        value: The value.
        known: Other names that the expression may use.

    Raises:
        ConfigError: the value cannot be written as an expression, or its expression needs other names.
    """
    writer = ValueWriter()
    with suppress(ConfigError, RecursionError):
        text = writer.write(value)
        if writer.names.keys() <= {*known}:
            return text
    raise build_value_error(value)


def is_plain(value: object) -> bool:
    """Return whether a value can be written as an expression with only Python's own names."""
    try:
        write_value(value)
    except ConfigError:
        return False
    return True


def list_parts(kind: type) -> Sequence[str]:
    """Return the names of the fields of a NamedTuple or dataclass, if their values are all that creates an object.

    The result is empty for any other class.
    """
    if not is_dataclass(kind):
        return getattr(kind, "_fields", ()) if issubclass(kind, tuple) else ()
    of_kind = fields(kind)
    is_direct = "__init__" in vars(kind) and not hasattr(kind, "__post_init__")
    return [field.name for field in of_kind] if is_direct and all(f.init for f in of_kind) else ()


def is_own(module: str) -> bool:
    """Return whether a module is one of the user's: not a library, not installed, and not part of tuisim."""
    if module == "__main__":
        return True
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None or is_library(module) or module.startswith("tuisim."):
        return False
    return _INSTALLED.isdisjoint(Path(file).parts)


def write_import(name: str, value: Any) -> str:
    """Return a statement that imports a module, or an object that a library defines.

    The result is empty if the program cannot import it.

    Args:
        name: The name that the statement must define.
        value: The module or object.
    """
    if isinstance(value, ModuleType):
        return f"import {value.__name__} as {name}" if is_library(value.__name__) else ""
    module = getattr(value, "__module__", None) or ""
    own = getattr(value, "__qualname__", None) or ""
    if isinstance(module, str) and is_library(module) and own.isidentifier():
        return f"from {module} import {own} as {name}"
    return ""


def is_library(module: str) -> bool:
    """Return whether a module belongs to a library for a brick or to Python."""
    return module not in ("__main__", "builtins") and module.partition(".")[0] in _IMPORTED
