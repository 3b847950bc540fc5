"""Going back in a long run: from the key to the frame that shows the instant."""

from __future__ import annotations

import time
from collections.abc import Iterator
from random import Random
from statistics import median

from tests.bench.figures import Figure
from tests.bench.references import paints_elapsed
from tests.bench.running import LOG
from tests.bench.sampling import Effort
from tests.bench.terminal import Terminal
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

RUN_S = 600.0
PANELS = ("-O", "-A", "-i", "-D", "-c")
JUMPS_A_REPEAT = 5
QUIET_S = 1.0
"""An app that has drawn nothing for so long has caught up with the run."""


def back(effort: Effort) -> Iterator[Figure]:
    """Yield the time that it takes to see an instant of a ten-minute run."""
    for words, noise in (("without noise", 0), ("with noise", 20)):
        spec = build_run_spec(
            Settings(
                {
                    "background": "Grey_bands",
                    "noise.light": noise,
                    "noise.motor": noise,
                    "pen.down": True,
                }
            )
        )
        run = start_run(Program("bench.py", LOG, "preloaded"), spec, RunOptions(time_limit_s=RUN_S))
        run.wait()
        with Terminal(["open", "--run", run.run_id, *PANELS]) as terminal:
            _wait_until_quiet(terminal)
            jumps = [
                _jump(terminal, f"{at_s:.2f}")
                for at_s in _instants(effort.repeats * JUMPS_A_REPEAT)
            ]
            steps = [press(terminal, b",") for _ in jumps]
        jump_s, step_s = (median(took_s for took_s, _ in taken) for taken in (jumps, steps))
        ratio = paints_elapsed(jump_s)
        yield Figure(
            f"any instant of 10 minutes, {words}", 1e3 * jump_s, "ms", most=0.3, ratio=ratio
        )
        yield Figure(
            f"the slowest of them, {words}", 1e3 * max(took_s for took_s, _ in jumps), "ms"
        )
        yield Figure(
            f"one tick back, {words}", 1e3 * step_s, "ms", most=0.14, ratio=paints_elapsed(step_s)
        )
        yield Figure(
            f"sent for one tick back, {words}", median(sent for _, sent in steps) / 1e3, "kB"
        )


def _instants(count: int) -> list[float]:
    chance = Random(7)
    return [chance.uniform(0.0, RUN_S - 1) for _ in range(count)]


def _wait_until_quiet(terminal: Terminal) -> None:
    """Wait until the run is shown, with all of its rows and its chart."""
    terminal.read_until(lambda: b"time limit" in terminal.seen)
    settle(terminal)


def settle(terminal: Terminal) -> None:
    """Wait until nothing has been drawn for a time."""
    shown = -1
    while shown != terminal.queries:
        shown = terminal.queries
        terminal.read_for(QUIET_S)


def _jump(terminal: Terminal, where: str) -> tuple[float, int]:
    """Go to an instant by the dialog; only what follows the last key counts."""
    for keys in (b"g", where.encode()):
        terminal.type(keys)
        settle(terminal)
    taken = press(terminal, b"\r")
    settle(terminal)
    return taken


def press(terminal: Terminal, key: bytes) -> tuple[float, int]:
    """Return the seconds and the bytes until the frame after a key is there."""
    frames, sent, start = terminal.queries, terminal.shown, time.monotonic()
    terminal.type(key)
    terminal.read_until(lambda: terminal.queries > frames)
    return time.monotonic() - start, terminal.shown - sent
