"""A function of Python as a program: its source, and what it uses of the file or notebook around it."""

from __future__ import annotations

import ast
import inspect
import os
import sys
from collections.abc import Callable
from dataclasses import replace
from textwrap import dedent
from types import FunctionType
from typing import Any, NamedTuple

from tuisim.base.errors import ConfigError
from tuisim.base.source import PRELUDE_TEXTS, source_lines
from tuisim.base.syntax_tree import parse_module
from tuisim.programs.constants import quote_annotations, write_literal
from tuisim.programs.program_file import ProgramSource, parse_program
from tuisim.programs.robot.course import list_global_names
from tuisim.programs.surroundings import (
    Surroundings,
    compute,
    is_plain,
    write_import,
    write_instance,
)


def read_function(function: Callable[[], object]) -> ProgramSource:
    """Return a program that calls a function.

    Each line has the number that it has in the file of the function. Imports of libraries for a brick and of Python's
    own, plain constants, functions and classes that it uses are copied as they are written, and instances with plain
    values as calls of their class; names without a definition are those of the prelude.

    Raises:
        ConfigError: it is no function with a name and a source, takes arguments, uses something else, or its file has
            changed since.
    """
    function = inspect.unwrap(function)
    if not isinstance(function, FunctionType) or function.__name__ == "<lambda>":
        raise ConfigError(
            f"{function!r} is not a program", "give the name of a file, or a function made by def"
        )
    if inspect.iscoroutinefunction(function) or inspect.isgeneratorfunction(function):
        message = f"{function.__name__} does nothing when it is called"
        raise ConfigError(message, "call it from a function without async or yield")
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
    reader.add_function(function.__name__, function, "the script")
    file = inspect.getsourcefile(function) or ""
    path = file if os.path.isfile(file) else ""
    name = ":".join(filter(None, (os.path.basename(path), function.__name__)))
    source = replace(parse_program(reader.write(function.__name__), name, path), fixed=reader.fixed)
    if reader.unknown.isdisjoint(list_global_names(PRELUDE_TEXTS["preloaded"])[1]):
        return source
    return replace(source, program=replace(source.program, prelude="preloaded"))


class _Block(NamedTuple):
    """The lines of a function, a class or an instance."""

    name: str
    file: str
    first: int
    """The number of the first line, from 1."""
    lines: list[str]

    @property
    def is_evaluated(self) -> bool:
        """Whether it needs what it uses not only when it is called."""
        node = parse_module("\n".join(self.lines)).body[0]
        return not isinstance(node, ast.FunctionDef) or bool(
            node.decorator_list or node.args.defaults or node.args.kw_defaults
        )

    @property
    def numbered(self) -> dict[int, str]:
        """The lines by their number."""
        return dict(enumerate(self.lines, self.first))


class _Reader:
    """Collects functions and classes, and the statements that define the other names."""

    def __init__(self) -> None:
        self._owners: dict[str, object] = {}
        """What each name stands for."""
        self._statements: list[str] = []
        self._blocks: list[_Block] = []
        """Each after those that it uses."""
        self._aliases: list[str] = []
        self.unknown: set[str] = set()
        """Names that are known from nowhere."""
        self.fixed: dict[str, str] = {}
        """Constants of which another one has been computed outside the program, with the name of that one."""

    def add_function(self, name: str, function: FunctionType, user: str) -> None:
        """Add a function that is used by a name, and what it uses.

        Raises:
            ConfigError: it has no source, or uses what cannot go along.
        """
        if not self._claim(name, id(function), user):
            return
        own = function.__name__
        if own == "<lambda>":
            raise build_refusal(name, "lambda", user)
        try:
            lines, first = inspect.getsourcelines(function)
            text = "".join(inspect.findsource(function)[0])
        except (OSError, TypeError):
            hint = "define it in a file or a notebook: this prompt keeps no source"
            raise ConfigError(f"the function {own} has no source", hint) from None
        around = Surroundings.read_function(function, text)
        around.check_source([function], own)
        # The program decorates it again.
        public: Any = around.values.get(own)
        if lines[0].lstrip().startswith("@") and inspect.unwrap(public) is not function:
            raise ConfigError(f"a decorator hides {own}", "give it functools.wraps")
        if self._claim_own(name, own, user):
            self._add_block(_Block(own, function.__code__.co_filename, first, lines), around, own)

    def _add_class(self, name: str, kind: type, around: Surroundings, user: str) -> None:
        """Add a class that is used by a name, and what it uses."""
        own = kind.__name__
        if kind.__module__ != around.values.get("__name__"):
            around = Surroundings.read_module(sys.modules[kind.__module__])
        node, text = around.find(own)
        if not isinstance(node, ast.ClassDef):
            raise build_refusal(name, "type", user)
        if not self._claim(name, id(kind), user) or not self._claim_own(name, own, user):
            return
        methods = [each for each in vars(kind).values() if isinstance(each, FunctionType)]
        around.check_source(methods, own)
        first = min([node.lineno, *(each.lineno for each in node.decorator_list)])
        lines = [f"{line}\n" for line in source_lines(text)[first - 1 : node.end_lineno]]
        self._add_block(_Block(own, around.name_file(text), first, lines), around, own)

    def _add_block(self, block: _Block, around: Surroundings, user: str) -> None:
        text = quote_annotations(dedent("".join(block.lines)).rstrip())
        used, defined = list_global_names(text)
        self.unknown |= used - defined - around.values.keys()
        for name in sorted(used & around.values.keys()):
            self._add(name, around, user)
        self._blocks.append(block._replace(lines=text.split("\n")))

    def _claim_own(self, name: str, own: str, user: str) -> bool:
        """Return whether what a new name stands for, a function or class, is new under its own name, too."""
        if name == own:
            return True
        self._aliases.append(f"{name} = {own}")
        return self._claim(own, self._owners[name], user)

    def _claim(self, name: str, owner: object, user: str) -> bool:
        """Return whether a name is new.

        Raises:
            ConfigError: it stands for something else already.
        """
        is_new = name not in self._owners
        if self._owners.setdefault(name, owner) != owner:
            raise ConfigError(f"{user} uses another {name}", "give one of them another name")
        return is_new

    def _add(self, name: str, around: Surroundings, user: str) -> None:
        """Add the object that a function or a class uses by a name."""
        value = around.values[name]
        if statement := around.find_import(name) or write_import(name, value):
            if self._claim(name, statement, user):
                self._statements.append(statement)
        elif is_plain(value):
            self._add_constant(name, around, user)
        elif isinstance(value, type):
            self._add_class(name, value, around, user)
        elif isinstance(function := inspect.unwrap(value), FunctionType):
            self.add_function(name, function, user)
        elif expression := write_instance(value):
            self._add_instance(name, expression, around, user)
        else:
            raise build_refusal(name, type(value).__name__, user)

    def _add_constant(self, name: str, around: Surroundings, user: str) -> None:
        """Add a constant as it is written, if this gives the value that it has, else its value."""
        origin, source = around.find_origin(name)
        if origin != name:
            self._add_constant(origin, source, user)
            if self._claim(name, around.get_owner(name), user):
                self._statements.append(f"{name} = {origin}")
            return
        if not self._claim(name, source.get_owner(name), user):
            return
        value = source.values[name]
        expression = source.find_expression(name)
        if expression is not None and compute(expression, source.values) == write_literal(value):
            for other in sorted(source.list_used(expression)):
                self._add(other, source, user)
            self._statements.append(f"{name} = {ast.unparse(expression)}")
        else:
            self._statements.append(f"{name} = {write_literal(value)}")
            self.fixed |= dict.fromkeys(source.list_sources(name), name)

    def _add_instance(self, name: str, expression: str, around: Surroundings, user: str) -> None:
        """Add a value that a class gives, after its class."""
        value = around.values[name]
        if not self._claim(name, id(value), user):
            return
        origin, source = around.find_origin(name)
        kind = type(value)
        if statement := write_import(kind.__name__, kind):
            if self._claim(kind.__name__, statement, user):
                self._statements.append(statement)
        else:
            self._add_class(kind.__name__, kind, source, name)
        node, text = around.find(name)
        place = around.name_file(text), getattr(node, "lineno", 0)
        self._blocks.append(_Block(name, *place, [f"{name} = {expression}"]))
        self.fixed |= dict.fromkeys(source.list_sources(origin), name)

    def write(self, name: str) -> str:
        """Return the program that calls a function."""
        own = self._blocks[-1].file
        reserved = {
            number for block in self._blocks if block.file == own for number in block.numbered
        }
        # All on one line, so that the functions keep theirs; on the first if it is free, since defaults need them.
        place = max(reserved) + 1 if 1 in reserved else 1
        lines = {place: "; ".join(self._statements)}
        defined = place
        for block in self._blocks:
            numbered = block.numbered
            is_early = block.is_evaluated and block.first <= place
            if block.file != own or is_early or not lines.keys().isdisjoint(numbered):
                # A class may have its other name as a base.
                names = [alias for alias in self._aliases if alias.endswith(f" = {block.name}")]
                moved = [*block.lines, *names]
                first = (max(place, defined) if block.is_evaluated else place) + 1
                while not reserved.isdisjoint(range(first, first + len(moved))):
                    first += 1
                place = first + len(moved) - 1
                numbered = dict(enumerate(moved, first))
            elif block.is_evaluated:
                defined = max(numbered)
            lines |= numbered
        last = max(lines)
        lines[last + 2] = "; ".join([*self._aliases, f"{name}()"])
        return "\n".join(lines.get(number, "") for number in range(1, last + 3)) + "\n"


def build_refusal(name: str, kind: str, user: str) -> ConfigError:
    """Return the error for an object of a kind that cannot go along with its user."""
    message = f"{user} uses {name}, a {kind}, which cannot go along"
    verb = "import" if kind == "module" else "make"
    return ConfigError(message, f"{verb} it inside the function")
