"""The effects of commands to motors with the kernel's driver."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from tuisim.engine.core.commands.calls import Call, Values, find_index
from tuisim.engine.core.driver.motor import Command, SetPoints
from tuisim.engine.core.driver.regulator import StopAction
from tuisim.engine.core.driver.simulated import SimulatedMotor

COMMAND_CALLS: dict[Command, Call] = {
    command: Call(Call.RUN_FOREVER + number) for number, command in enumerate(Command)
}
"""The call of each command of the driver; its values are those of `SetPoints`."""
STOP_ACTIONS = (*StopAction,)
"""The stop actions, in the order of their numbers in commands, from 0."""
MAX_SET_POINTS = 1024
"""Number of set points that are cached, because a control loop gives the same ones again and again."""
CONTROLS = ("speed", "hold")
CONSTANTS = ("kp", "ki", "kd")


@lru_cache(MAX_SET_POINTS)
def _build_set_points(values: Values) -> SetPoints:
    speed_dps, position, duty, time_ms, ramp_up_ms, ramp_down_ms, _ = map(int, values)
    action = STOP_ACTIONS[find_index(values, 6, len(STOP_ACTIONS))]
    return SetPoints(speed_dps, position, duty, time_ms, ramp_up_ms, ramp_down_ms, action)


def build_effect(command: Command) -> Callable[[SimulatedMotor, int, Values], None]:
    """Return a function that gives a motor this command of the kernel's driver.

    The function takes the motor, the time in ns, and the values of all set points.
    """

    def obey(motor: SimulatedMotor, time_ns: int, values: Values) -> None:
        motor.obey(time_ns, command, _build_set_points(values))

    return obey


def set_duty(motor: SimulatedMotor, time_ns: int, values: Values) -> None:
    """Set the duty of a motor to `values[0]` percent, as `DriverMotor.set_duty` does."""
    motor.set_duty(time_ns, int(values[0]))


def set_position(motor: SimulatedMotor, time_ns: int, values: Values) -> None:
    """Set the value that the motor reports for its present position to `values[0]` degrees, without moving it."""
    motor.wake(time_ns)
    motor.set_position(int(values[0]))


def set_constant(motor: SimulatedMotor, time_ns: int, values: Values) -> None:
    """Set a constant of one of the motor's two controllers.

    Args:
        motor: The motor.
        time_ns: When the program sets it.
        values: An index in `CONTROLS`, an index in `CONSTANTS`, and the new value.
    """
    control = CONTROLS[find_index(values, 0, len(CONTROLS))]
    name = CONSTANTS[find_index(values, 1, len(CONSTANTS))]
    motor.wake(time_ns)
    setattr(getattr(motor, f"{control}_control"), name, int(values[2]))
