"""Differential drive: how two rolling wheels move the robot.

A profile's motor law also says how it reckons, because figures that are to be the same
to the last bit need the same sums in the same order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import accumulate, islice, repeat
from math import cos, degrees, radians, sin
from operator import add, mul
from struct import Struct
from typing import NamedTuple, Protocol

from tuisim.core.geometry import Pose
from tuisim.core.spec import RobotSpec

_FLOAT32 = Struct("<f")


def float32(value: float) -> float:
    """Return `value` as the telemetry stores it, so that viewers and programs see the same."""
    return float(_FLOAT32.unpack(_FLOAT32.pack(value))[0])


def mm_per_degree(robot: RobotSpec) -> float:
    """Return how far a wheel rolls for one degree of turn."""
    return math.pi * robot.wheel_diameter_mm / 360.0


def turn_rate_dps(left_dps: float, right_dps: float, robot: RobotSpec) -> float:
    """Return the counter-clockwise rate of turn in degrees per second.

    Args:
        left_dps: Turning speed of the left wheel, degrees per second.
        right_dps: Turning speed of the right wheel.
        robot: Wheel diameter and spacing.
    """
    return (right_dps - left_dps) * robot.wheel_diameter_mm / (2.0 * robot.wheel_spacing_mm)


class Way(NamedTuple):
    """Where the robot is after each of some ticks."""

    x_mm: Iterable[float]
    y_mm: Iterable[float]
    heading_deg: Iterable[float]
    gyro_zero_deg: Iterable[float]


class Drive(Protocol):
    """Where the robot is, and how its wheels move it."""

    x_mm: float
    y_mm: float
    heading_deg: float
    gyro_zero_deg: float
    """Heading at which the gyro shows 0."""

    def put(self, pose: Pose) -> None:
        """Put the robot somewhere."""

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Let the wheels roll by what one tick turns them."""

    def roll_evenly(self, ticks: int, left_deg: float, right_deg: float) -> Way:
        """Let the wheels roll by the same for some ticks."""

    def roll_along(self, left_deg: list[float], right_deg: list[float]) -> Way:
        """Let the wheels roll for some ticks."""


def tracks(
    forward: Iterable[float], ways: Iterable[float], x_mm: float, y_mm: float
) -> tuple[list[float], list[float]]:
    """Return x and y from a place on, after each of some ticks.

    Args:
        forward: How far each goes, in mm.
        ways: In which direction, in radians.
        x_mm: Where the first begins.
        y_mm: Where the first begins.
    """
    directions = list(ways)
    steps = list(islice(forward, len(directions)))
    xs = list(accumulate(map(mul, steps, map(cos, directions)), initial=x_mm))
    return xs, list(accumulate(map(mul, steps, map(sin, directions)), initial=y_mm))


class BrickDrive:
    """The drive of a brick.

    Args:
        robot: Wheel diameter and spacing.
        start: Where the robot is.
        early: Which part of a tick's turn counts already for the way of that tick.
    """

    __slots__ = ("_early", "_mm_per_deg", "_spacing_mm", "gyro_zero_deg", "heading_deg", "x_mm", "y_mm")

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._mm_per_deg, self._spacing_mm, self._early = mm_per_degree(robot), robot.wheel_spacing_mm, early
        self.x_mm, self.y_mm, self.heading_deg = start.x_mm, start.y_mm, start.heading_deg
        self.gyro_zero_deg = float32(start.heading_deg)

    def put(self, pose: Pose) -> None:
        """Put the robot somewhere."""
        self.x_mm, self.y_mm, self.heading_deg = pose.x_mm, pose.y_mm, pose.heading_deg

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Let the wheels roll by what one tick turns them."""
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        heading = radians(self.heading_deg + turned * self._early)
        forward = (left_mm + right_mm) / 2
        self.x_mm += forward * cos(heading)
        self.y_mm += forward * sin(heading)
        self.heading_deg += turned

    def roll_evenly(self, ticks: int, left_deg: float, right_deg: float) -> Way:
        """Let the wheels roll by the same for some ticks."""
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        return self._roll((left_mm + right_mm) / 2, turned, ticks)

    def _roll(self, forward: float, turned: float, ticks: int) -> Way:
        early = turned * self._early
        if not turned:
            return self._straight([forward] * ticks)
        headings = list(accumulate(repeat(turned, ticks), initial=self.heading_deg))
        self.heading_deg = headings[-1]
        ways = [radians(heading + early) for heading in headings[:-1]]
        return self._along(repeat(forward), ways, headings[1:])

    def _straight(self, forward: list[float]) -> Way:
        ways = repeat(radians(self.heading_deg), len(forward))
        return self._along(forward, ways, repeat(self.heading_deg))

    def _along(self, forward: Iterable[float], ways: Iterable[float], headings: Iterable[float]) -> Way:
        xs, ys = tracks(forward, ways, self.x_mm, self.y_mm)
        self.x_mm, self.y_mm = xs[-1], ys[-1]
        return Way(xs[1:], ys[1:], headings, repeat(self.gyro_zero_deg))

    def roll_along(self, left_deg: list[float], right_deg: list[float]) -> Way:
        """Let the wheels roll for some ticks."""
        per_deg, spacing, early = self._mm_per_deg, self._spacing_mm, self._early
        left_mm, right_mm = [deg * per_deg for deg in left_deg], [deg * per_deg for deg in right_deg]
        forward = [(left + right) / 2 for left, right in zip(left_mm, right_mm, strict=True)]
        turns = [degrees((right - left) / spacing) for left, right in zip(left_mm, right_mm, strict=True)]
        headings = list(accumulate(turns, initial=self.heading_deg))
        ways = [radians(heading + turned * early) for heading, turned in zip(headings, turns)]  # noqa: B905
        self.heading_deg = headings[-1]
        return self._along(forward, ways, headings[1:])


class BrowserDrive:
    """The drive of the browser simulator: headings in radians, which drop by a whole turn when they pass it upwards.

    Args:
        robot: Wheel diameter and spacing.
        start: Where the robot is.
        early: Which part of a tick's turn counts already for the way of that tick.
    """

    __slots__ = ("_early", "_heading", "_rim_mm", "_spacing_mm", "gyro_zero_deg", "heading_deg", "x_mm", "y_mm")

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._rim_mm, self._spacing_mm, self._early = math.pi * robot.wheel_diameter_mm, robot.wheel_spacing_mm, early
        self.put(start)
        self.gyro_zero_deg = float32(self.heading_deg)

    def put(self, pose: Pose) -> None:
        """Put the robot somewhere."""
        self.x_mm, self.y_mm = pose.x_mm, pose.y_mm
        self._heading = radians(pose.heading_deg)
        self.heading_deg = self._heading * 180 / math.pi

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Let the wheels roll by what one tick turns them."""
        left_mm, right_mm = left_deg / 360 * self._rim_mm, right_deg / 360 * self._rim_mm
        turned, forward = (right_mm - left_mm) / self._spacing_mm, (left_mm + right_mm) / 2
        way = self._heading + turned * self._early
        self.x_mm += forward * cos(way)
        self.y_mm += forward * sin(way)
        if turned:
            self._turn(turned)

    def _turn(self, turned: float) -> None:
        self._heading += turned
        if self._heading > 2 * math.pi:
            self._heading -= 2 * math.pi
            self.gyro_zero_deg = float32(self.gyro_zero_deg - 360)
        self.heading_deg = self._heading * 180 / math.pi

    def roll_evenly(self, ticks: int, left_deg: float, right_deg: float) -> Way:
        """Let the wheels roll by the same for some ticks."""
        left_mm, right_mm = left_deg / 360 * self._rim_mm, right_deg / 360 * self._rim_mm
        turned, forward = (right_mm - left_mm) / self._spacing_mm, (left_mm + right_mm) / 2
        return self._along(repeat(forward, ticks), repeat(turned, ticks))

    def roll_along(self, left_deg: list[float], right_deg: list[float]) -> Way:
        """Let the wheels roll for some ticks."""
        rim, spacing = self._rim_mm, self._spacing_mm
        left_mm, right_mm = [deg / 360 * rim for deg in left_deg], [deg / 360 * rim for deg in right_deg]
        forward = [(left + right) / 2 for left, right in zip(left_mm, right_mm, strict=True)]
        return self._along(forward, [(right - left) / spacing for left, right in zip(left_mm, right_mm, strict=True)])

    def _along(self, forward: Iterable[float], turns: Iterable[float]) -> Way:
        turned, early = list(turns), self._early
        headings, zeros = self._headings(turned)
        ways = map(add, headings, (turn * early for turn in turned)) if early else headings[:-1]
        xs, ys = tracks(forward, ways, self.x_mm, self.y_mm)
        self.x_mm, self.y_mm, self._heading = xs[-1], ys[-1], headings[-1]
        shown = [heading * 180 / math.pi for heading in headings[1:]]
        self.heading_deg = shown[-1]
        return Way(xs[1:], ys[1:], shown, zeros)

    def _headings(self, turned: list[float]) -> tuple[list[float], Iterable[float]]:
        """Return the headings in radians from now on, and the gyro's zero after each turn."""
        headings = list(accumulate(turned, initial=self._heading))
        if max(headings[1:]) <= 2 * math.pi:
            return headings, repeat(self.gyro_zero_deg)
        headings, zeros = [self._heading], []
        for turn in turned:
            self._turn(turn)
            headings.append(self._heading)
            zeros.append(self.gyro_zero_deg)
        return headings, zeros
