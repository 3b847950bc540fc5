"""`hub.imu`: the heading, and the rotation and acceleration that the hub measures. The robot stays level."""

from __future__ import annotations

from math import cos, radians, sin
from typing import Any

from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.hub_spec import INSIDE
from tuisim.engine.shim.pybricks.brick import (
    Connected,
    FirmwareError,
    invalid_argument,
    round_number,
)
from tuisim.engine.shim.pybricks.matrix import Axis, Matrix, Side, cross, vector
from tuisim.engine.shim.pybricks.robotics import DriveBase

GRAVITY_MM_S2 = 9806.65
STILL_DPS = 2.0
"""A hub whose motors coast and do not turn is at rest if it turns more slowly than this, in degrees per second."""
UNCORRECTED = (
    STILL_DPS,
    2500.0,
    (0.0, 0.0, 0.0),
    (360.0, 360.0, 360.0),
    (GRAVITY_MM_S2, -GRAVITY_MM_S2) * 3,
    360.0,
)
"""What `settings` of the IMU returns for a hub that was not calibrated, in the order of its arguments."""
MAX_CORRECTION_DEG = 15
"""A program may set the heading correction, or the scale of an axis, to 360 degrees per turn plus or minus this."""


class Accelerometer(Connected):
    """The accelerometer of a hub.

    Args:
        top, front: The axes of the robot along which the top and the front of the hub point; they are perpendicular.

    Raises:
        ValueError: the axes are not perpendicular.
    """

    def __init__(self, top: Matrix, front: Matrix) -> None:
        if top.T * front:
            raise invalid_argument()
        left = cross(top, front)
        self._sides: dict[Side, Matrix] = dict(
            zip(Side, (top, -top, front, -front, left, -left), strict=True)
        )

    def _read(self, mode: str = "GYRO-ANG") -> None:
        self.brick.read(mode, INSIDE)

    def up(self, calibrated: bool = True) -> Side:
        """Return which side of the hub is up, as a member of `Side`."""
        self._read("TILT-ANG")
        return max(self._sides, key=lambda side: self._sides[side][2])

    def tilt(self, calibrated: bool = True) -> tuple[float, float]:
        """Return pitch and roll of the hub in degrees: both are 0, because a robot on the mat never tilts."""
        self._read("TILT-ANG")
        return 0.0, 0.0

    def acceleration(self, axis: Matrix | None = None, calibrated: bool = True) -> Any:
        """Return the acceleration along an axis in mm/s²; without an axis, a vector for all three."""
        self._read("TILT-ANG")
        return _along(axis, vector(0, 0, GRAVITY_MM_S2))


class IMU(Accelerometer):
    """The inertial measurement unit of a hub: its gyro and its accelerometer."""

    def __init__(self, top: Matrix, front: Matrix) -> None:
        super().__init__(top, front)
        self.brick.tell(0, Call.SET_GYRO, 0.0)
        self._settings: tuple[Any, ...] = UNCORRECTED

    @property
    def _heading(self) -> float:
        return self.brick.session.sim.gyro_deg

    @property
    def _rate_dps(self) -> float:
        """Return the robot's rate of turn in degrees per second, counter-clockwise."""
        return self.brick.session.sim.build_instant().turn_rate_dps

    def heading(self) -> float:
        """Return the heading in degrees, clockwise, which is not wrapped at 360."""
        self._read()
        return round_number(self._heading)

    def reset_heading(self, angle: float) -> None:
        """Make the hub show the heading `angle`, in degrees clockwise, at the robot's present heading.

        Raises:
            OSError: a drive base drives or holds by the gyro.
        """
        base = DriveBase.current
        if base is not None and base.holds_by_gyro:
            raise FirmwareError("Can't reset heading while gyro in use. Stop driving first.")
        self.brick.command()
        self.brick.tell(0, Call.SET_GYRO, angle)

    def ready(self) -> bool:
        """Return whether the gyro is calibrated: always True, because that happens before the program begins."""
        self._read()
        return True

    def stationary(self) -> bool:
        """Return whether the robot is at rest, and no motor is held."""
        self._read("GYRO-RATE")
        motors: Any = self.brick.session.sim.motors
        is_coasting = all(
            motor.guide is None and motor.duty is None and not motor.speed_dps for motor in motors
        )
        return is_coasting and abs(self._rate_dps) < STILL_DPS

    def angular_velocity(self, axis: Matrix | None = None, calibrated: bool = True) -> Any:
        """Return the rate of turn about an axis in degrees per second; without an axis, a vector for all three."""
        self._read("GYRO-RATE")
        return _along(axis, vector(0, 0, self._rate_dps))

    def rotation(self, axis: Matrix, calibrated: bool = True) -> float:
        """Return the turned angle in degrees about an axis since the heading was last reset."""
        self._read()
        return _along(axis, vector(0, 0, -self._heading))  # type: ignore[no-any-return]

    def orientation(self) -> Matrix:
        """Return the robot's rotation as a matrix whose columns are the directions of the robot's axes."""
        self._read()
        angle = -radians(self._heading)
        return Matrix([[cos(angle), -sin(angle), 0], [sin(angle), cos(angle), 0], [0, 0, 1]])

    def settings(
        self,
        angular_velocity_threshold: float | None = None,
        acceleration_threshold: float | None = None,
        heading_correction: float | None = None,
        angular_velocity_bias: Any = None,
        angular_velocity_scale: Any = None,
        acceleration_correction: Any = None,
    ) -> tuple[Any, ...] | None:
        """Set below which values the hub counts as at rest, and the corrections of its measurements.

        Without arguments, return these settings. In the simulation they change no measurement.

        Raises:
            ValueError: `heading_correction` or a scale, both in degrees per turn, is too far from 360.
        """
        given = (
            angular_velocity_threshold,
            acceleration_threshold,
            angular_velocity_bias,
            angular_velocity_scale,
            acceleration_correction,
            heading_correction,
        )
        if all(value is None for value in given):
            return self._settings
        turns = heading_correction or 360, *(angular_velocity_scale or ())
        if any(abs(turn_deg - 360) > MAX_CORRECTION_DEG for turn_deg in turns):
            raise invalid_argument()
        self.brick.command()
        pairs = zip(given, self._settings, strict=True)
        self._settings = tuple(before if value is None else value for value, before in pairs)
        return None


def _along(axis: Matrix | None, values: Matrix) -> Any:
    if axis is None:
        return values
    if axis.shape != Axis.X.shape or not (square := axis.T * axis):
        raise invalid_argument()
    return round_number(axis.T * values / square**0.5)
