"""Which calls the text of a program has, by whatever names it imports them.

Names are followed as far as they are clear from the text: imports under other names, a variable that is assigned
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
from tuisim.programs.robot.scopes import Binding, Bound, Imported, Scope, build_scope
from tuisim.programs.robot.source import Module

_MAX_MEANING = 200
"""Longer meanings of names, in characters, are not followed."""
_MAX_MEANINGS = 24
"""More meanings of one expression are not followed."""
_DEFAULT_PRELUDE = "preloaded"
"""Its names mean the same in a goals file, whichever prelude a program has."""


@dataclass(slots=True)
class _Names:
    """Finds out what the names of a program stand for.

    Args:
        prelude: The scope of its prelude.
    """

    prelude: Scope
    _known: dict[tuple[ast.expr, Scope], tuple[str, ...]] = field(default_factory=dict)

    def list_meanings(self, node: ast.expr, scope: Scope) -> tuple[str, ...]:
        """Return what an expression can stand for, such as `ev3dev2.motor.MoveTank().on`."""
        key = (node, scope)
        if key not in self._known:
            # Where a name refers to itself, nothing is known.
            self._known[key] = ()
            meanings = (
                meaning for meaning in self._follow(node, scope) if len(meaning) <= _MAX_MEANING
            )
            self._known[key] = tuple(dict.fromkeys(meanings))[:_MAX_MEANINGS]
        return self._known[key]

    def _follow(self, node: ast.expr, scope: Scope) -> Iterator[str]:
        match node:
            case ast.Name(id=name):
                bindings = scope.find_bindings(name) or self.prelude.find_bindings(name)
                yield from self._follow_bindings(name, bindings)
            case ast.Attribute(value=value, attr=attr):
                if isinstance(value, ast.Name) and value.id == "self" and scope.owner:
                    for binding in scope.owner.attributes.get(attr, ()):
                        yield from self._follow_bindings("", [binding])
                yield from (f"{inner}.{attr}" for inner in self.list_meanings(value, scope))
            case ast.Call(func=func):
                yield from (f"{inner}()" for inner in self.list_meanings(func, scope))

    def _follow_bindings(self, name: str, bindings: list[Binding]) -> Iterator[str]:
        meanings: list[str] = []
        for binding in bindings:
            match binding:
                case Imported(module=module, name=imported):
                    meanings.append(f"{module}.{imported}" if imported else module)
                case Bound(node=node, scope=scope, path=(), is_item=False):
                    meanings += self.list_meanings(node, scope)
        yield from meanings or ([name] if name else [])


@lru_cache
def _build_prelude_scope(prelude: str) -> Scope:
    return build_scope(Module("", "", parse_module(PRELUDE_TEXTS.get(prelude, ""))))


def _name_prelude(name: str, prelude: str) -> str:
    """Return what a name stands for in a prelude, or the name itself if the prelude does not define it."""
    names = _Names(_build_prelude_scope(prelude))
    return next(iter(names.list_meanings(ast.Name(name), names.prelude)))


def _list_scopes(scope: Scope) -> list[Scope]:
    return [scope, *(each for inner in scope.inner.values() for each in _list_scopes(inner))]


def list_calls(tree: ast.Module, prelude: str, wanted: str) -> list[int]:
    """Return the lines of a program with a call, in ascending order.

    Args:
        tree: The program.
        prelude: Its prelude, a key of `PRELUDE_TEXTS`.
        wanted: The call: a name such as `time.sleep`, a method of an object that the prelude defines such as
            `tank_drive.on`, or the name of a function or method alone. Objects of the same class count as well.
    """
    scopes = _list_scopes(build_scope(Module("", "", tree)))
    names = _Names(_build_prelude_scope(prelude))
    calls = [
        ({ast.unparse(call.func), *names.list_meanings(call.func, scope)}, call.lineno)
        for scope in scopes
        for call in scope.body
        if isinstance(call, ast.Call)
    ]
    wanted = wanted.removesuffix("()")
    head, _, rest = wanted.partition(".")
    # `sleep` alone is any function or method of that name.
    if not rest:
        return sorted(
            {
                line
                for meanings, line in calls
                if any(wanted == meaning.rpartition(".")[2] for meaning in meanings)
            }
        )
    meant = _name_prelude(head, _DEFAULT_PRELUDE)
    # `MoveTank.on` is also a method of an object of the class.
    owner, _, method = f"{meant}.{rest}".rpartition(".")
    whole = {wanted, f"{meant}.{rest}", f"{owner}().{method}"}
    # `DriveBase.straight` is one of the class that the program imports from Pybricks.
    for own in {
        meaning for scope in scopes for meaning in names.list_meanings(ast.Name(head), scope)
    }:
        if own.partition(".")[0] == PYBRICKS:
            whole |= {f"{own}.{rest}", f"{own}().{rest}"}
    # After `from ev3dev2.motor import *` a program writes `MoveTank` alone: accept it without the module, too.
    starred = [f"{module}." for scope in scopes for module in scope.stars]
    whole |= {
        meaning.removeprefix(module)
        for module in starred
        for meaning in whole
        if meaning.startswith(module)
    }
    return sorted({line for meanings, line in calls if meanings & whole})
