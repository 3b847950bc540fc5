"""Which calls the text of a program has, whatever it calls them.

Names are resolved as far as they are clear from the text: imports under other names, a variable that is assigned
another name or a new object of a class, and the names that a prelude defines. Nothing is executed.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import field
from functools import lru_cache

from tuisim.base.data_class import dataclass
from tuisim.base.source import PRELUDE_TEXTS, PYBRICKS
from tuisim.base.syntax_tree import parse_module

_MAX_MEANING = 200
"""Longer meanings of names, in characters, are not followed."""
_DEFAULT_PRELUDE = "preloaded"
"""Its names mean the same in a goals file, whichever prelude a program has."""


@dataclass
class _Names:
    """What the names of a program stand for."""

    meanings: dict[str, str] = field(default_factory=dict)
    """By name, or by attribute such as `self.tank`."""
    all_of: list[str] = field(default_factory=list)
    """Modules of which everything is imported."""

    def of(self, node: ast.expr) -> str:
        """Return what an expression stands for, such as `ev3dev2.motor.MoveTank().on`; empty if that is not clear."""
        match node:
            case ast.Name(id=name):
                return self.meanings.get(name, name)
            case ast.Attribute(value=value, attr=attr):
                known = self.meanings.get(ast.unparse(node))
                inner = self.of(value)
                return known or (f"{inner}.{attr}" if inner else "")
            case ast.Call(func=func):
                inner = self.of(func)
                return f"{inner}()" if inner else ""
        return ""

    def take_in(self, tree: ast.AST) -> None:
        """Note the names that a program imports and assigns."""
        for node in ast.walk(tree):
            match node:
                case ast.Import(names=names):
                    for alias in names:
                        first = alias.name if alias.asname else alias.name.partition(".")[0]
                        self.meanings[alias.asname or first] = first
                case ast.ImportFrom(module=str(module), names=names, level=0):
                    for alias in names:
                        if alias.name == "*":
                            self.all_of.append(module)
                        else:
                            self.meanings[alias.asname or alias.name] = f"{module}.{alias.name}"
        # Assignments in the order of the text: one may use another.
        for node in ast.walk(tree):
            match node:
                case ast.Assign(
                    targets=targets, value=ast.Name() | ast.Attribute() | ast.Call() as value
                ):
                    meaning = self.of(value)
                    for target in targets:
                        self._assign(target, meaning)
                case (
                    ast.NamedExpr(target=target, value=value)
                    | ast.AnnAssign(target=target, value=ast.expr() as value)
                ):
                    self._assign(target, self.of(value))

    def _assign(self, target: ast.expr, meaning: str) -> None:
        # `x = x.y` in many lines would take a long time.
        if not 0 < len(meaning) <= _MAX_MEANING:
            return
        if isinstance(target, ast.Name | ast.Attribute) and meaning != ast.unparse(target):
            self.meanings[ast.unparse(target)] = meaning

    def may_be(self, meaning: str, whole: set[str]) -> bool:
        """Return whether what an expression stands for is one of several names."""
        return meaning in whole or any(f"{module}.{meaning}" in whole for module in self.all_of)


@lru_cache
def _prelude_names(prelude: str) -> _Names:
    names = _Names()
    names.take_in(parse_module(PRELUDE_TEXTS.get(prelude, "")))
    return names


def _calls(tree: ast.AST, names: _Names) -> Iterator[tuple[str, str, int]]:
    """Yield what each call stands for, its text, and its line."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            yield names.of(node.func), ast.unparse(node.func), node.lineno


def list_calls(tree: ast.Module, prelude: str, wanted: str) -> list[int]:
    """Return the lines of a program with a call, in ascending order.

    Args:
        tree: The program.
        prelude: Its prelude, a key of `PRELUDE_TEXTS`.
        wanted: The call: a name such as `time.sleep`, a method of an object that the prelude defines such as
            `tank_drive.on`, or the name of a function or method alone. An object of the same class counts as well.
    """
    names = _Names(dict(_prelude_names(prelude).meanings))
    names.take_in(tree)
    wanted = wanted.removesuffix("()")
    head, _, rest = wanted.partition(".")
    # `sleep` alone is any function or method of that name.
    if not rest:
        return sorted(
            {
                line
                for meaning, said, line in _calls(tree, names)
                if wanted in (said.rpartition(".")[2], meaning.rpartition(".")[2])
            }
        )
    meant = _prelude_names(_DEFAULT_PRELUDE).meanings.get(head, head)
    whole = {wanted, f"{meant}.{rest}"}
    # `MoveTank.on` is also a method of an object of the class.
    owner, _, method = f"{meant}.{rest}".rpartition(".")
    whole |= {f"{owner}().{method}"}
    # `DriveBase.straight` is one of the class that the program imports from Pybricks.
    own = names.meanings.get(head, "")
    if own.partition(".")[0] == PYBRICKS:
        whole |= {f"{own}.{rest}", f"{own}().{rest}"}
    calls = _calls(tree, names)
    return sorted(
        {line for meaning, said, line in calls if names.may_be(meaning, whole) or said == wanted}
    )
