"""Differential drive: how two rolling wheels move the robot.

A profile's motor law also says how it reckons, because figures that are to be the same
to the last bit need the same sums in the same order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import accumulate, repeat
from math import cos, degrees, radians, sin
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
        if left_deg != right_deg:
            return self.roll_along([left_deg] * ticks, [right_deg] * ticks)
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        forward, heading = (left_mm + right_mm) / 2, radians(self.heading_deg)
        xs = list(accumulate(repeat(forward * cos(heading), ticks), initial=self.x_mm))
        ys = list(accumulate(repeat(forward * sin(heading), ticks), initial=self.y_mm))
        self.x_mm, self.y_mm = xs[-1], ys[-1]
        return Way(xs[1:], ys[1:], repeat(self.heading_deg), repeat(self.gyro_zero_deg))

    def roll_along(self, left_deg: list[float], right_deg: list[float]) -> Way:
        """Let the wheels roll for some ticks."""
        per_deg, spacing, early = self._mm_per_deg, self._spacing_mm, self._early
        x, y, heading = self.x_mm, self.y_mm, self.heading_deg
        xs, ys, headings, faced = [], [], [], False
        across = up = 0.0
        for left, right in zip(left_deg, right_deg, strict=True):
            left_mm, right_mm = left * per_deg, right * per_deg
            forward = (left_mm + right_mm) / 2
            if left_mm != right_mm:
                turned = degrees((right_mm - left_mm) / spacing)
                turn = radians(heading + turned * early)
                x += forward * cos(turn)
                y += forward * sin(turn)
                heading += turned
                faced = False
            else:
                if not faced:
                    turn = radians(heading)
                    across, up, faced = cos(turn), sin(turn), True
                x += forward * across
                y += forward * up
            xs.append(x)
            ys.append(y)
            headings.append(heading)
        self.x_mm, self.y_mm, self.heading_deg = x, y, heading
        return Way(xs, ys, headings, repeat(self.gyro_zero_deg))


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
        if left_deg != right_deg:
            return self.roll_along([left_deg] * ticks, [right_deg] * ticks)
        left_mm, right_mm = left_deg / 360 * self._rim_mm, right_deg / 360 * self._rim_mm
        forward, heading = (left_mm + right_mm) / 2, self._heading
        xs = list(accumulate(repeat(forward * cos(heading), ticks), initial=self.x_mm))
        ys = list(accumulate(repeat(forward * sin(heading), ticks), initial=self.y_mm))
        self.x_mm, self.y_mm = xs[-1], ys[-1]
        return Way(xs[1:], ys[1:], repeat(self.heading_deg), repeat(self.gyro_zero_deg))

    def roll_along(self, left_deg: list[float], right_deg: list[float]) -> Way:
        """Let the wheels roll for some ticks."""
        if left_deg == right_deg:
            return self._roll_straight(left_deg)
        way: list[tuple[float, float, float, float]] = []
        for left, right in zip(left_deg, right_deg, strict=True):
            self.roll(left, right)
            way.append((self.x_mm, self.y_mm, self.heading_deg, self.gyro_zero_deg))
        return Way(*zip(*way, strict=True))

    def _roll_straight(self, turned_deg: list[float]) -> Way:
        across, up, rim = cos(self._heading), sin(self._heading), self._rim_mm
        forward = [turned / 360 * rim for turned in turned_deg]
        # As in `roll`: half of twice a way is the way, to the last bit.
        xs = list(accumulate((mm * across for mm in forward), initial=self.x_mm))
        ys = list(accumulate((mm * up for mm in forward), initial=self.y_mm))
        self.x_mm, self.y_mm = xs[-1], ys[-1]
        return Way(xs[1:], ys[1:], repeat(self.heading_deg), repeat(self.gyro_zero_deg))
