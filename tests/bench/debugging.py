"""What the debugger costs: tracing, a break in a busy loop, a step."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from statistics import median

from tests.bench.figures import Figure
from tests.bench.references import starts_elapsed
from tests.bench.running import LINE, begin
from tests.bench.sampling import Effort
from tests.bench.speed import speed
from tuisim.engine.protocol import Inspect, Inspected, Message, Pause, Paused, Resume, StepLine
from tuisim.engine.runs.handle import RunHandle, RunOptions

PATIENCE_S = 5.0
NEVER = 999
"""A line that no program has."""
BUSY = "n = 0\nwhile True:\n    n += 1\n"
BUSY_BREAKS: Mapping[str, str] = {
    "plain condition": "3 if n < 0",
    "condition with a call": "3 if len(str(n)) > 99",
}
PAUSE_GOALS: Mapping[str, float] = {"plain condition": 0.08, "condition with a call": 0.36}


def debugging(effort: Effort) -> Iterator[Figure]:
    """Yield the speed with tracing on, and how soon commands are heard."""
    yield speed(
        "line follower, tracing on",
        LINE,
        "Two_shapes",
        "robolab",
        350.0,
        (str(NEVER),),
        effort=effort,
        goal=0.035,
    )
    for name, text in BUSY_BREAKS.items():
        taken_s = median(_pause_s(text) for _ in range(effort.stops))
        yield Figure(
            f"pause, busy loop, {name}",
            taken_s * 1e3,
            "ms",
            most=PAUSE_GOALS[name],
            ratio=starts_elapsed(taken_s),
        )
    steps, looks = _steps_s(10 * effort.stops)
    yield Figure(
        "step to the next line",
        median(steps) * 1e3,
        "ms",
        most=0.024,
        ratio=starts_elapsed(median(steps)),
    )
    yield Figure(
        "look at the variables",
        median(looks) * 1e3,
        "ms",
        most=0.42,
        ratio=starts_elapsed(median(looks)),
    )


def _pause_s(text: str) -> float:
    """Return how long a pause takes in a loop in which a break is looked at in every turn."""
    handle = begin(BUSY, options=RunOptions(live=True, breaks=(text,)))
    try:
        while not handle.started:
            handle.wait_for_event(PATIENCE_S)
            handle.pump()
        time.sleep(0.2)
        return _answer_s(handle, Pause(), Paused)
    finally:
        handle.close()


def _steps_s(count: int) -> tuple[list[float], list[float]]:
    handle = begin(BUSY, options=RunOptions(live=True, hold_at=(0, 1)))
    try:
        while not handle.paused:
            handle.wait_for_event(PATIENCE_S)
            handle.pump()
        steps = [_answer_s(handle, StepLine(), Paused) for _ in range(count)]
        looks = [_answer_s(handle, Inspect(), Inspected) for _ in range(count)]
        handle.send(Resume())
        return steps, looks
    finally:
        handle.close()


def _answer_s(handle: RunHandle, command: Message, answer: type[Message]) -> float:
    """Send a command and return how long its answer takes."""
    begun = time.monotonic()
    handle.send(command)
    while not any(isinstance(event, answer) for event in handle.pump()):
        handle.wait_for_event(PATIENCE_S)
        assert time.monotonic() - begun < PATIENCE_S
    return time.monotonic() - begun
