"""Calls of motors of the Pybricks firmware, of their controllers, and of drive bases. Numbers are whole, in counts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.engine.core.commands.calls import find_index
from tuisim.engine.core.servo.control import Controller, Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import ControlSettings

if TYPE_CHECKING:
    from tuisim.engine.core.servo.drive_base import DriveBase
    from tuisim.engine.core.simulation import Simulation

SETTINGS: tuple[str, ...] = tuple(ControlSettings.__dataclass_fields__)
"""The settings of a controller, in the order of their numbers, which count from 0."""


def _find_motor(sim: Simulation, part: int) -> ServoMotor:
    motor = sim.motors[part]
    assert isinstance(motor, ServoMotor)
    return motor


def _find_ending(values: tuple[float, ...], place: int) -> Ending:
    return Ending(find_index(values, place, len(Ending)))


def _read_optional(number: float) -> int | None:
    """Return a number, or None for NaN."""
    return int(number) if number == number else None


def _change_setting(control: Controller, values: tuple[float, ...]) -> None:
    """Change one setting, by its number."""
    name = SETTINGS[find_index(values, 0, len(SETTINGS))]
    control.settings = replace(control.settings, **{name: int(values[1])})


def begin_anew(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Begin anew: the sign of the motor's direction, the gear ratio, whether the angle is kept."""
    sign, ratio, keeps_angle = values
    _find_motor(sim, part).set_up(time_ns // 1000, int(sign), ratio, keeps_angle=bool(keeps_angle))


def run_freely(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Run with a power, or coast."""
    _find_motor(sim, part).run_freely(time_ns // 1000, _read_optional(values[0]))


def set_milli(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Make the current position another one."""
    _find_motor(sim, part).set_position(time_ns // 1000, int(values[0]))


def hold(sim: Simulation, time_ns: int, part: int, _values: tuple[float, ...]) -> None:
    """Let the controller stay where the motor is."""
    motor = _find_motor(sim, part)
    now_us = time_ns // 1000
    motor.control.hold(now_us, motor.measure_start(now_us).milli)


def hold_milli(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Let the controller stay at a position."""
    _find_motor(sim, part).control.hold(time_ns // 1000, int(values[0]))


def run_control(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Let the controller run at a rate, with an acceleration, for a time in microseconds or without an end.

    The motor follows it with an ending, if one is given.
    """
    rate, acceleration, time_us, ending = values
    motor = _find_motor(sim, part)
    motor.control.run(
        time_ns // 1000, motor.measure_start, int(rate), int(acceleration), _read_optional(time_us)
    )
    if ending == ending:
        motor.follow(ending=_find_ending(values, 3))


def move(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Let the controller move to a position, at a rate, with an acceleration, relative or not."""
    target, rate, acceleration, relative = values
    motor = _find_motor(sim, part)
    motor.control.move_to_position(
        time_ns // 1000,
        motor.measure_start,
        int(target),
        int(rate),
        int(acceleration),
        relative=bool(relative),
    )


def follow(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Follow the controller, which has just got its trajectory, with an ending.

    Raises:
        ValueError: it has got none.
    """
    motor = _find_motor(sim, part)
    if motor.control.trajectory is None:
        raise ValueError("there is no trajectory to follow")
    motor.follow(ending=_find_ending(values, 0))


def limit_duty(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Limit the power of the current move."""
    _find_motor(sim, part).control.duty_limit = _read_optional(values[0])


def set_control(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Change a setting of a motor's controller: its number, and the value."""
    _change_setting(_find_motor(sim, part).control, values)


# Drive bases


def build_base(sim: Simulation, _time_ns: int, _part: int, values: tuple[float, ...]) -> None:
    """Make a drive base of two motors: their numbers, the wheels' diameter, the track."""
    # Imported on demand: only programs with a drive base need it.
    from tuisim.engine.core.servo.drive_base import DriveBase

    left, right = (_find_motor(sim, find_index(values, place, len(sim.motors))) for place in (0, 1))
    sim.bases.add(DriveBase(left, right, *values[2:]))


def _find_base(sim: Simulation, part: int) -> DriveBase:
    return sim.bases[part]


def move_base(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Drive a distance and turn by an angle, with an ending."""
    distance_mm, turn_deg, _ = values
    _find_base(sim, part).move(time_ns // 1000, distance_mm, turn_deg, _find_ending(values, 2))


def drive_base(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Drive on at a speed and a rate of turn."""
    speed, turn_rate = map(int, values)
    _find_base(sim, part).drive(time_ns // 1000, speed, turn_rate)


def stop_base(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Let go of the motors, and run them with a power or let them coast."""
    _find_base(sim, part).stop(time_ns // 1000, _read_optional(values[0]))


def set_base(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set how it usually moves."""
    speed, acceleration, turn_rate, turn_acceleration = map(int, values)
    _find_base(sim, part).set_usual((speed, acceleration, turn_rate, turn_acceleration))


def set_slowing(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set how a drive base stops, otherwise than it speeds up."""
    straight, turn = map(int, values)
    _find_base(sim, part).set_slowing(straight, turn)


def use_gyro(sim: Simulation, time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Let the gyro tell the heading, or the wheels."""
    find_heading = (lambda: sim.gyro_deg) if values[0] else None
    _find_base(sim, part).use_gyro(time_ns // 1000, find_heading)


def set_base_control(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Change a setting of a controller of a drive base: 0 for the distance or 1 for the heading, number, value."""
    base = _find_base(sim, part)
    control = (base.distance, base.heading)[find_index(values, 0, 2)]
    _change_setting(control, values[1:])
