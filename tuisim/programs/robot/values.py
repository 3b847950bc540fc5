"""What an expression of a program can be, besides the numbers and texts of Python."""

from __future__ import annotations

import ast
from dataclasses import field
from typing import TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.scopes import Function, Scope


@dataclass(frozen=True, slots=True)
class LibraryModule:
    """A possible value of an expression in a program: a module of a library for a brick."""

    name: str


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """A possible value of an expression in a program: a class of a library for a brick."""

    name: str


@dataclass(frozen=True, slots=True)
class SourceModule:
    """A possible value of an expression in a program: one of the program's own modules."""

    name: str


@dataclass(frozen=True, slots=True)
class OwnClass:
    """A possible value of an expression in a program: a class that the program defines."""

    scope: Scope


@dataclass(frozen=True, slots=True)
class OwnFunction:
    """A possible value of an expression in a program: a function that the program defines."""

    node: Function
    scope: Scope
    """The scope of the function itself."""
    is_bound: bool = False
    """Whether it is called without its first parameter."""


@dataclass(frozen=True, slots=True)
class Instance:
    """A possible value of an expression in a program: an object, which a call of a class created."""

    of: OwnClass | LibraryClass
    call: ast.Call | None = None
    """None for the `self` of a method."""
    via: ast.Call | None = field(default=None, compare=False)
    """The call of the program's function or class that makes it with `call`, if that is known."""


@dataclass(frozen=True, slots=True)
class Parent:
    """A possible value of an expression in a program: the result of `super()` in a method of a class."""

    of: Scope


@dataclass(frozen=True, slots=True)
class SourceCollection:
    """A possible value of an expression in a program: a list, tuple, set or dict whose items the text shows."""

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
