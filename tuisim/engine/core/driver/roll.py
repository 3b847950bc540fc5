"""Rolling: the motion of a motor that nothing controls, computed for any time in closed form."""

from __future__ import annotations

from math import copysign, exp, expm1, floor, inf, log, sqrt

from tuisim.engine.core.driver.counter import (
    CLOCK_HZ,
    HALF_CLOCK_HZ,
    KEPT_COUNTS,
    KEPT_SPAN,
    MAX_DEPTH,
    MIN_IDLE,
    MIN_SPAN,
    STRIDE,
    TICKS_PER_NS,
    Counter,
)
from tuisim.engine.core.driver.plant import NS_PER_S, STEP_NS, Axle

MIN_ROLL_DPS = 20.0
"""Slowest speed of a roll: a slower axle may take so long for a count that the counter notes a standstill."""
MIN_ROLL_NS = 5 * STEP_NS
ENDLESS_NS = 1 << 62
MAX_ERROR_S = 1e-6
"""Error of a time at which Newton's method ends: another step, which squares it, is not worth its cost."""


class Roll:
    """A stretch of time in which an axle turns freely, and the power of its motor stays the same.

    A formula gives angle and speed at any time in it, without single steps. The counter is updated only when the roll
    ends.

    Args:
        axle: The axle, which turns at a speed of at least `MIN_ROLL_DPS`.
        counter: The axle's counter, up to date at the begin.
        begin_ns: When the roll begins.
    """

    __slots__ = (
        "_axle",
        "_begin_deg",
        "_begin_dps",
        "_begin_ns",
        "_constant_s",
        "_counter",
        "_depth",
        "_goal_dps",
        "_now",
        "_sign",
        "count",
        "end_ns",
        "time_ns",
    )

    def __init__(self, axle: Axle, counter: Counter, begin_ns: int) -> None:
        self._axle = axle
        self._counter = counter
        self._begin_ns = begin_ns
        self._begin_deg, self._begin_dps = axle.angle_deg, axle.speed_dps
        self._sign = copysign(1.0, axle.speed_dps)
        self._constant_s = axle.circuit.time_constant_s
        self._goal_dps = axle.goal_dps - self._sign * axle.circuit.friction_dps
        """The speed that the rolling axle approaches, in degrees per second."""
        self._depth = STRIDE
        """Number of changes of the count over which the driver measured the last speed."""
        self._now = begin_ns * TICKS_PER_NS
        self.count = counter.count
        self.time_ns = begin_ns - 1
        """Time in ns of the last step of the control up to which the axle has been turned."""
        self.end_ns = self._find_end_ns()
        """Time in ns of the last step of the control in which the axle is not slower than `MIN_ROLL_DPS`."""

    def _find_end_ns(self) -> int:
        goal_dps = self._sign * self._goal_dps
        if goal_dps >= MIN_ROLL_DPS:
            return ENDLESS_NS
        ratio = (abs(self._begin_dps) - goal_dps) / (MIN_ROLL_DPS - goal_dps)
        end_ns = self._begin_ns + self._constant_s * log(ratio) * NS_PER_S
        return int(end_ns / STEP_NS) * STEP_NS

    def turn_to(self, time_ns: int) -> None:
        """Set the axle's angle and speed to those at a time after the begin."""
        since_s = (time_ns - self._begin_ns) / NS_PER_S
        goal_dps = self._goal_dps
        constant_s = self._constant_s
        axle = self._axle
        speed_dps = goal_dps + (self._begin_dps - goal_dps) * exp(-since_s / constant_s)
        turned_deg = goal_dps * since_s + (self._begin_dps - speed_dps) * constant_s
        axle.angle_deg = self._begin_deg + turned_deg
        axle.speed_dps = speed_dps
        self.time_ns = time_ns
        self._now = time_ns * TICKS_PER_NS
        self.count = floor(2 * axle.angle_deg)

    def measure_speed_dps(self) -> int:
        """Return the speed that the driver measures now, in whole degrees per second."""
        if self.count == self._counter.count:
            return self._counter.measure_speed_dps()
        time = self._find_time(0)
        depth = self._depth
        while depth > STRIDE and time - self._find_time(depth - STRIDE) >= MIN_SPAN:
            depth -= STRIDE
        while (span := time - self._find_time(depth)) < MIN_SPAN and depth < MAX_DEPTH:
            depth += STRIDE
        self._depth = depth
        speed_dps = depth * HALF_CLOCK_HZ // span
        return speed_dps if self._sign > 0 else -speed_dps

    def _find_time(self, back: int) -> int:
        """Return when the axle reached the count that is `back` counts before the newest one, in ticks of the clock."""
        counter = self._counter
        count = self.count
        sign = self._sign
        before = back - abs(count - counter.count)
        if before >= 0:
            return counter.find_time(before)
        edge = count if sign > 0 else count + 1
        way_deg = sign * (self._axle.angle_deg - edge / 2) + back / 2
        return floor(self._now - self._find_age_s(way_deg) * CLOCK_HZ)

    def _find_age_s(self, way_deg: float) -> float:
        """Return how many seconds ago the axle was `way_deg` behind its present angle."""
        sign = self._sign
        constant_s = self._constant_s
        speed_dps, goal_dps = sign * self._axle.speed_dps, sign * self._goal_dps
        gain_dps2 = (goal_dps - speed_dps) / constant_s
        age_s = 2 * way_deg / (speed_dps + sqrt(max(speed_dps**2 - 2 * gain_dps2 * way_deg, 0.0)))
        error_s = inf
        while abs(error_s) > MAX_ERROR_S:
            faster_dps = (speed_dps - goal_dps) * expm1(age_s / constant_s)
            passed_deg = goal_dps * age_s + faster_dps * constant_s
            error_s = (passed_deg - way_deg) / (speed_dps + faster_dps)
            age_s -= error_s
        return age_s

    def tell_counter(self) -> None:
        """Add the newest counts of the roll to the counter: those over which the driver may still measure a speed."""
        times: list[int] = []
        for back in range(abs(self.count - self._counter.count)):
            times.append(self._find_time(back))
            if back >= KEPT_COUNTS and times[0] - times[back] > KEPT_SPAN:
                break
        self._counter.add_straight(self.count, times[::-1])


def begin_roll(axle: Axle, counter: Counter, begin_ns: int) -> Roll | None:
    """Return the `Roll` that an axle begins at a time; None if the axle turns too slowly, or not freely."""
    if abs(axle.speed_dps) < MIN_ROLL_DPS or axle.low_deg > -inf or axle.high_deg < inf:
        return None
    is_straight = counter.is_straight(axle.speed_dps)
    if not is_straight or begin_ns * TICKS_PER_NS - counter.find_time(0) > MIN_IDLE / 2:
        return None
    roll = Roll(axle, counter, begin_ns)
    return roll if roll.end_ns >= begin_ns + MIN_ROLL_NS else None
