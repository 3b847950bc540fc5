"""The values of a paused program beside the lines that assign them."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from tuisim.engine.protocol import FrameState, Inspected, Variable
from tuisim.programs.robot.source import parse

MODULE = "<module>"
"""The function of a frame that is the program itself."""

_Function = ast.FunctionDef | ast.AsyncFunctionDef
_LOOPS = (ast.For, ast.AsyncFor, ast.While)
_OWN_NAMES = (ast.Lambda, ast.ClassDef, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
"""Nodes with a scope of their own."""


def map_line_values(text: str, inspected: Inspected) -> dict[int, tuple[Variable, ...]]:
    """Return the variables to show beside the lines of a paused program, by line number: those that the line assigned.

    If several lines have assigned a variable, it is shown only beside the line that did so last, and beside the current
    line. A line that assigns a constant is left out if the variable now has another value.

    Args:
        text: The program that runs.
        inspected: The state of the paused program: its stack, the variables of the selected function, and its globals.
    """
    tree = parse(text)
    frame = inspected.stack[inspected.frame] if inspected.frame < len(inspected.stack) else None
    if tree is None:
        return {}
    outer = next(
        (
            frame_
            for frame_ in reversed(inspected.stack)
            if not frame_.file and frame_.function == MODULE
        ),
        None,
    )
    if frame is None or (frame.function == MODULE and not frame.file):
        return _find_values(tree, frame, inspected.variables)
    values = _find_values(tree, outer, inspected.globals)
    function = None if frame.file else _find_function(tree, frame)
    return (
        values if function is None else values | _find_values(function, frame, inspected.variables)
    )


def _find_function(tree: ast.Module, frame: FrameState) -> _Function | None:
    """Return the definition of the function that a frame runs; None if the program does not define it."""
    functions = [
        node
        for node in ast.walk(tree)
        if isinstance(node, _Function)
        and node.name == frame.function
        and node.lineno <= frame.line <= (node.end_lineno or 0)
    ]
    return max(functions, key=lambda node: node.lineno, default=None)


def _find_values(
    scope: ast.Module | _Function, frame: FrameState | None, variables: Sequence[Variable]
) -> dict[int, tuple[Variable, ...]]:
    """Return the variables to show beside each line of a scope, by line number: those that the line assigned.

    Args:
        scope: The program or a function.
        frame: The frame that runs the scope; None if it has ended.
        variables: The variables of the scope, with their present values.
    """
    by_name = {variable.name: variable for variable in variables}
    here = frame.line if frame else 0
    loops = [
        (node.lineno, node.end_lineno or 0)
        for node in walk_scope(scope)
        if isinstance(node, _LOOPS)
    ]
    # These are the lines of the outermost loop around the current line.
    first, last = min(
        ((start, end) for start, end in loops if start <= here <= end), default=(0, -1)
    )
    lines_of: dict[str, list[int]] = {}
    for line, name, constant in _list_assignments(scope):
        variable = by_name.get(name)
        is_past = not here or line < here or first <= line <= last
        if variable is not None and is_past and constant in (None, variable.value):
            lines_of.setdefault(name, []).append(line)

    def rank_age(line: int) -> tuple[int, int]:
        """Return a sort key of a line, smaller for a line that ran later.

        Lines of this iteration of the loop come first, then those of the previous iteration, then lines outside the
        loop.
        """
        if not first <= line <= last:
            return 2, -line
        return (0 if line < here else 1), -line

    values: dict[int, dict[str, Variable]] = {}
    for name, lines in lines_of.items():
        for line in {
            min(lines, key=rank_age),
            *(assigned_line for assigned_line in lines if assigned_line == here),
        }:
            values.setdefault(line, {})[name] = by_name[name]
    return {line: tuple(names.values()) for line, names in sorted(values.items())}


def walk_scope(scope: ast.AST) -> Iterator[ast.AST]:
    """Yield the syntax nodes of a scope, without those of functions, classes and comprehensions in it."""
    # A chain of `elif` may be deeper than functions can call themselves.
    nodes = _list_children(scope)
    while nodes:
        node = nodes.pop()
        yield node
        nodes += _list_children(node)


def _list_children(node: ast.AST) -> list[ast.AST]:
    """Return the children of a syntax node, the last one first, without functions, classes and comprehensions."""
    children = [
        child
        for child in ast.iter_child_nodes(node)
        if not isinstance(child, (*_OWN_NAMES, ast.FunctionDef, ast.AsyncFunctionDef))
    ]
    return children[::-1]


def _list_assignments(scope: ast.Module | _Function) -> Iterator[tuple[int, str, str | None]]:
    """Yield line, name and value of each assignment in a scope; the value is the text of a constant, else None."""
    if not isinstance(scope, ast.Module):
        arguments = scope.args
        parameters = [
            *arguments.posonlyargs,
            *arguments.args,
            arguments.vararg,
            *arguments.kwonlyargs,
            arguments.kwarg,
        ]
        yield from (
            (parameter.lineno, parameter.arg, None)
            for parameter in parameters
            if parameter is not None
        )
    constants: Mapping[ast.AST, str] = {
        target: repr(node.value.value)
        for node in walk_scope(scope)
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        for target in node.targets
    }
    for node in walk_scope(scope):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id, constants.get(node)
