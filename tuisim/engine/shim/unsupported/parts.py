"""Parts of the library and of Python that the simulated brick does not have; each raises an error with its name."""

from __future__ import annotations

import sys
import types
from collections.abc import Mapping
from functools import wraps
from typing import Any, NoReturn

from tuisim.base.errors import NotSimulated

_THREADS = "the simulated brick has one process; use threading"

REFUSED: Mapping[str, Mapping[str, str]] = {
    "ev3dev2.control.GyroBalancer": {
        "GyroBalancer": "it balances on two wheels, and this robot cannot fall; to drive, use MoveTank or MoveSteering",
    },
    "ev3dev2.control.webserver": {
        "RobotWebServer": "a program has no network; for driving by hand use RemoteControlledTank or the buttons",
        "WebControlledTank": "a program has no network; for driving by hand use RemoteControlledTank or the buttons",
    },
    "ev3dev.GyroBalancer": {
        "GyroBalancer": "it balances on two wheels, and this robot cannot fall; to drive, use LargeMotor",
    },
    "ev3dev.virtualterminal": {"VirtualTerminal": "to write on the screen, use ev3dev.ev3.Screen"},
    "ev3dev.webserver": {
        "RobotWebServer": "a program has no network; for driving by hand use the buttons",
        "TankWebHandler": "a program has no network; for driving by hand use the buttons",
        "WebControlledTank": "a program has no network; for driving by hand use the buttons",
    },
    "multiprocessing.shared_memory": {"SharedMemory": _THREADS},
}
"""For each module, its classes whose constructors raise NotSimulated, with the reason or what to use instead."""

_IN_CONTEXT = (
    "Array",
    "Barrier",
    "BoundedSemaphore",
    "Condition",
    "Event",
    "JoinableQueue",
    "Lock",
    "Manager",
    "Pipe",
    "Pool",
    "Queue",
    "RLock",
    "RawArray",
    "RawValue",
    "Semaphore",
    "SimpleQueue",
    "Value",
)
"""The methods of the contexts of `multiprocessing` that are refused: some would start a process, the others would block
forever.
"""


def refuse_contexts(module: Any) -> None:
    """Patch the contexts of `multiprocessing` after their import, so that they refuse to start processes."""
    base = module.BaseContext
    genuine = {name: getattr(base, name) for name in _IN_CONTEXT}
    module.ThreadContext = type("ThreadContext", (base,), {**genuine, "_name": "fork"})
    for name in _IN_CONTEXT:
        setattr(base, name, _refusal(f"multiprocessing.{name}", _hint(name)))


def keep_thread_pool(module: types.ModuleType) -> None:
    """Patch `multiprocessing.pool` after its import, so that `ThreadPool` works: it uses threads, not processes."""
    contexts: Any = sys.modules["multiprocessing.context"]
    pool, context = module.Pool, contexts.ThreadContext()

    def __init__(
        self: Any, processes: Any = None, initializer: Any = None, initargs: Any = ()
    ) -> None:  # noqa: N807
        pool.__init__(self, processes, initializer, initargs, context=context)

    module.ThreadPool.__init__ = __init__


def refuse_process(module: types.ModuleType) -> None:
    """Patch `multiprocessing.process` after its import, so that it refuses to start processes."""
    module.BaseProcess.__init__ = _refusal("multiprocessing.Process", _hint("Process"))


def refuse_process_pool(module: types.ModuleType) -> None:
    """Patch `concurrent.futures.process` after its import, so that it refuses its process pool."""
    name = "ProcessPoolExecutor"
    getattr(module, name).__init__ = _refusal(
        f"concurrent.futures.{name}", f"{_THREADS}, or ThreadPoolExecutor"
    )


def _hint(name: str) -> str:
    match name:
        case "Process":
            return f"{_THREADS}.Thread"
        case "Queue" | "JoinableQueue" | "SimpleQueue" | "Pipe":
            return f"{_THREADS}, and queue.Queue between threads"
        case "Pool":
            return f"{_THREADS}, or multiprocessing.pool.ThreadPool"
        case (
            "Lock" | "RLock" | "Event" | "Condition" | "Semaphore" | "BoundedSemaphore" | "Barrier"
        ):
            return f"{_THREADS}.{name}"
        case _:
            return f"{_THREADS}: its threads share their variables"


PROCESSES = {
    "concurrent.futures.process": refuse_process_pool,
    "multiprocessing.context": refuse_contexts,
    "multiprocessing.pool": keep_thread_pool,
    "multiprocessing.process": refuse_process,
}
"""Functions that patch a module after its import, by its name, so that it starts no processes on this computer."""


OTHER_BOARDS = ("ev3dev.brickpi", "ev3dev.brickpi3", "ev3dev.pistorms")
"""Modules of python-ev3dev, the older library, for other boards than the EV3; their import raises NotSimulated."""


def refuse_board(module: types.ModuleType) -> NoReturn:
    """Raise the error for importing a module that is for another board than the EV3.

    Raises:
        NotSimulated: always.
    """
    raise NotSimulated(
        f"{module.__name__} is not part of the simulated brick: it is an EV3", "import ev3dev.ev3"
    )


def refuse_classes(module: types.ModuleType) -> None:
    """Make the constructors of a module's refused classes raise NotSimulated."""
    for name, hint in REFUSED[module.__name__].items():
        refused: Any = getattr(module, name)
        refused.__init__ = wraps(refused.__init__)(_refusal(f"{module.__name__}.{name}", hint))


def _refusal(name: str, hint: str) -> Any:
    def refuse(*_args: object, **_kwargs: object) -> NoReturn:
        raise NotSimulated(f"{name} is not part of the simulated brick", hint)

    return refuse
