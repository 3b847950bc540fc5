"""What an expression of a program can be, besides the numbers and texts of Python."""

from __future__ import annotations

import ast
from dataclasses import field
from typing import TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.scopes import Function, Scope


@dataclass(frozen=True, slots=True)
class LibraryModule:
    """An expression's value that is a module of one of the libraries for a brick."""

    name: str


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """An expression's value that is a class of a library for a brick."""

    name: str


@dataclass(frozen=True, slots=True)
class SourceModule:
    """An expression's value that is a module of the program."""

    name: str


@dataclass(frozen=True, slots=True)
class OwnClass:
    """An expression's value that is a class of the program."""

    scope: Scope


@dataclass(frozen=True, slots=True)
class OwnFunction:
    """An expression's value that is a function of the program."""

    node: Function
    scope: Scope
    """The scope of the function itself."""
    is_bound: bool = False
    """Whether it is called without its first parameter."""


@dataclass(frozen=True, slots=True)
class Instance:
    """An expression's value that is an object, created by a call of a class."""

    of: OwnClass | LibraryClass
    call: ast.Call | None = None
    """None for the `self` of a method."""
    via: ast.Call | None = field(default=None, compare=False)
    """The call of the program's function or class that makes it with `call`, if that is known."""


@dataclass(frozen=True, slots=True)
class Parent:
    """An expression's value that is the result of `super()` in a method of a class."""

    of: Scope


@dataclass(frozen=True, slots=True)
class SourceCollection:
    """An expression's value that is a list, tuple, set or dict, with its items in the program's text."""

    node: ast.List | ast.Tuple | ast.Set | ast.Dict
    scope: Scope

    @property
    def keys(self) -> list[ast.expr | None]:
        """The expressions for the keys of a dict, None for a `**` in it; empty for other collections."""
        return list(self.node.keys) if isinstance(self.node, ast.Dict) else []

    @property
    def items(self) -> list[ast.expr]:
        """The values of a dict, or the items of another collection."""
        return self.node.values if isinstance(self.node, ast.Dict) else self.node.elts


Constant: TypeAlias = str | int | float | None
Value: TypeAlias = (
    Constant
    | LibraryModule
    | LibraryClass
    | SourceModule
    | OwnClass
    | OwnFunction
    | Instance
    | Parent
    | SourceCollection
)


def is_number(value: Value) -> bool:
    """Return whether a value is a number, and not True or False."""
    return isinstance(value, int | float) and not isinstance(value, bool)
