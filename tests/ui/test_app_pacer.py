"""Frame pacing against a terminal that answers at once, late, or never."""

from __future__ import annotations

from tuisim.ui.pacer import MAX_MISSED, TIMEOUT_S, Pacer


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def frames(pacer: Pacer, clock: Clock, seconds: float, answer_after_s: float | None) -> int:
    """Count the frames drawn with a timer of 5 ms and a terminal that answers after a time."""
    drawn = 0
    due: list[float] = []
    end = clock.now_s + seconds
    while clock.now_s < end:
        while due and due[0] <= clock.now_s:
            due.pop(0)
            pacer.answered()
        if pacer.ready():
            drawn += 1
            if pacer.drawn() and answer_after_s is not None:
                due.append(clock.now_s + answer_after_s)
        clock.now_s += 0.005
    return drawn


def test_a_quick_terminal_gets_every_frame() -> None:
    clock = Clock()
    assert 19 <= frames(Pacer(20, clock=clock), clock, 1.0, 0.002) <= 22


def test_a_backlog_shows_fewer_frames() -> None:
    clock = Clock()
    assert frames(Pacer(20, clock=clock), clock, 4.0, 0.4) <= 24


def test_a_long_way_does_not_halve_the_rate() -> None:
    clock = Clock()
    # Without more than one frame on the way there would be 80.
    assert frames(Pacer(20, clock=clock), clock, 10.0, 0.12) >= 150


def test_a_terminal_that_never_answers_is_no_longer_asked() -> None:
    clock = Clock()
    pacer = Pacer(20, clock=clock)
    frames(pacer, clock, TIMEOUT_S * (MAX_MISSED + 1), None)
    assert not pacer.asks
    assert 19 <= frames(pacer, clock, 1.0, None) <= 22


def test_an_answer_to_nothing_is_ignored() -> None:
    pacer = Pacer(20, clock=Clock())
    pacer.answered()
    assert pacer.ready()
