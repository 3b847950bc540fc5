"""Names that only the brick's older Python has, and the modules of MicroPython, which runs ev3dev2, too."""

from __future__ import annotations

import collections.abc
import math
import sys
import time
import types
import warnings
from collections.abc import Callable, Mapping

from tuisim.engine.shim.pybricks.micropython import OF_PYTHON, MicroPythonFinder, clock_names
from tuisim.engine.shim.session import DeviceSession


def _finish_collections(module: types.ModuleType) -> None:
    for name in collections.abc.__all__:
        vars(module).setdefault(name, getattr(collections.abc, name))


def _finish_threading(module: types.ModuleType) -> None:
    thread = vars(module)["Thread"]
    thread.isAlive = thread.is_alive


FINISHERS: Mapping[str, Callable[[types.ModuleType], None]] = {
    "asyncio": lambda module: vars(module).update(coroutine=types.coroutine),
    "collections": _finish_collections,
    "fractions": lambda module: vars(module).update(gcd=math.gcd),
    "threading": _finish_threading,
}
"""Functions that add to a module, after its import, the names that only Python 3.5 has there, by the module's name."""


class _MicroPython(MicroPythonFinder):
    """Module finder for MicroPython's forms of Python's modules, such as `utime`.

    Args:
        session: The program's clock.
    """

    def __init__(self, session: DeviceSession) -> None:
        super().__init__(OF_PYTHON, {})
        self._session = session

    def exec_module(self, module: types.ModuleType) -> None:
        """Fill a module of MicroPython, such as `ujson`, with the names of Python's module, here `json`.

        `utime` also gets counters of simulated time.
        """
        super().exec_module(module)
        if module.__name__ == "utime":
            vars(module).update(clock_names(self._session))


def install(session: DeviceSession) -> None:
    """Give a program the names and modules that only the brick's older Python has, and hide warnings about them."""
    vars(time)["clock"] = time.perf_counter
    warnings.filterwarnings("ignore", category=DeprecationWarning)
    sys.meta_path.append(_MicroPython(session))
