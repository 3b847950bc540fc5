"""What is around a function: the values that it finds by name, and the statements that have made them."""

from __future__ import annotations
import __future__

import ast
import builtins
import inspect
import math
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from importlib.util import resolve_name
from types import CellType, CodeType, FunctionType, ModuleType
from typing import Any, Self

from tuisim.base.errors import ConfigError
from tuisim.base.syntax_tree import NOT_PYTHON, parse_module
from tuisim.programs.values import ValueWriter, is_library, is_own, is_plain, list_parts

_PURE = (abs, bool, dict, float, int, len, list, max, min, pow, round, set, sorted, str, sum, tuple)
"""Functions that give the same value each time, and do nothing else."""
_UNKNOWN = ast.Pass()


class Surroundings:
    """The names that a function or a class can use from outside: its globals and the variables of functions around it.

    Args:
        values: Its global names.
        file: Its file; in a notebook the name of its cell.
        text: The text of the file.
        cells: The variables of the functions around it, by name.
    """

    def __init__(
        self, values: Mapping[str, Any], file: str, text: str, cells: Mapping[str, CellType]
    ) -> None:
        self._globals = values
        self._cells = cells
        self.file = file
        self._text = text
        self.values = {**values}
        for name, cell in cells.items():
            with suppress(ValueError):  # an empty cell: the variable is not assigned yet
                self.values[name] = cell.cell_contents
        # IPython keeps the texts of the cells that have run in `In`, the latest at the end.
        inputs = values.get("In")
        texts = inputs[::-1] if isinstance(inputs, list) else [text]
        self._texts = [(_parse(each), each) for each in texts if isinstance(each, str)]

    @classmethod
    def read_function(cls, function: FunctionType, text: str) -> Self:
        """Return the surroundings of a function.

        Args:
            function: The function.
            text: The text of its file.
        """
        code = function.__code__
        cells = dict(zip(code.co_freevars, function.__closure__ or (), strict=True))
        return cls(function.__globals__, code.co_filename, text, cells)

    @classmethod
    def read_module(cls, module: ModuleType) -> Self:
        """Return the surroundings of the functions in a module."""
        try:
            text = inspect.getsource(module)
        except (OSError, TypeError):
            text = ""
        return cls(vars(module), getattr(module, "__file__", None) or "", text, {})

    def check_source(self, functions: Iterable[FunctionType], name: str) -> None:
        """Check that functions are unchanged in their file since they were loaded.

        Args:
            functions: The functions.
            name: The name for the error.

        Raises:
            ConfigError: the file has changed.
        """
        codes = [function.__code__ for function in functions]
        own = [code for code in codes if code.co_filename == self.file]
        # Code that pytest has rewritten differs from its source, so it is not compared.
        if not own or "@pytest_ar" in self._globals:
            return
        flags = own[0].co_flags & __future__.annotations.compiler_flag
        try:
            codes = [*_list_codes(compile(self._text, "", "exec", flags, dont_inherit=True))]
        except (SyntaxError, ValueError):
            codes = []
        if any(code not in codes for code in own):
            message = f"the file of {name} has changed since it was imported"
            raise ConfigError(message, "import it again", file=self.file)

    def get_owner(self, name: str) -> int:
        """Return a number that identifies the scope in which a variable is, given by its name.

        Variables with the same name in different scopes have different numbers.
        """
        return id(self._cells.get(name, self._globals))

    def find(self, name: str) -> tuple[ast.stmt, str]:
        """Return the last statement that assigns a global name, and the text of the file or cell that contains it.

        If there is none, the statement is `pass`, and the text empty.
        """
        if name not in self._cells:
            for statements, text in self._texts:
                for statement in reversed(statements):
                    if name in _list_bound(statement):
                        return statement, text
        return _UNKNOWN, ""

    def name_file(self, text: str) -> str:
        """Return the name of these surroundings' file if `text`, from `find`, is the text of that file.

        The result is empty if `text` is that of another notebook cell.
        """
        return self.file if text.rstrip() == self._text.rstrip() else ""

    def find_expression(self, name: str) -> ast.expr | None:
        """Return the expression that the last assignment of a global name gives to it.

        The result is None if there is none, or if the statement also assigns other names.
        """
        match self.find(name)[0]:
            case ast.Assign(targets=[ast.Name()], value=value):
                return value
            case ast.AnnAssign(value=value):
                return value
        return None

    def find_import(self, name: str) -> str:
        """Return a statement that imports a name as these surroundings do, such as `from math import pi as pi`.

        The result is empty if the name is not imported from a library for a brick, or from one of Python's own modules.
        """
        module, original = self._find_module(name)
        return f"from {module} import {original} as {name}" if is_library(module) else ""

    def find_origin(self, name: str) -> tuple[str, Surroundings]:
        """Return the name of a value in the module that defines it, and the names around it in that module."""
        module, original = self._find_module(name)
        if not module:
            return name, self
        return Surroundings.read_module(sys.modules[module]).find_origin(original)

    def _find_module(self, name: str) -> tuple[str, str]:
        """Return the module from which a name is imported, and the name in that module; both empty for other names."""
        statement, _ = self.find(name)
        if isinstance(statement, ast.ImportFrom):
            names = {alias.asname or alias.name: alias.name for alias in statement.names}
            original = names.get(name, name)
            package = self._globals.get("__package__") or ""
            with suppress(ImportError):
                module = resolve_name("." * statement.level + (statement.module or ""), package)
                if getattr(sys.modules.get(module), original, None) is self.values[name]:
                    return module, original
        return "", ""

    def list_attributes(self, name: str, text: str) -> set[str]:
        """Return the attributes of a user's own module that a text reads, such as `speed` in `settings.speed`.

        The result is empty for other modules, and if the text uses the module in another way, for example as an
        argument.

        Args:
            name: The name of the module in these surroundings.
            text: The text of a function or class.
        """
        module = self.values[name]
        if not isinstance(module, ModuleType) or not is_own(module.__name__):
            return set()
        nodes = [*ast.walk(parse_module(text))]
        names = [node for node in nodes if isinstance(node, ast.Name) and node.id == name]
        read = {
            node.value: node.attr
            for node in nodes
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load)
        }
        return {read[node] for node in names} if read.keys() >= {*names} else set()

    def list_used(self, expression: ast.AST) -> set[str]:
        """Return the global names of these surroundings that an expression uses."""
        names = {node.id for node in ast.walk(expression) if isinstance(node, ast.Name)}
        return names & self.values.keys()

    def list_sources(self, name: str) -> set[str]:
        """Return the names from which the value of a name was computed, directly or in several steps."""
        sources: set[str] = set()
        names = [name]
        while names:
            statement, _ = self.find(names.pop())
            value = getattr(statement, "value", None) or getattr(statement, "iter", None)
            if value is not None:
                new = self.list_used(value) - sources
                sources |= new
                names += new
        return sources - {name}


def compute(expression: ast.expr, values: Mapping[str, Any]) -> str | None:
    """Evaluate an expression; return its value as the text of an expression, as `ValueWriter` writes it.

    The result is None if the expression uses anything but constants, `math` and classes that only store their values.
    """
    for node in ast.walk(expression):
        match node:
            case ast.Name(id=name):
                is_pure = _is_pure(values.get(name, getattr(builtins, name, None)))
            case ast.Attribute(value=ast.Name(id=name)):
                is_pure = values.get(name) is math
            case _:
                is_pure = not isinstance(node, ast.Attribute | ast.NamedExpr | ast.Lambda)
        if not is_pure:
            return None
    code = compile(ast.Expression(expression), "", "eval")
    try:
        return ValueWriter().write(eval(code, {**values}))
    except Exception:  # Any error means that the expression does not give the value.
        return None


def _is_pure(value: object) -> bool:
    is_known = any(value is each for each in (math, *_PURE))
    is_known |= isinstance(value, type) and bool(list_parts(value))
    is_known |= getattr(value, "__module__", None) == "math"
    return is_known or (is_plain(value) and not callable(value))


def _parse(text: str) -> list[ast.stmt]:
    """Return the statements of a text outside functions and classes, with the statements in blocks such as loops.

    The result is empty if the text is not Python.
    """
    try:
        return [*_list_statements(parse_module(text).body)]
    except NOT_PYTHON:
        return []


def _list_statements(nodes: Sequence[Any]) -> Iterator[ast.stmt]:
    for node in nodes:
        yield node
        if not isinstance(node, ast.FunctionDef | ast.ClassDef | ast.AsyncFunctionDef):
            for block in ("body", "handlers", "cases", "orelse", "finalbody"):
                yield from _list_statements(getattr(node, block, ()))


def _list_bound(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement assigns or defines."""
    match statement:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Import(names=aliases):
            yield from (alias.asname or alias.name.partition(".")[0] for alias in aliases)
        case ast.ImportFrom(module=str(module), names=[ast.alias(name="*")]):
            names = vars(sys.modules[module]) if module in sys.modules else ()
            yield from (name for name in names if not name.startswith("_"))
        case ast.ImportFrom(names=aliases):
            yield from (alias.asname or alias.name for alias in aliases)
        case ast.Assign() | ast.AnnAssign() | ast.AugAssign() | ast.For() | ast.With():
            targets = getattr(statement, "targets", None) or [statement]
            for node in (each for target in targets for each in ast.walk(target)):
                if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                    yield node.id


def _list_codes(code: CodeType) -> Iterator[CodeType]:
    """Yield a code object, and the code objects in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _list_codes(constant)
