"""Compiles programs: adds loop hooks, and replaces names of the prelude whose part this robot does not have."""

from __future__ import annotations
import __future__

import ast
import re
import types
from collections.abc import Iterator
from typing import Any, NoReturn

from tuisim.base.source import PRELUDE_TEXTS


class MissingPart:
    """The value of a predefined name whose part the robot does not have. Any use of it raises an error.

    Args:
        name: The name.
        error: The error on creating the part, which is raised at each use.
    """

    __slots__ = ("_error", "_name")
    _name: str
    _error: Exception

    def __init__(self, name: str, error: Exception) -> None:
        error.add_note(f"`{name}` is a predefined name, for a part of Default_Robot.")
        object.__setattr__(self, "_name", name)
        object.__setattr__(self, "_error", error.with_traceback(None))

    def __repr__(self) -> str:
        return f"<{self._name}: this robot has no such part>"

    def _refuse_use(self, *_: Any, **__: Any) -> NoReturn:
        raise self._error.with_traceback(None)

    __getattr__ = __setattr__ = __delattr__ = __call__ = __str__ = _refuse_use


PRELUDE_FILE = "<prelude>"
LOOP_HOOK = "__loop_turn__"


class _LoopHooks(ast.NodeTransformer):
    """A transformer of a program's syntax tree that inserts a call of `LOOP_HOOK` at the start of every loop body."""

    def _add_hook(self, node: ast.For | ast.While | ast.AsyncFor) -> ast.AST:
        self.generic_visit(node)
        call = ast.Expr(ast.Call(ast.Name(LOOP_HOOK, ast.Load()), [], []))
        first = node.body[0]
        for part in ast.walk(call):
            ast.copy_location(part, first)
        node.body.insert(0, call)
        return node

    visit_For = visit_While = visit_AsyncFor = _add_hook  # noqa: N815


_FIRST_BYTE, _LAST_BYTE = "\udc80", "\udcff"
"""The lone surrogates that stand for bytes of a file that are not UTF-8."""
_MAX_DECLARATION = 1000
"""Characters at the beginning of a program in which it may declare its encoding."""


def _check_encoding(text: str, file: str) -> None:
    """Raise a SyntaxError, as Python does, if the bytes of a file are not text in the encoding that it declares.

    Args:
        text: The text of the file, in which each byte that does not fit the encoding is a surrogate.
        file: The name of the file, for the error.

    Raises:
        SyntaxError: the declared encoding is not a text encoding, a byte does not fit it, or there is a null byte.
    """
    if "coding" in text[:_MAX_DECLARATION] and (declared := _find_declared_encoding(text)):
        number, encoding = declared
        if not _is_text_encoding(encoding):
            raise SyntaxError(f"encoding problem: {encoding}", (file, number, None, None))
    if text.isascii() and "\0" not in text:
        return
    for number, line in enumerate(text.split("\n"), start=1):
        if wrong := next(
            (character for character in line if _FIRST_BYTE <= character <= _LAST_BYTE), ""
        ):
            byte = f"\\x{ord(wrong) & 0xFF:02x}"
            what = (
                f"Non-UTF-8 code starting with '{byte}', but no encoding declared; save it as UTF-8"
            )
            raise SyntaxError(what, (file, number, None, None))
        if "\0" in line:
            raise SyntaxError("source code cannot contain null bytes", (file, number, None, None))


def _find_declared_encoding(text: str) -> tuple[int, str] | None:
    """Return the number of the line in which a file declares its encoding, and the encoding, as defined by PEP 263.

    Return None if the file declares no encoding.
    """
    import re

    for number, line in enumerate(text.split("\n", 2)[:2], start=1):
        if match := re.match(r"[ \t\f]*#.*?coding[:=][ \t]*([-\w.]+)", line, re.ASCII):
            return number, match[1]
        if not re.match(r"[ \t\f]*(?:#|$)", line):
            break
    return None


def _is_text_encoding(name: str) -> bool:
    try:
        return b"a\n".decode(name) == "a\n"
    except (LookupError, ValueError):
        return False


def compile_program(text: str, file: str, drops_annotations: bool = False) -> types.CodeType:
    """Return the code of a program, with a call of `LOOP_HOOK` in each loop body, and with unchanged line numbers.

    Args:
        text: The source.
        file: The name of its file.
        drops_annotations: Whether annotations are left out, not evaluated.

    Raises:
        SyntaxError, ValueError: the text is not Python.
    """
    _check_encoding(text, file)
    return compile_with_hooks(text, file, drops_annotations)


def compile_with_hooks(
    source: str | bytes, file: str, drops_annotations: bool = False
) -> types.CodeType:
    """Return the code of a program or of one of its modules, as `compile_program` does; the arguments are the same.

    Raises:
        SyntaxError, ValueError: the source is not Python.
    """
    tree = ast.parse(source, file)
    flags = __future__.annotations.compiler_flag if drops_annotations else 0
    code: types.CodeType = compile(_LoopHooks().visit(tree), file, "exec", flags, dont_inherit=True)
    return code


def compile_prelude(name: str) -> Iterator[tuple[str, types.CodeType]]:
    """Yield the statements of a prelude, a text that runs before a program and defines names for it.

    Each comes as two values: the name that the statement assigns to, empty for none, and its code.

    Args:
        name: The name of the prelude.

    Raises:
        KeyError: no prelude has this name.
    """
    for statement in ast.parse(PRELUDE_TEXTS[name], PRELUDE_FILE).body:
        code = compile(ast.Module([statement], []), PRELUDE_FILE, "exec", dont_inherit=True)
        match statement:
            case ast.Assign(targets=[ast.Name(id=part)]):
                yield part, code
            case _:
                yield "", code


_IMPORT = re.compile(r"^\s*(?:from|import)\s+ev3dev2\b", re.MULTILINE)


def add_prelude_note(error: BaseException, text: str) -> None:
    """Add a note to a NameError about a predefined name that the program has not enabled: how to get the name.

    Any other error stays unchanged.

    Args:
        error: The error.
        text: The text of the program.
    """
    if not isinstance(error, NameError) or not error.name:
        return
    statement = _find_statement(error.name)
    if statement is None:
        return
    make = f"make it: `{ast.unparse(statement)}`" if isinstance(statement, ast.Assign) else ""
    if _IMPORT.search(text) and not isinstance(statement, ast.FunctionDef):
        if make:
            error.add_note(f"To use `{error.name}`, {make}.")
        return
    magic = "put `# %%sim_magic_preloaded` into its first line"
    how = f", or {make}" if make else ""
    error.add_note(
        f"`{error.name}` is a predefined name, which this program has not enabled: {magic}{how}."
    )


def _find_statement(name: str) -> ast.stmt | None:
    for statement in ast.parse(PRELUDE_TEXTS["preloaded"]).body:
        match statement:
            case ast.ImportFrom(names=aliases):
                new_names = [alias.name for alias in aliases]
            case ast.Assign(targets=[ast.Name(id=target)]):
                new_names = [target]
            case ast.FunctionDef(name=function):
                new_names = [function]
            case _:
                new_names = []
        if name in new_names:
            return statement
    return None
