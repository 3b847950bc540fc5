"""What the runtime itself uses of Python, out of the reach of a program, which may replace any name.

The program gets a copy of the builtins. The runtime keeps the real ones, and copies of the modules that it uses: a
program that replaces `os.path.join` or `len` changes what its own code finds, as with Python itself, and no more.
"""

from __future__ import annotations

import builtins
import sys
import types
from importlib.util import find_spec, module_from_spec
from typing import Any

PROGRAM_BUILTINS = types.ModuleType("builtins", builtins.__doc__)
"""The program's `builtins`; filled by `give_builtins`."""
_SHARED = ("sys", "builtins")
"""Modules whose names the runtime sets for the program: streams, the path, a loop hook."""


def give_builtins() -> None:
    """Let everything that is imported from now on find a copy of the builtins."""
    vars(PROGRAM_BUILTINS).update(vars(builtins))
    sys.modules["builtins"] = PROGRAM_BUILTINS


def own_instance(name: str, **parts: types.ModuleType) -> Any:
    """Return a second instance of a module of the standard library.

    Args:
        name: Its name.
        parts: Modules that it imports instead of those of the same name.
    """
    spec = find_spec(name)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    kept = {part: sys.modules.get(part) for part in parts}
    sys.modules.update(parts)
    try:
        spec.loader.exec_module(module)
    finally:
        for part, there in kept.items():
            if there is None:
                del sys.modules[part]
            else:
                sys.modules[part] = there
    return module


def keep_modules() -> None:
    """Let the modules of this application refer to copies of the modules of Python as they are now."""
    copies: dict[int, types.ModuleType] = {}
    ours = [module for name, module in sys.modules.items() if name.partition(".")[0] == "tuisim"]
    for module in ours:
        for name, value in list(vars(module).items()):
            if type(value) is types.ModuleType and _is_kept(value.__name__):
                vars(module)[name] = _copy(value, copies)


def _is_kept(name: str) -> bool:
    top = name.partition(".")[0]
    return top in sys.stdlib_module_names and top not in _SHARED


def _copy(module: types.ModuleType, copies: dict[int, types.ModuleType]) -> types.ModuleType:
    if id(module) not in copies:
        copy = copies[id(module)] = types.ModuleType(module.__name__)
        vars(copy).update(vars(module))
        if isinstance(path := vars(module).get("path"), types.ModuleType):
            # os.path
            vars(copy)["path"] = _copy(path, copies)
    return copies[id(module)]
