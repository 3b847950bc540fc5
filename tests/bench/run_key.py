"""How soon after the key `R` the app shows the robot where it was not before."""

from __future__ import annotations

import re
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median, quantiles

from tests.bench.figures import Figure
from tests.bench.references import paints_elapsed
from tests.bench.sampling import Effort
from tests.bench.screen import Screen
from tests.bench.terminal import Terminal

MOVES = """\
# %%sim_magic_preloaded -b Grey_bands
import time
tank_drive.on(50, 50)
time.sleep(0.3)
"""
"""Moves the robot in its first tick, and has ended when `R` is pressed again."""
PRESSES = 10
"""With each app, after the first one."""
_CLOCK = re.compile(r"Clock\s+(\d+\.\d+) s")
"""In the instrumentation panel. After the first tick the robot has moved, at first by hundredths of a millimetre."""
_READY_S = 1.0
"""From the first paint of the world to the first key."""
_REST_S, _FURTHER_S = 1.5, 0.0137
"""From a key to the next one, and how much longer that is each time: keys come at any point between two frames."""


def run_key(effort: Effort) -> Iterator[Figure]:
    """Yield the time from the key to the first frame that shows the robot under way."""
    firsts = []
    later = []
    for number in range(effort.repeats):
        first, *rest = latencies_s(number * PRESSES)
        firsts.append(first)
        later += rest
    yield Figure("R to the first frame that moved, first run", median(firsts) * 1e3, "ms")
    yield Figure(
        "R to the first frame that moved, later runs",
        median(later) * 1e3,
        "ms",
        most=0.3,
        ratio=paints_elapsed(median(later)),
    )
    yield Figure("p90 of that", quantiles(later, n=10)[-1] * 1e3, "ms")


def latencies_s(phase: int = 0) -> list[float]:
    """Start the app, press `R` again and again, and return the time that each took.

    Args:
        phase: How much longer the first rest is, in steps.
    """
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "moves.py")
        program.write_text(MOVES, "utf-8")
        with Terminal([str(program), "-i"]) as terminal:
            screen = Screen(terminal)
            terminal.read_until(lambda: screen.has(_CLOCK.pattern))
            terminal.read_for(_READY_S)
            return [_latency_s(terminal, screen, phase + number) for number in range(PRESSES + 1)]


def _latency_s(terminal: Terminal, screen: Screen, number: int) -> float:
    """Press the key, wait until the run is over, and return when the screen first showed an instant after a tick."""
    before_s = _clock_s(screen.text())
    arrived = len(terminal.arrivals)
    begun_s = time.monotonic()
    terminal.type(b"R")
    # What arrives is examined later: that takes longer than a frame.
    terminal.read_for(_REST_S + _FURTHER_S * number)
    shown = [(at_s, _clock_s(screen.text(length))) for at_s, length in terminal.arrivals[arrived:]]
    moved = [at_s for at_s, clock_s in shown if clock_s not in (0.0, before_s)]
    assert moved, f"the robot did not move: {shown}"
    return moved[0] - begun_s


def _clock_s(text: str) -> float:
    found = _CLOCK.search(text)
    assert found is not None, text
    return float(found[1])
