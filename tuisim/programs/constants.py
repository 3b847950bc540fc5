"""The constants of a program: what it assigns to a name outside its functions."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import replace

from tuisim.base.errors import ConfigError, nearest
from tuisim.base.syntax_tree import parse_module
from tuisim.programs.program_file import ProgramSource


def set_constants(source: ProgramSource, values: Mapping[str, object]) -> ProgramSource:
    """Return a program with other values of some constants; its lines keep their numbers.

    Raises:
        ConfigError: the program has no such constant, assigns several values to it, or is not Python.
    """
    if not values:
        return source
    text = source.program.text
    try:
        nodes = _list_values(parse_module(text))
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise ConfigError(
            f"{source.program.name} is not Python: {error}", key="constants"
        ) from None
    lines = [line.encode() for line in text.split("\n")]
    # From the end, so that what is before stays where it is.
    for node, name in sorted(nodes, key=lambda pair: (pair[0].lineno, pair[0].col_offset))[::-1]:
        if name in values:
            _replace(lines, node, repr(values[name]))
    counts = {name: sum(name == other for _, other in nodes) for name in values}
    for name, count in counts.items():
        if not count:
            names = sorted({other for _, other in nodes})
            message = f"{source.program.name} has no constant {name}"
            hint = nearest(name, names) if names else "it uses none"
            raise ConfigError(message, hint, key="constants")
        if count > 1:
            message = f"{source.program.name} assigns {count} values to {name}"
            raise ConfigError(message, "a constant has one", key="constants")
    changed = b"\n".join(lines).decode()
    return replace(source, program=replace(source.program, text=changed))


def _list_values(module: ast.Module) -> list[tuple[ast.expr, str]]:
    """Return the values that are assigned outside functions and blocks, each with the name that gets it."""
    pairs: list[tuple[ast.expr, str]] = []
    for statement in module.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                pairs.append((value, name))
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                pairs.append((value, name))
    return pairs


def _replace(lines: list[bytes], node: ast.expr, text: str) -> None:
    """Put a text in place of a value, and empty lines in place of its further lines."""
    first, last = node.lineno - 1, (node.end_lineno or node.lineno) - 1
    after = lines[last][node.end_col_offset or 0 :]
    lines[first] = lines[first][: node.col_offset] + text.encode() + after
    lines[first + 1 : last + 1] = [b""] * (last - first)
