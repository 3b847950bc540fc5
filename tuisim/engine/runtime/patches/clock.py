"""Simulated time for the program's own modules: time, datetime, process times, pandas."""

from __future__ import annotations

import builtins
import copyreg
import operator
import os
import time
import types
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import BusyLoop
from tuisim.engine.runtime import wallclock as real
from tuisim.engine.runtime.modules import OWN_FILES
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.session import Session
from tuisim.engine.shim.waits import Wait, waits_for

EPOCH_S = 1_577_836_800
"""Every run starts on 1 January 2020, 00:00 UTC."""

MAX_SLEEP_S = 9_000_000_000
"""Longest sleep, because the real functions store nanoseconds in 63 bits."""


def _build_wall_clock(session: Session) -> Callable[[], float]:
    """Return a function that reads the simulated time of day, in seconds since 1970, which costs some time."""
    cost = session.sim.spec.profile.clock_read_ns

    def wall() -> float:
        session.charge(cost)
        return EPOCH_S + session.now / NS_PER_S

    return wall


def patch_time(session: Session) -> None:
    """Replace the functions of `time` by simulated ones; modules that have imported them before keep the real ones."""
    profile = session.sim.spec.profile
    cost = profile.clock_read_ns
    wall = _build_wall_clock(session)
    real_sleep = time.sleep

    def clock_ns() -> int:
        session.charge(cost)
        return session.now

    def clock() -> float:
        session.charge(cost)
        return session.now / NS_PER_S

    def wall_ns() -> int:
        session.charge(cost)
        return EPOCH_S * NS_PER_S + session.now

    @waits_for(Wait.SLEEP)
    def sleep(seconds: Any) -> None:
        length = seconds if isinstance(seconds, float) else operator.index(seconds)
        if not 0 <= length < MAX_SLEEP_S:
            # The real function raises the proper error for such a length.
            real_sleep(seconds)
        session.spend(round(length * NS_PER_S))

    replace(time, "sleep", sleep, (1, 1))
    replace(time, "time", wall, (0, 0))
    replace(time, "time_ns", wall_ns, (0, 0))
    for name in ("monotonic", "perf_counter", "process_time", "thread_time"):
        replace(time, name, clock, (0, 0))
        replace(time, f"{name}_ns", clock_ns, (0, 0))
    # The real functions are called, too, because they check whether the clock exists.
    gettime = time.clock_gettime
    gettime_ns = time.clock_gettime_ns
    replace(time, "clock_gettime", lambda clock: (gettime(clock), wall())[1], (1, 1))
    replace(time, "clock_gettime_ns", lambda clock: (gettime_ns(clock), wall_ns())[1], (1, 1))
    _patch_calendar(wall)


def _patch_calendar(wall: Callable[[], float]) -> None:
    localtime, asctime, strftime = time.localtime, time.asctime, time.strftime

    def at_present(real: Callable[[float], Any]) -> Callable[..., Any]:
        return lambda seconds=None: real(wall() if seconds is None else seconds)

    for name in ("localtime", "gmtime", "ctime"):
        replace(time, name, at_present(getattr(time, name)), (0, 1))
    replace(time, "asctime", lambda *when: asctime(*when or (localtime(wall()),)), (0, 1))
    replace(
        time, "strftime", lambda form, *when: strftime(form, *when or (localtime(wall()),)), (1, 2)
    )


def patch_datetime(session: Session, folder: Callable[[], str]) -> None:
    """Give the program, its own modules and the library a `datetime` with simulated time.

    All other modules keep the real one: compiled code, such as that of pandas, relies on the real classes, and crashes
    with others.

    Args:
        session: The program's clock.
        folder: Returns the folder of the program's own modules.
    """
    real_import = builtins.__import__
    shadow: list[types.ModuleType] = []

    def needs_simulated(importer: Mapping[str, Any]) -> bool:
        name = str(importer.get("__name__", ""))
        if name == "__main__" or name.partition(".")[0] == "ev3dev2":
            return True
        file = str(importer.get("__file__") or "/")
        return file in OWN_FILES or os.path.dirname(real.absolute(file)) == folder()

    def import_module(
        name: str,
        globals: Any = None,  # noqa: A002 - the names of the real function
        locals: Any = None,  # noqa: A002
        fromlist: Any = (),
        level: int = 0,
    ) -> Any:
        module = real_import(name, globals, locals, fromlist, level)
        if name != "datetime" or level or globals is None or not needs_simulated(globals):
            return module
        if not shadow:
            shadow.append(_build_simulated_datetime(session, module))
        return shadow[0]

    replace(builtins, "__import__", import_module)


def _build_simulated_datetime(session: Session, module: types.ModuleType) -> types.ModuleType:
    """Return a copy of `datetime` whose `now`, `utcnow` and `today` return simulated time."""
    real_datetime, real_date = module.datetime, module.date
    seconds = _build_wall_clock(session)

    class LikeTheReal(type):
        def __instancecheck__(cls, instance: object) -> bool:
            return (
                isinstance(instance, real_of[cls])
                if cls in real_of
                else super().__instancecheck__(instance)
            )

        def __subclasscheck__(cls, subclass: type) -> bool:
            return (
                issubclass(subclass, real_of[cls])
                if cls in real_of
                else super().__subclasscheck__(subclass)
            )

    class date(real_date, metaclass=LikeTheReal):  # type: ignore[misc,valid-type]  # noqa: N801
        @classmethod
        def today(cls) -> Any:
            """Current date or datetime:  same as self.__class__.fromtimestamp(time.time())."""
            return cls.fromtimestamp(seconds())

    class datetime(real_datetime, metaclass=LikeTheReal):  # type: ignore[misc,valid-type]  # noqa: N801
        @classmethod
        def now(cls, tz: Any = None) -> Any:
            """Returns new datetime object representing current time local to tz."""
            return cls.fromtimestamp(seconds(), tz)

        @classmethod
        def utcnow(cls) -> Any:
            """Return a new datetime representing UTC day and time."""
            return cls.utcfromtimestamp(seconds())

        @classmethod
        def today(cls) -> Any:
            """Current date or datetime:  same as self.__class__.fromtimestamp(time.time())."""
            return cls.fromtimestamp(seconds())

    shadow = types.ModuleType("datetime", module.__doc__)
    vars(shadow).update(vars(module))
    real_of: dict[type, type] = {datetime: real_datetime, date: real_date}
    for replacement, replaced in real_of.items():
        _copy_looks(replacement, replaced)
        setattr(shadow, replaced.__name__, replacement)

    def reduce_class(one: Any) -> Any:
        # The class is pickled as the real one, so that the data can be loaded without tuisim.
        return (type, (one.min,)) if one in real_of else one.__qualname__

    copyreg.pickle(LikeTheReal, reduce_class)
    return shadow


def _copy_looks(replacement: Any, real: Any) -> None:
    """Give a replaced class and its objects the `repr` and the pickled form that the real class has."""
    replacement.__module__ = "datetime"
    replacement.__qualname__ = real.__name__
    replacement.__doc__ = real.__doc__
    for name, part in vars(replacement).items():
        if isinstance(part, classmethod):
            part.__func__.__qualname__ = f"{real.__name__}.{name}"

    def show(self: Any) -> str:
        text = real.__repr__(self)
        # The `repr` of the real class begins with its module, that of derived classes does not.
        return f"datetime.{text}" if type(self) is replacement else str(text)

    def reduce(self: Any, protocol: Any) -> Any:
        made, *rest = real.__reduce_ex__(self, protocol)
        return (real if made is replacement else made, *rest)

    replacement.__repr__ = show
    replacement.__reduce_ex__ = reduce


def patch_process_times(session: Session) -> None:
    """Patch `os.times`, so that the process time is the simulated time since the start."""
    real_times = os.times

    def times() -> Any:
        used_s = session.now / NS_PER_S
        return type(real_times())((used_s, 0.0, 0.0, 0.0, EPOCH_S + used_s))

    replace(os, "times", times, (0, 0))


def finish_resource(session: Session, module: types.ModuleType) -> None:
    """Patch `resource` after its import, so that it reports the same process times as `os.times`."""
    real_usage = module.getrusage

    def getrusage(who: Any) -> Any:
        usage = real_usage(who)
        used_s = session.now / NS_PER_S if who == module.RUSAGE_SELF else 0.0
        return type(usage)((used_s, 0.0, *usage[2:]))

    replace(module, "getrusage", getrusage, (1, 1))


def finish_pandas(session: Session, module: types.ModuleType) -> None:
    """Patch pandas after its import, so that its present time is simulated: its compiled code does not call `time`."""
    stamp = module.Timestamp
    period = module.Period
    seconds = _build_wall_clock(session)

    def now(cls: Any, tz: Any = None) -> Any:
        return cls.fromtimestamp(seconds(), tz)

    def utcnow(cls: Any) -> Any:
        return cls.fromtimestamp(seconds(), "UTC")

    def period_now(cls: Any, freq: Any) -> Any:
        return cls(now(stamp), freq=freq)

    for owner, name, does in (
        (stamp, "now", now),
        (stamp, "today", now),
        (stamp, "utcnow", utcnow),
        (period, "now", period_now),
    ):
        does.__doc__ = getattr(owner, name).__doc__
        setattr(owner, name, classmethod(does))
    make = stamp.__new__

    @wraps(make)
    def new(cls: Any, *given: Any, **named: Any) -> Any:
        if given and isinstance(given[0], str) and given[0] in ("now", "today"):
            return cls.now(named.get("tz"))
        return make(cls, *given, **named)

    stamp.__new__ = new


LONG_NS = 5 * NS_PER_S
"""Simulated time after which a message tells the user of a loop without a wait."""


def loop_hook(session: Session, turns: int, cost_ns: int) -> Callable[[], None]:
    """Return the function that the program calls at the start of each loop body.

    It keeps a loop that takes no simulated time from running forever, and passes on output that C code has written.

    Args:
        session: The run.
        turns: After this number of calls without simulated time, some time passes.
        cost_ns: How much time passes then.
    """
    left = turns
    mark = -1
    began = -1
    told = False

    @waits_for(Wait.LOOP)
    def turn() -> None:
        nonlocal left, mark, began, told
        left -= 1
        if left:
            return
        left = turns
        session.output.drain()
        if session.now == mark:
            session.spend(cost_ns)
            if not told and session.now - began >= LONG_NS:
                told = True
                if session.steering.live:
                    session.channel.send(BusyLoop(session.sim.line, began))
        else:
            began = session.now
        mark = session.now

    return turn
