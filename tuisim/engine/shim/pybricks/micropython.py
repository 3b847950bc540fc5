"""MicroPython's modules, made from Python's own ones, and the names that Python's own ones lack."""

from __future__ import annotations

import builtins
import operator
import re
import sys
import types
from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from importlib import import_module
from importlib.machinery import ModuleSpec
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.unsupported.modules import Hardware, HardwareModule
from tuisim.engine.shim.waits import Wait, waits_for

TICKS_PERIOD = 1 << 30
"""The counters that `ticks_ms` and its like return begin again at 0 when they reach this number."""
US = MS // 1000
FOLDER = 0x4000
FILE = 0x8000
"""`FOLDER` and `FILE` are the types of entries that `os.ilistdir` yields in MicroPython."""

OF_PYTHON: Mapping[str, str] = {
    f"u{name}": name
    for name in (
        "array",
        "asyncio",
        "binascii",
        "collections",
        "errno",
        "hashlib",
        "heapq",
        "io",
        "json",
        "math",
        "os",
        "queue",
        "random",
        "re",
        "select",
        "signal",
        "socket",
        "ssl",
        "struct",
        "sys",
        "time",
        "zlib",
    )
}
"""Names of Python's modules that stand in for MicroPython's modules, by MicroPython's name, such as `utime`."""

_MACHINE = Hardware("the processor of the brick", "use the modules of pybricks")
_MEMORY = Hardware("the memory of MicroPython", "leave it out: a program has more memory here")
_NETWORK = Hardware("a network", "leave it out: a program has no network")
_C_CODE = Hardware(
    "code in C, and its data in memory", "use the modules of pybricks, and struct for bytes"
)

BUILT_IN: Mapping[str, Hardware] = {
    "btree": Hardware("the database btree", "use a file: open()"),
    "ffi": _C_CODE,
    "framebuf": Hardware("framebuf", "draw on EV3Brick().screen"),
    "machine": _MACHINE,
    "ucryptolib": Hardware("ucryptolib", "leave it out"),
    "uctypes": _C_CODE,
    "umachine": _MACHINE,
    "utimeq": Hardware("utimeq", "use a list, and sort()"),
    "uwebsocket": _NETWORK,
}
"""Built-in modules of MicroPython that a program here can import but not use, by name."""
INSTALLED: Mapping[str, Hardware] = {"umqtt": _NETWORK, "urequests": _NETWORK}
"""Modules, installed as files on the brick, that a program here can import but not use, by name; a module of that name
beside the program comes first.
"""


class MicroPythonFinder:
    """Module finder for MicroPython's modules.

    Args:
        of_python: The module of Python that has the same functions, by MicroPython's name, such as `utime`.
        refused: Modules that a program can import but not use, with the hardware or feature that they are for.
    """

    def __init__(self, of_python: Mapping[str, str], refused: Mapping[str, Hardware]) -> None:
        self._of_python = of_python
        self._refused = refused

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        """Return the spec of a module of MicroPython; None for other modules."""
        loader: Any = self
        is_refused = fullname.partition(".")[0] in self._refused
        known = fullname in self._of_python or is_refused
        return (
            ModuleSpec(fullname, loader, origin="MicroPython", is_package=is_refused)
            if known
            else None
        )

    def create_module(self, spec: ModuleSpec) -> types.ModuleType:
        """Return a new module without any names in it yet."""
        hardware = self._refused.get(spec.name.partition(".")[0])
        return (
            types.ModuleType(spec.name) if hardware is None else HardwareModule(spec.name, hardware)
        )

    def exec_module(self, module: types.ModuleType) -> None:
        """Add the names of a module of Python to the module of MicroPython that corresponds to it."""
        if (source := self._of_python.get(module.__name__)) is not None:
            names = vars(import_module(source))
            vars(module).update(
                {name: value for name, value in names.items() if not name.startswith("__")}
            )
            if source == "asyncio":
                vars(module)["sleep_ms"] = lambda time: names["sleep"](operator.index(time) / 1000)


def install(session: DeviceSession) -> None:
    """Make MicroPython's modules importable by the program, and add MicroPython's own names to Python's modules."""
    for name, more in (
        ("time", clock_names(session)),
        ("gc", GARBAGE),
        ("os", FILES),
        ("sys", SYSTEM),
    ):
        vars(import_module(name)).update(more)
    for name, function, fitted in (
        ("collections", "namedtuple", _named_tuple),
        ("_thread", "stack_size", lambda _: 0),
    ):
        names = vars(import_module(name))
        names[function] = _lenient(names[function], fitted)
    module = sys.modules["micropython"] = HardwareModule("micropython", _MEMORY)
    vars(module).update(LANGUAGE)
    # In MicroPython, these names are built in: no import is needed.
    vars(builtins).update(const=LANGUAGE["const"], micropython=module)
    # As on a brick, a built-in module comes before a file of the same name.
    sys.meta_path.insert(0, MicroPythonFinder(OF_PYTHON, BUILT_IN))
    sys.meta_path.append(MicroPythonFinder({}, INSTALLED))


def clock_names(session: DeviceSession) -> dict[str, Callable[..., Any]]:
    """Return the functions that only MicroPython's `time` has, by name; they measure simulated time."""
    cost = session.sim.spec.profile.clock_read_ns

    def counter(tick_ns: int) -> Callable[[], int]:
        def ticks() -> int:
            session.charge(cost)
            return session.now // tick_ns % TICKS_PERIOD

        return ticks

    def sleeper(unit_ns: int) -> Callable[[int], None]:
        @waits_for(Wait.SLEEP)
        def sleep(duration: int) -> None:
            if (length := operator.index(duration)) > 0:
                session.spend(length * unit_ns)
            else:
                session.command()

        return sleep

    ticks_us = counter(US)
    return {
        "clock": lambda: ticks_us() / 1e6,
        "sleep_ms": sleeper(MS),
        "sleep_us": sleeper(US),
        "ticks_add": ticks_add,
        "ticks_cpu": ticks_us,
        "ticks_diff": ticks_diff,
        "ticks_ms": counter(MS),
        "ticks_us": ticks_us,
    }


def ticks_add(ticks: int, delta: int) -> int:
    """Return the value of a tick counter `delta` ticks after the value `ticks`.

    After its period, the counter restarts at 0.
    """
    return (operator.index(ticks) + operator.index(delta)) % TICKS_PERIOD


def ticks_diff(end: int, start: int) -> int:
    """Return how many ticks of a counter `end` is after `start`; negative if it is before.

    The counter wraps, so the result is from minus half a period to half a period.
    """
    half = TICKS_PERIOD // 2
    return (operator.index(end) - operator.index(start) + half) % TICKS_PERIOD - half


def _unchanged(value: Any) -> Any:
    return value


def _without_effect(*_given: object) -> None:
    """Do nothing: the setting has no effect on a simulated program."""


def _opt_level(level: int | None = None) -> int | None:
    return 0 if level is None else None


def _lenient(real: Callable[..., Any], fitted: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that calls `real`, a function of Python, or `fitted` with the same arguments if that fails.

    Only a ValueError counts as a failure; other errors are raised.
    """

    @wraps(real)
    def function(*given: Any, **named: Any) -> Any:
        try:
            return real(*given, **named)
        except ValueError:
            return fitted(*given, **named)

    return function


def _named_tuple(name: str, fields: Any, **named: Any) -> type:
    """Return a named tuple class. As in MicroPython, any names are allowed: those that Python forbids are replaced."""
    return namedtuple("_" + re.sub(r"\W", "_", name.strip()), fields, rename=True, **named)


LANGUAGE: Mapping[str, Any] = {
    "alloc_emergency_exception_buf": _without_effect,
    "bytecode": _unchanged,
    "const": _unchanged,
    "heap_lock": _without_effect,
    "heap_unlock": _without_effect,
    "kbd_intr": _without_effect,
    "mem_info": _without_effect,
    "native": _unchanged,
    "opt_level": _opt_level,
    "schedule": lambda function, argument: function(argument),
    "viper": _unchanged,
}
"""The names of the module `micropython` that a program can use; its other names are about memory, and cannot be used.
"""

FREE_BYTES, USED_BYTES = 48_000_000, 200_000
"""Estimated free and used memory that `gc.mem_free` and `gc.mem_alloc` return: the brick has 64 MB."""

GARBAGE: Mapping[str, Any] = {
    "mem_alloc": lambda: USED_BYTES,
    "mem_free": lambda: FREE_BYTES,
    "threshold": _without_effect,
}
"""The names that MicroPython's `gc` has and Python's has not or has otherwise, with their values."""


def _ilistdir(folder: str = ".") -> Iterator[tuple[str, int, int]]:
    """Yield the name, the type and the inode of each entry of a folder, as MicroPython's `os.ilistdir` does."""
    os = import_module("os")
    for entry in os.scandir(folder):
        yield entry.name, FOLDER if entry.is_dir() else FILE, entry.inode()


FILES: Mapping[str, Any] = {"ilistdir": _ilistdir}
"""The names that MicroPython's `os` has and Python's has not, with their values."""


def _print_exception(error: BaseException, file: Any = None) -> None:
    """Print an error with its traceback to a file, by default to the program's output."""
    import_module("traceback").print_exception(error, file=sys.stdout if file is None else file)


class _Implementation(types.SimpleNamespace):
    """The value of `sys.implementation`, whose fields can also be read by number."""

    def __getitem__(self, index: int) -> Any:
        return (self.name, self.version)[index]


SYSTEM: Mapping[str, Any] = {
    # Attributes that MicroPython does not have stay, because Python's import system needs them.
    "implementation": _Implementation(
        **{**vars(sys.implementation), "name": "pybricks-micropython", "version": (1, 11, 0)}
    ),
    "print_exception": _print_exception,
}
"""The names that MicroPython's `sys` has and Python's has not or has otherwise, with their values."""
