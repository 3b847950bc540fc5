"""Variables of past instants, found by a run anew in a process of its own."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise

import pytest

from tests.running import PATIENCE_S
from tuisim.base.source import Program
from tuisim.engine.protocol import (
    AFTER_TICK,
    BEFORE_NEXT_TICK,
    Inspect,
    Inspected,
    LineStep,
    Paused,
    PauseReason,
    Resume,
    StepLine,
)
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.replay_debugger import Position, ReplayDebugger
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

TEXT = """\
import time
for n in range(30):
    m = n * n
    time.sleep(0.1)
print('over')
"""


def test_positions_in_one_tick_are_ordered_by_their_lines() -> None:
    places = [
        Position(4),
        Position(5, AFTER_TICK),
        Position(5, 1),
        Position(5, 9),
        Position(5),
        Position(6, 1),
    ]
    assert Position(5).ordinal == BEFORE_NEXT_TICK
    assert all(one.precedes(other) and not other.precedes(one) for one, other in pairwise(places))


class Looker:
    """Asks a debugger, and keeps what it answers."""

    def __init__(self) -> None:
        self.answers: list[tuple[Paused, dict[str, str]]] = []
        self.failures: list[str] = []
        self.passed = 0
        self.debugger = ReplayDebugger(self._arrived, self.failures.append, self._ended)

    def _arrived(self, paused: Paused, found: Inspected) -> None:
        self.answers.append((paused, {one.name: one.value for one in found.variables}))

    def _ended(self) -> None:
        self.passed += 1

    def answer(self) -> tuple[Paused, dict[str, str]]:
        """Wait for the next answer."""
        give_up = time.monotonic() + PATIENCE_S
        while not self.answers:
            assert time.monotonic() < give_up and not self.failures, self.failures
            self.debugger.poll()
        return self.answers.pop()


@pytest.fixture
def looker() -> Iterator[Looker]:
    made = Looker()
    yield made
    made.debugger.close()


@pytest.fixture(scope="module")
def recording() -> Recording:
    """A run of three seconds."""
    run = start_run(Program("p.py", TEXT), build_run_spec(Settings()), RunOptions())
    assert run.wait(PATIENCE_S)
    return Recording(RunStore().load_run(run.run_id))


def test_variables_are_right_at_instants_visited_forwards_and_back(
    recording: Recording, looker: Looker
) -> None:
    for tick, n in ((105, "10"), (205, "20"), (205, "20"), (55, "5")):
        looker.debugger.go(recording, Position(tick), Inspect())
        paused, names = looker.answer()
        assert (paused.tick, names["n"], names["m"]) == (tick, n, str(int(n) ** 2))


def test_stepping_two_lines_back_from_an_instant_holds_at_that_line(
    recording: Recording, looker: Looker
) -> None:
    looker.debugger.lines_back(recording, Position(105), 2, Inspect())
    paused, names = looker.answer()
    assert (paused.line, names["n"], names["m"]) == (3, "10", "81")


def test_going_to_a_line_in_a_tick_holds_where_the_line_began(
    recording: Recording, looker: Looker
) -> None:
    looker.debugger.go_to_line(recording, 110, 3, Inspect())
    paused, names = looker.answer()
    assert (paused.line, paused.tick, names["n"], names["m"]) == (3, 110, "11", "100")
    # It begins later, so that the tick's end is all there is.
    looker.debugger.go_to_line(recording, 110, 5, Inspect())
    paused, names = looker.answer()
    assert (paused.line, paused.ordinal, names["m"]) == (4, BEFORE_NEXT_TICK, "121")


def test_a_step_from_a_past_instant_holds_at_the_next_line(
    recording: Recording, looker: Looker
) -> None:
    looker.debugger.go_on(recording, Position(105), StepLine(LineStep.INTO), Inspect())
    paused, _ = looker.answer()
    assert (paused.line, paused.tick) == (2, 110)


def test_going_beyond_a_runs_end_holds_at_the_end(recording: Recording, looker: Looker) -> None:
    looker.debugger.go(recording, Position(10_000), Inspect())
    paused, names = looker.answer()
    assert (paused.reason, paused.tick, names["n"]) == (PauseReason.END, 300, "29")
    looker.debugger.go_on(recording, Position(300), Resume(), Inspect())
    give_up = time.monotonic() + PATIENCE_S
    while looker.debugger.busy:
        assert time.monotonic() < give_up
        looker.debugger.poll()
    assert (looker.passed, looker.failures) == (1, [])


def test_a_step_is_taken_in_the_run_asked_for_and_not_the_one_before(
    recording: Recording, looker: Looker
) -> None:
    run = start_run(
        Program("q.py", TEXT.replace("n * n", "-n")), build_run_spec(Settings()), RunOptions()
    )
    assert run.wait(PATIENCE_S)
    looker.debugger.go(recording, Position(105), Inspect())
    looker.answer()
    other = Recording(RunStore().load_run(run.run_id))
    looker.debugger.go_on(other, Position(105), StepLine(LineStep.OVER), Inspect())
    assert looker.answer()[1]["m"] == "-10"
