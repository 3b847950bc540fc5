"""The state of the world at one tick."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB, ProfileSpec
from tuisim.engine.core.spec import MOTOR_ENDS, NoiseSpec, RobotSpec
from tuisim.engine.core.tick_record import FLAG_FIRST_END

MotorValues: TypeAlias = tuple[int, int, int, int]
"""Values of one motor, in the order of `MOTOR_FIELDS`."""


@dataclass(frozen=True, slots=True)
class Instant:
    """One moment of a run: the values that the telemetry stores for a tick."""

    tick: int
    pose: Pose
    left_position_deg: float = 0.0
    right_position_deg: float = 0.0
    left_speed_dps: float = 0.0
    right_speed_dps: float = 0.0
    turn_rate_dps: float = 0.0
    """Rate of turn of the robot over the last tick, counter-clockwise, as a gyro senses it."""
    gyro_zero_deg: float = 0.0
    """Heading at which the gyro reads 0."""
    press_flags: int = 0
    """End stops that motors are at, and touch sensors that a hand presses: the bits of `PRESS_FLAGS`."""
    noise: NoiseSpec = NoiseSpec()
    drift: DriftSpec = NO_DRIFT
    profile: ProfileSpec = ROBOLAB
    seed: int = 0
    motors: tuple[MotorValues, ...] = ()
    """The values of all motors' drivers; empty if the motors have no drivers, or the values were not requested."""
    scales: tuple[float, ...] = ()
    """How many degrees the program counts for one degree of each motor; empty if this was not requested."""

    def get_scale(self, number: int) -> float:
        """Return how many degrees the program counts while a motor turns by one degree.

        `number` is the motor's number among all motors.
        """
        return self.scales[number] if number < len(self.scales) else 1.0

    @property
    def gyro_deg(self) -> int:
        """The clockwise angle since the gyro's last reset, in whole degrees, not wrapped."""
        return round(self.gyro_zero_deg - self.pose.heading_deg)

    @property
    def gyro_rate_dps(self) -> int:
        """The clockwise rate of turn, in whole degrees per second, limited to what the gyro can measure."""
        fastest = self.profile.gyro_max_dps or inf
        return round(max(-fastest, min(fastest, -self.turn_rate_dps)))


@dataclass(frozen=True, slots=True)
class Present:
    """The values that a program would read between two ticks, as far as they can differ from those of the last tick."""

    turns: tuple[tuple[float, float], ...]
    """Position in degrees and speed in degrees per second of each motor."""
    motors: tuple[MotorValues, ...]
    scales: tuple[float, ...]
    gyro_zero_deg: float
    pen_down: bool
    actions: int
    """The number of user actions in the record of the tick; a further user action makes these values outdated."""

    def apply(self, instant: Instant) -> Instant:
        """Return a copy of the last tick's instant in which these values replace those of the tick."""
        left, right, *_ = self.turns
        return replace(
            instant,
            left_position_deg=left[0],
            right_position_deg=right[0],
            left_speed_dps=left[1],
            right_speed_dps=right[1],
            gyro_zero_deg=self.gyro_zero_deg,
            motors=self.motors,
            scales=self.scales,
        )


def end_flag(robot: RobotSpec, port: str, end: str) -> int:
    """Return the flag in a tick record for an end stop: it is set while the motor on a port is there.

    `end` is one of `MOTOR_ENDS`.
    """
    number = [motor.port for motor in robot.extra_motors].index(port)
    return FLAG_FIRST_END << len(MOTOR_ENDS) * number + MOTOR_ENDS.index(end)
