"""Trajectories of a servo motor, in whole numbers, as the Pybricks firmware computes them.

Times are in microseconds, positions in counts or thousandths of a count, rates in counts per second and
accelerations in counts per second squared. Every quotient is rounded towards zero, as in C, and times count in whole
milliseconds: the results equal those of the firmware to the last digit.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isqrt
from typing import NamedTuple

MS_US = 1000
"""Microseconds in a millisecond."""
MILLI = 1000
"""Thousandths of a count in a count."""
LONGEST_US = 1_800_000_000
"""No move takes longer than this: half an hour."""
ENDLESS_S = 60
"""What the firmware assumes an endless move to take. It has no effect on the motion."""


def divided(dividend: int, divisor: int) -> int:
    """Return a quotient, rounded towards zero as in C."""
    quotient = abs(dividend) // abs(divisor)
    return quotient if (dividend < 0) == (divisor < 0) else -quotient


def duration_us(change: int, rate: int) -> int:
    """Return how long a change takes at a rate per second."""
    return divided(change * 1000, rate) * MS_US


def rate_change(acceleration: int, time_us: int) -> int:
    """Return how much an acceleration changes a rate."""
    return divided(acceleration * (time_us // MS_US), 1000)


class Segment(NamedTuple):
    """The start of one of a trajectory's parts: speeding up or down, running evenly, stopping, standing."""

    start_us: int
    milli: int
    rate: int
    acceleration: int

    def milli_at(self, time_us: int) -> int:
        """Return the position at a time in this segment."""
        passed_us, rate, acceleration = time_us - self.start_us, self.rate, self.acceleration
        # Each quotient rounds towards zero; each motor asks in every tick.
        milli = self.milli + (
            rate * passed_us // 1000 if rate >= 0 else -(-rate * passed_us // 1000)
        )
        if acceleration > 0:
            return milli + acceleration * passed_us // 1000 * passed_us // 2_000_000
        return (
            milli - -acceleration * passed_us // 1000 * passed_us // 2_000_000
            if acceleration
            else milli
        )

    def rate_at(self, time_us: int) -> int:
        """Return the rate at a time in this segment."""
        return self.rate + (
            rate_change(self.acceleration, time_us - self.start_us) if self.acceleration else 0
        )

    def millis(self, times_us: range) -> list[int]:
        """Return the positions at several times in this segment, which `at` gives one by one."""
        sign, way, steps = (
            (1 if self.rate >= 0 else -1),
            abs(self.rate),
            [at - self.start_us for at in times_us],
        )
        even = [self.milli + sign * (way * at // 1000) for at in steps]
        if not self.acceleration:
            return even
        sign, change = (1 if self.acceleration >= 0 else -1), abs(self.acceleration)
        return [
            milli + sign * (change * at // 1000 * at // 2_000_000)
            for milli, at in zip(even, steps, strict=True)
        ]


Measure = Callable[[int], Segment]
"""Returns where a motion is at a time, as the start of a trajectory."""


class Trajectory(NamedTuple):
    """A motion: it speeds up or down, runs evenly, and stops."""

    first: Segment
    even: Segment
    last: Segment
    end: Segment
    endless: bool = False
    """Whether it never stops; `last` and `end` then do not count."""

    @property
    def end_us(self) -> int:
        """When it stops."""
        return self.end.start_us

    def segment(self, time_us: int) -> Segment:
        """Return the segment that a time lies in."""
        if time_us < self.even.start_us:
            return self.first
        if self.endless or time_us <= self.last.start_us:
            return self.even
        return self.last if time_us <= self.end.start_us else self.end

    def segment_end_us(self, time_us: int) -> int | None:
        """Return when the segment of a time ends; None if it does not."""
        if time_us < self.even.start_us:
            return self.even.start_us
        if self.endless or time_us > self.end.start_us:
            return None
        return self.last.start_us if time_us < self.last.start_us else self.end.start_us


def standing(time_us: int, milli: int) -> Trajectory:
    """Return the trajectory that stays at a position, given in thousandths of a count."""
    there = Segment(time_us, milli, 0, 0)
    return Trajectory(there, there, there, there)


def angle_move(
    start: Segment, target: int, rate: int, acceleration: int, fastest: int
) -> Trajectory:
    """Return the move to a position.

    Args:
        start: Where it begins; its acceleration does not count.
        target: Where it stops, in counts.
        rate: The wanted rate; its sign does not count.
        acceleration: How it speeds up and stops.
        fastest: The highest rate.

    Raises:
        ValueError: the rate is 0, or the move takes longer than half an hour.
    """
    if not rate:
        raise ValueError("the speed of a move to a position is 0")
    begin, origin = divided(start.milli, MILLI), start.milli
    if target == begin:
        return standing(start.start_us, target * MILLI)
    sign = 1 if target > begin else -1
    wanted, length = min(abs(rate), fastest), abs(target - begin)
    w0 = max(-fastest, min(fastest, start.rate * sign))
    if w0 > 0 and w0 * w0 // (2 * acceleration) > length:
        w0 = isqrt(2 * acceleration * length)
    # Forwards from position 0; a move backwards is its mirror image.
    if w0 < wanted:
        a0, from_rest = acceleration, -divided(w0 * w0, 2 * acceleration)
        if length - from_rest >= wanted * wanted // acceleration:
            th1, th2, w1 = (
                from_rest + wanted * wanted // (2 * acceleration),
                length - wanted * wanted // (2 * acceleration),
                wanted,
            )
        else:
            th1 = th2 = divided(length + from_rest, 2)
            w1 = isqrt(2 * acceleration * (th1 - from_rest))
    else:
        a0, w1 = -acceleration, wanted
        th1, th2 = (
            divided(w0 * w0 - wanted * wanted, 2 * acceleration),
            length - wanted * wanted // (2 * acceleration),
        )
    t1 = start.start_us + duration_us(w1 - w0, a0)
    t2 = t1 + (duration_us(th2 - th1, w1) if th2 != th1 else 0)
    t3 = t2 + duration_us(w1, acceleration)
    if t3 - start.start_us > LONGEST_US:
        raise ValueError("the move takes longer than half an hour")
    return Trajectory(
        Segment(start.start_us, origin, sign * w0, sign * a0),
        Segment(t1, (begin + sign * th1) * MILLI, sign * w1, 0),
        Segment(t2, (begin + sign * th2) * MILLI, sign * w1, -sign * acceleration),
        Segment(t3, target * MILLI, 0, 0),
    )


def endless_move(start: Segment, rate: int, acceleration: int, fastest: int) -> Trajectory:
    """Return the motion at a speed that does not end.

    Args:
        start: Where it begins; its acceleration does not count.
        rate: The wanted rate.
        acceleration: How it speeds up or down.
        fastest: The highest rate.
    """
    at = start.start_us
    limit = min(fastest, acceleration * ENDLESS_S)
    wanted, w0 = max(-limit, min(limit, rate)), max(-limit, min(limit, start.rate))
    change = wanted - w0
    speeds_up = change > 0 or (not change and rate < 0)
    first = Segment(at, start.milli, w0, acceleration if speeds_up else -acceleration)
    if not change:
        even = first._replace(acceleration=0)
        return Trajectory(first, even, even, even, True)
    t1 = at + abs(change) * 1000 // acceleration * MS_US
    even = Segment(t1, first.milli_at(t1), wanted, 0)
    return Trajectory(first, even, even, even, True)


def timed_move(
    start: Segment, time_us: int, rate: int, acceleration: int, fastest: int
) -> Trajectory:
    """Return the move that takes a time, with its ramps.

    Args:
        start: Where it begins; its acceleration does not count.
        time_us: How long it takes.
        rate: The wanted rate.
        acceleration: How it speeds up and stops.
        fastest: The highest rate.

    Raises:
        ValueError: the time is negative, or longer than half an hour.
    """
    if not 0 <= time_us <= LONGEST_US:
        raise ValueError("the time of a move is from 0 to half an hour")
    sign = 1 if rate >= 0 else -1
    limit = min(fastest, rate_change(acceleration, time_us))
    wanted = min(abs(rate), limit)
    w0 = max(-limit, min(limit, sign * start.rate))
    if w0 < wanted:
        a0, t1, w1 = acceleration, duration_us(wanted - w0, acceleration), wanted
        room_us = time_us - duration_us(w0, acceleration)
        if t1 >= room_us // 2:
            t1, w1 = room_us // 2, divided(rate_change(acceleration, time_us), 2) + divided(w0, 2)
    else:
        a0, t1, w1 = -acceleration, duration_us(w0 - wanted, acceleration), wanted
    t3 = duration_us(w1, acceleration)
    at = start.start_us
    first = Segment(at, start.milli, sign * w0, sign * a0)
    even = Segment(at + t1, first.milli_at(at + t1), sign * w1, 0)
    t2 = at + time_us - t3
    last = Segment(t2, even.milli_at(t2), sign * w1, -sign * acceleration)
    return Trajectory(first, even, last, Segment(t2 + t3, last.milli_at(t2 + t3), 0, 0))


def proportional(trajectory: Trajectory, leader: Trajectory) -> Trajectory:
    """Return a move with the ends of a trajectory and the times of a leader, in proportion to its positions."""
    begin, whole = trajectory.first.milli, trajectory.end.milli - trajectory.first.milli
    from_milli, way = leader.first.milli, leader.end.milli - leader.first.milli

    def part(number: int) -> int:
        return divided(number * whole, way) if way else 0

    def scaled(one: Segment) -> Segment:
        return Segment(
            one.start_us,
            begin + part(one.milli - from_milli),
            part(one.rate),
            part(one.acceleration),
        )

    return Trajectory(
        scaled(leader.first), scaled(leader.even), scaled(leader.last), scaled(leader.end)
    )
