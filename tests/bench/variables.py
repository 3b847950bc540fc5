"""Variables of a former instant: from asking for it to knowing them, by a re-run of a ten-minute run."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from random import Random
from statistics import median

from tests.bench.figures import Figure
from tests.bench.references import ticks_elapsed
from tests.bench.running import LOG
from tests.bench.sampling import Effort
from tuisim.base.source import Program
from tuisim.engine.protocol import Inspect, Inspected, Paused
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.replay_debugger import Position, ReplayDebugger
from tuisim.engine.runs.store import load_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

RUN_S = 600.0
PLACES_A_REPEAT = 5
LOOK_EVERY_S = 0.002


class Asking:
    """Asks for instants of one run and takes the time.

    Args:
        noise: Light and motor noise of the run.
    """

    def __init__(self, noise: int) -> None:
        spec = build_run_spec(
            Settings({"background": "Grey_bands", "noise.light": noise, "noise.motor": noise})
        )
        run = start_run(Program("bench.py", LOG, "preloaded"), spec, RunOptions(time_limit_s=RUN_S))
        run.wait()
        self.recording = Recording(load_run(run.run_id))
        self.replay_debugger = ReplayDebugger(self._arrived, self._failed, self._passed)
        self._there = False

    def _arrived(self, paused: Paused, looked: Inspected) -> None:
        self._there = True

    def _failed(self, why: str) -> None:
        raise RuntimeError(why)

    def _passed(self) -> None:
        raise RuntimeError("nothing goes on here")

    def places(self, count: int) -> list[Position]:
        """Return instants from all over the run."""
        chance = Random(7)
        return [Position(chance.randrange(self.recording.newest)) for _ in range(count)]

    def took_s(self, ask: Callable[[], None]) -> float:
        """Ask and wait for the answer."""
        self._there, start = False, time.monotonic()
        ask()
        while not self._there:
            self.replay_debugger.poll()
            time.sleep(LOOK_EVERY_S)
        return time.monotonic() - start

    def look_s(self, at: Position) -> float:
        """Return how long it takes to know the variables of an instant."""
        return self.took_s(lambda: self.replay_debugger.go(self.recording, at, Inspect()))

    def back_s(self, at: Position) -> float:
        """Return how long it takes to go a line back from an instant."""
        return self.took_s(
            lambda: self.replay_debugger.lines_back(self.recording, at, 1, Inspect())
        )


def variables(effort: Effort) -> Iterator[Figure]:
    """Yield the time that it takes to know the variables of an instant of a ten-minute run."""
    for words, noise, most in (("without noise", 0, 9), ("with noise", 20, 28)):
        asking = Asking(noise)
        places = asking.places(effort.repeats * PLACES_A_REPEAT)
        known = [asking.look_s(at) for at in places]
        back = [asking.back_s(at) for at in places]
        asking.replay_debugger.close()
        ratio = ticks_elapsed(median(known), RUN_S)
        yield Figure(
            f"variables of any instant of 10 minutes, {words}",
            1e3 * median(known),
            "ms",
            most=most,
            ratio=ratio,
        )
        yield Figure(f"the slowest of them, {words}", 1e3 * max(known), "ms")
        yield Figure(f"one line back, with variables, {words}", 1e3 * median(back), "ms")
