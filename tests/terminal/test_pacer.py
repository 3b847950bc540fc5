"""Frame pacing against terminals that answer at once, late, or never, and against slow lines."""

from __future__ import annotations

from collections import deque
from math import inf

import pytest

from tests.cases import cases
from tuisim.terminal.pacer import MAX_ON_THE_WAY, PAGE_QUEUED_S, PATIENCE_S, PROOF_S, Pacer

TICK_S = 0.005
FRAME_BYTES = 1_000


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class Line:
    """A terminal at the end of a line, and a pacer before it.

    Args:
        bytes_s: So much goes through.
        round_trip_s: There and back.
    """

    def __init__(
        self, bytes_s: float = inf, round_trip_s: float = 0.002, most_queued_s: float | None = None
    ) -> None:
        self.clock = Clock()
        self.pacer = Pacer(20, clock=self.clock, most_queued_s=most_queued_s)
        self.bytes_s = bytes_s
        self.round_trip_s = round_trip_s
        self.answers = True
        self._free_s = 0.0
        self._due_s: deque[float] = deque()

    def send(self, size: int) -> None:
        """The app paints."""
        self._free_s = max(self._free_s, self.clock.now_s) + size / self.bytes_s
        if self.pacer.record_painted(size) and self.answers:
            self._due_s.append(self._free_s + self.round_trip_s)

    @property
    def backlog_s(self) -> float:
        """So late would come what was sent now."""
        return max(0.0, self._free_s - self.clock.now_s)

    def drive(self, seconds: float, size: int = FRAME_BYTES) -> int:
        """Draw as often as there may be a frame, each of some bytes; returns how many there were."""
        drawn = 0
        for _ in range(round(seconds / TICK_S)):
            while self._due_s and self._due_s[0] <= self.clock.now_s:
                self._due_s.popleft()
                self.pacer.record_answer()
            if self.pacer.ready():
                drawn += 1
                self.pacer.drawn()
                self.send(size)
            self.clock.now_s += TICK_S
        return drawn


@cases(
    "bytes_s, round_trip_s, least, most",
    {
        "at once": (inf, 0.002, 19, 21),
        "a little too late for the next frame": (inf, 0.070, 19, 21),
        # Without more than one frame on the way there would be 8.
        "a long way": (inf, 0.120, 15, 21),
        "a very long way": (inf, 0.400, 6, 9),
        "128 kbit/s": (16_000, 0.150, 10, 16),
        "16 kbit/s": (2_000, 0.150, 1, 2),
    },
)
def test_each_link_gets_as_many_frames_a_second_as_it_carries(
    bytes_s: float, round_trip_s: float, least: int, most: int
) -> None:
    line = Line(bytes_s, round_trip_s)
    line.drive(5.0)

    assert least <= line.drive(10.0) / 10.0 <= most


@pytest.mark.parametrize("first_paint", [1_000, 20_000, 60_000])
@pytest.mark.parametrize("size", [1_000, 6_000], ids=["frames", "frames with a chart"])
def test_a_key_is_answered_within_a_second_at_128_kbit_s(first_paint: int, size: int) -> None:
    line = Line(bytes_s=16_000, round_trip_s=0.150)
    line.send(first_paint)
    line.drive(10.0, size)

    worst_s = 0.0
    for _ in range(200):
        line.drive(0.05, size)
        worst_s = max(worst_s, line.backlog_s)
    assert worst_s + line.round_trip_s <= 1.0


def test_the_pacer_keeps_limiting_frames_after_three_late_answers() -> None:
    line = Line(round_trip_s=0.1)
    line.drive(1.0)
    line.round_trip_s = 3.0
    line.drive(12.0)

    # No more in each patience than may be on the way, and not 20 a second.
    assert line.drive(10.0) <= MAX_ON_THE_WAY * 10.0 / PATIENCE_S


def test_a_terminal_that_never_answers_still_gets_frames() -> None:
    line = Line()
    line.answers = False
    assert line.drive(PROOF_S) <= 2.5 * PROOF_S
    line.drive(1.0)

    assert 19 <= line.drive(1.0) <= 21


def test_unanswered_queries_to_a_closed_page_do_not_count_as_a_slow_link() -> None:
    line = Line(most_queued_s=PAGE_QUEUED_S)
    line.drive(1.0)
    line.answers = False
    line.drive(0.2)
    line.pacer.record_interruption()
    line.clock.now_s += 5.0
    line.answers = True

    assert line.drive(1.0) > 15
    assert not line.pacer.is_slow


def test_a_page_that_starts_answering_late_is_not_called_a_slow_link() -> None:
    clock = Clock()
    pacer = Pacer(20, clock=clock, most_queued_s=PAGE_QUEUED_S)

    def draws(answer_after_s: float) -> None:
        pacer.drawn()
        pacer.record_painted(FRAME_BYTES)
        clock.now_s += answer_after_s
        pacer.record_answer()

    draws(0.01)
    pacer.record_interruption()
    draws(2.0)
    was_slow = pacer.is_slow
    draws(2.0)

    assert (was_slow, pacer.is_slow) == (False, True)


def test_small_output_that_is_no_frame_is_not_followed_by_a_query() -> None:
    pacer = Pacer(20, clock=Clock())

    assert [pacer.record_painted(size) for size in (100, 30_000, 100)] == [False, True, False]


def test_the_first_painted_frame_is_followed_by_a_query() -> None:
    pacer = Pacer(20, clock=Clock())
    pacer.drawn()

    assert pacer.ready() is False
    assert pacer.record_painted(10)


def test_an_unexpected_answer_of_the_terminal_is_ignored_by_the_pacer() -> None:
    pacer = Pacer(20, clock=Clock())
    pacer.record_answer()
    assert pacer.ready()


def test_a_link_is_slow_until_the_first_answer_and_quick_again_after_a_rest() -> None:
    line = Line(10_000)
    seen = [line.pacer.is_slow]
    line.drive(3.0)
    line.drive(3.0, size=10)

    assert seen == [True]
    assert not line.pacer.is_slow
    assert line.pacer.is_idle


def test_fine_frames_are_tried_less_and_less_often_on_a_link_that_does_not_carry_them() -> None:
    line = Line(32_000, 0.150)
    was_slow = True
    tries = 0
    for _ in range(600):
        slow = line.pacer.is_slow
        line.drive(0.1, size=FRAME_BYTES if slow else 5 * FRAME_BYTES)
        tries += was_slow and not slow
        was_slow = slow

    assert 3 <= tries <= 6
