"""What figures are compared with: something well known, measured on the same machine in the same run.

Machines differ by more than a factor of two, and so do the hours of one of them; ratios to such a reference do not.
"""

from __future__ import annotations

import math
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from statistics import median

from tests.bench.processes import app_environment, children_cpu_s, cpu_s
from tests.bench.terminal import Terminal

REPEATS = 5
TICKS = 100_000
MINIMAL_APP = """
from textual.app import App
from textual.widgets import Static
class Minimal(App):
    def compose(self):
        yield Static("minimal")
Minimal().run()
"""


@dataclass(frozen=True, slots=True)
class Cost:
    """What a reference costs."""

    cpu_s: float
    wall_s: float


@dataclass(frozen=True, slots=True)
class Ratio:
    """A figure as a multiple of a reference."""

    value: float
    reference: str


def bare_ticks(count: int) -> tuple[float, float, float]:
    """Do the arithmetic of ticks in which both motors run: positions, heading and place, in a bare loop."""
    x_mm = y_mm = heading = left_deg = right_deg = 0.0
    left_dps, right_dps, seconds, mm_per_deg, spacing_mm = 200.0, 210.0, 0.01, 0.4887, 180.0
    for _ in range(count):
        left_step, right_step = left_dps * seconds, right_dps * seconds
        left_deg, right_deg = left_deg + left_step, right_deg + right_step
        way_mm = (left_step + right_step) / 2 * mm_per_deg
        turn = (right_step - left_step) * mm_per_deg / spacing_mm
        middle = heading + turn / 2
        x_mm, y_mm = x_mm + way_mm * math.cos(middle), y_mm + way_mm * math.sin(middle)
        heading += turn
    return x_mm, y_mm, heading


def _median(measure: Callable[[], Cost]) -> Cost:
    costs = [measure() for _ in range(REPEATS)]
    return Cost(median(cost.cpu_s for cost in costs), median(cost.wall_s for cost in costs))


@cache
def one_tick() -> Cost:
    """Return what one tick costs in a bare Python loop."""

    def measure() -> Cost:
        cpu, wall = time.process_time(), time.perf_counter()
        bare_ticks(TICKS)
        return Cost((time.process_time() - cpu) / TICKS, (time.perf_counter() - wall) / TICKS)

    return _median(measure)


@cache
def bare_start() -> Cost:
    """Return what `python -c pass` costs."""

    def measure() -> Cost:
        cpu, wall = children_cpu_s(), time.perf_counter()
        subprocess.run([sys.executable, "-c", "pass"], env=app_environment(), stdin=subprocess.DEVNULL, check=True)
        return Cost(children_cpu_s() - cpu, time.perf_counter() - wall)

    return _median(measure)


@cache
def bare_paint() -> Cost:
    """Return what a minimal Textual app costs until its text is on the screen."""

    def measure() -> Cost:
        wall = time.perf_counter()
        with Terminal([], command=(sys.executable, "-c", MINIMAL_APP)) as terminal:
            terminal.read_until(lambda: b"minimal" in terminal.seen)
            return Cost(cpu_s(terminal.pid), time.perf_counter() - wall)

    return _median(measure)


def forget() -> None:
    """Measure each reference again when it is next needed."""
    for reference in (one_tick, bare_start, bare_paint):
        reference.cache_clear()


def loop_speed(speed: float, tick_hz: float = 100.0) -> Ratio:
    """Return simulated seconds per CPU second as a share of what the bare loop reaches."""
    return Ratio(speed * one_tick().cpu_s * tick_hz, "x bare loop")


def loop_time(seconds: float, simulated_s: float) -> Ratio:
    """Return a duration as a multiple of the bare loop's for a simulated time, at 100 ticks a second."""
    return Ratio(seconds / (one_tick().wall_s * 100 * simulated_s), "x bare loop")


def starts(cpu_seconds: float) -> Ratio:
    """Return CPU time as a multiple of that of `python -c pass`."""
    return Ratio(cpu_seconds / bare_start().cpu_s, "x python -c pass")


def starts_elapsed(seconds: float) -> Ratio:
    """Return elapsed time as a multiple of that of `python -c pass`."""
    return Ratio(seconds / bare_start().wall_s, "x python -c pass")


def paints(cpu_seconds: float) -> Ratio:
    """Return CPU time as a multiple of a minimal Textual app's until its first paint."""
    return Ratio(cpu_seconds / bare_paint().cpu_s, "x minimal app")


def paints_elapsed(seconds: float) -> Ratio:
    """Return elapsed time as a multiple of a minimal Textual app's until its first paint."""
    return Ratio(seconds / bare_paint().wall_s, "x minimal app")
