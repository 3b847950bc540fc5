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
from typing import TYPE_CHECKING, NamedTuple

from tuisim.engine.core.tick_record import POSITION_FIELDS, TICK_RECORD, Buffer

if TYPE_CHECKING:
    from tuisim.engine.core.geometry import Pose
    from tuisim.engine.core.spec import RobotSpec

_FLOAT32 = Struct("<f")
_WHOLE_TURN = 2 * math.pi


def round_to_float32(value: float) -> float:
    """Return `value` rounded to single precision, as the telemetry stores it."""
    return float(_FLOAT32.unpack(_FLOAT32.pack(value))[0])


def compute_mm_per_degree(robot: RobotSpec) -> tuple[float, float]:
    """Return how many mm the left and right wheel roll forwards per degree of their motors; negative if reversed."""
    return _sign_wheels(math.pi * robot.wheel_diameter_mm / 360.0 / robot.gear_ratio, robot)


def _sign_wheels(forwards_mm: float, robot: RobotSpec) -> tuple[float, float]:
    """Return `forwards_mm` for the left and the right wheel, negative where the motor is reversed."""
    return (
        -forwards_mm if robot.left_reversed else forwards_mm,
        -forwards_mm if robot.right_reversed else forwards_mm,
    )


def turn_rate_dps(left_dps: float, right_dps: float, robot: RobotSpec) -> float:
    """Return the counter-clockwise rate of turn that results from the speeds of the wheels' motors."""
    left_dps, right_dps = (
        -left_dps if robot.left_reversed else left_dps,
        -right_dps if robot.right_reversed else right_dps,
    )
    return (
        (right_dps - left_dps)
        * robot.wheel_diameter_mm
        / (2.0 * robot.wheel_spacing_mm)
        / robot.gear_ratio
    )


class Records(NamedTuple):
    """Where to write the tick records of several ticks, and the values of the fields that are equal in all of them."""

    buffer: Buffer
    offsets: range
    """Offset of each tick's record in the buffer, in bytes."""
    ticks: range
    line: int
    flags: int
    actions: int
    tick_hz: int


def _fill(
    records: Records, offset: int, left: EvenGlide, right: EvenGlide, zero_deg: float
) -> None:
    """Fill all records from byte `offset` of the buffer on with the fields that are the same in all of them.

    The positions in these records stay 0: the caller writes them afterwards.

    Args:
        records: Where the records are written.
        offset: The byte in the buffer at which the first record to fill begins.
        left, right: How the wheels' motors move.
        zero_deg: The heading at which the gyro reads 0.
    """
    left_dps, right_dps = left.roll_deg * records.tick_hz, right.roll_deg * records.tick_hz
    zeros = 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0
    common = TICK_RECORD.pack(*zeros, left_dps, right_dps, zero_deg, records.flags, records.actions)
    end = records.offsets.stop
    records.buffer[offset:end] = common * ((end - offset) // 64)


class Glide(NamedTuple):
    """How one wheel's motor moves over several ticks: its rotation in each, and its encoder's position after each."""

    rolls_deg: list[float]
    """Rotation of the motor in each tick, in degrees."""
    counts_deg: list[float]
    """Encoder position after each tick, in degrees."""


class EvenGlide(NamedTuple):
    """How one wheel's motor moves over several ticks at a steady speed: its rotation and encoder positions."""

    roll_deg: float
    """Rotation of the motor in each tick, in degrees."""
    counts_deg: Iterator[float]
    """Encoder position after each tick, in degrees."""


def _glide_straight(
    drive: Drive, forward_mm: float, way: float, records: Records, left: EvenGlide, right: EvenGlide
) -> tuple[float, float]:
    """Move the robot by equal steps in one direction, write a record for each, and return the final encoder positions.

    Args:
        drive: The robot's drive.
        forward_mm: The length of each step.
        way: The direction, in radians.
        records: Where the records are written.
        left, right: How the wheels' motors move.
    """
    buffer, offsets, ticks, line, *_ = records
    _fill(records, offsets.start, left, right, drive.gyro_zero_deg)
    x = drive.x_mm
    y = drive.y_mm
    heading = drive.heading_deg
    pack_into = POSITION_FIELDS.pack_into
    across = forward_mm * cos(way)
    up = forward_mm * sin(way)
    left_at = right_at = 0.0
    for offset, tick, left_at, right_at in zip(
        offsets, ticks, left.counts_deg, right.counts_deg, strict=True
    ):
        x += across
        y += up
        pack_into(buffer, offset, tick, line, x, y, heading, left_at, right_at)
    drive.x_mm, drive.y_mm = x, y
    return left_at, right_at


class BrickDrive:
    """The pose of a robot with a brick, which changes with the rotation of its wheels.

    `early` chooses the heading along which the robot drives in a tick in which it turns: 0 is the heading before the
    turn, 1 the heading after the turn, and 0.5 the heading halfway between them.
    """

    __slots__ = (
        "_early",
        "_left_mm_per_deg",
        "_right_mm_per_deg",
        "_spacing_mm",
        "gyro_zero_deg",
        "heading_deg",
        "x_mm",
        "y_mm",
    )

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._left_mm_per_deg, self._right_mm_per_deg = compute_mm_per_degree(robot)
        self._spacing_mm = robot.wheel_spacing_mm
        self._early = early
        self.x_mm = start.x_mm
        self.y_mm = start.y_mm
        self.heading_deg = start.heading_deg
        self.gyro_zero_deg = round_to_float32(start.heading_deg)
        """Heading at which the gyro reads 0."""

    def put(self, pose: Pose) -> None:
        """Set the robot's pose, such as after a user has moved the robot."""
        self.x_mm = pose.x_mm
        self.y_mm = pose.y_mm
        self.heading_deg = pose.heading_deg

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by one tick's rotation of the wheels' motors."""
        left_mm, right_mm = left_deg * self._left_mm_per_deg, right_deg * self._right_mm_per_deg
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        heading = radians(self.heading_deg + turned * self._early)
        forward = (left_mm + right_mm) / 2
        self.x_mm += forward * cos(heading)
        self.y_mm += forward * sin(heading)
        self.heading_deg += turned

    def glide(self, records: Records, left: Glide, right: Glide) -> None:
        """Move the robot by several ticks of its wheels' motors, and write a tick record for each."""
        buffer, offsets, ticks, line, flags, actions, hz = records
        left_per_deg, right_per_deg = self._left_mm_per_deg, self._right_mm_per_deg
        spacing = self._spacing_mm
        early = self._early
        zero = self.gyro_zero_deg
        x = self.x_mm
        y = self.y_mm
        heading = self.heading_deg
        pack_into = TICK_RECORD.pack_into
        for offset, tick, left_deg, left_at, right_deg, right_at in zip(
            offsets, ticks, *left, *right, strict=True
        ):
            left_mm, right_mm = left_deg * left_per_deg, right_deg * right_per_deg
            turned = degrees((right_mm - left_mm) / spacing)
            forward = (left_mm + right_mm) / 2
            way = radians(heading + turned * early)
            x += forward * cos(way)
            y += forward * sin(way)
            heading += turned
            pack_into(
                buffer,
                offset,
                tick,
                line,
                x,
                y,
                heading,
                left_at,
                right_at,
                left_deg * hz,
                right_deg * hz,
                zero,
                flags,
                actions,
            )
        self.x_mm = x
        self.y_mm = y
        self.heading_deg = heading

    def glide_evenly(
        self, records: Records, left: EvenGlide, right: EvenGlide
    ) -> tuple[float, float]:
        """Move the robot through several ticks, and write a tick record for each.

        Each wheel turns by the same angle in every tick; left and right may differ.

        Returns:
            The final positions of the left and the right encoder, in degrees.
        """
        left_mm, right_mm = (
            left.roll_deg * self._left_mm_per_deg,
            right.roll_deg * self._right_mm_per_deg,
        )
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        forward = (left_mm + right_mm) / 2
        if not turned:
            return _glide_straight(self, forward, radians(self.heading_deg), records, left, right)
        buffer, offsets, ticks, line, *_ = records
        _fill(records, offsets.start, left, right, self.gyro_zero_deg)
        x = self.x_mm
        y = self.y_mm
        heading = self.heading_deg
        pack_into = POSITION_FIELDS.pack_into
        early = turned * self._early
        left_at = right_at = 0.0
        for offset, tick, left_at, right_at in zip(
            offsets, ticks, left.counts_deg, right.counts_deg, strict=True
        ):
            way = radians(heading + early)
            x += forward * cos(way)
            y += forward * sin(way)
            heading += turned
            pack_into(buffer, offset, tick, line, x, y, heading, left_at, right_at)
        self.x_mm = x
        self.y_mm = y
        self.heading_deg = heading
        return left_at, right_at


class BrowserDrive:
    """The pose of a robot of the browser simulator, which changes with the rotation of its wheels.

    The heading is computed in radians, and kept below a whole turn. `early` chooses the heading along which the robot
    drives in a tick in which it turns: 0 is the heading before the turn, 1 the heading after the turn.
    """

    __slots__ = (
        "_early",
        "_forward_mm",
        "_heading",
        "_left_deg",
        "_left_rim_mm",
        "_right_deg",
        "_right_rim_mm",
        "_spacing_mm",
        "_turn",
        "gyro_zero_deg",
        "heading_deg",
        "x_mm",
        "y_mm",
    )

    def __init__(self, robot: RobotSpec, start: Pose, early: float) -> None:
        self._left_rim_mm, self._right_rim_mm = _sign_wheels(
            math.pi * robot.wheel_diameter_mm / robot.gear_ratio, robot
        )
        """How far each wheel rolls per turn of its motor, in mm."""
        self._spacing_mm = robot.wheel_spacing_mm
        self._early = early
        self._left_deg = self._right_deg = self._forward_mm = self._turn = 0.0
        """Rotation of the wheels' motors in the last tick, and the step and turn that result from it."""
        self.put(start)
        self.gyro_zero_deg = round_to_float32(self.heading_deg)

    def put(self, pose: Pose) -> None:
        """Set the robot's pose, such as after a user has moved the robot."""
        self.x_mm, self.y_mm = pose.x_mm, pose.y_mm
        self._heading = radians(pose.heading_deg)
        self.heading_deg = self._heading * 180.0 / math.pi

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by one tick's rotation of the wheels' motors."""
        if left_deg != self._left_deg or right_deg != self._right_deg:
            self._left_deg, self._right_deg = left_deg, right_deg
            self._forward_mm, self._turn = self._step(left_deg, right_deg)
        turned = self._turn
        forward = self._forward_mm
        way = self._heading + turned * self._early
        self.x_mm += forward * cos(way)
        self.y_mm += forward * sin(way)
        if turned:
            heading = self._heading + turned
            if heading > _WHOLE_TURN:
                heading -= _WHOLE_TURN
                self.gyro_zero_deg = round_to_float32(self.gyro_zero_deg - 360)
            self._heading = heading
            self.heading_deg = heading * 180.0 / math.pi

    def _step(self, left_deg: float, right_deg: float) -> tuple[float, float]:
        """Return how far the robot moves forwards, in mm, and turns counter-clockwise, in radians.

        Args:
            left_deg, right_deg: How far the wheels' motors turn.
        """
        left_mm, right_mm = (
            left_deg / 360.0 * self._left_rim_mm,
            right_deg / 360.0 * self._right_rim_mm,
        )
        return (left_mm + right_mm) / 2, (right_mm - left_mm) / self._spacing_mm

    def glide(self, records: Records, left: Glide, right: Glide) -> None:
        """Move the robot by several ticks of its wheels' motors, and write a tick record for each."""
        buffer, offsets, ticks, line, flags, actions, hz = records
        left_rim, right_rim = self._left_rim_mm, self._right_rim_mm
        spacing = self._spacing_mm
        early = self._early
        zero = self.gyro_zero_deg
        x = self.x_mm
        y = self.y_mm
        heading = self._heading
        shown_deg = self.heading_deg
        pack_into = TICK_RECORD.pack_into
        whole = _WHOLE_TURN
        pi = math.pi
        for offset, tick, left_deg, left_at, right_deg, right_at in zip(
            offsets, ticks, *left, *right, strict=True
        ):
            left_mm, right_mm = left_deg / 360.0 * left_rim, right_deg / 360.0 * right_rim
            turned = (right_mm - left_mm) / spacing
            forward = (left_mm + right_mm) / 2
            way = heading + turned * early
            x += forward * cos(way)
            y += forward * sin(way)
            if turned:
                heading += turned
                if heading > whole:
                    heading = heading - whole
                    zero = round_to_float32(zero - 360)
                shown_deg = heading * 180.0 / pi
            pack_into(
                buffer,
                offset,
                tick,
                line,
                x,
                y,
                shown_deg,
                left_at,
                right_at,
                left_deg * hz,
                right_deg * hz,
                zero,
                flags,
                actions,
            )
        self.x_mm = x
        self.y_mm = y
        self._heading = heading
        self.heading_deg = shown_deg
        self.gyro_zero_deg = zero

    def glide_evenly(
        self, records: Records, left: EvenGlide, right: EvenGlide
    ) -> tuple[float, float]:
        """Move the robot by several ticks with equal rotations of the wheels, and write a tick record for each.

        Returns:
            The final positions of the left and the right encoder, in degrees.
        """
        forward, turned = self._step(left.roll_deg, right.roll_deg)
        if not turned:
            return _glide_straight(self, forward, self._heading, records, left, right)
        buffer, offsets, ticks, line, *_ = records
        _fill(records, offsets.start, left, right, self.gyro_zero_deg)
        x = self.x_mm
        y = self.y_mm
        heading = self._heading
        pack_into = POSITION_FIELDS.pack_into
        whole = _WHOLE_TURN
        pi = math.pi
        early = turned * self._early
        left_at = right_at = 0.0
        for offset, tick, left_at, right_at in zip(
            offsets, ticks, left.counts_deg, right.counts_deg, strict=True
        ):
            way = heading + early
            x += forward * cos(way)
            y += forward * sin(way)
            heading += turned
            if heading > whole:
                heading -= whole
                self.gyro_zero_deg = round_to_float32(self.gyro_zero_deg - 360)
                _fill(records, offset, left, right, self.gyro_zero_deg)
            pack_into(buffer, offset, tick, line, x, y, heading * 180.0 / pi, left_at, right_at)
        self.x_mm = x
        self.y_mm = y
        self._heading = heading
        self.heading_deg = heading * 180.0 / pi
        return left_at, right_at


Drive = BrickDrive | BrowserDrive
"""The robot's pose, and how its wheels change it."""
