"""The effects of commands to motors of the Pybricks firmware, to their controllers, and to drive bases.

Numbers are whole, in counts.
"""

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

MAX_BASES = 256
"""Only so many newest drive bases have numbers: a program may make one in each turn of a loop."""
SETTINGS: tuple[str, ...] = tuple(ControlSettings.__dataclass_fields__)
"""The settings of a controller, in the order of their numbers, which count from 0."""


def _find_ending(values: Values, place: int) -> Ending:
    return Ending(find_index(values, place, len(Ending)))


def _read_optional(number: float) -> int | None:
    """Return a value of a command as an int; None for NaN, with which a program leaves the value out."""
    return int(number) if number == number else None


def _change_setting(control: Controller, values: Values) -> None:
    """Change one setting of a controller; `values` are the setting's index in `SETTINGS` and its new value."""
    name = SETTINGS[find_index(values, 0, len(SETTINGS))]
    control.settings = replace(control.settings, **{name: int(values[1])})


def begin_anew(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Reset a motor, as when a program creates a new object for it.

    Args:
        motor: The motor.
        time_ns: When the program does so.
        values: 1 or -1 for the direction, the gear ratio, and whether the motor keeps its angle (1) or sets it to 0
            (0).
    """
    sign, ratio, keeps_angle = values
    motor.set_up(time_ns // 1000, int(sign), ratio, keeps_angle=bool(keeps_angle))


def run_freely(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Run a motor with a constant power in hundredths of a percent: 0 brakes it, NaN lets it coast."""
    motor.run_freely(time_ns // 1000, _read_optional(values[0]))


def set_milli(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Set the value that the motor reports for its present position, without moving it.

    The value is in thousandths of a count, the firmware's unit of angles.
    """
    motor.set_position(time_ns // 1000, int(values[0]))


def hold(motor: ServoMotor, time_ns: int, _values: Values) -> None:
    """Make the motor's controller hold the present position."""
    now_us = time_ns // 1000
    motor.control.hold(now_us, motor.measure_start(now_us).milli)


def hold_milli(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Make the motor's controller hold a given position, in thousandths of a count, the firmware's unit of angles."""
    motor.control.hold(time_ns // 1000, int(values[0]))


def run_control(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Make the motor's controller run at a speed.

    Args:
        motor: The motor.
        time_ns: When the program gives the command.
        values: The speed in counts per second, the acceleration in counts per second squared, the duration in
            microseconds (NaN: endless), and an `Ending`. If the `Ending` is NaN, only the controller changes; otherwise
            the motor begins to follow the controller.
    """
    rate, acceleration, time_us, ending = values
    motor.control.run(
        time_ns // 1000, motor.measure_start, int(rate), int(acceleration), _read_optional(time_us)
    )
    if ending == ending:
        motor.follow(ending=_find_ending(values, 3))


def move(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Make the motor's controller move to a position.

    Args:
        motor: The motor.
        time_ns: When the program gives the command.
        values: The target in counts, the speed in counts per second, the acceleration in counts per second squared, and
            1 if the target is relative to the present position, else 0.
    """
    *numbers, relative = values
    motor.control.move_to_position(
        time_ns // 1000, motor.measure_start, *map(int, numbers), relative=bool(relative)
    )


def follow(motor: ServoMotor, time_ns: int, values: Values) -> None:
    """Make a motor follow the trajectory that its own controller has just computed; the value is an `Ending`.

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
    """Limit the power of the motor's present motion, and let the motion go on until the motor stalls.

    The value is the highest power in hundredths of a percent; NaN is no limit.
    """
    motor.control.duty_limit = _read_optional(values[0])
    motor.control.seeks_stall = True


def set_control(motor: ServoMotor, _time_ns: int, values: Values) -> None:
    """Change one setting of a motor's controller; `values` are the setting's index in `SETTINGS` and its new value."""
    _change_setting(motor.control, values)


# Drive bases


def build_base(sim: Simulation, _time_ns: int, values: Values) -> None:
    """Create a drive base from two motors; once there are `MAX_BASES`, it gets the number of the oldest one.

    Args:
        sim: The simulation.
        values: Numbers of the left and the right motor, diameter of the wheels and axle track in mm.
    """
    # Imported on demand: only programs with a drive base need it.
    from tuisim.engine.core.servo.drive_base import DriveBase

    left, right = (sim.motors[find_index(values, place, len(sim.motors))] for place in (0, 1))
    assert isinstance(left, ServoMotor) and isinstance(right, ServoMotor)
    _, _, diameter_mm, track_mm = values
    bases = sim.bases
    number = len(bases) if len(bases) < MAX_BASES else next(iter(bases))
    bases.pop(number, None)
    bases[number] = DriveBase(left, right, diameter_mm, track_mm, lambda: sim.gyro_deg)


def move_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Make a drive base drive a distance and turn by an angle at the same time.

    `values` are the distance in mm, the angle in degrees, clockwise, and an `Ending`.
    """
    distance_mm, turn_deg, _ = values
    base.move(time_ns // 1000, distance_mm, turn_deg, _find_ending(values, 2))


def drive_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Make a drive base drive until the next command.

    `values` are the speed in mm/s and the rate of turn in degrees per second, clockwise.
    """
    base.drive(time_ns // 1000, *map(int, values))


def stop_base(base: DriveBase, time_ns: int, values: Values) -> None:
    """Stop controlling a drive base, and run its motors with a power.

    The value is the power in hundredths of a percent; 0 brakes the motors, NaN lets them coast.
    """
    base.stop(time_ns // 1000, _read_optional(values[0]))


def set_base(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Set the default speed, acceleration, turn rate and turn acceleration of a drive base.

    `values` are these four numbers, in mm/s, mm/s², °/s and °/s².
    """
    base.set_usual(*map(int, values))


def set_slowing(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Set the decelerations of a drive base in straight moves and in turns; by default they equal its accelerations.

    `values` are these two numbers, in mm/s² and °/s².
    """
    base.set_slowing(*map(int, values))


def use_gyro(base: DriveBase, time_ns: int, values: Values) -> None:
    """Make a drive base take its heading from the gyro if the value is 1, and from its wheels if it is 0."""
    base.use_gyro(time_ns // 1000, bool(values[0]))


def set_base_control(base: DriveBase, _time_ns: int, values: Values) -> None:
    """Change a setting of one of a drive base's two controllers.

    Args:
        base: The drive base.
        values: 0 for the controller of the distance or 1 for that of the heading, an index in `SETTINGS`, the new
            value.
    """
    control = (base.distance, base.heading)[find_index(values, 0, 2)]
    _change_setting(control, values[1:])
