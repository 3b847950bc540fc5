"""A function of Python as a program: its source, and what it uses of the file or notebook around it."""

from __future__ import annotations

import ast
import inspect
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from textwrap import dedent
from types import FunctionType, ModuleType
from typing import Any

from tuisim.base.errors import ConfigError
from tuisim.base.source import LIBRARIES, PRELUDE_TEXTS
from tuisim.programs.program_file import ProgramSource, parse_program
from tuisim.programs.robot.course import list_global_names

_IMPORTED = {*LIBRARIES, *sys.stdlib_module_names}
"""Packages that a program imports, as the function's own file does."""


def read_function(function: Callable[[], object]) -> ProgramSource:
    """Return a program that calls a function.

    Each line has the number that it has in the file of the function. Imports of libraries for a brick and of Python's
    own, plain constants, and functions that it uses are copied; names without a definition are those of the prelude.

    Raises:
        ConfigError: it is no function with a name and a source, takes arguments, or uses something else.
    """
    if not isinstance(function, FunctionType) or function.__name__ == "<lambda>":
        raise ConfigError(
            f"{function!r} is not a program", "give the name of a file, or a function made by def"
        )
    needed = [
        parameter.name
        for parameter in inspect.signature(function).parameters.values()
        if parameter.default is parameter.empty
        and parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    ]
    if needed:
        message = f"{function.__name__} as a program takes no arguments: {', '.join(needed)}"
        raise ConfigError(message, "give them defaults")
    reader = _Reader()
    reader.add_function(function)
    file = inspect.getsourcefile(function) or ""
    path = file if os.path.isfile(file) else ""
    name = ":".join(filter(None, (os.path.basename(path), function.__name__)))
    source = parse_program(reader.write(function.__name__), name, path)
    if reader.unknown.isdisjoint(list_global_names(PRELUDE_TEXTS["preloaded"])[1]):
        return source
    return replace(source, program=replace(source.program, prelude="preloaded"))


class _Reader:
    """Collects the functions of a program, and the statements that define the other names."""

    def __init__(self) -> None:
        self._functions: dict[str, FunctionType] = {}
        self._statements: dict[str, str] = {}
        self._lines: dict[int, str] = {}
        """By their numbers, from 1."""
        self.unknown: set[str] = set()
        """Names that the functions know from nowhere."""

    def add_function(self, function: FunctionType) -> None:
        """Add a function, and what it uses.

        Raises:
            ConfigError: it has no source, or uses what cannot go along.
        """
        name = function.__name__
        self._functions[name] = function
        try:
            lines, first = inspect.getsourcelines(function)
        except (OSError, TypeError):
            hint = "define it in a file or a notebook: this prompt keeps no source"
            raise ConfigError(f"the function {name} has no source", hint) from None
        text = dedent("".join(lines))
        self._place(text.rstrip().split("\n"), first)
        used, defined = list_global_names(text)
        values = {**function.__globals__, **_read_closure(function)}
        self.unknown |= used - defined - values.keys()
        for other in sorted((used - defined) & values.keys()):
            self._add(other, values[other], name)

    def _place(self, lines: Sequence[str], first: int) -> None:
        """Give lines the numbers that they have in their file, or others if they are from another file."""
        if not self._lines.keys().isdisjoint(range(first, first + len(lines))):
            first = max(self._lines) + 1
        self._lines |= dict(enumerate(lines, first))

    def _add(self, name: str, value: Any, user: str) -> None:
        """Add the object that a function uses by a name: a statement that defines it, or another function."""
        if statement := _write_statement(name, value):
            self._statements[name] = statement
        elif not isinstance(value, FunctionType) or value.__name__ != name:
            message = f"{user} uses {name}, a {type(value).__name__}, which cannot go along"
            raise ConfigError(message, "make it inside the function")
        elif name not in self._functions:
            self.add_function(value)
        elif self._functions[name] is not value:
            raise ConfigError(f"{user} uses another function {name}", "give it another name")

    def write(self, name: str) -> str:
        """Return the program that calls a function."""
        numbered = {**self._lines}
        last = max(self._lines)
        # All on one line, so that the functions keep theirs; on the first if it is free, since defaults need them.
        place = last + 1 if 1 in numbered else 1
        numbered[place] = "; ".join(self._statements.values())
        numbered[last + 2] = f"{name}()"
        return "\n".join(numbered.get(number, "") for number in range(1, last + 3)) + "\n"


def _read_closure(function: FunctionType) -> dict[str, Any]:
    """Return the variables that a function uses of the functions around it, by name."""
    values = {}
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        with suppress(ValueError):  # not assigned yet
            values[name] = cell.cell_contents
    return values


def _write_statement(name: str, value: Any) -> str:
    """Return a statement that defines a name with a value; empty if no statement can."""
    if isinstance(value, ModuleType):
        return f"import {value.__name__} as {name}" if _is_imported(value.__name__) else ""
    with suppress(SyntaxError, ValueError, TypeError):
        if ast.literal_eval(repr(value)) == value:
            return f"{name} = {value!r}"
    module = getattr(value, "__module__", None) or ""
    own = getattr(value, "__qualname__", "")
    if _is_imported(module) and own.isidentifier():
        return f"from {module} import {own} as {name}"
    return ""


def _is_imported(module: str) -> bool:
    return module != "__main__" and module.partition(".")[0] in _IMPORTED
