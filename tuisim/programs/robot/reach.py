"""Which parts of a program can run: its functions and classes that something refers to."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from tuisim.programs.robot.library import CLASSES
from tuisim.programs.robot.scopes import Scope


def find_reachable(modules: Mapping[str, Scope]) -> list[Scope]:
    """Return the scopes of a program that can run: first the program's own, then those of its modules.

    A function can run if its name is used anywhere in code that can run; the body of a class always runs.
    """
    scopes: list[Scope] = []
    names: set[str] = set()
    waiting = list(modules.values())
    left: list[Scope] = []
    while waiting:
        for scope in waiting:
            scopes.append(scope)
            names.update(_list_names(scope))
            left += scope.inner.values()
        waiting = [scope for scope in left if _is_used(scope, names)]
        left = [scope for scope in left if scope not in waiting]
    return scopes


def find_skipped(scope: Scope) -> set[ast.AST]:
    """Return the nodes of a module below `if __name__ == …`, which do not run because the module is imported."""
    nodes: set[ast.AST] = set()
    if scope.outer is None and scope.module.name:
        for node in scope.module.tree.body:
            match node:
                case ast.If(test=ast.Compare(left=ast.Name(id="__name__"))):
                    nodes.update(inner for statement in node.body for inner in ast.walk(statement))
    return nodes


def _list_names(scope: Scope) -> Iterator[str]:
    left_out = find_skipped(scope)
    for node in scope.body:
        if node in left_out:
            continue
        match node:
            case ast.Name(id=name, ctx=ast.Load()) | ast.Attribute(attr=name):
                yield name
            case ast.Constant(value=str(name)) if name.isidentifier():
                # A text may be the name of an attribute, as in `getattr(robot, "lift")`.
                yield name


def _is_used(scope: Scope, names: set[str]) -> bool:
    node = scope.node
    owner = scope.outer
    assert not isinstance(node, ast.Module)
    if isinstance(node, ast.ClassDef):
        return True
    if owner is None or not isinstance(owner.node, ast.ClassDef):
        return node.name in names or bool(node.decorator_list)
    if owner.node.name not in names and not owner.node.decorator_list:
        return False
    if node.name in names or node.decorator_list:
        return True
    # Python calls special methods, and a base class from a library may call others.
    return (node.name.startswith("__") and node.name.endswith("__")) or any(
        map(_is_foreign, owner.node.bases)
    )


def _is_foreign(base: ast.expr) -> bool:
    match base:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name in ("Thread", "Process", "Timer") or (
                name not in CLASSES and name.endswith("Handler")
            )
    return False
