"""Simulated time for the program's own modules: time, datetime, random, selectors."""

from __future__ import annotations

import builtins
import os
import time
import types
from collections.abc import Callable, Mapping
from typing import Any

from tuisim.core.simulation import NS_PER_S
from tuisim.runtime.session import THREADS, Session

EPOCH_S = 1_577_836_800
"""Every run begins on 1 January 2020, 00:00 UTC."""

POLL_NS = 1_000_000
"""How often an event loop with threads behind it looks for what they did."""


def patch_time(session: Session) -> None:
    """Replace the functions of `time` in place; what was imported from it before stays real."""
    module: Any = time
    real_localtime, real_gmtime = time.localtime, time.gmtime
    real_strftime, real_ctime, real_asctime = time.strftime, time.ctime, time.asctime
    cost = session.sim.spec.profile.clock_read_ns

    def clock_ns() -> int:
        session.charge(cost)
        return session.now

    def clock() -> float:
        session.charge(cost)
        return session.now / NS_PER_S

    def wall() -> float:
        session.charge(cost)
        return EPOCH_S + session.now / NS_PER_S

    def sleep(seconds: float) -> None:
        """Let simulated time pass."""
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        session.spend(round(seconds * NS_PER_S))

    module.sleep = sleep
    module.time, module.time_ns = wall, lambda: EPOCH_S * NS_PER_S + clock_ns()
    for name in ("monotonic", "perf_counter", "process_time", "thread_time"):
        setattr(module, name, clock)
        setattr(module, f"{name}_ns", clock_ns)
    module.clock_gettime, module.clock_gettime_ns = lambda _clock: wall(), lambda _clock: module.time_ns()
    module.localtime = lambda seconds=None: real_localtime(wall() if seconds is None else seconds)
    module.gmtime = lambda seconds=None: real_gmtime(wall() if seconds is None else seconds)
    module.ctime = lambda seconds=None: real_ctime(wall() if seconds is None else seconds)
    module.asctime = lambda when=None: real_asctime(module.localtime() if when is None else when)
    module.strftime = lambda form, when=None: real_strftime(form, module.localtime() if when is None else when)


def patch_datetime(session: Session, program_file: str) -> None:
    """Give the program, the modules beside it and the library a `datetime` that tells simulated time.

    Everybody else keeps the real module: compiled ones, such as those of pandas, build on
    the real classes and crash on others.
    """
    real_import = builtins.__import__
    folder = os.path.dirname(os.path.abspath(program_file))
    shadow: list[types.ModuleType] = []

    def wants_simulated(importer: Mapping[str, Any]) -> bool:
        name = str(importer.get("__name__", ""))
        if name == "__main__" or name.partition(".")[0] == "ev3dev2":
            return True
        return os.path.dirname(os.path.abspath(str(importer.get("__file__") or "/"))) == folder

    def import_module(
        name: str,
        globals: Any = None,  # noqa: A002 - the names of the real function
        locals: Any = None,  # noqa: A002
        fromlist: Any = (),
        level: int = 0,
    ) -> Any:
        found = real_import(name, globals, locals, fromlist, level)
        if name != "datetime" or level or globals is None or not wants_simulated(globals):
            return found
        if not shadow:
            shadow.append(_simulated_datetime(session, found))
        return shadow[0]

    builtins.__import__ = import_module


def _simulated_datetime(session: Session, module: types.ModuleType) -> types.ModuleType:
    """Return a copy of `datetime` whose `now`, `utcnow` and `today` tell simulated time."""
    cost = session.sim.spec.profile.clock_read_ns
    real_datetime, real_date = module.datetime, module.date

    def seconds() -> float:
        session.charge(cost)
        return EPOCH_S + session.now / NS_PER_S

    class LikeTheReal(type):
        def __instancecheck__(cls, instance: object) -> bool:
            return isinstance(instance, cls.__mro__[1])

        def __subclasscheck__(cls, subclass: type) -> bool:
            return issubclass(subclass, cls.__mro__[1])

    class datetime(real_datetime, metaclass=LikeTheReal):  # type: ignore[misc,valid-type]  # noqa: N801
        @classmethod
        def now(cls, tz: Any = None) -> Any:
            return cls.fromtimestamp(seconds(), tz)

        @classmethod
        def utcnow(cls) -> Any:
            return cls.utcfromtimestamp(seconds())

        @classmethod
        def today(cls) -> Any:
            return cls.fromtimestamp(seconds())

    class date(real_date, metaclass=LikeTheReal):  # type: ignore[misc,valid-type]  # noqa: N801
        @classmethod
        def today(cls) -> Any:
            return cls.fromtimestamp(seconds())

    shadow = types.ModuleType("datetime", module.__doc__)
    vars(shadow).update(vars(module))
    for replacement in (datetime, date):
        replacement.__module__ = "datetime"
        replacement.__qualname__ = replacement.__name__
        setattr(shadow, replacement.__name__, replacement)
    return shadow


def finish_selectors(session: Session, module: types.ModuleType) -> None:
    """Let everything that waits for files wait in simulated time."""
    for name in ("SelectSelector", "PollSelector", "EpollSelector", "KqueueSelector", "DevpollSelector"):
        found = getattr(module, name, None)
        if found is not None:
            found.select = _simulated_select(session, found.select)


def _simulated_select(session: Session, look: Callable[[Any, float], Any]) -> Callable[..., Any]:
    """Return a `select` that looks at the real files without waiting, and waits on the simulated clock."""

    def select(self: Any, timeout: float | None = None) -> Any:
        ready = look(self, 0)
        if ready or (timeout is not None and timeout <= 0):
            if not ready:
                session.command()
            return ready
        until = None if timeout is None else session.now + round(timeout * NS_PER_S)
        while not ready and (until is None or session.now < until):
            rest = POLL_NS if until is None else until - session.now
            session.spend(min(rest, POLL_NS) if session.slow & THREADS else rest)
            ready = look(self, 0)
        return ready

    return select


def loop_hook(session: Session, turns: int, cost_ns: int) -> Callable[[], None]:
    """Return the function called at the top of each loop body.

    Args:
        session: The run.
        turns: So many turns in which no time passed …
        cost_ns: … cost this much.
    """
    left, mark = turns, -1

    def turn() -> None:
        nonlocal left, mark
        left -= 1
        if left:
            return
        left = turns
        if session.now == mark:
            session.spend(cost_ns)
        mark = session.now

    return turn
