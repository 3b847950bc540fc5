"""The constants of a program: what it assigns to a name outside its functions, and values as it has them."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Mapping
from dataclasses import replace

from tuisim.base.errors import ConfigError, nearest
from tuisim.base.syntax_tree import NOT_PYTHON, parse_module
from tuisim.programs.program_file import ProgramSource
from tuisim.programs.robot.course import list_global_names
from tuisim.programs.values import write_value

_EVALUATED = ("ClassVar", "InitVar", "KW_ONLY")
"""Words in annotations that dataclasses evaluate."""


def set_constants(source: ProgramSource, values: Mapping[str, object]) -> ProgramSource:
    """Return a program in which some constants have other values; its lines keep their numbers.

    Args:
        source: The program.
        values: The new values, by the name of the constant.

    Raises:
        ConfigError: the program is not Python; it lacks such a constant, or assigns it several values; another constant
            has already been computed from it; or a value cannot be written in a program.
    """
    if not values:
        return source
    for name in values.keys() & source.fixed.keys():
        message = f"{source.fixed[name]} has been computed from {name}, and would keep its value"
        hint = f"compute {source.fixed[name]} in the function, or by operators, `math` and `round`"
        raise ConfigError(message, hint, key="constants")
    text = source.program.text
    try:
        nodes = _list_values(parse_module(text))
    except NOT_PYTHON as error:
        raise ConfigError(
            f"{source.program.name} is not Python: {error}", key="constants"
        ) from None
    lines = [line.encode() for line in text.split("\n")]
    defined = list_global_names(text)[1]
    # The last value is replaced first, so that the positions of earlier ones remain valid.
    for node, name in sorted(nodes, key=lambda pair: (pair[0].lineno, pair[0].col_offset))[::-1]:
        if name in values:
            replace_node(lines, node, write_value(values[name], defined))
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
    """Return the values that a program assigns outside functions and blocks, each with the name of its variable."""
    pairs: list[tuple[ast.expr, str]] = []
    for statement in module.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                pairs.append((value, name))
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                pairs.append((value, name))
    return pairs


def quote_annotations(text: str) -> str:
    """Return a program in which annotations with names other than Python's own are quoted, so that they are not run."""
    lines = [line.encode() for line in text.split("\n")]
    nodes: list[ast.expr] = []
    for node in ast.walk(parse_module(text)):
        names = ("annotation", "returns")
        nodes += filter(None, (getattr(node, name, None) for name in names))
    for node in sorted(nodes, key=lambda each: (each.lineno, each.col_offset), reverse=True):
        used = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
        if not used <= vars(builtins).keys() and used.isdisjoint(_EVALUATED):
            replace_node(lines, node, repr(ast.unparse(node)))
    return b"\n".join(lines).decode()


def replace_node(lines: list[bytes], node: ast.expr, text: str) -> None:
    """Replace the text of an expression in the lines of a program, in place.

    The expression's further lines become empty.

    Args:
        lines: The lines, in UTF-8.
        node: The expression.
        text: The new text.
    """
    first, last = node.lineno - 1, (node.end_lineno or node.lineno) - 1
    after = lines[last][node.end_col_offset or 0 :]
    lines[first] = lines[first][: node.col_offset] + text.encode() + after
    lines[first + 1 : last + 1] = [b""] * (last - first)
