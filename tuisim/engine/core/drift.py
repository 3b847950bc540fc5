"""Drift: why the robot is not where its encoders say, and which other errors its sensors have.

The sizes of these errors are in `engine.core.drift_spec`.

Encoders count the turns of the motors. This module changes only what the turns do to the robot, so every motor law and
every drive keeps its own arithmetic: each tick's turns are replaced by those that would move a robot of the nominal
sizes as the real one moves.

Slip comes in jerks: on average a wheel loses its share of slip of the way, and the variance of the loss is the mean
loss times `JERK_MM`, so that the spread grows with the root of the way, as in the usual models of odometry (Chong &
Kleeman, Accurate Odometry and Error Modelling for a Mobile Robot, 1997).
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import cos, degrees, inf, log, pi, sin, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.drive import Drive, compute_mm_per_degree, round_to_float32, turn_rate_dps
from tuisim.engine.core.motors import find_top_speed_dps
from tuisim.engine.core.noise import draw_numbers, draw_slip
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, ColorSensorSpec, UltrasonicSpec

if TYPE_CHECKING:
    from tuisim.engine.core.spec import RunSpec

JERK_MM = 1.0
"""How far a wheel slips in one jerk: about the width of the area in which it touches the floor."""

MAX_DEVIATIONS = 3.0
"""Numbers from a normal distribution are limited to this many standard deviations."""

MAX_OVERSHOOT = 1.2
"""A motor turns no faster than this many times its top speed."""

MAX_TIMES = 3.0
"""With its errors, a wheel moves the robot at most this many times as far as the faster wheel would without them."""

_FIRST_LOSS_DEG, _LAST_LOSS_DEG = 15.0, 50.0
"""Between these angles off the normal of a surface, more and more pulses are lost: see `DriftSpec.echo_loss_pc`."""


class DrawnErrors(NamedTuple):
    """The errors of wheels, gyro and light that are drawn at random once per run."""

    left: float
    """The diameter of the left wheel, as a multiple of the robot's."""
    right: float
    spacing: float
    """The distance of the wheels, as a multiple of the robot's."""
    gyro_dps: float
    """The rate that the gyro shows while the robot stands, clockwise."""
    bright_rad: float
    """The direction from the middle of the field to its brightest side."""


def find_drift(spec: RunSpec) -> DriftSpec:
    """Return the sizes of the drift errors that apply to a run.

    The errors by which two sensors of one kind differ are 0, unless the profile follows measurements of real bricks.
    """
    drift = spec.world.drift
    if drift is NO_DRIFT or spec.profile.motor_law.is_measured:
        return drift
    return _build_equal_sensors(drift)


@lru_cache(maxsize=16)
def _build_equal_sensors(drift: DriftSpec) -> DriftSpec:
    return replace(drift, gyro_scale_pc=0.0, echo_bias_mm=0.0, light_gain_pc=0.0)


def _shape_normal(far: float, turn: float) -> float:
    """Return a normally distributed number, limited to ±`MAX_DEVIATIONS`, for two evenly distributed ones."""
    # The Box-Muller transform.
    return max(-MAX_DEVIATIONS, min(MAX_DEVIATIONS, sqrt(-2 * log(1 - far)) * cos(2 * pi * turn)))


@lru_cache(maxsize=64)
def draw_light_gain(port: str, drift: DriftSpec, seed: int) -> float:
    """Return the brightness that the colour sensor on a port sees, as a multiple of the true brightness."""
    far, turn = draw_numbers(seed, 0, f"drift/light/{port}", 2)
    return 1 + _shape_normal(far, turn) * drift.light_gain_pc / 100


@lru_cache(maxsize=64)
def draw_echo_bias_mm(port: str, drift: DriftSpec, seed: int) -> int:
    """Return the constant error in mm of the distances of the ultrasonic sensor on a port."""
    (share,) = draw_numbers(seed, 0, f"drift/echo/{port}", 1)
    return round(drift.echo_bias_mm * (share - (1 - share) / 7))


@lru_cache(maxsize=16)
def draw_errors(drift: DriftSpec, seed: int) -> DrawnErrors:
    """Return the random errors of wheels, gyro and light in a run; the same seed always gives the same errors."""
    ours = draw_numbers(seed, 0, "drift", 9)
    pairs = zip(ours[0:8:2], ours[1:8:2], strict=True)
    left, right, spacing, gyro = (_shape_normal(far, turn) for far, turn in pairs)
    return DrawnErrors(
        1 + left * drift.wheel_pc / 100,
        1 + right * drift.wheel_pc / 100,
        1 + spacing * drift.spacing_pc / 100,
        gyro * drift.gyro_dps,
        2 * pi * ours[8],
    )


def sense_turn_rate_dps(left_dps: float, right_dps: float, spec: RunSpec) -> float:
    """Return the counter-clockwise rate of turn that a gyro senses, from the speeds of the wheels' motors.

    Wheels that speed up slide a little, but for so short a time that the gyro does not sense it.
    """
    drift = find_drift(spec)
    if drift.is_none:
        return turn_rate_dps(left_dps, right_dps, spec.robot)
    drawn = draw_errors(drift, spec.seed)
    rate = turn_rate_dps(left_dps * drawn.left, right_dps * drawn.right, spec.robot)
    rate = rate / drawn.spacing * (1 - drift.turn_slip_pc / 100)
    if drift.gyro_scale_pc:
        rate += drift.gyro_scale_pc / 100 * (abs(rate) - rate) / 2
    return rate - drawn.gyro_dps


def compute_light_share(x_mm: Any, y_mm: Any, drift: DriftSpec, seed: int) -> Any:
    """Return the brightness at positions in mm, as a share of the full brightness at the brightest side of the field.

    The positions are numbers or arrays; the result is of the same type.
    """
    across, up = draw_bright_side(drift, seed)
    towards = (x_mm - FIELD_WIDTH_MM / 2) * across + (y_mm - FIELD_HEIGHT_MM / 2) * up
    return 1 - (0.5 - towards) * (drift.light_pc / 100)


@lru_cache(maxsize=16)
def draw_bright_side(drift: DriftSpec, seed: int) -> tuple[float, float]:
    """Return how much the brightness of the field increases per mm along x and along y, in a direction drawn at random.

    The numbers are scaled so that it increases by 1 from the darkest to the brightest side of the field.
    """
    way = draw_errors(drift, seed).bright_rad
    across = cos(way)
    up = sin(way)
    size_mm = FIELD_WIDTH_MM * abs(across) + FIELD_HEIGHT_MM * abs(up)
    return across / size_mm, up / size_mm


def compute_lost_echoes(flatness_deg: float, drift: DriftSpec) -> float:
    """Return the share of ultrasonic pulses, 0 … 1, that a surface does not send back to the sensor.

    `flatness_deg` is the angle between the pulse and the normal of the surface.
    """
    share = (flatness_deg - _FIRST_LOSS_DEG) / (_LAST_LOSS_DEG - _FIRST_LOSS_DEG)
    return max(0.0, min(1.0, share)) * drift.echo_loss_pc / 100


class _Wheel:
    """A wheel with errors: it slides on the floor while it speeds up or brakes, and its gears have play."""

    def __init__(self, times: float, backlash_mm: float, slip: float, tick_hz: int) -> None:
        self._times = times
        self._half_mm = backlash_mm / 2
        self._slip = slip
        self._accelerations = tick_hz * tick_hz / 1000
        self._play_mm = 0.0
        """Where the motor is in its play: from -_half_mm to _half_mm."""
        self.before_mm = 0.0
        """How far the wheel has turned in the tick before."""

    def engage_mm(self, motor_mm: float) -> float:
        """Return how far the wheel rolls in a tick, given its backlash and its real diameter.

        Args:
            motor_mm: How far a wheel without backlash and of the nominal diameter would roll.
        """
        half = self._half_mm
        if half:
            play_mm = self._play_mm + motor_mm
            self._play_mm = max(-half, min(half, play_mm))
            motor_mm = play_mm - self._play_mm
        return motor_mm * self._times

    def compute_slip_mm(self, way_mm: float) -> float:
        """Return the distance that the wheel loses in a tick because it slides; negative while it brakes.

        Args:
            way_mm: How far the wheel turns in the tick, measured at its rim.
        """
        speeding = (way_mm - self.before_mm) * self._accelerations
        self.before_mm = way_mm
        return self._slip * speeding * abs(way_mm)


class SlippingWheels:
    """The wheels of a run with drift: they slide on the floor, their gears have play, and their sizes are not exact.

    Args:
        spec: The run.
    """

    def __init__(self, spec: RunSpec) -> None:
        drift = find_drift(spec)
        hz = spec.profile.tick_hz
        drawn = draw_errors(drift, spec.seed)
        self._seed = spec.seed
        self._left_mm, self._right_mm = compute_mm_per_degree(spec.robot)
        self._left, self._right = (
            _Wheel(times, drift.backlash_deg * abs(mm), drift.slip_pc / 100, hz)
            for times, mm in ((drawn.left, self._left_mm), (drawn.right, self._right_mm))
        )
        self._spacing = drawn.spacing
        self._turn_slip = drift.turn_slip_pc / 100

    def turn_deg(self, tick: int, left_deg: float, right_deg: float) -> tuple[float, float]:
        """Return the turns of the motors with which a robot without wheel errors would move as this robot does.

        Args:
            tick: The number of the tick.
            left_deg, right_deg: How far the left and the right motor of this robot turn in the tick.

        Returns:
            The turns of the left and the right motor of the robot without errors, in degrees.
        """
        if not (left_deg or right_deg):
            self._left.before_mm = self._right.before_mm = 0.0
            return left_deg, right_deg
        left_mm, right_mm = left_deg * self._left_mm, right_deg * self._right_mm
        left, right = self._left.engage_mm(left_mm), self._right.engage_mm(right_mm)
        turning = (right - left) / 2
        lost_left, lost_right = self._left.compute_slip_mm(left), self._right.compute_slip_mm(right)
        scrubbed = self._turn_slip * turning
        if lost_left or lost_right or scrubbed:
            by_left, by_right = draw_slip(self._seed, tick)
            lost_left += sqrt((abs(lost_left) + abs(scrubbed)) * JERK_MM) * by_left - scrubbed
            lost_right += sqrt((abs(lost_right) + abs(scrubbed)) * JERK_MM) * by_right + scrubbed
        left, right = left - lost_left, right - lost_right
        forward = (left + right) / 2
        turning = (right - left) / 2 / self._spacing
        limit_mm = MAX_TIMES * max(abs(left_mm), abs(right_mm))
        left, right = (
            max(-limit_mm, min(limit_mm, way_mm))
            for way_mm in (forward - turning, forward + turning)
        )
        return left / self._left_mm, right / self._right_mm


class WrongGyro:
    """A gyro with errors: it drifts, and senses turns only up to a maximum rate.

    Args:
        spec: The run.
        drive: The drive of the robot.
    """

    def __init__(self, spec: RunSpec, drive: Drive) -> None:
        drift = find_drift(spec)
        profile = spec.profile
        self._drive = drive
        self._scale = 1 - drift.gyro_scale_pc / 100
        self._drift_deg = draw_errors(drift, spec.seed).gyro_dps / profile.tick_hz
        self._max_deg = (profile.gyro_max_dps or inf) / profile.tick_hz
        self._carry_deg = 0.0
        self._drifts = not drift.is_none

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Move the robot by the turns of its wheel motors in one tick, and add the gyro's errors to its angle."""
        drive = self._drive
        angle_deg = drive.gyro_zero_deg - drive.heading_deg
        drive.roll(left_deg, right_deg)
        turned_deg = drive.gyro_zero_deg - drive.heading_deg - angle_deg
        if -self._max_deg <= turned_deg <= self._max_deg and not self._drifts:
            return
        sensed_deg = turned_deg * self._scale if turned_deg > 0 else turned_deg
        sensed_deg = max(-self._max_deg, min(self._max_deg, sensed_deg))
        exact_deg = (
            drive.gyro_zero_deg + self._drift_deg + self._carry_deg - (turned_deg - sensed_deg)
        )
        drive.gyro_zero_deg = round_to_float32(exact_deg)
        self._carry_deg = exact_deg - drive.gyro_zero_deg


def build_slipping_wheels(spec: RunSpec) -> SlippingWheels | None:
    """Return the wheels of a run with drift errors; None if all drift errors are 0."""
    return None if find_drift(spec).is_none else SlippingWheels(spec)


def build_gyro(spec: RunSpec, drive: Drive) -> WrongGyro | None:
    """Return the gyro of a run with its errors; None if the run's gyro has no errors."""
    is_right = find_drift(spec).is_none and not spec.profile.gyro_max_dps
    return None if is_right else WrongGyro(spec, drive)


def can_strain_gyro(spec: RunSpec) -> bool:
    """Return whether the motors can turn the robot faster than its gyro can measure; noise is not considered."""
    if not spec.profile.gyro_max_dps:
        return False
    fastest_mm = sum(
        abs(mm) * find_top_speed_dps(motor.kind, spec.profile)
        for mm, motor in zip(
            compute_mm_per_degree(spec.robot), spec.robot.wheel_motors, strict=True
        )
    )
    fastest_dps = MAX_OVERSHOOT * degrees(fastest_mm / spec.robot.wheel_spacing_mm)
    return fastest_dps > spec.profile.gyro_max_dps


def describe_errors(spec: RunSpec) -> str:
    """Return a text with the random errors of wheels, gyro and sensors that a run has by its drift and its seed.

    An example is `left wheel +0.31 %, right wheel -0.12 %, …`; without drift, all numbers in it are 0.
    """
    drift = find_drift(spec)
    drawn = draw_errors(drift, spec.seed)
    sizes = {"left wheel": drawn.left, "right wheel": drawn.right, "spacing": drawn.spacing}
    parts = [f"{name} {100 * (times - 1):+.2f} %" for name, times in sizes.items()]
    parts += [f"gyro {drawn.gyro_dps:+.3f} °/s", f"light from {degrees(drawn.bright_rad):.0f}°"]
    for sensor in spec.robot.sensors:
        if drift.light_gain_pc and isinstance(sensor, ColorSensorSpec):
            gain = draw_light_gain(sensor.port, drift, spec.seed)
            parts.append(f"{sensor.name} light {100 * (gain - 1):+.1f} %")
        elif drift.echo_bias_mm and isinstance(sensor, UltrasonicSpec):
            bias_mm = draw_echo_bias_mm(sensor.port, drift, spec.seed)
            parts.append(f"{sensor.name} {bias_mm:+d} mm")
    return ", ".join(parts)
