"""Finds out whether the program would catch an error: then it only tests what there is, and continues without it."""

from __future__ import annotations

import ast
import builtins
import linecache
from collections.abc import Iterator
from functools import cache
from types import FrameType
from typing import Any

from tuisim.engine.runtime.tracebacks import own_files


def is_caught(error: type[Exception], frame: FrameType | None, program_file: str) -> bool:
    """Return whether the program would catch an error with `try` if the error were raised in a frame.

    A `try` that catches every `Exception` counts only in the function that calls the library. Around a whole program,
    it does not mean that the program expects this error.

    Args:
        error: The class of the error.
        frame: Where it would be raised.
        program_file: File name of the program.
    """
    is_own, is_nearest = own_files(program_file), True
    while frame is not None:
        if is_own(frame.f_code.co_filename):
            for kind in _find_handled(frame):
                is_wide = kind in (Exception, BaseException)
                if issubclass(error, kind) and (is_nearest or not is_wide):
                    return True
            is_nearest = False
        frame = frame.f_back
    return False


def _find_handled(frame: FrameType) -> Iterator[type]:
    """Yield the classes of errors that the `try` statements around a frame's current line catch."""
    for block in _parse_tries(frame.f_code.co_filename):
        if block.body[0].lineno <= frame.f_lineno <= (block.body[-1].end_lineno or 0):
            for handler in block.handlers:
                yield from _find_classes(handler.type, frame)


@cache
def _parse_tries(file: str) -> list[ast.Try]:
    try:
        tree = ast.parse("".join(linecache.getlines(file)))
    except (SyntaxError, RecursionError, ValueError):
        return []
    return [node for node in ast.walk(tree) if isinstance(node, ast.Try)]


def _find_classes(node: ast.expr | None, frame: FrameType) -> list[type]:
    """Return the classes of errors that the expression after an `except` names."""
    match node:
        case None:
            return [BaseException]
        case ast.Tuple(elts=parts):
            return [kind for part in parts for kind in _find_classes(part, frame)]
    value = _find_value(node, frame)
    return [value] if isinstance(value, type) else []


def _find_value(node: ast.expr, frame: FrameType) -> Any:
    match node:
        case ast.Name(id=name):
            for names in (frame.f_locals, frame.f_globals, vars(builtins)):
                if name in names:
                    return names[name]
        case ast.Attribute(value=base, attr=name):
            return getattr(_find_value(base, frame), name, None)
    return None
