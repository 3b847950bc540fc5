"""Stepping through awkward programs, looking at each hold, and stopping there."""

from __future__ import annotations

import pytest

from tests.running import PATIENCE_S, Start
from tests.runtime.awkward import ENDLESS, ENDS, PROGRAMS, QUICK
from tests.runtime.debugging import Driver
from tuisim.protocol import Ended, LineStep, Paused, StepLine

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


def walk(start: Start, name: str, how: LineStep) -> None:
    """Step through one program."""
    text = PROGRAMS[name]
    driver = begin(start, text)
    ended = step_through(driver, text, how)
    if ended is None:
        stops_at_once(driver)
        return
    assert ended.end == ENDS.get(name, "time_limit" if name in ENDLESS else "finished"), ended


@pytest.mark.quick_cases("generators", "repr that raises")
@pytest.mark.parametrize("name", QUICK)
def test_awkward_programs_are_stepped_into(start: Start, name: str) -> None:
    walk(start, name, LineStep.INTO)


@pytest.mark.slow
@pytest.mark.parametrize("how", LineStep)
@pytest.mark.parametrize("name", PROGRAMS)
def test_every_awkward_program_is_stepped_through(start: Start, name: str, how: LineStep) -> None:
    walk(start, name, how)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_stop_works_at_every_step(start: Start, name: str) -> None:
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


LOOKS: dict[str, tuple[str, str | tuple[str, ...]]] = {
    "repr that raises": ("r", "<repr raised ValueError: no repr>"),
    # The second where the machine is busy, and the whole look takes too long.
    "repr that loops": ("r", ("<repr takes too long>", "<R, not shown: values take too long>")),
    "repr that recurses": ("r", "<repr calls itself without end>"),
    "repr of no text": ("r", "<repr raised TypeError: __repr__ returned non-string (type int)>"),
    "repr of 20 MB": ("r", "x" * 300),
    "repr with effects": ("r", "<repr raised RuntimeError: the program is paused"),
    "long list": ("data", "[0, 1, 2, 3"),
    "huge numbers and texts": ("n", "<whole number of 561471 bits>"),
}


@pytest.mark.slow_cases("repr that loops", "repr of 20 MB")
@pytest.mark.parametrize(("name", "shown"), LOOKS.items(), ids=LOOKS)
def test_hostile_values_are_cut_safely(start: Start, name: str, shown: tuple[str, str | tuple[str, ...]]) -> None:
    text = PROGRAMS[name]
    driver = Driver(start(text, live=True, speed=0.0, breaks=(str(text.count("\n")),)))
    driver.paused()
    variable, value = shown
    assert driver.values()[variable].startswith(value)
    ended = driver.finish(StepLine(LineStep.OUT))
    assert ended.end == "finished"
    # What was done for a look is undone.
    assert driver.run.output.all_rows()[-1].text in ("on", "0", "49995000", "10000000")


@pytest.mark.quick_cases("repr that ends the program")
@pytest.mark.parametrize("name", ["repr that cannot be stopped", "repr stuck in C", "repr that ends the program"])
def test_values_that_never_come_do_not_hold_up_the_rest(start: Start, name: str) -> None:
    text = PROGRAMS[name]
    driver = Driver(start(text, live=True, speed=0.0, breaks=(str(text.count("\n")),)))
    driver.paused()
    looked = driver.look("1 + 1")
    assert looked.stack
    assert looked.note.endswith("take too long")
    assert ("r", "<R, not shown: values take too long>") in [(v.name, v.value) for v in looked.variables]
    assert driver.finish(StepLine(LineStep.OUT)).end == "finished"
