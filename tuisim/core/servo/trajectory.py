"""Trajectories of a servo motor, in whole numbers, as the Pybricks firmware computes them.

Times are in microseconds, positions in counts or thousandths of a count, rates in counts per second and
accelerations in counts per second squared. Every quotient is rounded towards zero, as in C, and times count in whole
milliseconds: the results equal those of the firmware to the last digit.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isqrt

MS_US = 1000
"""Microseconds in a millisecond."""
MILLI = 1000
"""Thousandths of a count in a count."""
LONGEST_US = 1_800_000_000
"""No move takes longer than this: half an hour."""
ENDLESS_US = 60_000_000
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


def path(rate: int, time_us: int) -> int:
    """Return how far a rate leads, in thousandths of a count."""
    return divided(rate * time_us, 1000)


def path_of_acceleration(acceleration: int, time_us: int) -> int:
    """Return how far an acceleration from standstill leads, in thousandths of a count."""
    return divided(path(path(acceleration, time_us), time_us), 2000)


@dataclass(frozen=True, slots=True)
class Reference:
    """Where a trajectory is at one time."""

    milli: int
    """Position in thousandths of a count."""
    rate: int
    acceleration: int


@dataclass(frozen=True, slots=True)
class Segment:
    """The start of one of a trajectory's parts: speeding up or down, running evenly, stopping, standing."""

    start_us: int
    milli: int
    rate: int
    acceleration: int

    def at(self, time_us: int) -> Reference:
        """Return the reference at a time in this segment."""
        passed_us, acceleration = time_us - self.start_us, self.acceleration
        milli = self.milli + path(self.rate, passed_us)
        if not acceleration:
            return Reference(milli, self.rate, 0)
        milli += path_of_acceleration(acceleration, passed_us)
        return Reference(milli, self.rate + rate_change(acceleration, passed_us), acceleration)

    def millis(self, times_us: range) -> list[int]:
        """Return the positions at several times in this segment, which `at` gives one by one."""
        sign, way, steps = (1 if self.rate >= 0 else -1), abs(self.rate), [at - self.start_us for at in times_us]
        even = [self.milli + sign * (way * at // 1000) for at in steps]
        if not self.acceleration:
            return even
        sign, change = (1 if self.acceleration >= 0 else -1), abs(self.acceleration)
        return [milli + sign * (change * at // 1000 * at // 2_000_000) for milli, at in zip(even, steps, strict=True)]


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A motion: it speeds up or down, runs evenly, and stops.

    Args:
        first, even, last, end: Its segments.
        endless: Whether it never stops; `last` and `end` then do not count.
    """

    first: Segment
    even: Segment
    last: Segment
    end: Segment
    endless: bool = False

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

    def at(self, time_us: int) -> Reference:
        """Return the reference at a time."""
        return self.segment(time_us).at(time_us)


def standing(time_us: int, milli: int) -> Trajectory:
    """Return the trajectory that stays at a position, given in thousandths of a count."""
    there = Segment(time_us, milli, 0, 0)
    return Trajectory(there, there, there, there)


def angle_move(start: Segment, target: int, rate: int, acceleration: int, fastest: int) -> Trajectory:
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
        th1, th2 = divided(w0 * w0 - wanted * wanted, 2 * acceleration), length - wanted * wanted // (2 * acceleration)
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


def timed_move(
    start: Segment, time_us: int, rate: int, acceleration: int, fastest: int, *, endless: bool = False
) -> Trajectory:
    """Return the move that takes a time, with its ramps.

    Args:
        start: Where it begins; its acceleration does not count.
        time_us: How long it takes.
        rate: The wanted rate.
        acceleration: How it speeds up and stops.
        fastest: The highest rate.
        endless: Whether it never stops; `time_us` is then what the firmware assumes.

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
        a0, ramp_us = acceleration, duration_us(wanted - w0, acceleration)
        room_us = time_us - duration_us(w0, acceleration)
        t1, w1 = ramp_us, wanted
        if not endless and ramp_us >= room_us // 2:
            t1, w1 = room_us // 2, divided(rate_change(acceleration, time_us), 2) + divided(w0, 2)
    else:
        a0, t1, w1 = -acceleration, duration_us(w0 - wanted, acceleration), wanted
    t3 = duration_us(w1, acceleration)
    t2 = time_us - t1 - t3
    th1 = path(w0, t1) + path_of_acceleration(a0, t1)
    th2 = th1 + path(w1, t2)
    th3 = th2 + path(w1, t3) + path_of_acceleration(-acceleration, t3)
    at = start.start_us
    return Trajectory(
        Segment(at, start.milli, sign * w0, sign * a0),
        Segment(at + t1, start.milli + sign * th1, sign * w1, 0),
        Segment(at + t1 + t2, start.milli + sign * th2, sign * w1, -sign * acceleration),
        Segment(at + t1 + t2 + t3, start.milli + sign * th3, 0, 0),
        endless,
    )
