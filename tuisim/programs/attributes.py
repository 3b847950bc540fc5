"""Unknown attributes: what a program wants of an object of a library that does not have it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from tuisim.base.errors import did_you_mean
from tuisim.base.meant import find_meant_names
from tuisim.programs.names import UnknownName, count_column, parse_readable
from tuisim.programs.program_file import parse_unfinished

_IMPORTS = (ast.Import, ast.ImportFrom)
_ASKS_FIRST = re.compile(r"\b(hasattr|getattr|setattr|pybricks)\b")
"""Programs that look themselves what there is; and Pybricks, whose versions have different members."""

Members = Callable[[str, str, int, int], frozenset[str] | None]
"""`completion.members`, which tests replace."""


class AttributeCheck:
    """Looks for unknown attributes; caches the attributes of an object until the line that defines it changes.

    Args:
        members: Returns the names that an object has.
    """

    def __init__(self, members: Members) -> None:
        self._members = members
        self._known: dict[tuple[str, ...], frozenset[str] | None] = {}

    def find_unknown_attributes(self, text: str, path: str) -> tuple[UnknownName, ...]:
        """Return the unknown attributes of names that get an object only once, in the program or its prelude.

        Args:
            text: The program as it stands in the editor.
            path: Its file, or its name.
        """
        program = parse_unfinished(text, path)
        tree, _ = parse_readable(program.text)
        if tree is None or _ASKS_FIRST.search(text):
            return ()
        lines = program.text.split("\n")
        definitions = _find_definitions(tree)
        around = (
            path,
            program.prelude,
            *(ast.unparse(node) for node in tree.body if isinstance(node, _IMPORTS)),
        )
        unknown = []
        for node, name in _find_uses(tree):
            row, at_dot = _find_end(lines, name)
            key = (name.id, definitions.get(name.id, ""), *around)
            if key not in self._known:
                self._known[key] = self._members(text, path, row, at_dot)
            members = self._known[key]
            if members is None or node.attr in members:
                continue
            row, end = _find_end(lines, node)
            start = end - len(node.attr)
            if lines[row][start:end] == node.attr:
                hint = did_you_mean(
                    [f"`{meant}`" for meant in find_meant_names(node.attr, members)]
                )
                unknown.append(UnknownName(node.attr, row, start, end, hint, name.id))
        return tuple(unknown)


def _find_end(lines: Sequence[str], node: ast.expr) -> tuple[int, int]:
    """Return the row, from 0, and the column in characters just after the end of a node."""
    row = (node.end_lineno or 1) - 1
    return row, count_column(lines[row], node.end_col_offset)


def _find_definitions(tree: ast.Module) -> dict[str, str]:
    """Return, by name, the statement at the top level that gives the name its object."""
    statements: dict[str, str] = {}
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)]):
                statements[name] = ast.unparse(node)
            case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
                statements.update((_get_name(alias), ast.unparse(node)) for alias in aliases)
    return statements


def _find_uses(tree: ast.Module) -> Iterator[tuple[ast.Attribute, ast.Name]]:
    """Yield each attribute that is read of a name which gets one object only, and that name."""
    attributes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    assigned = {node.attr for node in attributes if not isinstance(node.ctx, ast.Load)}
    bound = Counter(_list_bound_names(tree))
    definitions = _find_definitions(tree)
    for node in attributes:
        name = node.value
        if (
            isinstance(name, ast.Name)
            and node.attr not in assigned
            and bound[name.id] == (name.id in definitions)
        ):
            yield node, name


def _list_bound_names(tree: ast.Module) -> Iterator[str]:
    """Yield each name as often as it gets an object, in whatever scope."""
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
                yield name
            case (
                ast.FunctionDef(name=name)
                | ast.AsyncFunctionDef(name=name)
                | ast.ClassDef(name=name)
            ):
                yield name
            case (
                ast.ExceptHandler(name=str(name))
                | ast.MatchAs(name=str(name))
                | ast.MatchStar(name=str(name))
            ):
                yield name
            case ast.MatchMapping(rest=str(name)):
                yield name
            case ast.alias():
                yield _get_name(node)


def _get_name(alias: ast.alias) -> str:
    return alias.asname or alias.name.partition(".")[0]
