"""The program's own modules: found as Python finds them, and stored with the run, so that it can be repeated."""

from __future__ import annotations

import linecache
import os
import sys
import traceback
import types
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from typing import Any, NoReturn

from tuisim.base.source import source_lines
from tuisim.engine.brick_home import place_folder
from tuisim.engine.runs.side_files import OwnModule, note_module, read_modules
from tuisim.engine.runtime.loader import compile_with_hooks
from tuisim.engine.runtime.stack import PACKAGE_FOLDER

_FOREIGN = (PACKAGE_FOLDER, os.path.dirname(traceback.__file__) + os.sep)
_INSTALLED = ("site-packages", "dist-packages")

OWN_FILES: set[str] = set()
"""Files of all imported modules of the program's own."""


def is_own(path: str) -> bool:
    """Return whether a file may be the user's: not part of Python, an installed package, or this application."""
    return not path.startswith(_FOREIGN) and not any(name in path for name in _INSTALLED)


def remember_source(file: str, source: str) -> None:
    """Make tracebacks show this source of a file, even if the file changes later."""
    lines = [line + "\n" for line in source_lines(source)]
    linecache.cache[file] = len(source), None, lines, file


class OwnLoader(SourceFileLoader):
    """The loader of a module of the program, which uses the text that was first read from the module's file.

    Args:
        module: The module.
        drops_annotations: Whether its annotations are left out, not evaluated.
    """

    def __init__(self, module: OwnModule, drops_annotations: bool) -> None:
        super().__init__(module.name, module.file)
        self._drops_annotations = drops_annotations
        self._data = module.text.encode("utf-8", "surrogateescape")

    def get_data(self, path: str) -> bytes:
        """Return the stored text of the module's file; for another path, the contents of that file."""
        return self._data if path == self.path else super().get_data(path)

    def source_to_code(self, data: Any, path: Any, *, _optimize: int = -1) -> types.CodeType:  # type: ignore[override]
        """Return the code of the module, with a call of `LOOP_HOOK` in each loop body, as in the program."""
        return compile_with_hooks(data, path, self._drops_annotations)

    def path_stats(self, path: str) -> NoReturn:
        """Raise OSError, so that Python uses no compiled code beside the file: it may belong to another text."""
        raise OSError


class OwnModules(PathFinder):
    """Module finder for files. For each module of the user, it stores a copy with the run.

    Args:
        run_folder: Where the copies are stored.
        known: If an earlier run is repeated, the modules that were stored with it; they are loaded instead of the
            files.
        brick_folder: The program's folder, in which modules of the brick's home folder are looked for; empty without a
            brick.
        drops_annotations: Whether annotations are left out, not evaluated.
    """

    def __init__(
        self,
        run_folder: Path,
        known: Sequence[OwnModule],
        brick_folder: str,
        drops_annotations: bool,
    ) -> None:
        self._run_folder, self._brick_folder = run_folder, brick_folder
        self._drops_annotations = drops_annotations
        self._missed: dict[str, int] = {}
        """How often each module was not found, by name, not counting the first time, which is stored immediately."""
        self._known: dict[str, list[OwnModule]] = {}
        for module in known:
            self._known.setdefault(module.name, []).append(module)

    def find_spec(  # type: ignore[override]
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: types.ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return the spec of a module; None if there is no such module."""
        if known := self._known.get(fullname):
            # A module that was imported several times may have had another text each time. The texts are used in order,
            # and the last one for all later imports.
            return self._spec_of(known.pop(0) if len(known) > 1 else known[0])
        if path is None and self._brick_folder:
            path = [place_folder(str(folder), self._brick_folder) for folder in sys.path]
        spec = PathFinder.find_spec(fullname, path, target)
        module = OwnModule(fullname) if spec is None else _own_module(fullname, spec)
        if module is None:
            return spec
        if module.missing and fullname in self._missed:
            self._missed[fullname] += 1
            return None
        for _ in range(0 if module.missing else self._missed.pop(fullname, 0)):
            note_module(self._run_folder, OwnModule(fullname))
        note_module(self._run_folder, module)
        if module.missing:
            self._missed[fullname] = 0
        return spec if spec is None or not module.file else self._spec_of(module)

    def _spec_of(self, module: OwnModule) -> ModuleSpec | None:
        if module.missing:
            return None
        if not module.file:
            spec = ModuleSpec(module.name, None, is_package=True)
            spec.submodule_search_locations = list(module.folders or ())
            return spec
        from importlib.util import spec_from_file_location

        OWN_FILES.add(module.file)
        remember_source(module.file, module.text)
        folders = None if module.folders is None else list(module.folders)
        loader = OwnLoader(module, self._drops_annotations)
        return spec_from_file_location(
            module.name, module.file, loader=loader, submodule_search_locations=folders
        )


def install_finder(run_folder: Path, brick_folder: str, drops_annotations: bool) -> None:
    """Install a module finder that stores the program's own modules with the run.

    When a run is repeated, the finder loads the modules that are stored in its folder instead.

    Args:
        run_folder: The folder of the run.
        brick_folder: The program's folder, in which modules of the brick's home folder are looked for; empty without a
            brick.
        drops_annotations: Whether annotations are left out, not evaluated.
    """
    finders: list[Any] = sys.meta_path
    finders[finders.index(PathFinder)] = OwnModules(
        run_folder, read_modules(run_folder), brick_folder, drops_annotations
    )


def _own_module(name: str, spec: ModuleSpec) -> OwnModule | None:
    """Return the module to store; None if it is not the user's, or is compiled, so that Python loads it as usual."""
    folders = (
        None if spec.submodule_search_locations is None else tuple(spec.submodule_search_locations)
    )
    if spec.origin is None:
        return OwnModule(name, folders=folders) if folders and all(map(is_own, folders)) else None
    if not spec.origin.endswith(".py") or not is_own(spec.origin):
        return None
    loader: Any = spec.loader
    try:
        data = loader.get_data(spec.origin)
    except (OSError, AttributeError):
        # Python reports the error when it loads the module.
        return None
    return OwnModule(name, spec.origin, folders, data.decode("utf-8", "surrogateescape"))
