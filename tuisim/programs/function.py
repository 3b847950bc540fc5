"""A function of Python as a program: its source, and what it uses of the file or notebook around it."""

from __future__ import annotations

import ast
import inspect
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from textwrap import dedent
from types import FunctionType, MethodType, ModuleType, SimpleNamespace
from typing import Any, NamedTuple

from tuisim.base.errors import ConfigError
from tuisim.base.source import PRELUDE_TEXTS, source_lines
from tuisim.base.syntax_tree import parse_module
from tuisim.programs.constants import quote_annotations
from tuisim.programs.program_file import ProgramSource, parse_program
from tuisim.programs.robot.course import list_global_names
from tuisim.programs.surroundings import Surroundings, compute
from tuisim.programs.values import ValueWriter, is_library, is_own, is_plain, write_import


def read_function(function: Callable[..., object]) -> ProgramSource:
    """Return a program that calls a function, a method of an object, or a `partial` of one with its arguments.

    Each line has the number that it has in the function's file. The program contains everything that the function uses:
    imports of libraries for a brick and of Python's own modules, the text of functions and classes, and values as text
    or as expressions that compute them. Names without a definition, such as `tank_drive`, are taken from the prelude,
    the code that runs before programs.

    Raises:
        ConfigError: `function` is no function with a name and a source, needs arguments, or uses something that cannot
            be copied; or its file has changed since it was loaded.
    """
    plain = SimpleNamespace(func=function, args=(), keywords={})
    called: Any = function if isinstance(function, partial) else plain
    method = inspect.unwrap(called.func)
    function = method.__func__ if isinstance(method, MethodType) else method
    if not isinstance(function, FunctionType) or function.__name__ == "<lambda>":
        what = "a lambda" if isinstance(function, FunctionType) else repr(function)
        hint = (
            "give the function itself, without brackets"
            if function is None
            else "give the name of a file, or a function made by def"
        )
        raise ConfigError(f"{what} is not a program", hint)
    name = function.__name__
    if inspect.iscoroutinefunction(function) or inspect.isgeneratorfunction(function):
        message = f"{name} does nothing when it is called"
        hint = "call it from a function without async or yield; a coroutine of Pybricks by run_task"
        raise ConfigError(message, hint)
    try:
        inspect.signature(method).bind(*called.args, **called.keywords)
    except TypeError as error:
        message = f"{name} as a program takes no arguments: {error}"
        raise ConfigError(message, "give them defaults, or functools.partial") from None
    reader = _Reader()
    arguments = reader.write_arguments(called.args, called.keywords)
    call = f"{reader.write_called(method)}({arguments})"
    file = inspect.getsourcefile(function) or ""
    path = file if os.path.isfile(file) else ""
    label = ":".join(filter(None, (os.path.basename(path), name)))
    source = replace(parse_program(reader.write(call), label, path), fixed=reader.fixed)
    if reader.unknown.isdisjoint(list_global_names(PRELUDE_TEXTS["preloaded"])[1]):
        return source
    return replace(source, program=replace(source.program, prelude="preloaded"))


class _Block(NamedTuple):
    """The lines that define a function, a class or a value."""

    name: str
    file: str
    first: int
    """The number of the first line, from 1."""
    lines: list[str]

    @property
    def is_evaluated(self) -> bool:
        """Whether Python needs other names as soon as it reads the definition, as for a class or a default value.

        A function without default values and decorators needs other names only when it is called.
        """
        node = parse_module("\n".join(self.lines)).body[0]
        return not isinstance(node, ast.FunctionDef) or bool(
            node.decorator_list or node.args.defaults or node.args.kw_defaults
        )

    @property
    def numbered(self) -> dict[int, str]:
        """The lines of the definition, by their number in the file."""
        return dict(enumerate(self.lines, self.first))


class _Reader:
    """Collects the functions, classes and values that a program needs, and writes the program."""

    def __init__(self) -> None:
        self._owners: dict[str, object] = {}
        """The object to which each name refers."""
        self._statements: list[str] = []
        self._blocks: list[_Block] = []
        """Each after those that it uses."""
        self._aliases: list[str] = []
        self._attributes: dict[str, set[str]] = {}
        """What is used of each module."""
        self._writer = ValueWriter()
        self.unknown: set[str] = set()
        """Names without any definition."""
        self.fixed: dict[str, str] = {}
        """Constants of which another one has been computed outside the program, with the name of that one."""

    def write_arguments(self, values: Sequence[object], named: Mapping[str, object]) -> str:
        """Return the text of a call's arguments, and add to the program the definitions that they use.

        Args:
            values: The positional arguments.
            named: The keyword arguments.
        """
        texts = [self._write(value, "an argument", "partial") for value in values]
        texts += [f"{name}={self._write(value, name, 'partial')}" for name, value in named.items()]
        self._add_names(Surroundings({}, "", "", {}), "partial")
        return ", ".join(texts)

    def write_called(self, function: FunctionType | MethodType) -> str:
        """Return the expression for a function, or for the method of an object.

        The definitions that the expression uses are added to the program.
        """
        name = function.__name__
        if isinstance(function, FunctionType):
            self.add_function(name, function, "the script")
            return name
        owner = self._write(function.__self__, name, "the script")
        self._add_names(Surroundings({}, "", "", {}), name)
        return f"{owner}.{name}"

    def _write(self, value: object, name: str, user: str) -> str:
        try:
            return self._writer.write(value)
        except (ConfigError, RecursionError):
            raise build_refusal(name, type(value).__name__, user) from None

    def add_function(self, name: str, function: FunctionType, user: str) -> None:
        """Add to the program a function and everything that it uses.

        Args:
            name: The function's name in the program.
            function: The function.
            user: What uses it, such as the name of a function, for errors.

        Raises:
            ConfigError: the function has no source, or uses something that cannot be copied.
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
        # The copied source includes the decorators, so the object of that name must wrap this function.
        public: Any = around.values.get(own)
        if lines[0].lstrip().startswith("@") and inspect.unwrap(public) is not function:
            raise ConfigError(f"a decorator hides {own}", "give it functools.wraps")
        if self._claim_own(name, own, user):
            self._add_block(_Block(own, function.__code__.co_filename, first, lines), around, own)

    def _add_class(self, name: str, kind: type, around: Surroundings, user: str) -> None:
        """Add to the program a class and everything that it uses.

        Args:
            name: The name of the class in the program.
            kind: The class.
            around: The names around the code that uses it.
            user: What uses it, such as the name of a function, for errors.
        """
        own = kind.__name__
        if kind.__module__ != around.values.get("__name__"):
            around = Surroundings.read_module(sys.modules[kind.__module__])
        node, text = around.find(own)
        if not isinstance(node, ast.ClassDef | ast.Assign):
            raise build_refusal(name, "type", user)
        if not self._claim(name, id(kind), user) or not self._claim_own(name, own, user):
            return
        methods = [each for each in vars(kind).values() if isinstance(each, FunctionType)]
        around.check_source(methods, own)
        decorators = getattr(node, "decorator_list", ())
        first = min([node.lineno, *(each.lineno for each in decorators)])
        lines = [f"{line}\n" for line in source_lines(text)[first - 1 : node.end_lineno]]
        self._add_block(_Block(own, around.name_file(text), first, lines), around, own)

    def _add_block(self, block: _Block, around: Surroundings, user: str) -> None:
        text = quote_annotations(dedent("".join(block.lines)).rstrip())
        used, defined = list_global_names(text)
        self.unknown |= used - defined - around.values.keys()
        for name in sorted(used & around.values.keys()):
            if names := around.list_attributes(name, text):
                self._add_module(name, around.values[name], names, user)
            else:
                self._add(name, around, user)
        self._blocks.append(block._replace(lines=text.split("\n")))

    def _add_module(self, name: str, module: ModuleType, names: set[str], user: str) -> None:
        """Add to the program the parts of a user's own module that the code uses.

        A `SimpleNamespace` in the program contains them. It has the module's name, so that expressions such as
        `module.part` still work.

        Args:
            name: The name of the module in the program.
            module: The module.
            names: The names in the module that the code uses.
            user: What uses it, such as the name of a function, for errors.
        """
        self._claim(name, id(module), user)
        around = Surroundings.read_module(module)
        self._attributes.setdefault(name, set()).update(names)
        for each in sorted(names & around.values.keys()):
            self._add(each, around, name)
        self._add_import("SimpleNamespace", "from types import SimpleNamespace", user)
        values = ", ".join(f"{each}={each}" for each in sorted(self._attributes[name]))
        self._blocks.append(_Block(name, "", 0, [f"{name} = SimpleNamespace({values})"]))

    def _claim_own(self, name: str, own: str, user: str) -> bool:
        """Register the name by which a function or class is defined; return whether its definition must still be added.

        Args:
            name: The name by which the code uses the function or class; if it differs from `own`, it becomes an alias.
            own: The name in the definition.
            user: What uses it, such as the name of a function, for errors.
        """
        if name == own:
            return True
        self._aliases.append(f"{name} = {own}")
        return self._claim(own, self._owners[name], user)

    def _claim(self, name: str, owner: object, user: str) -> bool:
        """Register that a name stands for an object in the program; return whether the name is new.

        Args:
            name: The name.
            owner: An id of the object.
            user: What uses it, such as the name of a function, for errors.

        Raises:
            ConfigError: the name stands for another object already.
        """
        is_new = name not in self._owners
        if self._owners.setdefault(name, owner) != owner:
            raise ConfigError(f"{user} uses another {name}", "give one of them another name")
        return is_new

    def _add(self, name: str, around: Surroundings, user: str) -> None:
        """Add to the program the object to which a name refers, and everything that it uses.

        Args:
            name: The name.
            around: The names around the code that uses it.
            user: What uses it, such as the name of a function, for errors.
        """
        if statement := around.find_import(name):
            self._add_import(name, statement, user)
        elif not self._add_named(name, around.values[name], around, user):
            self._add_value(name, around, user)

    def _add_import(self, name: str, statement: str, user: str) -> None:
        if self._claim(name, statement, user):
            self._statements.append(statement)

    def _add_named(self, name: str, value: Any, around: Surroundings, user: str) -> bool:
        """Add to the program the object that a name stands for, if it is a module, a class or a function.

        Return whether it is a module, a class or a function.

        Args:
            name: The name.
            value: The object.
            around: The names around the code that uses it.
            user: What uses it, such as the name of a function, for errors.
        """
        function = inspect.unwrap(value)
        if statement := write_import(name, value):
            self._add_import(name, statement, user)
        elif not isinstance(function, ModuleType | type | FunctionType):
            return False
        elif isinstance(value, type) and is_own(value.__module__):
            self._add_class(name, value, around, user)
        elif isinstance(function, FunctionType) and is_own(function.__module__):
            self.add_function(name, function, user)
        else:
            raise build_refusal(name, type(value).__name__, user)
        return True

    def _add_value(self, name: str, around: Surroundings, user: str) -> None:
        """Add to the program the assignment of a value that the code uses.

        The value is assigned as in its file if that gives the same value, otherwise by an expression for the present
        value.

        Args:
            name: The name of the value.
            around: The names around the code that uses it.
            user: What uses it, such as the name of a function, for errors.
        """
        origin, source = around.find_origin(name)
        if origin == name:
            around = source
        else:
            self._add(origin, source, user)
        if not self._claim(name, around.get_owner(name), user):
            return
        text = origin if origin != name else self._write_value(name, around, user)
        if is_plain(around.values[name]):
            self._statements.append(f"{name} = {text}")
        else:
            node, of_node = around.find(name)
            place = around.name_file(of_node), getattr(node, "lineno", 0)
            self._blocks.append(_Block(name, *place, [f"{name} = {text}"]))

    def _write_value(self, name: str, around: Surroundings, user: str) -> str:
        """Return the expression for the value of a name.

        The definitions that the expression uses are added to the program.
        """
        value = around.values[name]
        expression = around.find_expression(name)
        kind = type(value)
        try:
            text = self._writer.write(value)
        except (ConfigError, RecursionError):
            # A value that cannot be copied, such as a lock, is created by its original expression.
            if expression is None or not is_library(kind.__module__):
                raise build_refusal(name, kind.__name__, user) from None
            text = ""
        if expression and (not text or compute(expression, around.values) == text):
            for other in sorted(around.list_used(expression)):
                self._add(other, around, user)
            return ast.unparse(expression)
        self._add_names(around, name)
        self.fixed |= dict.fromkeys(around.list_sources(name), name)
        return text

    def _add_names(self, around: Surroundings, user: str) -> None:
        """Add to the program the classes and functions that the expressions written so far use.

        Args:
            around: The names around the code with these expressions.
            user: What uses them, such as the name of a function, for errors.
        """
        for name, value in [*self._writer.names.items()]:
            self._add_named(name, value, around, user)

    def write(self, call: str) -> str:
        """Return the text of the program: the collected definitions, and a call at the end.

        Args:
            call: The expression of the call.
        """
        own = self._blocks[-1].file
        reserved = {
            number for block in self._blocks if block.file == own for number in block.numbered
        }
        # All imports and values share one line, so that the functions keep their line numbers. It is line 1 if that is
        # free, since default values of the functions may use them.
        place = max(reserved) + 1 if 1 in reserved else 1
        lines = {place: "; ".join(self._statements)}
        defined = place
        for block in self._blocks:
            numbered = block.numbered
            is_early = block.is_evaluated and block.first <= place
            if block.file != own or is_early or not lines.keys().isdisjoint(numbered):
                # A class may be a base under its other name, so that name follows its definition.
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
        lines[last + 2] = "; ".join([*self._aliases, call])
        return "\n".join(lines.get(number, "") for number in range(1, last + 3)) + "\n"


def build_refusal(name: str, kind: str, user: str) -> ConfigError:
    """Return the error for an object that cannot be copied into a program.

    Args:
        name: The name of the object.
        kind: What it is, in words.
        user: The function or class that uses it.
    """
    message = f"{user} uses {name}, a {kind}, which cannot go along"
    return ConfigError(message, "import or make it inside the function")
