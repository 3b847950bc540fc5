"""A drive base: two controllers, one for the sum and one for the difference of two motors' counts.

The sum is how far the robot drives, the difference how far it turns, clockwise positive.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from tuisim.engine.core.motors import FOREVER
from tuisim.engine.core.servo.control import Controller, Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import FIRMWARES, ControlSettings, combine_settings
from tuisim.engine.core.servo.trajectory import Measure, Segment

if TYPE_CHECKING:
    from tuisim.engine.core.profile import MotorLaw


def compute_base_settings(
    left: ControlSettings, right: ControlSettings, wheel_diameter_mm: float, axle_track_mm: float
) -> tuple[ControlSettings, ControlSettings]:
    """Return the settings of both controllers: of the distance in mm, and of the heading in degrees."""
    per_deg = left.counts_per_unit
    return (
        combine_settings(left, right, 2 * per_deg * 360 / (pi * wheel_diameter_mm)),
        combine_settings(left, right, 2 * per_deg * axle_track_mm / wheel_diameter_mm),
    )


def compute_usual_settings(
    law: MotorLaw, distance: ControlSettings, heading: ControlSettings
) -> tuple[int, int, int, int]:
    """Return speed, acceleration, rate of turn and its acceleration of a new drive base, in mm and degrees."""
    firmware = FIRMWARES[law]

    def scale(control: ControlSettings, counts: int, fraction: tuple[int, int]) -> int:
        if firmware.divides_units:
            return control.units(counts) * fraction[0] // fraction[1]
        return round(counts * fraction[0] / fraction[1] / control.counts_per_unit)

    return (
        scale(distance, distance.speed, firmware.straight_speed),
        scale(distance, distance.acceleration, firmware.straight_acceleration),
        scale(heading, heading.speed, firmware.turn_rate),
        scale(heading, heading.acceleration, firmware.turn_acceleration),
    )


def _move_relative(
    control: Controller, now_us: int, measured: Measure, way: float, speed: int, acceleration: int
) -> None:
    counts = control.settings.counts
    target = counts(int(way)) if way == int(way) else round(way * control.settings.counts_per_unit)
    control.move_to_position(
        now_us, measured, target, counts(speed), counts(acceleration), relative=True
    )


class DriveBase:
    """Moves two motors together. It is the `Guide` of both while it moves them or holds them.

    Args:
        left, right: The motors.
        wheel_diameter_mm, axle_track_mm: The robot's sizes.
    """

    __slots__ = (
        "_at_us",
        "_behind_us",
        "_millis",
        "distance",
        "heading",
        "left",
        "motors",
        "right",
        "usual",
    )

    def __init__(
        self, left: ServoMotor, right: ServoMotor, wheel_diameter_mm: float, axle_track_mm: float
    ) -> None:
        self.left, self.right, self.motors = left, right, (left, right)
        ours = left.control.settings, right.control.settings
        distance, heading = compute_base_settings(*ours, wheel_diameter_mm, axle_track_mm)
        self.distance = Controller(distance, slips=True)
        """Controls the sum; its units are mm."""
        self.heading = Controller(heading, slips=True)
        """Controls the difference; its units are degrees."""
        self.usual = compute_usual_settings(left.law, self.distance.settings, self.heading.settings)
        """How it moves, unless the program says something else; in mm and degrees."""
        self._at_us, self._behind_us, self._millis = -1, -1, (0, 0)

    # What the program sees

    @property
    def active(self) -> bool:
        """Whether it moves or holds its motors, both of them."""
        return self.left.guide is self and self.right.guide is self

    def find_millis(self, now_us: int) -> tuple[int, int]:
        """Return sum and difference, in thousandths of a count."""
        left, right = self.left.find_milli(now_us), self.right.find_milli(now_us)
        return left + right, left - right

    def find_rates(self, now_us: int) -> tuple[int, int]:
        """Return the rates of sum and difference, in counts per second."""
        left, right = self.left.find_counts_per_s(now_us), self.right.find_counts_per_s(now_us)
        return left + right, left - right

    def done(self, now_us: int) -> bool:
        """Return whether no move is under way."""
        (total, difference), rates = self.find_millis(now_us), self.find_rates(now_us)
        return self.distance.done(now_us, total, rates[0]) and self.heading.done(
            now_us, difference, rates[1]
        )

    @property
    def stalled(self) -> bool:
        """Whether something has blocked the robot."""
        return self.distance.stalled or self.heading.stalled

    # Commands

    def move(
        self, now_us: int, distance_mm: float, turn_deg: float, ending: Ending = Ending.HOLD
    ) -> None:
        """Begin to drive a distance and to turn by an angle; if both, along an arc.

        Args:
            ending: What the motors do after the move.

        Raises:
            ValueError: the usual speed is 0, or the move takes too long.
        """
        self._begin(now_us)
        speed, acceleration, turn_rate, turn_acceleration = self.usual
        _move_relative(self.distance, now_us, self._measure_total, distance_mm, speed, acceleration)
        _move_relative(
            self.heading, now_us, self._measure_difference, turn_deg, turn_rate, turn_acceleration
        )
        if distance_mm and turn_deg:
            fast, slow = sorted((self.distance, self.heading), key=lambda one: one.end_us or 0)
            fast.match_pace(slow)
        self._take(ending)

    def drive(self, now_us: int, speed_mm_s: int, turn_rate_dps: int) -> None:
        """Drive on at a speed and a rate of turn."""
        runs = self.active and all(
            motor.mode == FOREVER and not motor.blocked_ticks for motor in self.motors
        )
        self._begin(now_us)
        distance, heading = self.distance, self.heading
        ours, other = distance.settings, heading.settings
        distance.run(now_us, self._measure_total, ours.counts(speed_mm_s), ours.acceleration)
        heading.run(
            now_us, self._measure_difference, other.counts(turn_rate_dps), other.acceleration
        )
        self._at_us = -1
        if not runs:
            self._take(Ending.HOLD)

    def stop(self, now_us: int, duty: int | None) -> None:
        """Let go of the motors, and run them with a power; see `ServoMotor.run_freely`."""
        for motor in self.motors:
            motor.run_freely(now_us, duty)
        self.distance.release()
        self.heading.release()

    def _measure_total(self, now_us: int) -> Segment:
        left, right = self.left.measure_start(now_us), self.right.measure_start(now_us)
        return Segment(now_us, left.milli + right.milli, left.rate + right.rate, 0)

    def _measure_difference(self, now_us: int) -> Segment:
        left, right = self.left.measure_start(now_us), self.right.measure_start(now_us)
        return Segment(now_us, left.milli - right.milli, left.rate - right.rate, 0)

    def _begin(self, now_us: int) -> None:
        """Make the controllers passive unless they move both motors; let go of one that is left."""
        if not self.active:
            for motor in self.motors:
                if motor.guide is self:
                    motor.run_freely(now_us, None)
            self.distance.release()
            self.heading.release()

    def _take(self, ending: Ending) -> None:
        self._at_us = self._behind_us = -1
        for motor in self.motors:
            motor.follow(self, ending)

    # As the guide of its motors

    @property
    def end_us(self) -> int | None:
        """When the motion ends; None if it does not."""
        one, other = self.distance.end_us, self.heading.end_us
        return None if one is None or other is None else max(one, other)

    def find_target(self, now_us: int, motor: ServoMotor) -> int:
        """Return where a motor is wanted to be."""
        if now_us != self._at_us:
            self._at_us, self._millis = (
                now_us,
                (self.distance.milli(now_us), self.heading.milli(now_us)),
            )
        total, difference = self._millis
        return total + difference if motor is self.left else total - difference

    def list_targets(self, times_us: range, motor: ServoMotor) -> list[int]:
        """Return where a motor is wanted to be at several times of one segment."""
        both = zip(
            self.distance.list_millis(times_us), self.heading.list_millis(times_us), strict=True
        )
        if motor is self.left:
            return [total + difference for total, difference in both]
        return [total - difference for total, difference in both]

    def rate(self, now_us: int, motor: ServoMotor) -> float:
        """Return the wanted rate of a motor, in counts per second."""
        total, difference = self.distance.rate(now_us), self.heading.rate(now_us)
        return (total + difference) / 2 if motor is self.left else (total - difference) / 2

    def find_segment_end_us(self, now_us: int) -> int | None:
        """Return when the current segment of either trajectory ends; None if neither does."""
        ends = [
            end
            for control in (self.distance, self.heading)
            if (end := control.find_segment_end_us(now_us)) is not None
        ]
        return min(ends, default=None)

    def note_lag(self, now_us: int, passed_us: int, _milli: int, _rate: int) -> None:
        """Take note that a motor is not where it is wanted to be; the second of two calls for a time does nothing."""
        if now_us == self._behind_us:
            return
        self._behind_us, self._at_us = now_us, -1
        millis, rates = (
            (motor.milli for motor in self.motors),
            (motor.counts_per_s for motor in self.motors),
        )
        (left, right), (left_rate, right_rate) = millis, rates
        self.distance.note_lag(now_us, passed_us, left + right, left_rate + right_rate)
        self.heading.note_lag(now_us, passed_us, left - right, left_rate - right_rate)
