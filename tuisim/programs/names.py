"""Names in a program that are not defined, and attributes that objects do not have."""

from __future__ import annotations

import ast
import builtins
import dis
import re
import sys
import types
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import field
from functools import cache

from tuisim.base.data_class import dataclass
from tuisim.base.errors import closest, did_you_mean
from tuisim.base.meant import find_meant_names, map_functions, map_modules
from tuisim.base.source import PRELUDE_TEXTS, source_lines
from tuisim.base.syntax_tree import NOT_PYTHON, parse_module
from tuisim.programs.mistakes import find_fault
from tuisim.programs.program_file import parse_unfinished
from tuisim.programs.robot.course import list_global_names

_IMPORTS = (ast.Import, ast.ImportFrom)
_ASKS_FIRST = re.compile(r"\b(hasattr|getattr|setattr|pybricks)\b")
"""Functions and libraries of programs that are not checked: they test themselves what exists, or versions differ."""

Members = Callable[[str, str, int, int], frozenset[str] | None]
"""`completion.members`, which tests replace."""


class AttributeCheck:
    """Finds unknown attributes in a program; caches the attributes of an object until the line that defines it changes.

    Args:
        members: Returns the names of an object's attributes.
    """

    def __init__(self, members: Members) -> None:
        self._members = members
        self._known: dict[tuple[str, ...], frozenset[str] | None] = {}

    def find_unknown_attributes(self, text: str, path: str) -> tuple[UnknownName, ...]:
        """Return the unknown attributes of names that are assigned only once, in the program or in its prelude.

        The prelude is the code that runs before the program and defines names such as `tank_drive`.

        Args:
            text: The present text of the program in the editor.
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
    """Return row and column (in characters, both from 0) just after the end of a node."""
    row = (node.end_lineno or 1) - 1
    return row, count_column(lines[row], node.end_col_offset)


def _find_definitions(tree: ast.Module) -> dict[str, str]:
    """Return the top-level statements that define names, by name."""
    statements: dict[str, str] = {}
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)]):
                statements[name] = ast.unparse(node)
            case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
                statements.update((_get_name(alias), ast.unparse(node)) for alias in aliases)
    return statements


def _find_uses(tree: ast.Module) -> Iterator[tuple[ast.Attribute, ast.Name]]:
    """Yield each attribute that the program reads, such as `robot.speed`, and its name before the dot.

    Only names that are assigned once are considered.
    """
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
    """Yield the names that the program assigns or defines, in any scope.

    A name is yielded as often as the program assigns or defines it.
    """
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


MAX_MENDED = 3
"""Lines that are left out if they are not Python yet."""
_LIKENESS = 0.7
_LOADS = frozenset({"LOAD_NAME", "LOAD_GLOBAL", "LOAD_FROM_DICT_OR_GLOBALS"})
_STORES = frozenset({"STORE_NAME", "STORE_GLOBAL"})
_READS_ANY_NAME = frozenset({"eval", "exec", "globals", "locals", "vars"})
"""Functions that may define names that do not appear in the program."""
_BUILTINS = frozenset(dir(builtins))
_MODULE_NAMES = frozenset({"__file__", "__builtins__", "__annotations__", "__path__", "__cached__"})
_WORD = re.compile(r"[^\W\d]\w*")


@dataclass(frozen=True, slots=True)
class UnknownName:
    """An unknown name or attribute, or a line that is not Python, with its position in the text."""

    name: str
    row: int
    """From 0."""
    start: int
    end: int
    """Columns, from 0."""
    hint: str = ""
    """The names that may have been meant."""
    owner: str = ""
    """The name of the object that lacks the attribute; empty for an unknown name."""
    fault: str = ""
    """Why the line is not Python; empty for a name."""

    @property
    def message(self) -> str:
        """A sentence on the unknown name or the faulty line, with the names that may have been meant."""
        wrong = self.fault or (
            f"`{self.owner}` has no `{self.name}`"
            if self.owner
            else f"`{self.name}` is not defined"
        )
        return f"{wrong}{': ' if self.hint else ''}{self.hint}"


@dataclass(slots=True)
class _SeenNames:
    """The global names that the code of a program reads, and those that it defines."""

    loaded: dict[tuple[int, int, int], str] = field(default_factory=dict)
    """Globals that are read, by line, first and last byte."""
    defined: set[str] = field(default_factory=set)
    within: dict[str, str] = field(default_factory=dict)
    """Local variables with a function that has them."""


def find_faulty_line(text: str, name: str) -> UnknownName | None:
    """Return the line with a program's syntax error; None if there is no error, or if its line is not known.

    Args:
        text: The present text of the program in the editor.
        name: The name of its file.
    """
    program = parse_unfinished(text, name)
    fault, line = find_fault(program.text) or ("", 0)
    lines = program.text.split("\n")
    if not 0 < line <= len(lines):
        return None
    words = lines[line - 1].strip()
    start = len(_read_indent(lines[line - 1]))
    return UnknownName(words, line - 1, start, start + len(words), fault=fault)


def find_unknown_names(text: str, name: str) -> tuple[UnknownName, ...] | None:
    """Return the unknown names of a program; None if the program cannot be read.

    Args:
        text: The present text of the program in the editor.
        name: The name of its file.
    """
    program = parse_unfinished(text, name)
    tree, guessed = parse_readable(program.text)
    if tree is None or _has_unseen_names(tree):
        return None
    seen = _SeenNames()
    with warnings.catch_warnings():
        # Warnings are ignored here; Python shows them when the program runs.
        warnings.simplefilter("ignore")
        try:
            _search(compile(tree, name, "exec", dont_inherit=True), seen)
        except NOT_PYTHON:
            return None
    own = seen.defined | guessed | _list_prelude_names(program.prelude)
    lines = program.text.split("\n")
    known = own | _BUILTINS | _MODULE_NAMES
    unknown = []
    for (line, *columns), word in sorted(seen.loaded.items()):
        start, end = (count_column(lines[line - 1], column) for column in columns)
        if word not in known and lines[line - 1][start:end] == word:
            hint = _build_hint(word, lines[line - 1][end : end + 1], own, seen.within)
            unknown.append(UnknownName(word, line - 1, start, end, hint))
    return tuple(unknown)


def parse_readable(text: str) -> tuple[ast.Module | None, set[str]]:
    """Return the syntax tree of a program without the lines that are not Python, and the words in those lines.

    The tree is None if too many lines are not Python.
    """
    lines = source_lines(text)
    readable = list(lines)
    words = set[str]()
    for _ in range(MAX_MENDED + 1):
        try:
            return parse_module("\n".join(readable)), words
        except SyntaxError as error:
            index = (error.lineno or 0) - 1
            if not 0 <= index < len(readable) or readable[index] != lines[index]:
                break
            words.update(_WORD.findall(readable[index]))
            readable[index] = _replace_line(readable, index)
        except (ValueError, RecursionError, MemoryError):
            break
    return None, words


def _replace_line(lines: Sequence[str], index: int) -> str:
    """Return a statement in place of a line with a syntax error: `if True:` if an indented block follows, else `pass`.

    Args:
        lines: All lines.
        index: Index of the faulty line.
    """
    indent = _read_indent(lines[index])
    below = next((line for line in lines[index + 1 :] if line.strip()), "")
    return indent + ("if True:" if len(_read_indent(below)) > len(indent) else "pass")


def _read_indent(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def _has_unseen_names(tree: ast.Module) -> bool:
    for node in ast.walk(tree):
        match node:
            case ast.ImportFrom(names=[ast.alias(name="*")]):
                return True
            case ast.Name(id=name) if name in _READS_ANY_NAME:
                return True
    return False


def _search(code: types.CodeType, seen: _SeenNames, is_module: bool = True) -> None:
    """Add the global names that compiled code reads and defines to `seen`.

    Names in the body of a class are not global.
    """
    own = set[str]()
    for instruction in dis.get_instructions(code):
        if instruction.opname in _STORES:
            to = seen.defined if is_module or instruction.opname == "STORE_GLOBAL" else own
            to.add(instruction.argval)
    for instruction in dis.get_instructions(code):
        place = instruction.positions
        if (
            instruction.opname in _LOADS
            and instruction.argval not in own
            and place
            and place.lineno is not None
        ):
            seen.loaded[place.lineno, place.col_offset or 0, place.end_col_offset or 0] = (
                instruction.argval
            )
    if not code.co_name.startswith("<"):
        seen.within.update(dict.fromkeys(code.co_varnames, code.co_name))
    for inner in code.co_consts:
        if isinstance(inner, types.CodeType):
            _search(inner, seen, is_module=False)


def count_column(line: str, byte: int | None) -> int:
    """Return the index of a character in a line.

    Args:
        line: The line.
        byte: The index of its first byte in UTF-8, as in Python's errors; None for the end of the line.
    """
    return len(line.encode()[:byte].decode(errors="ignore"))


@cache
def _list_prelude_names(prelude: str) -> frozenset[str]:
    return frozenset(list_global_names(PRELUDE_TEXTS[prelude])[1])


def _build_hint(name: str, follows: str, own: set[str], within: Mapping[str, str]) -> str:
    """Return a hint on what to write for a name that is not defined, such as an import or a similar name.

    The hint is empty if nothing fits.

    Args:
        name: The name.
        follows: The character after the name.
        own: The names that the program defines.
        within: Local variables, each with its function.
    """
    if follows == "." and name in sys.stdlib_module_names:
        return f"`import {name}`"
    if function := within.get(name):
        return f"it exists only inside `{function}`"
    if follows == "(" and (module := map_functions().get(name)):
        return f"did you mean `{module}.{name}`? `import {module}`"
    if close := guess_name(name, own | within.keys()) or guess_name(name, _BUILTINS):
        return did_you_mean([f"`{close}`"])
    if module := map_modules().get(name):
        return f"`from {module} import {name}`"
    return (
        "put `# %%sim_magic_preloaded` into line 1"
        if name in _list_prelude_names("preloaded")
        else ""
    )


def guess_name(name: str, names: Set[str]) -> str:
    """Return the name among `names` that is most similar to an unknown one; empty if none is similar."""
    known = (
        candidate
        for candidate in sorted(names)
        if not candidate.startswith("_") or name.startswith("_")
    )
    return next(iter(closest(name, known, 1, _LIKENESS)), "")
