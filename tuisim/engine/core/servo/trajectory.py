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
MAX_DURATION_US = 1_800_000_000
"""The longest duration of a move: half an hour."""
ENDLESS_S = 60
"""Seconds that the firmware assumes for a motion without an end: its rate is at most the acceleration times this."""


def divide(dividend: int, divisor: int) -> int:
    """Return a quotient, rounded towards zero as in C."""
    quotient = abs(dividend) // abs(divisor)
    return quotient if (dividend < 0) == (divisor < 0) else -quotient


def compute_duration_us(change: int, rate: int) -> int:
    """Return the time in µs that a change by `change` takes at `rate` per second, cut to whole milliseconds."""
    return divide(change * 1000, rate) * MS_US


def rate_change(acceleration: int, time_us: int) -> int:
    """Return by how much an acceleration, in counts per second squared, changes a rate during a time in µs."""
    return divide(acceleration * (time_us // MS_US), 1000)


class Segment(NamedTuple):
    """One part of a trajectory, with constant acceleration: its start time, and position and rate at that time.

    Positions are in thousandths of a count, rates in counts/s, accelerations in counts/s².
    """

    start_us: int
    milli: int
    rate: int
    acceleration: int

    def find_milli(self, time_us: int) -> int:
        """Return the position at a time in this segment, in thousandths of a count."""
        passed_us = time_us - self.start_us
        rate = self.rate
        acceleration = self.acceleration
        # `divide` is inlined here, because each motor needs it in every tick: each quotient is rounded towards zero.
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

    def find_rate(self, time_us: int) -> int:
        """Return the rate at a time in this segment, in counts per second."""
        return self.rate + (
            rate_change(self.acceleration, time_us - self.start_us) if self.acceleration else 0
        )


Measure = Callable[[int], Segment]
"""Takes a time in µs; returns where a motion is at that time, as the start of a trajectory."""


class Trajectory(NamedTuple):
    """The planned course of a motion: it speeds up or slows down to a rate, keeps this rate, and stops.

    Each of these three parts is a `Segment`, and so is the rest after them. An endless motion never stops.
    """

    first: Segment
    even: Segment
    last: Segment
    end: Segment
    endless: bool = False
    """Whether the motion never stops; `last` and `end` then have no meaning."""

    @property
    def end_us(self) -> int:
        """Time in µs at which the motion of the trajectory stops."""
        return self.end.start_us

    def find_segment(self, time_us: int) -> Segment:
        """Return the segment of the trajectory to which a time in µs belongs."""
        if time_us < self.even.start_us:
            return self.first
        if self.endless or time_us <= self.last.start_us:
            return self.even
        return self.last if time_us <= self.end.start_us else self.end

    def find_segment_end_us(self, time_us: int) -> int | None:
        """Return the time in µs at which the segment that contains the time `time_us` ends; None if it has no end."""
        if time_us < self.even.start_us:
            return self.even.start_us
        if self.endless or time_us > self.end.start_us:
            return None
        return self.last.start_us if time_us < self.last.start_us else self.end.start_us


def build_rest(time_us: int, milli: int) -> Trajectory:
    """Return a trajectory that stays at one position.

    Args:
        time_us: When it begins.
        milli: The position, in thousandths of a count.
    """
    there = Segment(time_us, milli, 0, 0)
    return Trajectory(there, there, there, there)


def build_angle_move(
    start: Segment,
    target: int,
    rate: int,
    acceleration: int,
    fastest: int,
    deceleration: int | None = None,
) -> Trajectory:
    """Return the trajectory of a move to a position.

    Args:
        start: Where the move begins; its acceleration is ignored.
        target: Where the move stops, in counts.
        rate: The rate that the program asks for, in counts/s; its sign is ignored.
        acceleration: Acceleration at the beginning, in counts/s².
        fastest: The limit of the rate, in counts/s.
        deceleration: Deceleration at the end, in counts/s²; None for the same as `acceleration`.

    Raises:
        ValueError: the rate is 0, or the move takes longer than half an hour.
    """
    if not rate:
        raise ValueError("the speed of a move to a position is 0")
    begin = divide(start.milli, MILLI)
    origin = start.milli
    if target == begin:
        return build_rest(start.start_us, target * MILLI)
    sign = 1 if target > begin else -1
    slowing = deceleration or acceleration
    top_rate = min(abs(rate), fastest)
    length = abs(target - begin)
    w0 = max(-fastest, min(fastest, start.rate * sign))
    if w0 > 0 and w0 * w0 // (2 * slowing) > length:
        w0 = isqrt(2 * slowing * length)
    # All moves are computed as moves forwards from position 0; a move backwards is mirrored at the end.
    if w0 < top_rate:
        a0 = acceleration
        from_rest = -divide(w0 * w0, 2 * acceleration)
        th1, th2, w1 = _speed_up(length, from_rest, top_rate, acceleration, slowing)
    else:
        a0 = -acceleration
        w1 = top_rate
        th1, th2 = (
            divide(w0 * w0 - top_rate * top_rate, 2 * acceleration),
            length - top_rate * top_rate // (2 * slowing),
        )
    t1 = start.start_us + compute_duration_us(w1 - w0, a0)
    t2 = t1 + (compute_duration_us(th2 - th1, w1) if th2 != th1 else 0)
    t3 = t2 + compute_duration_us(w1, slowing)
    if t3 - start.start_us > MAX_DURATION_US:
        raise ValueError("the move takes longer than half an hour")
    return Trajectory(
        Segment(start.start_us, origin, sign * w0, sign * a0),
        Segment(t1, (begin + sign * th1) * MILLI, sign * w1, 0),
        Segment(t2, (begin + sign * th2) * MILLI, sign * w1, -sign * slowing),
        Segment(t3, target * MILLI, 0, 0),
    )


def _speed_up(
    length: int, from_rest: int, top_rate: int, acceleration: int, slowing: int
) -> tuple[int, int, int]:
    """Return the part of a move in which the rate is constant: where it begins and ends, in counts, and the rate.

    Begin and end are equal if the move is too short to reach `top_rate`. Rates are in counts per second.

    Args:
        length: How far the move goes, in counts.
        from_rest: Where the move would have begun if it had sped up from rest; 0 or less.
        top_rate: The highest rate.
        acceleration: The acceleration before the part with the constant rate, in counts per second squared.
        slowing: The deceleration after it, in the same unit.
    """
    ramps = top_rate * top_rate * (acceleration + slowing) // (2 * acceleration * slowing)
    if length - from_rest >= ramps:
        even = from_rest + top_rate * top_rate // (2 * acceleration)
        return even, length - top_rate * top_rate // (2 * slowing), top_rate
    top = divide(slowing * length + acceleration * from_rest, acceleration + slowing)
    return top, top, isqrt(2 * acceleration * (top - from_rest))


def build_endless_move(start: Segment, rate: int, acceleration: int, fastest: int) -> Trajectory:
    """Return the trajectory of a motion at a speed, without an end.

    Args:
        start: Where the motion begins; its acceleration is ignored.
        rate: The rate to reach, in counts/s; its sign is the direction.
        acceleration: Acceleration or deceleration until then, in counts/s².
        fastest: The limit of the rate, in counts/s.
    """
    start_us = start.start_us
    limit = min(fastest, acceleration * ENDLESS_S)
    target_rate = max(-limit, min(limit, rate))
    w0 = max(-limit, min(limit, start.rate))
    change = target_rate - w0
    speeds_up = change > 0 or (not change and rate < 0)
    first = Segment(start_us, start.milli, w0, acceleration if speeds_up else -acceleration)
    if not change:
        even = first._replace(acceleration=0)
        return Trajectory(first, even, even, even, True)
    t1 = start_us + abs(change) * 1000 // acceleration * MS_US
    even = Segment(t1, first.find_milli(t1), target_rate, 0)
    return Trajectory(first, even, even, even, True)


def build_timed_move(
    start: Segment, time_us: int, rate: int, acceleration: int, fastest: int
) -> Trajectory:
    """Return the trajectory of a move that takes a given time, including its ramps.

    Args:
        start: Where the move begins; its acceleration is ignored.
        time_us: How long the move takes.
        rate: The rate to reach, in counts/s; its sign is the direction.
        acceleration: Acceleration at the beginning and deceleration at the end, in counts/s².
        fastest: The limit of the rate, in counts/s.

    Raises:
        ValueError: the time is negative, or longer than half an hour.
    """
    if not 0 <= time_us <= MAX_DURATION_US:
        raise ValueError("the time of a move is from 0 to half an hour")
    sign = 1 if rate >= 0 else -1
    limit = min(fastest, rate_change(acceleration, time_us))
    target_rate = min(abs(rate), limit)
    w0 = max(-limit, min(limit, sign * start.rate))
    if w0 < target_rate:
        a0 = acceleration
        t1 = compute_duration_us(target_rate - w0, acceleration)
        w1 = target_rate
        room_us = time_us - compute_duration_us(w0, acceleration)
        if t1 >= room_us // 2:
            t1 = room_us // 2
            w1 = divide(rate_change(acceleration, time_us), 2) + divide(w0, 2)
    else:
        a0 = -acceleration
        t1 = compute_duration_us(w0 - target_rate, acceleration)
        w1 = target_rate
    t3 = compute_duration_us(w1, acceleration)
    start_us = start.start_us
    first = Segment(start_us, start.milli, sign * w0, sign * a0)
    even = Segment(start_us + t1, first.find_milli(start_us + t1), sign * w1, 0)
    t2 = start_us + time_us - t3
    last = Segment(t2, even.find_milli(t2), sign * w1, -sign * acceleration)
    return Trajectory(first, even, last, Segment(t2 + t3, last.find_milli(t2 + t3), 0, 0))


def scale_move(leader: Trajectory, begin: int, part: int, whole: int) -> Trajectory:
    """Return a trajectory with the times of another one, and its distances multiplied by `part` / `whole`.

    Args:
        leader: The other trajectory.
        begin: Where the new one begins, in thousandths of a count.
        part, whole: The factor for distances.
    """

    def scale(number: int) -> int:
        return divide(number * part, whole) if whole else 0

    def scale_segment(segment: Segment) -> Segment:
        return Segment(
            segment.start_us,
            begin + scale(segment.milli - leader.first.milli),
            scale(segment.rate),
            scale(segment.acceleration),
        )

    first, even, last, end = (scale_segment(segment) for segment in leader[:4])
    return Trajectory(first, even, last, end, leader.endless)
