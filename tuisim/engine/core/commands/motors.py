"""Calls of motors of a brick and of the browser simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation


_DRIVEN = BrickMotor, BrowserMotor
"""For `isinstance`: a union in its place would be built anew for each of thousands of commands."""


def _find_motor(sim: Simulation, part: int) -> BrickMotor | BrowserMotor:
    motor = sim.motors[part]
    assert isinstance(motor, _DRIVEN)
    return motor


def start(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Run at a speed until the next command."""
    _find_motor(sim, part).run(*values)


def start_timed(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Run at a speed until a tick."""
    _find_motor(sim, part).run_until(*values)


def start_move(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Run to a position, at a speed, backwards or not."""
    goal_deg, speed_dps, backwards = values
    _find_motor(sim, part).run_to(goal_deg, speed_dps, bool(backwards))


def stop(sim: Simulation, _time_ns: int, part: int, _values: tuple[float, ...]) -> None:
    """Stop."""
    _find_motor(sim, part).stop()


def set_count(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set the number that the encoder shows as its present position."""
    _find_motor(sim, part).position_deg = values[0]


def limit_ramps(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Limit the acceleration of the move that has begun, and its deceleration before its end."""
    motor = _find_motor(sim, part)
    assert isinstance(motor, BrickMotor)
    motor.slowest_ramp_dps2, motor.approach_dps2 = values


def set_speed(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set the speed that the register follows."""
    motor = _find_motor(sim, part)
    assert isinstance(motor, BrowserMotor)
    motor.speed_sp = values[0]


def set_backwards(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set the direction of moves to a position, also of one that is under way or over."""
    motor = _find_motor(sim, part)
    assert isinstance(motor, BrowserMotor)
    motor.backwards = bool(values[0])


def set_roll(sim: Simulation, _time_ns: int, part: int, values: tuple[float, ...]) -> None:
    """Set in which direction the wheel rolls: 1 as the encoder counts, -1 the other way.

    Raises:
        ValueError: the value is neither.
    """
    motor = _find_motor(sim, part)
    assert isinstance(motor, BrowserMotor)
    if abs(values[0]) != 1.0:
        raise ValueError(f"{values[0]!r} is not a direction")
    motor.roll_sign = values[0]
