"""Unknown attributes: what a program wants of an object of a library that does not have it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from tuisim.base.errors import did_you_mean
from tuisim.base.meant import find_meant_names
from tuisim.programs.names import UnknownName, column_of, readable_tree
from tuisim.programs.program_file import parse_unfinished

_IMPORTS = (ast.Import, ast.ImportFrom)
_ASKS_FIRST = re.compile(r"\b(hasattr|getattr|setattr|pybricks)\b")
"""Programs that look themselves what there is; and Pybricks, whose versions have different members."""

Members = Callable[[str, str, int, int], frozenset[str] | None]
"""`completion.members`, which tests replace."""


class AttributeCheck:
    """Looks for unknown attributes, and remembers what objects have as long as their definitions stay.

    Args:
        members: Returns the names that an object has.
    """

    def __init__(self, members: Members) -> None:
        self._members = members
        self._known: dict[tuple[str, ...], frozenset[str] | None] = {}

    def unknown_attributes(self, text: str, path: str) -> tuple[UnknownName, ...]:
        """Return the unknown attributes of names that are given an object once, in the program or its prelude.

        Args:
            text: The program as it stands in the editor.
            path: Its file, or its name.
        """
        program = parse_unfinished(text, path)
        tree, _ = readable_tree(program.text)
        if tree is None or _ASKS_FIRST.search(text):
            return ()
        lines, definitions = program.text.split("\n"), _definitions(tree)
        around = (
            path,
            program.prelude,
            *(ast.unparse(node) for node in tree.body if isinstance(node, _IMPORTS)),
        )
        found = []
        for node, name in _uses(tree):
            row, at_dot = _place_after(lines, name)
            key = (name.id, definitions.get(name.id, ""), *around)
            if key not in self._known:
                self._known[key] = self._members(text, path, row, at_dot)
            members = self._known[key]
            if members is None or node.attr in members:
                continue
            row, end = _place_after(lines, node)
            start = end - len(node.attr)
            if lines[row][start:end] == node.attr:
                hint = did_you_mean([f"`{one}`" for one in find_meant_names(node.attr, members)])
                found.append(UnknownName(node.attr, row, start, end, hint, name.id))
        return tuple(found)


def _place_after(lines: Sequence[str], node: ast.expr) -> tuple[int, int]:
    """Return row and column of the end of a piece of code."""
    row = (node.end_lineno or 1) - 1
    return row, column_of(lines[row], node.end_col_offset)


def _definitions(tree: ast.Module) -> dict[str, str]:
    """Return the statement that gives a name its object, by name, for those at the margin."""
    found: dict[str, str] = {}
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)]):
                found[name] = ast.unparse(node)
            case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
                found.update((_name_of(alias), ast.unparse(node)) for alias in aliases)
    return found


def _uses(tree: ast.Module) -> Iterator[tuple[ast.Attribute, ast.Name]]:
    """Yield what is read of names that are given one object, and no further attributes."""
    attributes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    made = {node.attr for node in attributes if not isinstance(node.ctx, ast.Load)}
    bound, definitions = Counter(_bound_names(tree)), _definitions(tree)
    for node in attributes:
        name = node.value
        if (
            isinstance(name, ast.Name)
            and node.attr not in made
            and bound[name.id] == (name.id in definitions)
        ):
            yield node, name


def _bound_names(tree: ast.Module) -> Iterator[str]:
    """Yield each name as often as it is given an object, of whatever scope."""
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
                yield _name_of(node)


def _name_of(alias: ast.alias) -> str:
    return alias.asname or alias.name.partition(".")[0]
