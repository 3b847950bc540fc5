"""Calls of motors of the Pybricks firmware, of their controllers, and of drive bases. Numbers are whole, in counts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.engine.core.commands.calls import Values, find_index
from tuisim.engine.core.servo.control import Controller, Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import ControlSettings

if TYPE_CHECKING:
    from tuisim.engine.core.servo.drive_base import DriveBase
    from tuisim.engine.core.simulation import Simulation

SETTINGS: tuple[str, ...] = tuple(ControlSettings.__dataclass_fields__)
"""The settings of a controller, in the order of their numbers, which count from 0."""


def _find_ending(values: Values, place: int) -> Ending:
    return Ending(find_index(values, place, len(Ending)))


def _read_optional(number: float) -> int | None:
    """Return a value as a whole number; None for NaN."""
    return int(number) if number == number else None


def _change_setting(control: Controller, values: Values) -> None:
    """Change one setting of a controller. Values: the index in `SETTINGS`, and the new value."""
    name = SETTINGS[find_index(values, 0, len(SETTINGS))]
    control.settings = replace(control.settings, **{name: int(values[1])})


def begin_anew(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Set a motor up as new. Values: the sign of its direction, the gear ratio, whether it keeps its angle."""
    sign, ratio, keeps_angle = values
    motor.set_up(time_ns // 1000, int(sign), ratio, keeps_angle=bool(keeps_angle))


def run_freely(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Run with a power, or coast."""
    motor.run_freely(time_ns // 1000, _read_optional(values[0]))


def set_milli(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Set the number that the motor shows as its present position, in thousandths of a count."""
    motor.set_position(time_ns // 1000, int(values[0]))


def hold(motor: ServoMotor, time_ns: int, _values: Values) -> None:
    """Let the motor's controller hold the present position."""
    now_us = time_ns // 1000
    motor.control.hold(now_us, motor.measure_start(now_us).milli)


def hold_milli(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Let the motor's controller hold a position, in thousandths of a count."""
    motor.control.hold(time_ns // 1000, int(values[0]))


def run_control(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Let the motor's controller run. Values: the rate, the acceleration, the time in microseconds (NaN: no end).

    The fourth value is an ending, with which the motor follows its controller from now on; NaN leaves it as it is.
    """
    rate, acceleration, time_us, ending = values
    motor.control.run(
        time_ns // 1000, motor.measure_start, int(rate), int(acceleration), _read_optional(time_us)
    )
    if ending == ending:
        motor.follow(ending=_find_ending(values, 3))


def move(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Let the motor's controller move. Values: target, rate, acceleration, whether the target is relative."""
    *numbers, relative = values
    motor.control.move_to_position(
        time_ns // 1000, motor.measure_start, *map(int, numbers), relative=bool(relative)
    )


def follow(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Let a motor follow its own controller, which has just got its trajectory; the value is the ending.

    Raises:
        ValueError: the controller has no trajectory.
    """
    if motor.control.trajectory is None:
        raise ValueError("there is no trajectory to follow")
    if (ending := _find_ending(values, 0)) is Ending.NONE:
        motor.control.keep_running(time_ns // 1000, motor.measure_start)
        ending = Ending.HOLD
    motor.follow(ending=ending)


def limit_duty(motor: ServoMotor, _time_ns: int, values: Values) -> None:
    """Limit the power of the current move."""
    motor.control.duty_limit = _read_optional(values[0])


def set_control(motor: ServoMotor, _time_ns: int, values: Values) -> None:
    """Change a setting of a motor's controller. Values: as of `_change_setting`."""
    _change_setting(motor.control, values)


# Drive bases


def build_base(sim: Simulation, _time_ns: int, values: Values) -> None:
    """Make a drive base. Values: the numbers of two motors, the wheels' diameter, the track."""
    # Imported on demand: only programs with a drive base need it.
    from tuisim.engine.core.servo.drive_base import DriveBase

    left, right = (sim.motors[find_index(values, place, len(sim.motors))] for place in (0, 1))
    assert isinstance(left, ServoMotor) and isinstance(right, ServoMotor)
    _, _, diameter_mm, track_mm = values
    sim.bases.add(DriveBase(left, right, diameter_mm, track_mm, lambda: sim.gyro_deg))


def move_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Drive a distance and turn by an angle, with an ending."""
    distance_mm, turn_deg, _ = values
    base.move(time_ns // 1000, distance_mm, turn_deg, _find_ending(values, 2))


def drive_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Drive on at a speed and a rate of turn."""
    base.drive(time_ns // 1000, *map(int, values))


def stop_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Let go of a drive base's motors: run them with a power, or let them coast (NaN)."""
    base.stop(time_ns // 1000, _read_optional(values[0]))


def set_base(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Set speeds and accelerations with which a drive base moves unless the program gives others."""
    base.set_usual(*map(int, values))


def set_slowing(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Set with which accelerations a drive base stops, if not with those with which it speeds up."""
    base.set_slowing(*map(int, values))


def use_gyro(base: DriveBase, time_ns: int, values: Values) -> None:
    """Let the gyro tell a drive base the heading, or the wheels again."""
    base.use_gyro(time_ns // 1000, bool(values[0]))


def set_base_control(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Change a setting of a drive base. Values: 0 for the distance or 1 for the heading; index; new value."""
    control = (base.distance, base.heading)[find_index(values, 0, 2)]
    _change_setting(control, values[1:])
