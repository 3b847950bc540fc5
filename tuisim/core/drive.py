"""Differential drive: how two rolling wheels move the robot.

A profile's motor law also selects the arithmetic, because results that must be the same
to the last bit need the same operations in the same order. The loops over many ticks inline
the arithmetic of one tick and write the records themselves, because they are the hottest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from math import cos, degrees, radians, sin
from struct import Struct
from typing import NamedTuple, Protocol

from tuisim.core.geometry import Pose
from tuisim.core.spec import RobotSpec
from tuisim.core.state import TICK_RECORD, Buffer

_FLOAT32 = Struct("<f")
_WHOLE_TURN = 2 * math.pi


def float32(value: float) -> float:
    """Return `value` rounded to single precision, as the telemetry stores it."""
    return float(_FLOAT32.unpack(_FLOAT32.pack(value))[0])


def mm_per_degree(robot: RobotSpec) -> float:
    """Return how far a wheel rolls per degree."""
    return math.pi * robot.wheel_diameter_mm / 360.0


def turn_rate_dps(left_dps: float, right_dps: float, robot: RobotSpec) -> float:
    """Return the counter-clockwise rate of turn in degrees per second.

    Args:
        left_dps: Speed of the left wheel, degrees per second.
        right_dps: Speed of the right wheel.
        robot: Wheel diameter and spacing.
    """
    return (right_dps - left_dps) * robot.wheel_diameter_mm / (2.0 * robot.wheel_spacing_mm)


class Records(NamedTuple):
    """Destination of the records of several ticks, and the fields that are the same in all of them."""

    buffer: Buffer
    at: int
    """Offset of the first record in the buffer, in bytes."""
    tick: int
    """The first tick."""
    line: int
    flags: int
    actions: int
    tick_hz: int


class Glide(NamedTuple):
    """Motion of one wheel over several ticks."""

    rolls_deg: list[float]
    """Rotation in each tick."""
    counts_deg: list[float]
    """Encoder position after each tick."""


class EvenGlide(NamedTuple):
    """Motion of one wheel at a steady speed over several ticks."""

    roll_deg: float
    """Rotation in each tick."""
    counts_deg: Iterator[float]
    """Encoder position after each tick."""


class Drive(Protocol):
    """The robot's pose, and how its wheels change it."""

    x_mm: float
    y_mm: float
    heading_deg: float
    gyro_zero_deg: float
    """Heading at which the gyro reads 0."""

    def put(self, pose: Pose) -> None:
        """Set the robot's pose."""

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by one tick's rotation of the wheels."""

    def glide(self, records: Records, left: Glide, right: Glide) -> None:
        """Move the robot by several ticks and write a record for each."""

    def glide_evenly(self, records: Records, left: EvenGlide, right: EvenGlide) -> tuple[float, float]:
        """As `glide`, with the same rotation in each tick; returns the final encoder positions."""


class BrickDrive:
    """The drive of a brick.

    Args:
        robot: Wheel diameter and spacing.
        start: Initial pose.
        early: Fraction of a tick's turn that already applies to the motion of that tick.
    """

    __slots__ = ("_early", "_mm_per_deg", "_spacing_mm", "gyro_zero_deg", "heading_deg", "x_mm", "y_mm")

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._mm_per_deg, self._spacing_mm, self._early = mm_per_degree(robot), robot.wheel_spacing_mm, early
        self.x_mm, self.y_mm, self.heading_deg = start.x_mm, start.y_mm, start.heading_deg
        self.gyro_zero_deg = float32(start.heading_deg)

    def put(self, pose: Pose) -> None:
        """Set the robot's pose."""
        self.x_mm, self.y_mm, self.heading_deg = pose.x_mm, pose.y_mm, pose.heading_deg

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by one tick's rotation of the wheels."""
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        heading = radians(self.heading_deg + turned * self._early)
        forward = (left_mm + right_mm) / 2
        self.x_mm += forward * cos(heading)
        self.y_mm += forward * sin(heading)
        self.heading_deg += turned

    def glide(self, records: Records, left: Glide, right: Glide) -> None:
        """Move the robot by several ticks and write a record for each."""
        buffer, at, tick, line, flags, actions, hz = records
        per_deg, spacing, early, zero = self._mm_per_deg, self._spacing_mm, self._early, self.gyro_zero_deg
        x, y, heading, pack_into = self.x_mm, self.y_mm, self.heading_deg, TICK_RECORD.pack_into
        for left_deg, left_at, right_deg, right_at in zip(*left, *right, strict=True):
            left_mm, right_mm = left_deg * per_deg, right_deg * per_deg
            turned, forward = degrees((right_mm - left_mm) / spacing), (left_mm + right_mm) / 2
            way = radians(heading + turned * early)
            x += forward * cos(way)
            y += forward * sin(way)
            heading += turned
            pack_into(
                buffer, at, tick, line, x, y, heading, left_at, right_at, left_deg * hz, right_deg * hz,
                zero, flags, actions,
            )  # fmt: skip
            at += 64
            tick += 1
        self.x_mm, self.y_mm, self.heading_deg = x, y, heading

    def glide_evenly(self, records: Records, left: EvenGlide, right: EvenGlide) -> tuple[float, float]:
        """As `glide`, with the same rotation in each tick; returns the final encoder positions."""
        buffer, at, tick, line, flags, actions, hz = records
        left_mm, right_mm = left.roll_deg * self._mm_per_deg, right.roll_deg * self._mm_per_deg
        turned, forward = degrees((right_mm - left_mm) / self._spacing_mm), (left_mm + right_mm) / 2
        left_dps, right_dps, zero = left.roll_deg * hz, right.roll_deg * hz, self.gyro_zero_deg
        x, y, heading, pack_into = self.x_mm, self.y_mm, self.heading_deg, TICK_RECORD.pack_into
        early = turned * self._early
        way = radians(heading + early)
        across, up = forward * cos(way), forward * sin(way)
        left_at = right_at = 0.0
        for left_at, right_at in zip(left.counts_deg, right.counts_deg, strict=True):
            x += across
            y += up
            if turned:
                heading += turned
                way = radians(heading + early)
                across, up = forward * cos(way), forward * sin(way)
            pack_into(
                buffer, at, tick, line, x, y, heading, left_at, right_at, left_dps, right_dps, zero, flags, actions
            )
            at += 64
            tick += 1
        self.x_mm, self.y_mm, self.heading_deg = x, y, heading
        return left_at, right_at


class BrowserDrive:
    """The drive of the browser simulator: headings in radians, reduced by a whole turn when they exceed one.

    Args:
        robot: Wheel diameter and spacing.
        start: Initial pose.
        early: Fraction of a tick's turn that already applies to the motion of that tick.
    """

    __slots__ = ("_early", "_heading", "_rim_mm", "_spacing_mm", "gyro_zero_deg", "heading_deg", "x_mm", "y_mm")

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._rim_mm, self._spacing_mm, self._early = math.pi * robot.wheel_diameter_mm, robot.wheel_spacing_mm, early
        self.put(start)
        self.gyro_zero_deg = float32(self.heading_deg)

    def put(self, pose: Pose) -> None:
        """Set the robot's pose."""
        self.x_mm, self.y_mm = pose.x_mm, pose.y_mm
        self._heading = radians(pose.heading_deg)
        self.heading_deg = self._heading * 180 / math.pi

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by one tick's rotation of the wheels."""
        left_mm, right_mm = left_deg / 360 * self._rim_mm, right_deg / 360 * self._rim_mm
        turned, forward = (right_mm - left_mm) / self._spacing_mm, (left_mm + right_mm) / 2
        way = self._heading + turned * self._early
        self.x_mm += forward * cos(way)
        self.y_mm += forward * sin(way)
        if turned:
            heading = self._heading + turned
            if heading > _WHOLE_TURN:
                heading -= _WHOLE_TURN
                self.gyro_zero_deg = float32(self.gyro_zero_deg - 360)
            self._heading, self.heading_deg = heading, heading * 180 / math.pi

    def glide(self, records: Records, left: Glide, right: Glide) -> None:
        """Move the robot by several ticks and write a record for each."""
        buffer, at, tick, line, flags, actions, hz = records
        rim, spacing, early, zero = self._rim_mm, self._spacing_mm, self._early, self.gyro_zero_deg
        x, y, heading, shown, pack_into = self.x_mm, self.y_mm, self._heading, self.heading_deg, TICK_RECORD.pack_into
        whole, pi = _WHOLE_TURN, math.pi
        for left_deg, left_at, right_deg, right_at in zip(*left, *right, strict=True):
            left_mm, right_mm = left_deg / 360 * rim, right_deg / 360 * rim
            turned, forward = (right_mm - left_mm) / spacing, (left_mm + right_mm) / 2
            way = heading + turned * early
            x += forward * cos(way)
            y += forward * sin(way)
            if turned:
                heading += turned
                if heading > whole:
                    heading, zero = heading - whole, float32(zero - 360)
                shown = heading * 180 / pi
            pack_into(
                buffer, at, tick, line, x, y, shown, left_at, right_at, left_deg * hz, right_deg * hz,
                zero, flags, actions,
            )  # fmt: skip
            at += 64
            tick += 1
        self.x_mm, self.y_mm, self._heading, self.heading_deg, self.gyro_zero_deg = x, y, heading, shown, zero

    def glide_evenly(self, records: Records, left: EvenGlide, right: EvenGlide) -> tuple[float, float]:
        """As `glide`, with the same rotation in each tick; returns the final encoder positions."""
        buffer, at, tick, line, flags, actions, hz = records
        left_mm, right_mm = left.roll_deg / 360 * self._rim_mm, right.roll_deg / 360 * self._rim_mm
        turned, forward = (right_mm - left_mm) / self._spacing_mm, (left_mm + right_mm) / 2
        left_dps, right_dps, zero = left.roll_deg * hz, right.roll_deg * hz, self.gyro_zero_deg
        x, y, heading, shown, pack_into = self.x_mm, self.y_mm, self._heading, self.heading_deg, TICK_RECORD.pack_into
        whole, pi = _WHOLE_TURN, math.pi
        early = turned * self._early
        way = heading + early
        across, up = forward * cos(way), forward * sin(way)
        left_at = right_at = 0.0
        for left_at, right_at in zip(left.counts_deg, right.counts_deg, strict=True):
            x += across
            y += up
            if turned:
                heading += turned
                if heading > whole:
                    heading, zero = heading - whole, float32(zero - 360)
                shown, way = heading * 180 / pi, heading + early
                across, up = forward * cos(way), forward * sin(way)
            pack_into(buffer, at, tick, line, x, y, shown, left_at, right_at, left_dps, right_dps, zero, flags, actions)
            at += 64
            tick += 1
        self.x_mm, self.y_mm, self._heading, self.heading_deg, self.gyro_zero_deg = x, y, heading, shown, zero
        return left_at, right_at
