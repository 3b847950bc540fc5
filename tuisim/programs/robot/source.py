"""A program's own modules: its text and the files beside it that it imports, as syntax trees."""

from __future__ import annotations

import ast
import operator
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.repository import find_module_folder
from tuisim.base.source import (
    HUB_DEVICES,
    LIBRARIES,
    PYBRICKS,
    SPIKE_MODULES,
    Program,
    decode_source,
    user_python_path,
)
from tuisim.base.syntax_tree import NOT_PYTHON, parse_module
from tuisim.engine.brick_home import place_folder
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.core.profile import Library
from tuisim.engine.files import read_bytes

SIGNS: Mapping[type[ast.cmpop], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}
"""Comparisons of numbers in a syntax tree, as they are written."""
TURNED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
"""The operator of a comparison whose sides change places; others stay."""
OPERATORS: Mapping[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
"""Computing with numbers in a syntax tree."""
MAX_MODULES = 100
MAX_MODULE_BYTES = 1 << 20
MAX_NAME_CHARACTERS = 500
"""A longer name of a module is ignored: it has too many packages to list them all."""


@dataclass(frozen=True, slots=True)
class Module:
    """One file of a program, the main program or a module that it imports, with its syntax tree."""

    name: str
    """As it is imported, with dots; empty for the program itself."""
    file: str
    """The name of the file in messages."""
    tree: ast.Module
    is_package: bool = False

    def absolute(self, name: str | None, level: int) -> str:
        """Return the absolute name of a module from an import in this module.

        Args:
            name: The name after `from`; None for none.
            level: The number of dots before the name: 0 for an absolute import.
        """
        if not level:
            return name or ""
        parts = self.name.split(".") if self.name else []
        parents = parts[: len(parts) - level + (1 if self.is_package else 0)]
        return ".".join([*parents, *([name] if name else [])])


@lru_cache(16)
def parse(text: str) -> ast.Module | None:
    """Return the syntax tree of a text, which callers must not change; None if the text is not Python."""
    try:
        with warnings.catch_warnings():
            # Warnings are ignored here; Python shows them when the program runs.
            warnings.simplefilter("ignore")
            return parse_module(text)
    # When the program runs, Python reports what is wrong with it.
    except NOT_PYTHON:
        return None


def read_modules(program: Program) -> dict[str, Module]:
    """Return a program and its own modules by name, the program first; empty if the program is not Python."""
    tree = parse(program.text)
    if tree is None:
        return {}
    search = _Search(program)
    search.extend(tree, program.file)
    modules = {"": Module("", program.name, tree)}
    waiting = [modules[""]]
    while waiting and len(modules) < MAX_MODULES:
        module = waiting.pop()
        for name in _list_imported(module):
            # A module is only in a package of the program, which comes before it.
            if name in modules or name in LIBRARIES or name.rpartition(".")[0] not in modules:
                continue
            if (read := search.module(name)) is not None:
                modules[name] = read
                waiting.append(read)
    return modules


def find_missing_module(program: Program, modules: dict[str, Module]) -> str:
    """Return in words which module a program imports and cannot find, and in which folder of its repository it is.

    The result is empty if there is no such module.
    """
    known = {"", *modules, *LIBRARIES, *SPIKE_MODULES, *sys.stdlib_module_names}
    for name in dict.fromkeys(name.split(".")[0] for name in _list_all_imported(modules)):
        if name not in known and (folder := find_module_folder(name, own_folder(program))):
            return f"it imports {name}, which is in {folder}: PYTHONPATH={folder} finds it"
    return ""


class _Search:
    """The folders in which a program finds its modules.

    Args:
        program: The program.
    """

    def __init__(self, program: Program) -> None:
        self._own = own_folder(program)
        self._folders = list_first_folders(program)

    def extend(self, tree: ast.Module, file: str) -> None:
        """Search for modules also in the folders that the code of a module adds to `sys.path`.

        A relative folder is relative to the program, as on the brick.

        Args:
            tree: The module.
            file: Path of its file.
        """
        if os.path.isdir(self._own):
            own = os.path.abspath(self._own)
            places = (place_folder(folder, own) for folder in find_added_folders(tree, file))
            self._folders += [os.path.join(own, place) for place in places]

    def module(self, name: str) -> Module | None:
        """Return the module with a name; None if no folder has it."""
        if not all(part.isidentifier() for part in name.split(".")):
            return None
        for folder in self._folders:
            if (module := self._read(Path(folder), name)) is not None:
                return module
        return None

    def _read(self, folder: Path, name: str) -> Module | None:
        place = folder.joinpath(*name.split("."))
        for path, is_package in ((place / "__init__.py", True), (place.with_suffix(".py"), False)):
            try:
                data = read_bytes(path, MAX_MODULE_BYTES, ConfigError)
                text, _ = decode_source(data[:MAX_MODULE_BYTES], str(path))
            except ConfigError:
                continue
            if (tree := parse(text)) is None:
                return None
            self.extend(tree, str(path))
            return Module(name, os.path.relpath(path, self._own), tree, is_package)
        # A folder without __init__.py is a package, too.
        is_folder = os.path.isdir(place)
        return Module(name, name, ast.Module([], []), is_package=True) if is_folder else None


@lru_cache(16)
def _list_imported(module: Module) -> list[str]:
    """Return the names of all modules that a module may import, each package before the modules in it.

    For `from package import name`, these are `package` and `package.name`, as `name` may be a module.
    """
    imported: list[str] = []
    for node in ast.walk(module.tree):
        match node:
            case ast.Import(names=names):
                for alias in names:
                    imported += _list_packages(alias.name)
            case ast.ImportFrom(module=name, level=level, names=names):
                base = module.absolute(name, level)
                if len(base) > MAX_NAME_CHARACTERS:
                    continue
                imported += _list_packages(base)
                imported += (f"{base}.{alias.name}" if base else alias.name for alias in names)
    return imported


def _list_packages(name: str) -> Iterator[str]:
    """Yield the names of the packages that contain a module, the outermost first, and then the module's own name.

    If the module's name is empty or too long, nothing is yielded.
    """
    parts = name.split(".") if 0 < len(name) <= MAX_NAME_CHARACTERS else []
    yield from (".".join(parts[:end]) for end in range(1, len(parts) + 1))


def _list_all_imported(modules: Mapping[str, Module]) -> list[str]:
    """Return the names in the imports of several modules, in their order."""
    return [name for module in modules.values() for name in _list_imported(module)]


def is_for_other_hub(modules: dict[str, Module]) -> bool:
    """Return whether a program or its own modules import a module that only LEGO's Python for SPIKE hubs has."""
    names = {*_list_all_imported(modules)} - {*modules}
    return bool(names & {*SPIKE_MODULES}) and not names & {
        *EV3_MODULES,
        HUB_DEVICES,
        "pybricks.hubs",
    }


EV3_MODULES = frozenset({"pybricks.hubs.EV3Brick", "pybricks.ev3devices", "ev3dev2", "ev3dev"})
"""Modules that only programs for the EV3 import."""


def find_hub(modules: dict[str, Module]) -> str:
    """Return the hub for which a program or one of its own modules is written, one of `HUBS`.

    The result is empty for the EV3, or if the hub is unknown.
    """
    names = _list_all_imported(modules)
    if not EV3_MODULES.isdisjoint(names):
        return ""
    usual = "PrimeHub" if HUB_DEVICES in names else ""
    named = (name.removeprefix("pybricks.hubs.") for name in names)
    return next((hub for hub in named if hub in HUBS), usual)


def find_library(modules: dict[str, Module]) -> Library | None:
    """Return the library for a brick that a program or one of its own modules imports; None if they import none."""
    names = {name.split(".")[0] for name in _list_all_imported(modules)} & {*LIBRARIES}
    if PYBRICKS in names:
        return Library.PYBRICKS
    return Library.EV3DEV2 if names else None


_MAX_DEPTH = 20
_SAME = ("abspath", "realpath", "normpath", "expanduser", "fspath", "str", "resolve", "absolute")
"""Functions and methods whose result is the same folder."""
_PATHS = ("Path", "PurePath", "PosixPath")


def own_folder(program: Program) -> str:
    """Return the folder of a program, in which it finds its modules first."""
    return program.module_folder or os.path.dirname(program.path) or os.curdir


def list_first_folders(program: Program) -> list[str]:
    """Return the folders in which a program finds its modules before it changes `sys.path`."""
    path = program.python_path if program.working_directory else user_python_path()
    return [own_folder(program), *path]


def find_added_folders(tree: ast.Module, file: str) -> list[str]:
    """Return the folders that a module adds to `sys.path`, as far as its text shows them.

    Args:
        tree: The module.
        file: Path of its file.
    """
    assigned: dict[str, ast.expr] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
            assigned |= dict.fromkeys(names, node.value)
    folders = _Folders(assigned, file)
    return list(dict.fromkeys(filter(None, map(folders.path, _find_added(tree)))))


def _find_added(tree: ast.Module) -> Iterator[ast.expr]:
    """Yield the expressions for the folders that a module adds to `sys.path`."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Attribute(value=base, attr="append"), args=[folder]):
                folders = [folder]
            case ast.Call(func=ast.Attribute(value=base, attr="insert"), args=[_, folder]):
                folders = [folder]
            case ast.Call(
                func=ast.Attribute(value=base, attr="extend"), args=[ast.List(elts=folders)]
            ):
                pass
            case ast.AugAssign(target=base, value=ast.List(elts=folders)):
                pass
            case _:
                continue
        if isinstance(base, ast.Attribute) and base.attr == "path" and _is_name(base.value, "sys"):
            yield from folders


def _is_name(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name


@dataclass(frozen=True, slots=True)
class _Folders:
    """Computes the paths of expressions in a module; a path is empty if the text does not show it.

    Args:
        assigned: The last expression that is assigned to each name.
        file: Path of the module.
    """

    assigned: Mapping[str, ast.expr]
    file: str
    depth: int = 0

    def path(self, node: ast.expr) -> str:
        """Return the path that an expression computes; empty if it is not known."""
        if self.depth > _MAX_DEPTH:
            return ""
        inside = replace(self, depth=self.depth + 1)
        match node:
            case ast.Constant(value=str(text)):
                return text
            case ast.Name(id="__file__"):
                return self.file
            case ast.Name(id=name) if name in self.assigned:
                return inside.path(self.assigned[name])
            case ast.Attribute(attr="pardir"):
                return os.pardir
            case ast.Attribute(value=base, attr="parent"):
                return _climb(inside.path(base), 1)
            case ast.Subscript(
                value=ast.Attribute(value=base, attr="parents"),
                slice=ast.Constant(value=int(steps)),
            ):
                return _climb(inside.path(base), steps + 1)
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return _join(inside.path(left), inside.path(right))
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                parts = inside.path(left), inside.path(right)
                return "".join(parts) if all(parts) else ""
            case ast.Call():
                return inside.result(node)
        return ""

    def result(self, call: ast.Call) -> str:
        """Return the path of a file or folder that a call such as `os.path.join` returns; empty if not known."""
        match call:
            case ast.Call(func=ast.Attribute(attr="getcwd" | "cwd")):
                return os.path.dirname(self.file) or os.curdir
            case ast.Call(func=ast.Attribute(attr="join"), args=args):
                return _join(*map(self.path, args))
            case ast.Call(func=ast.Attribute(value=base, attr="joinpath"), args=args):
                return _join(*map(self.path, [base, *args]))
            case ast.Call(func=ast.Attribute(attr="dirname"), args=[part]):
                return _climb(self.path(part), 1)
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=[*args]) if (
                args and name in (*_PATHS, *_SAME)
            ):
                return _join(*map(self.path, args if name in _PATHS else args[:1]))
            case ast.Call(func=ast.Attribute(value=base, attr=name)) if name in _SAME:
                return self.path(base)
        return ""


def _climb(path: str, steps: int) -> str:
    """Return the folder a number of steps above a path; empty for an empty path."""
    if not path:
        return ""
    path = os.path.abspath(path)
    for _ in range(min(steps, _MAX_DEPTH)):
        path = os.path.dirname(path)
    return path


def _join(*parts: str) -> str:
    return os.path.join(*parts) if parts and all(parts) else ""
