"""The folders in which a program finds its own modules: as it sets `sys.path`, where its text says them plainly."""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator, Mapping
from dataclasses import replace

from tuisim.base.data_class import dataclass
from tuisim.base.source import Program, user_python_path

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
    """Return the folders that a module puts into `sys.path`.

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
    """Yield the expressions, for folders, that a module puts into `sys.path`."""
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
    """Works out the paths that expressions of a module stand for; empty where its text does not show them.

    Args:
        assigned: The last expression that is assigned to each name.
        file: Path of the module.
    """

    assigned: Mapping[str, ast.expr]
    file: str
    depth: int = 0

    def path(self, node: ast.expr) -> str:
        """Return the path that an expression stands for."""
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
        """Return the path that a call returns."""
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
    """Return the folder some steps above a path; empty for an empty path."""
    if not path:
        return ""
    path = os.path.abspath(path)
    for _ in range(min(steps, _MAX_DEPTH)):
        path = os.path.dirname(path)
    return path


def _join(*parts: str) -> str:
    return os.path.join(*parts) if parts and all(parts) else ""
