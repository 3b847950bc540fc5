"""The numbers of the Pybricks firmware: limits, tolerances and gains, and the motors that it was tuned for.

Sources: Pybricks 2.0.0, `lib/pbio/src/{servo,control,drivebase}.c` and `extmod/modrobotics.c`; Pybricks 4.1,
`lib/pbio/src/motor/servo_settings.c`. A motor has two counts per degree.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.servo.trajectory import divide

if TYPE_CHECKING:
    from tuisim.engine.core.servo.hub_motors import HubMotor

COUNTS_PER_DEG = 2
"""Counts of a motor's encoder per degree."""
FULL_ACTUATION = 10_000
"""Full power, in hundredths of a percent."""
PAUSE_MARGIN_MS = 12
"""A controller gives up following this long before its power is used up: two turns of the firmware's loop."""
_ONE = 1 << 16


@dataclass(frozen=True, slots=True)
class ControlSettings:
    """Settings of a controller, in counts."""

    scale: int
    """Counts per unit of the program, times 65,536: the firmware computes with such fractions."""
    speed: int
    """Highest rate, in counts per second."""
    acceleration: int
    actuation: int
    """Highest power, in hundredths of a percent."""
    kp: int
    ki: int
    kd: int
    integral_range: int
    integral_rate: int
    feed_forward: int
    """Power that is added in the direction of motion, in hundredths of a percent."""
    position_tolerance: int
    """A move is done when it is this close to its target..."""
    speed_tolerance: int
    """...and slower than this."""
    stall_speed: int
    """A motor that is slower than this while its power is used up..."""
    stall_time_ms: int
    """...for this long is stalled."""
    speed_window_ms: int = 0
    """Time over which the speed is averaged to decide whether a move is done; 0 uses the present speed."""
    torque_unm: int = 0
    """The torque at full power, in micro-Nm; it is shown to programs, but has no effect."""

    @property
    def counts_per_unit(self) -> float:
        """Number of the controller's counts per unit in which the program gives positions."""
        return self.scale / _ONE

    def counts(self, units: int) -> int:
        """Return a length or angle in the program's units as counts, rounded."""
        return _multiply(units, self.scale)

    def units(self, counts: int) -> int:
        """Return a number of counts in the program's units, rounded as the firmware does with a rounded inverse."""
        return _multiply(counts, (_ONE * _ONE + self.scale // 2) // self.scale)

    def describe(self) -> dict[str, str]:
        """Return the limits and tolerances of a motor as texts, by their names."""
        moves_done = f"{self.units(self.position_tolerance)} deg, below {self.units(self.speed_tolerance)} deg/s"
        return {
            "highest speed": f"{self.units(self.speed)} deg/s",
            "acceleration and deceleration": f"{self.units(self.acceleration)} deg/s²",
            "a move is done within": moves_done,
            "stalled": f"below {self.units(self.stall_speed)} deg/s for {self.stall_time_ms} ms",
        }


def _multiply(number: int, factor: int) -> int:
    """Return a number times `factor` / 65,536, rounded."""
    size = (abs(number) * factor + _ONE // 2) // _ONE
    return size if number >= 0 else -size


@dataclass(frozen=True, slots=True)
class MotorModel:
    """Constants of a motor that limit its speed under control, as measured by the authors of the firmware."""

    resistance_ohm: float
    back_emf_v_s: float
    torque_nm_per_a: float
    friction_nm: float


MODELS: Mapping[str, MotorModel] = {
    "large": MotorModel(5.504587, 0.473084, 0.274603, 0.016476),
    "medium": MotorModel(10.727729, 0.291152, 0.245926, 0.024593),
}
"""Limits of each kind of motor, by `MotorSpec.kind`."""

BATTERY_V = 8.0
"""The voltage at which the motors' numbers hold."""


@dataclass(frozen=True, slots=True)
class ServoKind:
    """Settings that differ between kinds of motor; angles in degrees, power in percent."""

    speed: int
    acceleration: int
    gains: tuple[int, ...]
    feed_forward: int
    position_tolerance_deg: int
    torque_unm: int = 0


@dataclass(frozen=True, slots=True)
class Firmware:
    """The settings of one version of the firmware."""

    motors: Mapping[str, ServoKind]
    stall_speed_dps: int
    pace: Sequence[tuple[int, int]]
    """The usual speed and acceleration of a drive base, and those of its turns, as fractions of their limits."""
    integral: tuple[int, int]
    """`ControlSettings.integral_range` and `integral_rate`."""
    divides_units: bool
    """Whether these are fractions of limits that are rounded to units of the program."""
    speed_window_ms: int
    """The value of `ControlSettings.speed_window_ms`."""


THIRD = (1, 3)
FIRMWARES: Mapping[MotorLaw, Firmware] = {
    MotorLaw.PYBRICKS: Firmware(
        {"large": ServoKind(800, 1600, (400, 1200, 5), 0, 5), "medium": ServoKind(1000, 4000, (300, 400, 3), 20, 5)},
        15, (THIRD, THIRD, THIRD, THIRD), (45, 10), divides_units=True, speed_window_ms=0,
    ),
    MotorLaw.PYBRICKS_4: Firmware(
        {
            "large": ServoKind(800, 2000, (400, 1200, 5), 0, 10, 448_976),
            "medium": ServoKind(1200, 2000, (300, 400, 3), 20, 10, 206_319),
        },
        20, ((2, 5), (3, 8), THIRD, (3, 8)), (16, 30), divides_units=False, speed_window_ms=100,
    ),
}  # fmt: skip


def compute_motor_settings(law: MotorLaw, kind: str, gear_ratio: float = 1.0) -> ControlSettings:
    """Return the settings of a new motor.

    Args:
        kind: One of `MOTOR_KINDS`.
        gear_ratio: Turns of the motor per turn of what it drives.
    """
    firmware = FIRMWARES[law]
    motor = firmware.motors.get(kind) or _build_hub_kind(kind)
    kp, ki, kd = motor.gains
    return ControlSettings(
        scale=round(COUNTS_PER_DEG * gear_ratio * _ONE),
        speed=motor.speed * COUNTS_PER_DEG,
        acceleration=motor.acceleration * COUNTS_PER_DEG,
        actuation=FULL_ACTUATION,
        kp=kp,
        ki=ki,
        kd=kd,
        integral_range=firmware.integral[0],
        integral_rate=firmware.integral[1],
        feed_forward=motor.feed_forward * 100,
        position_tolerance=motor.position_tolerance_deg * COUNTS_PER_DEG,
        speed_tolerance=50 * COUNTS_PER_DEG,
        stall_speed=firmware.stall_speed_dps * COUNTS_PER_DEG,
        stall_time_ms=200,
        torque_unm=motor.torque_unm,
        speed_window_ms=firmware.speed_window_ms,
    )


def find_steady_dps(kind: str, actuation: int) -> float:
    """Return the speed that a kind of motor reaches in the end at a power; 0 if friction keeps it at rest."""
    model = MODELS.get(kind) or _find_hub_motor(kind).plant
    ideal_dps = BATTERY_V * abs(actuation) / FULL_ACTUATION / model.back_emf_v_s * 180 / pi
    friction_v = model.resistance_ohm * model.friction_nm / model.torque_nm_per_a
    speed = max(0.0, ideal_dps - friction_v / model.back_emf_v_s * 180 / pi)
    return speed if actuation >= 0 else -speed


def _build_hub_kind(kind: str) -> ServoKind:
    """Return the settings of a hub's motor. Gains are converted to hundredths of a percent of the power per count."""
    motor = _find_hub_motor(kind)
    gains = tuple(
        round(gain * FULL_ACTUATION / motor.torque_unm / COUNTS_PER_DEG) for gain in motor.gains
    )
    return ServoKind(motor.speed_dps, 2000, gains, 0, motor.tolerance_deg, motor.torque_unm)


def _find_hub_motor(kind: str) -> HubMotor:
    from tuisim.engine.core.servo.hub_motors import MOTORS

    return MOTORS[kind]


def combine_settings(motor: ControlSettings, counts_per_unit: float) -> ControlSettings:
    """Return the settings of one controller of a drive base, which moves the sum or the difference of two motors.

    Args:
        motor: The settings of each motor.
        counts_per_unit: Counts of the sum or the difference per mm or degree of the robot.
    """
    return replace(
        motor,
        scale=round(counts_per_unit * _ONE),
        speed=2 * motor.speed,
        acceleration=4 * motor.acceleration,
        actuation=2 * motor.actuation,
        kp=divide(motor.kp, 2),
        ki=divide(motor.ki, 2),
        kd=divide(motor.kd, 2),
        integral_range=2 * motor.integral_range,
        integral_rate=2 * motor.integral_rate,
        position_tolerance=2 * motor.position_tolerance,
        speed_tolerance=2 * motor.speed_tolerance,
        stall_speed=2 * motor.stall_speed,
    )
