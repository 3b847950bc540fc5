"""How long after a stop a run is over."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

from tests.bench.figures import Figure
from tests.bench.references import starts_elapsed
from tests.bench.running import begin
from tests.bench.sampling import Effort
from tuisim.engine.protocol import Started
from tuisim.engine.runs.handle import RunOptions

SPIN = "while True:\n    pass\n"
SLEEP = "import time\nwhile True:\n    time.sleep(0.1)\n"
STUCK = "sum(range(10 ** 12))\n"

LIVE = RunOptions(live=True, time_limit_s=0.0, stall_limit_s=0.0)
HEADLESS = RunOptions(time_limit_s=0.0, stall_limit_s=0.0)
PATIENCE_S = 5.0


def stop_latency(effort: Effort) -> Iterator[Figure]:
    """Yield the latency from the stop to the run's last event, at the 90th percentile."""
    for name, options, most in (("live", LIVE, 1.5), ("headless", HEADLESS, 1.9)):
        taken = [
            _latency_s(text, options, at) for text in (SPIN, SLEEP) for at in range(effort.stops)
        ]
        took_s = _p90(taken)
        yield Figure(
            f"stop, Python code, {name}, p90",
            took_s * 1e3,
            "ms",
            most=most,
            ratio=starts_elapsed(took_s),
        )
    # Each half of them live, half headless: it makes no difference to code that hears nothing.
    stuck = [
        _latency_s(STUCK, options, at) for options in (LIVE, HEADLESS) for at in range(effort.stops)
    ]
    # A timer ends it after 400 ms: no figure of the machine.
    yield Figure("stop, stuck in C, p90", _p90(stuck) * 1e3, "ms", most=450)


def _latency_s(text: str, options: RunOptions, number: int) -> float:
    """Start a program, stop it at another moment of its loop for each number, and time its end."""
    handle = begin(text, options=options)
    try:
        while not any(isinstance(event, Started) for event in handle.pump()):
            handle.wait_for_event(PATIENCE_S)
        time.sleep(0.1 + 0.0037 * number)
        begun = time.monotonic()
        handle.stop()
        ended = handle.wait(PATIENCE_S)
        took_s = time.monotonic() - begun
        assert ended is not None and ended.end == "stopped", ended
        return took_s
    finally:
        handle.close()


def _p90(values: Sequence[float]) -> float:
    ordered = sorted(values)
    return ordered[-(-9 * len(ordered) // 10) - 1]
