"""The notebook side: the magics of a course's cells over runs in a child process.

`roboSim` and `eds` load their modules when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tuisim.notebook import eds
    from tuisim.notebook.lab import roboSim

__all__ = ["eds", "roboSim"]


def __getattr__(name: str) -> Any:
    if name == "eds":
        return import_module("tuisim.notebook.eds")
    if name == "roboSim":
        return import_module("tuisim.notebook.lab").roboSim
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
