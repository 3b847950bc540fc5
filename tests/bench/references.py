"""What figures are compared with: something like the work, measured on the same machine beside it.

Machines differ by more than a factor of two, and so do the hours of one of them; ratios to such a reference do not.
None of it is tuisim's code, so that a change of tuisim changes the figures and not what they are compared with.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from statistics import median

from tests.bench.processes import command_cpu_s, cpu_s, plain_environment
from tests.bench.sampling import MeasuringError, measured
from tests.bench.terminal import Terminal

REPEATS = 5
TICKS = 100_000
FORKED = 30
MOST_SPEED = 50.0
"""Nothing that records its ticks is so many times faster than the frozen ticks."""
FROZEN_TICKS = Path(__file__).with_name("frozen_ticks.py")
MINIMAL_APP = """
from textual.app import App
from textual.widgets import Static
class Minimal(App):
    def compose(self):
        yield Static("minimal")
Minimal().run()
"""
FORKS = """
import json, os, asyncio, dataclasses, decimal, random, statistics, subprocess, tempfile, threading
while os.read(0, 1):
    pid = os.fork()
    if not pid:
        os.write(1, b"x")
        os._exit(0)
    os.waitpid(pid, 0)
"""
"""Answers each byte by a forked process, after imports of the size of a small program's."""


@dataclass(frozen=True, slots=True)
class Ratio:
    """A figure as a multiple of a reference."""

    value: float
    reference: str


def _tick() -> tuple[float, float]:
    """Return the CPU seconds and the seconds of one of the frozen ticks, in a process of its own."""
    command = [sys.executable, "-I", str(FROZEN_TICKS), str(TICKS)]
    told = subprocess.run(
        command, env=plain_environment(), stdout=subprocess.PIPE, check=True
    ).stdout
    used_s, took_s = map(float, told.split())
    return used_s / TICKS, took_s / TICKS


def tick_cpu_s() -> float:
    """Return the CPU seconds of one of the frozen ticks."""
    return _tick()[0]


def tick_wall_s() -> float:
    """Return the seconds that one of the frozen ticks takes."""
    return _tick()[1]


def start_cpu_s() -> float:
    """Return the CPU seconds of `python -c pass`."""
    return command_cpu_s("-c", "pass", environment=plain_environment())


def start_wall_s() -> float:
    """Return the seconds that `python -c pass` takes."""
    begun_s = time.perf_counter()
    start_cpu_s()
    return time.perf_counter() - begun_s


def _minimal_app() -> tuple[float, float]:
    """Return the CPU seconds and the seconds of a minimal Textual app until its text is on the screen."""
    begun_s = time.perf_counter()
    command = (sys.executable, "-c", MINIMAL_APP)
    with Terminal([], command=command, environment=plain_environment()) as terminal:
        terminal.read_until(lambda: b"minimal" in terminal.seen)
        return cpu_s(terminal.pid), time.perf_counter() - begun_s


def paint_cpu_s() -> float:
    """Return the CPU seconds of a minimal Textual app until its first paint."""
    return _minimal_app()[0]


def paint_wall_s() -> float:
    """Return the seconds until the first paint of a minimal Textual app."""
    return _minimal_app()[1]


def fork_s() -> float:
    """Return the seconds until a fork of an empty prepared process has answered."""
    command = [sys.executable, "-c", FORKS]
    with subprocess.Popen(
        command, env=plain_environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        taken = []
        for _ in range(FORKED):
            begun_s = time.perf_counter()
            os.write(process.stdin.fileno(), b"x")
            if not os.read(process.stdout.fileno(), 1):
                raise MeasuringError("the process that is to fork has ended")
            taken.append(time.perf_counter() - begun_s)
        process.stdin.close()
    # The first one includes the start of the process.
    return median(taken[1:])


@cache
def usual(reference: Callable[[], float]) -> float:
    """Return the median of a reference, measured once for the figures of a bench that cannot be taken in turns."""
    return measured(median(reference() for _ in range(REPEATS)), "reference")


def tick_speed(speed: float, cpu_s_a_tick: float, tick_hz: float = 100.0) -> Ratio:
    """Return simulated seconds per CPU second as a share of what the frozen ticks reach.

    Raises:
        MeasuringError: no program can be so fast.
    """
    share = speed * cpu_s_a_tick * tick_hz
    if share > MOST_SPEED:
        raise MeasuringError(
            f"{speed:,.0f} simulated seconds a CPU second are {share:,.0f} x frozen ticks"
        )
    return Ratio(share, "x frozen ticks")


def ticks(cpu_seconds: float, simulated_s: float) -> Ratio:
    """Return CPU time as a multiple of the frozen ticks' for a simulated time, at 100 ticks a second."""
    return Ratio(cpu_seconds / (usual(tick_cpu_s) * 100 * simulated_s), "x frozen ticks")


def ticks_elapsed(seconds: float, simulated_s: float) -> Ratio:
    """Return elapsed time as a multiple of the frozen ticks' for a simulated time, at 100 ticks a second."""
    return Ratio(seconds / (usual(tick_wall_s) * 100 * simulated_s), "x frozen ticks")


def starts(cpu_seconds: float) -> Ratio:
    """Return CPU time as a multiple of that of `python -c pass`."""
    return Ratio(cpu_seconds / usual(start_cpu_s), "x python -c pass")


def starts_elapsed(seconds: float) -> Ratio:
    """Return elapsed time as a multiple of that of `python -c pass`."""
    return Ratio(seconds / usual(start_wall_s), "x python -c pass")


def forks(seconds: float) -> Ratio:
    """Return elapsed time as a multiple of that of a fork of an empty prepared process."""
    return Ratio(seconds / usual(fork_s), "x empty fork")


def paints(cpu_seconds: float) -> Ratio:
    """Return CPU time as a multiple of a minimal Textual app's until its first paint."""
    return Ratio(cpu_seconds / usual(paint_cpu_s), "x minimal app")


def paints_elapsed(seconds: float) -> Ratio:
    """Return elapsed time as a multiple of a minimal Textual app's until its first paint."""
    return Ratio(seconds / usual(paint_wall_s), "x minimal app")
