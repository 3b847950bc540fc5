"""`pybricks.tools`: waiting, a stopwatch and a log."""

from __future__ import annotations

import re
import time as clock
from collections.abc import Iterable
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.pybricks.brick import Connected, Waiting, whole
from tuisim.engine.shim.waits import Wait, waits_for


@waits_for(Wait.SLEEP)
def wait(time: float) -> None:
    """Wait for a time in milliseconds."""
    brick = Connected.brick
    time_ms = whole(time)
    if brick.in_task:
        return brick.finish(wait_until(brick.now_us + time_ms * 1000))
    if time_ms > 0:
        brick.session.spend(time_ms * MS)
    else:
        brick.session.command()
    return None


def wait_until(end_us: int) -> Waiting[None]:
    """Yield the time `end_us`, in microseconds, again and again until the simulation has reached it.

    After each yield the caller waits until this time. It may go on too early, because a motor has ended a move.
    """
    if Connected.brick.command() == end_us:
        yield end_us
    while Connected.brick.now_us < end_us:
        yield end_us


def localtime(seconds: float | None = None) -> clock.struct_time:
    """Return the local date and time at `seconds` after the beginning of 1970, by default at the simulated present."""
    return clock.localtime(seconds)


def ticks_us() -> int:
    """Return the simulated time in microseconds, which starts again from 0 after each period of the counter."""
    ticks: int = vars(clock)["ticks_us"]()
    return ticks


class StopWatch(Connected):
    """A stopwatch, which starts when it is created."""

    _counted_ns = 0
    _runs = True

    def __init__(self) -> None:
        self._began_ns = self.brick.session.now

    def _passed_ns(self) -> int:
        return self._counted_ns + (self.brick.session.now - self._began_ns if self._runs else 0)

    def time(self) -> int:
        """Return the measured time in milliseconds."""
        self.brick.session.charge(self.brick.session.sim.spec.profile.clock_read_ns)
        return self._passed_ns() // MS

    def pause(self) -> None:
        """Stop the stopwatch; it keeps its time."""
        self._counted_ns = self._passed_ns()
        self._runs = False

    def resume(self) -> None:
        """Make a paused stopwatch run on from its time."""
        self._counted_ns = self._passed_ns()
        self._began_ns = self.brick.session.now
        self._runs = True

    def reset(self) -> None:
        """Set the time to 0; a running stopwatch runs on."""
        self._counted_ns, self._began_ns = 0, self.brick.session.now


class DataLog(Connected):
    """A file into which a program writes rows of values, separated by commas."""

    def __init__(
        self,
        *headers: Any,
        name: str = "log",
        timestamp: bool = True,
        extension: str = "csv",
        append: bool = False,
    ) -> None:
        now_us = self.brick.now_us
        stamp = (
            f"{clock.strftime('_%Y_%m_%d_%H_%M_%S')}_{now_us % 1_000_000:06}" if timestamp else ""
        )
        self.file = open(f"{name}{stamp}.{extension}", "a+" if append else "w+")  # noqa: SIM115 - the program's
        self.file.seek(0, 2)
        self._names = [re.sub(r"\W+", "_", str(header)).strip("_") for header in headers]
        if headers and not self.file.tell():
            self._write(headers)

    def log(self, *values: Any) -> None:
        """Write one row to the file.

        Its numbers are also samples of the run, except those in columns whose names begin with `time`.
        """
        self._write(values)
        for at, value in enumerate(values):
            name = self._names[at] if at < len(self._names) else f"value{at + 1}"
            if (
                isinstance(value, int | float)
                and name.isidentifier()
                and not name.lower().startswith("time")
            ):
                self.brick.session.show(f"{name}: {value}", Stream.DATA)

    def _write(self, values: Iterable[Any]) -> None:
        print(*values, sep=", ", file=self.file)
        self.file.flush()

    def __repr__(self) -> str:
        self.file.seek(0)
        text = self.file.read()
        self.file.seek(0, 2)
        return text
