"""Runs the program's `threading` and `_thread` on the scheduler."""

from __future__ import annotations

import _thread
import sys
from collections.abc import Callable
from functools import wraps
from typing import Any

from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.scheduler import FOREVER, ScheduledThread, Scheduler, SimulatedLock
from tuisim.engine.runtime.session import StopProgram
from tuisim.engine.shim.waits import Wait, waits_for

EndedBy = Callable[[Callable[..., object], BaseException], None]
"""Called with the function of a thread and the error that has ended it."""


def patch_threads(scheduler: Scheduler, ended_by: EndedBy) -> None:
    """Replace the functions for locks and for starting threads, then import `threading`, which uses them.

    It must be called before anything imports `threading`.

    Args:
        scheduler: Runs the threads.
        ended_by: Shows the error that has ended a thread that `threading` does not know.
    """
    low: Any = _thread

    class LockType(SimulatedLock):
        """The type of the program's locks, which has the name and the `repr` of the real `_thread.lock`."""

        def __init__(self) -> None:
            super().__init__(scheduler)

        def __reduce_ex__(self, _protocol: object) -> Any:
            raise TypeError("cannot pickle '_thread.lock' object")

        def __repr__(self) -> str:
            return f"<{'locked' if self.locked() else 'unlocked'} _thread.lock object at {id(self):#x}>"

    LockType.__module__ = "_thread"
    LockType.__name__ = "lock"
    LockType.__qualname__ = "lock"

    for name in ("allocate_lock", "allocate"):
        replace(low, name, LockType, (0, 0))
    for name in ("start_new_thread", "start_new"):
        replace(low, name, _build_starter(scheduler, ended_by), (2, 3))
    low.LockType = LockType
    if hasattr(low, "lock"):
        low.lock = LockType
    # Without the C queue, `queue` falls back to its own locks, which are simulated.
    sys.modules["_queue"] = None  # type: ignore[assignment]

    import threading

    module: Any = threading
    module._CRLock = None
    module.RLock = module._RLock = module._PyRLock
    _patch_thread_class(scheduler, module.Thread)


def _build_starter(scheduler: Scheduler, ended_by: EndedBy) -> Callable[..., int]:
    """Return the function that replaces `_thread.start_new_thread`."""

    def start_new_thread(function: Any, args: Any, kwargs: Any = None) -> int:
        if not callable(function):
            raise TypeError("first arg must be callable")
        if not isinstance(args, tuple):
            raise TypeError("2nd arg must be a tuple")
        if not isinstance(kwargs, dict | None):
            raise TypeError("optional 3rd arg must be a dictionary")

        def run_bare() -> None:
            try:
                function(*args, **kwargs or {})
            except (SystemExit, StopProgram):
                # As in Python, such an exception ends the thread without a message.
                raise
            except BaseException as error:
                # As in Python, an error ends only this thread, and is shown.
                ended_by(function, error)

        task = scheduler.spawn(run_bare, daemon=True)
        # The library busy-waits until its new thread has started: let it start.
        scheduler.give_way()
        return task.ident

    return start_new_thread


def _patch_thread_class(scheduler: Scheduler, thread: Any) -> None:
    tasks: dict[int, ScheduledThread] = {}

    @wraps(thread.start)
    def start(self: Any) -> None:
        if not self._initialized:
            raise RuntimeError("thread.__init__() not called")
        if self._started.is_set():
            raise RuntimeError("threads can only be started once")
        import threading

        limbo: Any = threading
        with limbo._active_limbo_lock:
            limbo._limbo[self] = self
        try:
            tasks[id(self)] = scheduler.spawn(self._bootstrap, daemon=bool(self.daemon))
        except RuntimeError:
            del limbo._limbo[self]
            raise
        self._started.wait()

    @wraps(thread.join)
    @waits_for(Wait.THREAD)
    def join(self: Any, timeout: float | None = None) -> None:
        if not self._initialized:
            raise RuntimeError("Thread.__init__() not called")
        if not self._started.is_set():
            raise RuntimeError("cannot join thread before it is started")
        task = tasks.get(id(self))
        if task is scheduler.current:
            raise RuntimeError("cannot join current thread")
        if task is not None:
            scheduler.join(task, FOREVER if timeout is None else max(0, round(timeout * 1e9)))

    @wraps(thread.is_alive)
    def is_alive(self: Any) -> bool:
        if not self._started.is_set():
            return False
        task = tasks.get(id(self))
        if task is not None and task.done:
            # The thread's `repr` says `stopped` from now on.
            self._is_stopped = True
        return task is None or not task.done

    thread.start = start
    thread.join = join
    thread.is_alive = is_alive
    # Python's own end-of-thread lock is a real one: nothing waits for it here.
    thread._set_tstate_lock = lambda self: None
    thread._wait_for_tstate_lock = lambda self, block=True, timeout=-1: None
