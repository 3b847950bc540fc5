"""A drive base: two controllers, one for the sum and one for the difference of two motors' counts.

The sum is how far the robot drives, the difference how far it turns, clockwise positive.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

from tuisim.engine.core.servo.control import Controller, Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import (
    FIRMWARES,
    MODELS,
    ControlSettings,
    combine_settings,
    compute_motor_settings,
)
from tuisim.engine.core.servo.trajectory import MILLI, Measure, Segment, Trajectory

if TYPE_CHECKING:
    from tuisim.engine.core.profile import MotorLaw


def compute_base_settings(
    motor: ControlSettings, wheel_diameter_mm: float, axle_track_mm: float
) -> tuple[ControlSettings, ControlSettings]:
    """Return the settings of a drive base's controllers: of the distance in mm, and of the heading in degrees.

    Args:
        motor: The settings of each of its motors.
        wheel_diameter_mm, axle_track_mm: The robot's sizes.
    """
    per_deg = motor.counts_per_unit
    heading = combine_settings(motor, 2 * per_deg * axle_track_mm / wheel_diameter_mm)
    return (
        combine_settings(motor, 2 * per_deg * 360 / (pi * wheel_diameter_mm)),
        replace(heading, torque_unm=2 * heading.torque_unm),
    )


Pace = tuple[int, ...]
"""Speed, acceleration, rate of turn and its acceleration."""


def compute_usual_settings(
    law: MotorLaw, distance: ControlSettings, heading: ControlSettings
) -> tuple[Pace, Pace]:
    """Return the default speeds and accelerations of a drive base twice: in mm and degrees, and in counts.

    Those in counts may be more exact, because those in mm and degrees are whole numbers. Each `Pace` has the speed and
    the acceleration of straight moves, then those of turns.

    Args:
        law: The firmware that moves the motors.
        distance, heading: The settings of the drive base's two controllers.
    """
    firmware = FIRMWARES[law]
    controls = distance, distance, heading, heading
    limits = distance.speed, distance.acceleration, heading.speed, heading.acceleration
    rows = [*zip(controls, limits, firmware.pace, strict=True)]
    if not distance.torque_unm:
        units = [control.units(limit) * part // whole for control, limit, (part, whole) in rows]
        counts = [control.counts(unit) for control, unit in zip(controls, units, strict=True)]
    else:
        units = [control.tell(limit * part / whole) for control, limit, (part, whole) in rows]
        counts = [limit * part // whole for _, limit, (part, whole) in rows]
    return (*units,), (*counts,)


def compute_new_pace(law: MotorLaw, wheel_diameter_mm: float, axle_track_mm: float) -> Pace:
    """Return the default speeds and accelerations of a new drive base with large motors.

    They are in mm/s, mm/s², °/s and °/s², in this order.
    """
    motor = compute_motor_settings(law, "large")
    settings = compute_base_settings(motor, wheel_diameter_mm, axle_track_mm)
    return compute_usual_settings(law, *settings)[0]


def describe_new_motors(law: MotorLaw) -> dict[str, dict[str, str]]:
    """Return the limits and tolerances of a new motor as texts, by kind of motor and then by name of the setting."""
    return {kind: compute_motor_settings(law, kind).describe() for kind in MODELS}


def _move_relative(
    control: Controller,
    now_us: int,
    measured: Measure,
    way: float,
    speed: int,
    acceleration: int,
    deceleration: int | None,
) -> None:
    counts = control.settings.counts
    target = counts(int(way)) if way == int(way) else round(way * control.settings.counts_per_unit)
    control.move_to_position(
        now_us, measured, target, speed, acceleration, relative=True, deceleration=deceleration
    )


class DriveBase:
    """Two motors that move a robot together. The drive base is the `Guide` of both while it moves or holds them.

    Args:
        left, right: The motors, which have the same settings.
        wheel_diameter_mm, axle_track_mm: The robot's sizes.
        find_gyro_deg: Returns the heading that the robot's gyro shows, clockwise.
    """

    __slots__ = (
        "_at_us",
        "_behind_us",
        "_ending",
        "_find_gyro_deg",
        "_goal",
        "_millis",
        "_offset",
        "_pace",
        "_slowing",
        "distance",
        "heading",
        "left",
        "motors",
        "right",
        "uses_gyro",
        "usual",
    )

    def __init__(
        self,
        left: ServoMotor,
        right: ServoMotor,
        wheel_diameter_mm: float,
        axle_track_mm: float,
        find_gyro_deg: Callable[[], float],
    ) -> None:
        self._find_gyro_deg = find_gyro_deg
        self.left = left
        self.right = right
        self.motors = (left, right)
        motor = left.control.settings
        distance, heading = compute_base_settings(motor, wheel_diameter_mm, axle_track_mm)
        self.distance = Controller(distance, slips=True)
        """Controls the sum of both motors' positions: the distance, in mm for the program."""
        self.heading = Controller(heading, slips=True)
        """Controls the difference of the motors' positions: the heading, in degrees for the program."""
        self.usual, self._pace = compute_usual_settings(left.law, distance, heading)
        """How it moves, unless the program says something else: in mm and degrees, and in counts; until the program
        sets it, these are not rounded to whole units."""
        self._slowing: tuple[int | None, int | None] = None, None
        """Decelerations of straight moves and of turns, in counts; None for the same as the acceleration."""
        self._ending = Ending.HOLD
        self._goal: tuple[int, int, float] | None = None
        """Of a move after which the motion goes on: 0 for a distance or 1 for a turn, where the move began, and its
        length, both in thousandths of a count; None for other moves."""
        self.uses_gyro = False
        """Whether the heading comes from a gyro, not from the wheels."""
        self._offset = 0
        """How far the difference of the motors is ahead of the gyro, in thousandths of a count."""
        self._at_us = -1
        self._behind_us = -1
        self._millis = (0, 0)

    # The state of the drive base that a program can read

    @property
    def active(self) -> bool:
        """Whether both motors follow the drive base, which moves or holds them."""
        return self.left.guide is self and self.right.guide is self

    def find_millis(self, now_us: int) -> tuple[int, int]:
        """Return the sum and the difference of the motors' positions, in thousandths of a count."""
        left, right = self.left.find_milli(now_us), self.right.find_milli(now_us)
        self._follow_gyro()
        return left + right, left - right - self._offset

    def find_rates(self, now_us: int) -> tuple[int, int]:
        """Return the sum and the difference of the motors' rates, in counts per second."""
        (left, right), (left_turning, right_turning) = (
            [
                motor.find_counts_per_s(now_us, control.settings.speed_window_ms)
                for motor in self.motors
            ]
            for control in (self.distance, self.heading)
        )
        return left + right, left_turning - right_turning

    def done(self, now_us: int) -> bool:
        """Return whether no move is under way at a time in µs: none was begun, or the last one is complete."""
        if self._goal is not None:
            place, begin, way = self._goal
            return abs(self.find_millis(now_us)[place] - begin) >= way
        if self._ends_at_once and (end_us := self.end_us) is not None:
            return now_us >= end_us
        (total, difference), rates = self.find_millis(now_us), self.find_rates(now_us)
        return self.distance.done(now_us, total, rates[0]) and self.heading.done(
            now_us, difference, rates[1]
        )

    @property
    def _ends_at_once(self) -> bool:
        """Whether a move ends as soon as its trajectory does, without waiting for the motors to come to rest."""
        windowed = self.distance.settings.speed_window_ms > 0
        return windowed and self._ending in (Ending.COAST, Ending.BRAKE)

    def lets_go(self, now_us: int, _rate: int) -> bool:
        """Return whether a motor whose motion has ended stops following this drive base at a time in µs."""
        return self.done(now_us)

    @property
    def stalled(self) -> bool:
        """Whether something has blocked the robot that the drive base moves."""
        return self.distance.stalled or self.heading.stalled

    # The gyro

    def use_gyro(self, now_us: int, uses_gyro: bool) -> None:
        """Measure the heading with the gyro, or with the wheels if `uses_gyro` is False; let the motors coast."""
        self.stop(now_us, None)
        self.uses_gyro = uses_gyro
        self._offset = 0
        window_ms = 0 if uses_gyro else self.distance.settings.speed_window_ms
        self.heading.settings = replace(self.heading.settings, speed_window_ms=window_ms)

    def _follow_gyro(self) -> None:
        """If the gyro is in use, store by how much the heading that the motors measure differs from its heading."""
        if self.uses_gyro:
            counts = self._find_gyro_deg() * self.heading.settings.counts_per_unit
            self._offset = self.left.milli - self.right.milli - round(counts * MILLI)

    # Commands

    def set_usual(self, *usual: int) -> None:
        """Set the default speed, acceleration, turn rate and turn acceleration, in mm/s, mm/s², °/s and °/s².

        A value that equals the present one does not replace it: the present one may be more exact than a whole number.
        """
        distance = self.distance.settings
        heading = self.heading.settings
        self._pace = tuple(
            before if value == known else control.counts(value)
            for value, known, before, control in zip(
                usual, self.usual, self._pace, (distance, distance, heading, heading), strict=True
            )
        )
        self._slowing = None, None
        self.usual = usual

    def set_slowing(self, straight: int, turn: int) -> None:
        """Set the decelerations of straight moves, in mm/s², and of turns, in °/s²."""
        counts = self.distance.settings.counts, self.heading.settings.counts
        self._slowing = counts[0](straight), counts[1](turn)

    def move(
        self, now_us: int, distance_mm: float, turn_deg: float, ending: Ending = Ending.HOLD
    ) -> None:
        """Begin to drive a distance and to turn by an angle, both at the same time: along an arc.

        Args:
            now_us: The present time.
            distance_mm: The distance; 0 to turn on the spot.
            turn_deg: The angle, clockwise; 0 to drive straight.
            ending: What the motors do after the move.

        Raises:
            ValueError: the usual speed is 0, or the move takes too long.
        """
        if ending is Ending.NONE:
            return self._run_endlessly(now_us, distance_mm, turn_deg)
        self._begin(now_us)
        speed, acceleration, turn_rate, turn_acceleration = self._pace
        stop, turn_stop = self._slowing
        _move_relative(
            self.distance, now_us, self._measure_total, distance_mm, speed, acceleration, stop
        )
        turning = turn_rate, turn_acceleration, turn_stop
        _move_relative(self.heading, now_us, self._measure_difference, turn_deg, *turning)
        if distance_mm and turn_deg:
            fast, slow = sorted((self.distance, self.heading), key=lambda one: one.end_us or 0)
            fast.match_pace(slow)
        self._take(ending)

    def _run_endlessly(self, now_us: int, distance_mm: float, turn_deg: float) -> None:
        """Begin to drive a distance and to turn by an angle; after that the motion goes on at the same speed."""
        self._begin(now_us)
        place = 0 if distance_mm else 1
        control = (self.distance, self.heading)[place]
        length = abs(distance_mm or turn_deg) * control.settings.counts_per_unit * MILLI
        self._goal = place, self.find_millis(now_us)[place], length
        speed, acceleration, rate, turn_acceleration = self._pace
        distance = self.distance
        heading = self.heading
        if distance_mm:
            forwards = speed if distance_mm > 0 else -speed
            distance.run(now_us, self._measure_total, forwards, acceleration)
            turn = round(MILLI * turn_deg * heading.settings.counts_per_unit)
            way = round(MILLI * distance_mm * distance.settings.counts_per_unit)
            heading.run_in_proportion(now_us, self._measure_difference, distance, turn, way)
        else:
            _move_relative(distance, now_us, self._measure_total, 0, speed, acceleration, None)
            clockwise = rate * ((turn_deg > 0) - (turn_deg < 0))
            heading.run(now_us, self._measure_difference, clockwise, turn_acceleration)
        self._take(Ending.HOLD)

    def drive(self, now_us: int, speed_mm_s: int, turn_rate_dps: int) -> None:
        """Begin to drive at a speed and a clockwise rate of turn, until the next command."""
        self._begin(now_us)
        distance = self.distance
        heading = self.heading
        ours = distance.settings
        other = heading.settings
        accelerations = (
            (self._pace[1], self._pace[3])
            if ours.speed_window_ms
            else (ours.acceleration, other.acceleration)
        )
        distance.run(now_us, self._measure_total, ours.counts(speed_mm_s), accelerations[0])
        heading.run(now_us, self._measure_difference, other.counts(turn_rate_dps), accelerations[1])
        self._take(Ending.HOLD)

    def stop(self, now_us: int, duty: int | None) -> None:
        """Stop controlling the motors, and run them with a constant power.

        Args:
            now_us: The present time.
            duty: The power in hundredths of a percent; 0 brakes the motors, None lets them coast.
        """
        for motor in self.motors:
            motor.run_freely(now_us, duty)
        self.distance.release()
        self.heading.release()

    def _measure_total(self, now_us: int) -> Segment:
        left, right = self.left.measure_start(now_us), self.right.measure_start(now_us)
        return Segment(now_us, left.milli + right.milli, self.find_rates(now_us)[0], 0)

    def _measure_difference(self, now_us: int) -> Segment:
        left, right = self.left.measure_start(now_us), self.right.measure_start(now_us)
        self._follow_gyro()
        turned = left.milli - right.milli - self._offset
        return Segment(now_us, turned, self.find_rates(now_us)[1], 0)

    def _begin(self, now_us: int) -> None:
        """Prepare for a new motion. If the drive base moves both motors already, the new motion goes on from there.

        Otherwise, the new motion begins at rest; if one motor still follows the drive base, it coasts.
        """
        self._goal = None
        if not self.active:
            for motor in self.motors:
                if motor.guide is self:
                    motor.run_freely(now_us, None)
            self.distance.release()
            self.heading.release()

    def _take(self, ending: Ending) -> None:
        self._at_us = self._behind_us = -1
        self._ending = ending
        for motor in self.motors:
            motor.follow(self, ending)

    # The methods of a `Guide`, which the motors call

    @property
    def trajectory(self) -> Trajectory | None:
        """The trajectory of the distance, a new object for each move; None while nothing moves or holds the motors."""
        return self.distance.trajectory

    @property
    def end_us(self) -> int | None:
        """Time in µs at which the drive base's motion ends; None if the motion has no end."""
        one = self.distance.end_us
        other = self.heading.end_us
        return None if one is None or other is None else max(one, other)

    def find_target(self, now_us: int, motor: ServoMotor) -> int:
        """Return the position that one of the motors should have at a time in µs, in half thousandths of a count."""
        if now_us != self._at_us:
            self._follow_gyro()
            self._at_us, self._millis = (
                now_us,
                (self.distance.milli(now_us), self.heading.milli(now_us) + self._offset),
            )
        total, difference = self._millis
        return total + difference if motor is self.left else total - difference

    def rate(self, now_us: int, motor: ServoMotor) -> float:
        """Return the rate that one of the motors should have at a time in µs, in counts per second."""
        total = self.distance.rate(now_us)
        difference = self.heading.rate(now_us)
        return (total + difference) / 2 if motor is self.left else (total - difference) / 2

    def find_segment_end_us(self, now_us: int) -> int | None:
        """Return the next time in µs at which a segment of the two trajectories ends; None if none of them ends.

        While the drive base moves by the gyro, it is the next microsecond: the gyro corrects the motors at every tick.
        """
        if self.uses_gyro and (self.end_us is None or now_us < self.end_us):
            # The gyro corrects the motors at every tick, so no segment lasts longer.
            return now_us + 1
        ends = [
            end
            for control in (self.distance, self.heading)
            if (end := control.find_segment_end_us(now_us)) is not None
        ]
        return min(ends, default=None)

    def note_lag(self, now_us: int, passed_us: int, _milli: int, _rate: int) -> None:
        """React to motors that lag behind their trajectory: call `Controller.note_lag` for distance and heading.

        A second call for the same time, by the other motor, does nothing.
        """
        if now_us == self._behind_us:
            return
        self._behind_us, self._at_us = now_us, -1
        left, right = (motor.milli for motor in self.motors)
        left_rate, right_rate = (motor.counts_per_s for motor in self.motors)
        self.distance.note_lag(now_us, passed_us, left + right, left_rate + right_rate)
        turned = left - right - self._offset
        self.heading.note_lag(now_us, passed_us, turned, left_rate - right_rate)
