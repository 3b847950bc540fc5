"""The numbers of the Pybricks firmware: limits, tolerances and gains, and the motors that it was tuned for.

Sources: Pybricks 2.0.0, `lib/pbio/src/{servo,control,drivebase}.c` and `extmod/modrobotics.c`; Pybricks 4.1,
`lib/pbio/src/motor/servo_settings.c`. A motor has two counts per degree.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi

from tuisim.base.data_class import dataclass
from tuisim.engine.core.driver.plant import PlantSpec
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.servo.trajectory import divide

COUNTS_PER_DEG = 2
"""Counts of a motor's encoder per degree."""
STEPS = 250
"""Steps of the firmware, thousandths of a degree, per count of the sum of two motors."""
FULL_ACTUATION = 10_000
"""Full power, in hundredths of a percent."""
PAUSE_MARGIN_MS = 12
"""A controller leaves its trajectory so long before its power is used up: two turns of the firmware's loop."""
_ONE = 1 << 16


@dataclass(frozen=True, slots=True)
class ControlSettings:
    """The limits, gains and tolerances of a controller of the Pybricks firmware, in counts."""

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
    """The gains, in hundredths of a percent of the power per count (and second); if `torque_unm` is not 0, in micro-Nm
    per degree."""
    integral_range: int
    integral_rate: int
    feed_forward: int
    """Power that is added in the direction of motion, in hundredths of a percent."""
    position_tolerance: float
    """A move is done when the motor is at most this many counts from the target, and slower than `speed_tolerance`."""
    speed_tolerance: int
    """A move is done only when the motor is slower than this, in counts per second."""
    stall_speed: int
    """A motor slower than this, in counts per second, at full power is stalled after `stall_time_ms`."""
    stall_time_ms: int
    """A motor that is slower than `stall_speed` at full power for this long is stalled."""
    speed_window_ms: int = 0
    """Time over which the speed is averaged to decide whether a move is done; 0 uses the present speed."""
    torque_unm: int = 0
    """The highest torque, in micro-Nm, of firmware that computes with torques; 0 for other firmware."""

    @property
    def counts_per_unit(self) -> float:
        """How many of the controller's counts there are in one of the program's units, a degree or a mm."""
        return self.scale / _ONE

    @property
    def _steps(self) -> int:
        """How many steps of the firmware, thousandths of a degree, are in one unit of the program; rounded down."""
        return int(self.counts_per_unit * STEPS + 1e-3)

    def tell(self, counts: float) -> int:
        """Return a rate, acceleration or tolerance, given in counts, as a whole number of the program's units.

        Version 4 of the firmware truncates the number; the earlier version rounds it.
        """
        return int(counts * STEPS / self._steps) if self.torque_unm else self.units(int(counts))

    def take(self, units: int) -> int:
        """Return a rate, acceleration or tolerance, given in the program's units, in counts; the inverse of `tell`."""
        return -(-units * self._steps // STEPS) if self.torque_unm else self.counts(units)

    def counts(self, units: int) -> int:
        """Return a length or angle in the program's units as counts, rounded."""
        return _multiply(units, self.scale)

    def units(self, counts: int) -> int:
        """Return a number of counts in the program's units, rounded as the firmware rounds it.

        The firmware multiplies by the inverse of `scale`, which is rounded itself.
        """
        return _multiply(counts, (_ONE * _ONE + self.scale // 2) // self.scale)

    def describe(self) -> dict[str, str]:
        """Return the limits and tolerances of a motor as texts, by their names."""
        moves_done = f"{self.tell(self.position_tolerance)} deg, below {self.units(self.speed_tolerance)} deg/s"
        return {
            "highest speed": f"{self.units(self.speed)} deg/s",
            "acceleration and deceleration": f"{self.units(self.acceleration)} deg/s²",
            "a move is done within": moves_done,
            "stalled": f"below {self.units(self.stall_speed)} deg/s for {self.stall_time_ms} ms",
        }


def _multiply(number: int, factor: int) -> int:
    """Return `number` times `factor` / 65,536, rounded to a whole number."""
    size = (abs(number) * factor + _ONE // 2) // _ONE
    return size if number >= 0 else -size


MODELS: Mapping[str, PlantSpec] = {
    "large": PlantSpec(5.504587, 0.473084, 0.274603, 0.002478, 1e-7, 0.016476, 0.016476),
    "medium": PlantSpec(10.727729, 0.291152, 0.245926, 0.000521, 1e-7, 0.024593, 0.024593),
}
"""What limits each kind of motor, by `MotorSpec.kind`, by the data that the firmware's authors measured."""

SPEED_WINDOW_MS = 100
"""Firmware that computes with torques averages speeds over this time, in milliseconds."""
TUNED_MV = 7500
"""Firmware that computes with torques has gains that fit the torque at this voltage, in mV."""
BATTERY_V = 8.0
"""The voltage at which the motors' numbers hold."""


@dataclass(frozen=True, slots=True)
class ServoKind:
    """The settings of one kind of motor; angles in degrees, power in percent."""

    speed: int
    position_tolerance_deg: int
    torque_unm: int = 0
    acceleration: int = 2000
    gains: tuple[int, ...] = ()
    """The gains kp, ki and kd; empty if they are computed from the torque."""
    feed_forward: int = 0
    max_mv: int = 9000
    """The voltage at which the motor has its highest torque."""

    def compute_gains(self, tolerance_deg: int) -> tuple[int, ...]:
        """Return kp, ki and kd, the gains of a motor's PID controller.

        Args:
            tolerance_deg: The tolerance from which kp and ki follow; kd follows from the motor's usual tolerance.
        """
        torque_unm = self.torque_unm * min(self.max_mv, TUNED_MV) // self.max_mv
        kp = torque_unm // tolerance_deg
        return kp, kp // 2, torque_unm // self.position_tolerance_deg // 8


@dataclass(frozen=True, slots=True)
class Firmware:
    """The settings of one version of the Pybricks firmware: those of its motors, and of its drive bases."""

    motors: Mapping[str, ServoKind]
    stall_speed_dps: int
    pace: Sequence[tuple[int, int]]
    """The usual speed and acceleration of a drive base, and those of its turns, as fractions of their limits."""
    integral: tuple[int, int]
    """`ControlSettings.integral_range` and `integral_rate`."""


THIRD = (1, 3)
# The EV3 of version 4 has its own factors of the gains, which nobody has published: here they are those of the hubs.
FIRMWARES: Mapping[MotorLaw, Firmware] = {
    MotorLaw.PYBRICKS: Firmware(
        {
            "large": ServoKind(800, 5, 0, 1600, (400, 1200, 5)),
            "medium": ServoKind(1000, 5, 0, 4000, (300, 400, 3), 20),
        },
        15, (THIRD, THIRD, THIRD, THIRD), (45, 10),
    ),
    MotorLaw.PYBRICKS_4: Firmware(
        {
            "large": ServoKind(800, 10, 448_976),
            "medium": ServoKind(1200, 10, 206_319),
            "large-angular": ServoKind(1000, 11, 560_795),
            "medium-angular": ServoKind(1000, 11, 199_554),
            "small-angular": ServoKind(620, 11, 62_415, max_mv=6000),
            "interactive": ServoKind(1200, 12, 135_083),
            "technic": ServoKind(1500, 20, 263_601),
        },
        20, ((2, 5), (1, 1), THIRD, (1, 1)), (16, 30),
    ),
}  # fmt: skip


def compute_motor_settings(law: MotorLaw, kind: str, gear_ratio: float = 1.0) -> ControlSettings:
    """Return the settings of a new motor.

    Args:
        law: The firmware that moves the motor.
        kind: One of `MOTOR_KINDS`.
        gear_ratio: Turns of the motor for one turn of the part that it drives.
    """
    firmware = FIRMWARES[law]
    motor = firmware.motors[kind]
    kp, ki, kd = motor.gains or motor.compute_gains(motor.position_tolerance_deg)
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
        speed_window_ms=SPEED_WINDOW_MS if motor.torque_unm else 0,
    )


def find_steady_dps(kind: str, actuation: int) -> float:
    """Return the speed in degrees per second that a motor reaches at a power; 0 if friction keeps it at rest.

    Args:
        kind: One of `MOTOR_KINDS`.
        actuation: The power, in hundredths of a percent.
    """
    if (model := MODELS.get(kind)) is None:
        from tuisim.engine.core.servo.hub_motors import PLANTS

        model = PLANTS[kind]
    ideal_dps = BATTERY_V * actuation / FULL_ACTUATION / model.back_emf_v_s * 180 / pi
    friction_v = model.resistance_ohm * model.friction_nm / model.torque_nm_per_a
    return max(0.0, ideal_dps - friction_v / model.back_emf_v_s * 180 / pi)


def combine_settings(motor: ControlSettings, counts_per_unit: float) -> ControlSettings:
    """Return the settings of one of a drive base's two controllers.

    One controls the sum of the motors' positions, from which the robot's distance follows, the other their difference,
    from which its heading follows.

    Args:
        motor: The settings of each motor.
        counts_per_unit: Counts of the sum or the difference per mm or degree of the robot.
    """
    has_torque = motor.torque_unm > 0
    kp = divide(motor.kp, 2)
    return replace(
        motor,
        scale=round(counts_per_unit * _ONE),
        speed=2 * motor.speed,
        acceleration=3 * motor.acceleration // 2 if has_torque else 4 * motor.acceleration,
        actuation=2 * motor.actuation,
        kp=kp,
        ki=0 if has_torque else divide(motor.ki, 2),
        kd=motor.kd if has_torque else divide(motor.kd, 2),
        integral_range=2 * motor.integral_range,
        integral_rate=2 * motor.integral_rate,
        # In version 4, it is the error at which the proportional part alone asks for the highest torque.
        position_tolerance=2
        * (COUNTS_PER_DEG * motor.torque_unm / max(kp, 1) or motor.position_tolerance),
        speed_tolerance=2 * motor.speed_tolerance,
        stall_speed=2 * motor.stall_speed,
    )
