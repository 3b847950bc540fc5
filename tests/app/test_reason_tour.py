"""The reasons come in turn, and those of another run are forgotten."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from tuisim.app.reason_tour import ReasonTour
from tuisim.tasks.reasons.reason import Reason, ReasonKind

REASONS = (
    Reason(ReasonKind.BLOCKED, 1.0, 3, "the robot stood at the wall"),
    Reason(ReasonKind.LOST, 0.5, 0, "the robot left the mat"),
)


def test_the_key_for_errors_shows_each_reason_in_turn_and_then_the_end() -> None:
    tour = ReasonTour()
    recording = SimpleNamespace(newest=100)
    run: Any = recording
    tour.begin(run, has_ended=True)
    tour.take(run, REASONS, None)
    assert tour.advance() == REASONS[0]
    assert tour.words == ("1.00 s, line 3: the robot stood at the wall · 1 of 2, {went-wrong} next")
    assert tour.advance() == REASONS[1]
    assert tour.words == "0.50 s: the robot left the mat · 2 of 2, {went-wrong} end"
    assert tour.advance() is None
    assert tour.words.startswith("This is the end of the run again")
    assert tour.advance() == REASONS[0]


def test_after_going_to_the_end_the_first_reason_comes_again() -> None:
    tour = ReasonTour()
    run: Any = SimpleNamespace(newest=100)
    tour.begin(run, has_ended=True)
    tour.take(run, REASONS, None)
    tour.advance()
    tour.restart()
    assert tour.advance() == REASONS[0]


def test_a_run_that_has_gone_on_shows_its_first_reason_again() -> None:
    tour = ReasonTour()
    run: Any = SimpleNamespace(newest=100)
    tour.begin(run, has_ended=False)
    tour.take(run, REASONS, None)
    tour.advance()
    tour.take(run, REASONS, None)
    assert tour.advance() == REASONS[1]
    run.newest = 200
    tour.take(run, REASONS, None)
    assert tour.advance() == REASONS[0]
    assert not tour.is_about(run, has_ended=True)
    tour.begin(run, has_ended=True)
    tour.take(run, REASONS, None)
    assert tour.advance() == REASONS[0]


def test_a_single_reason_has_no_number() -> None:
    tour = ReasonTour()
    run: Any = SimpleNamespace(newest=100)
    tour.begin(run, has_ended=True)
    tour.take(run, REASONS[1:], None)
    tour.advance()
    assert tour.words == "0.50 s: the robot left the mat"


def test_reasons_found_for_a_run_no_longer_shown_are_dropped() -> None:
    tour = ReasonTour()
    first: Any = SimpleNamespace(newest=100)
    second: Any = SimpleNamespace(newest=100)
    tour.begin(first, has_ended=True)
    tour.begin(second, has_ended=True)
    tour.take(first, REASONS, None)
    assert tour.reasons == ()
    runs: Any = SimpleNamespace(timeline=SimpleNamespace(recording=second), earlier=None)
    assert not tour.has_gone_wrong(runs)
    tour.take(second, REASONS, None)
    assert tour.has_gone_wrong(runs)
