"""Awkward programs are stepped through, and stopped at each hold."""

from __future__ import annotations

import pytest

from tests.engine.runtime.awkward import ENDLESS, ENDS, PROGRAMS
from tests.engine.runtime.debugging import Driver
from tests.running import PATIENCE_S, Start
from tuisim.engine.protocol import Ended, LineStep, Paused, StepLine

MOST_STEPS = 25


WATCHES = ("len(str(x))", "y", "r", "[v for v in range(3)]")


def begin(start: Start, text: str) -> Driver:
    """Start a program held at its first line, or at its end if there is none."""
    return Driver(start(text, live=True, speed=0.0, hold_at=(0, 1)))


def check(driver: Driver, held: Paused, text: str) -> None:
    """See that a program that stands still shows its own lines only."""
    lines = text.count("\n") + 1
    assert held.file == ""
    assert 0 <= held.line <= lines
    looked = driver.look(*WATCHES)
    assert [watch.text for watch in looked.watches] == list(WATCHES)
    assert looked.stack or held.reason == "end"
    assert all(0 < frame.line <= lines and not frame.file for frame in looked.stack)
    assert all(len(variable.value) <= 400 for variable in (*looked.variables, *looked.globals))


def step_through(driver: Driver, text: str, how: LineStep) -> Ended | None:
    """Step to the end, at most so many steps; return how it ended."""
    event = driver.wait_for(Paused, Ended)
    for _ in range(MOST_STEPS):
        if isinstance(event, Ended):
            return event
        assert isinstance(event, Paused)
        check(driver, event, text)
        event = driver.do_or_end(StepLine(how))
    return event if isinstance(event, Ended) else None


def stops_at_once(driver: Driver) -> None:
    """Stop a run and see that it ends."""
    driver.run.stop()
    assert driver.run.wait(PATIENCE_S) is not None


@pytest.mark.quick_cases("generators-into", "repr that raises-into")
@pytest.mark.parametrize("how", LineStep)
@pytest.mark.parametrize("name", PROGRAMS)
def test_the_debugger_steps_through_every_awkward_program(
    start: Start, name: str, how: LineStep
) -> None:
    text = PROGRAMS[name]
    driver = begin(start, text)
    ended = step_through(driver, text, how)
    if ended is None:
        stops_at_once(driver)
        return
    assert ended.end == ENDS.get(name, "time_limit" if name in ENDLESS else "finished"), ended


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_stepped_program_can_be_stopped_at_every_step(start: Start, name: str) -> None:
    for steps in (0, 1, 3, 6):
        driver = begin(start, PROGRAMS[name])
        event = driver.wait_for(Paused, Ended)
        for _ in range(steps):
            if isinstance(event, Ended):
                return
            event = driver.do_or_end(StepLine(LineStep.INTO))
        if isinstance(event, Ended):
            return
        stops_at_once(driver)
