"""What MicroPython on a brick refuses: 1.11, of Pybricks 2.0, has the syntax of Python 3.4 and a bit more.

The MicroPython of Pybricks 4 has newer syntax, but lacks some modules and names.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.course import find_definitions
from tuisim.programs.robot.source import Module

MISSING_MODULES = "array", "asyncio", "collections", "os", "threading", "time"
MISSING = (*MISSING_MODULES, "filter", "frozenset", "open", "property", "sys.exit")
"""What Pybricks 4 lacks; it refuses nothing else of what `_name_refused` tells, and Pybricks 2.0 has it."""


@dataclass(frozen=True, slots=True)
class RefusedLine:
    """A line of a program with syntax that the brick's Python refuses."""

    file: str
    line: int
    what: str
    """The refused syntax, such as `f-string`, or name."""

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: the brick's Python would refuse this line ({self.what})"


def find_refused_lines(modules: Iterable[Module]) -> tuple[RefusedLine, ...]:
    """Return the lines of a program that the brick's Python refuses, in the order of its files and their lines."""
    return tuple(
        RefusedLine(module.file, line, what)
        for module in modules
        for line, what in sorted({*_find_refused(module.tree)})
    )


def _find_refused(tree: ast.Module) -> Iterator[tuple[int, str]]:
    own = {*find_definitions(tree)}
    for node in ast.walk(tree):
        what = _name_refused(node)
        if what and what not in own:
            yield getattr(node, "lineno", 0), what


def _name_refused(node: ast.AST) -> str:
    """Return the name of a node's syntax if the brick's Python refuses the syntax; else an empty text."""
    match node:
        case ast.alias(name=name) | ast.ImportFrom(module=str(name)) if name in MISSING_MODULES:
            return name
        case ast.Name(id="filter" | "frozenset" | "open" | "property" as name, ctx=ast.Load()):
            return name
        case ast.Attribute(value=ast.Name(id="sys" | "usys"), attr="exit"):
            return "sys.exit"
        case ast.JoinedStr():
            return "f-string"
        case ast.NamedExpr():
            return "assignment in an expression, :="
        case ast.Match():
            return "match statement"
        case ast.AnnAssign():
            return "annotation of a variable"
        case ast.TryStar():
            return "except*"
        case ast.BinOp(op=ast.MatMult()) | ast.AugAssign(op=ast.MatMult()):
            return "operator @"
        case ast.FunctionDef(args=arguments) | ast.AsyncFunctionDef(args=arguments) if (
            arguments.posonlyargs
        ):
            return "positional-only parameters, /"
        case (
            ast.List(ctx=ast.Load(), elts=parts)
            | ast.Tuple(ctx=ast.Load(), elts=parts)
            | ast.Set(elts=parts)
        ):
            return "* in a list, tuple or set" if _has_stars(parts) else ""
        case ast.Dict(keys=keys):
            return "** in a dictionary" if None in keys else ""
        case ast.Call(args=given):
            return "something after * in a call" if _has_stars(given[:-1]) else ""
    return ""


def _has_stars(parts: Iterable[ast.expr]) -> bool:
    return any(isinstance(part, ast.Starred) for part in parts)
