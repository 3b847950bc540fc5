"""Unknown names: what a program reads and nobody has defined. The program is compiled, never run."""

from __future__ import annotations

import ast
import builtins
import dis
import re
import sys
import types
import warnings
from collections.abc import Mapping, Sequence, Set
from dataclasses import field
from functools import cache

from tuisim.base.data_class import dataclass
from tuisim.base.errors import closest, did_you_mean
from tuisim.base.meant import map_functions, map_modules
from tuisim.base.source import PRELUDE_TEXTS, source_lines
from tuisim.base.syntax_tree import parse_module
from tuisim.programs.program_file import parse_unfinished
from tuisim.programs.robot.course import list_global_names

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
    """A name or an attribute that does not exist, and where it is in the text."""

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

    @property
    def message(self) -> str:
        """What is wrong, and the hint."""
        wrong = (
            f"`{self.owner}` has no `{self.name}`"
            if self.owner
            else f"`{self.name}` is not defined"
        )
        return f"{wrong}{': ' if self.hint else ''}{self.hint}"


@dataclass(slots=True)
class _SeenNames:
    """The names that a program's code uses and defines."""

    loaded: dict[tuple[int, int, int], str] = field(default_factory=dict)
    """Globals that are read, by line, first and last byte."""
    defined: set[str] = field(default_factory=set)
    within: dict[str, str] = field(default_factory=dict)
    """Local variables with a function that has them."""


def find_unknown_names(text: str, name: str) -> tuple[UnknownName, ...] | None:
    """Return the unknown names of a program; None if the program cannot be read.

    Args:
        text: The program as it stands in the editor.
        name: The name of its file.
    """
    program = parse_unfinished(text, name)
    tree, guessed = parse_readable(program.text)
    if tree is None or _has_unseen_names(tree):
        return None
    seen = _SeenNames()
    with warnings.catch_warnings():
        # Python shows the warnings when the program runs.
        warnings.simplefilter("ignore")
        try:
            _search(compile(tree, name, "exec", dont_inherit=True), seen)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
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
    """Return the syntax tree of a program without the lines that are not Python yet, and the words of these lines."""
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
    """Return a statement to replace a line that is not Python: the head of a block if a block follows."""
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
    """Note the global names that code reads and those that it defines; names in the body of a class are not global."""
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
    """Return the column in characters for one that Python counts in bytes."""
    return len(line.encode()[:byte].decode(errors="ignore"))


@cache
def _list_prelude_names(prelude: str) -> frozenset[str]:
    return frozenset(list_global_names(PRELUDE_TEXTS[prelude])[1])


def _build_hint(name: str, follows: str, own: set[str], within: Mapping[str, str]) -> str:
    """Return what may help with a name that is not defined.

    Args:
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
    """Return the name that may have been meant; empty if none is near."""
    known = (
        candidate
        for candidate in sorted(names)
        if not candidate.startswith("_") or name.startswith("_")
    )
    return next(iter(closest(name, known, 1, _LIKENESS)), "")
