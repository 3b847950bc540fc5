"""Whether a program is one of the course's: it uses names that only the course's simulator has."""

from __future__ import annotations

import ast
import symtable
from collections.abc import Iterator, Mapping

from tuisim.base.source import PRELUDE_TEXTS
from tuisim.programs.robot.library import COURSE_MODULE
from tuisim.programs.robot.source import Module

_ATTRIBUTES = frozenset({"reflected_light_intensity_pc", "full_reflected_light_intensity"})
"""Attributes that the course adds to colour sensors."""


def has_course_names(modules: Mapping[str, Module], text: str) -> bool:
    """Return whether a program uses names that only the course's simulator has, such as `reflected_light_intensity_pc`.

    Args:
        modules: The program and its own modules.
        text: The text of the program, which may use names such as `tank_drive` that are defined before it runs.
    """
    trees = [module.tree for module in modules.values()]
    defined = {name for tree in trees for name in find_definitions(tree)}
    if any(
        name == COURSE_MODULE or (name in _ATTRIBUTES - defined)
        for tree in trees
        for name in _list_used(tree)
    ):
        return True
    _, ready = list_global_names(PRELUDE_TEXTS["preloaded"])
    used, known = list_global_names(text)
    if any(_is_star(node) for node in ast.walk(modules[""].tree)):
        # After `import *`, capitalized names may be a library's, so only other names show a program of the course.
        ready = {name for name in ready - defined if name[0].islower()}
    return bool((used - known) & ready)


def _list_used(tree: ast.Module) -> Iterator[str]:
    """Yield the attributes and the modules that a module uses."""
    for node in ast.walk(tree):
        match node:
            case (
                ast.Attribute(attr=name)
                | ast.ImportFrom(module=str(name))
                | ast.Import(names=[ast.alias(name=name)])
            ):
                yield name


def find_definitions(tree: ast.Module) -> Iterator[str]:
    """Yield the names that a module defines itself, in any scope."""
    for node in ast.walk(tree):
        match node:
            case (
                ast.FunctionDef(name=name)
                | ast.AsyncFunctionDef(name=name)
                | ast.ClassDef(name=name)
                | ast.Name(id=name, ctx=ast.Store())
            ):
                yield name


def _is_star(node: ast.AST) -> bool:
    return isinstance(node, ast.ImportFrom) and any(alias.name == "*" for alias in node.names)


def list_global_names(text: str) -> tuple[set[str], set[str]]:
    """Return the global names that a text uses, and those that it defines."""
    used: set[str] = set()
    defined: set[str] = set()
    tables = [symtable.symtable(text, "", "exec")]
    while tables:
        table = tables.pop()
        tables += table.get_children()
        for symbol in table.get_symbols():
            if table.get_type() != "module" and not symbol.is_global():
                continue
            if symbol.is_referenced():
                used.add(symbol.get_name())
            if symbol.is_assigned() or symbol.is_imported():
                defined.add(symbol.get_name())
    return used, defined
