"""Calls of motors of a brick and of the browser simulator."""

from __future__ import annotations

from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.commands.calls import Values

DrivenMotor = BrickMotor | BrowserMotor


def start(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run at a speed until the next command."""
    motor.run(*values)


def start_timed(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run at a speed until a tick."""
    motor.run_until(*values)


def start_move(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run to a position, at a speed, backwards or not."""
    goal_deg, speed_dps, backwards = values
    motor.run_to(goal_deg, speed_dps, bool(backwards))


def stop(motor: DrivenMotor, _time_ns: int, _values: Values) -> None:
    """Stop."""
    motor.stop()


def set_count(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Set the number that the encoder shows as its present position."""
    motor.position_deg = values[0]


def limit_ramps(motor: BrickMotor, _time_ns: int, values: Values) -> None:
    """Limit the acceleration of the move that has begun, and its deceleration before its end."""
    motor.slowest_ramp_dps2, motor.approach_dps2 = values


def set_speed(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set the speed that the register follows."""
    motor.speed_sp = values[0]


def set_backwards(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set the direction of moves to a position, also of one that is under way or over."""
    motor.backwards = bool(values[0])


def set_roll(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set in which direction the wheel rolls: 1 as the encoder counts, -1 the other way.

    Raises:
        ValueError: the value is neither.
    """
    if abs(values[0]) != 1.0:
        raise ValueError(f"{values[0]!r} is not a direction")
    motor.roll_sign = values[0]
