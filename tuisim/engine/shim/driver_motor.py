"""Tacho motors of a brick with ev3dev: every attribute as the kernel's class of motors has it.

`polarity` negates what is read and written from then on: a set point that was written before the change keeps its
direction.
"""

from __future__ import annotations

from functools import partial

from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.driver import COMMAND_CALLS, CONSTANTS, CONTROLS, STOP_ACTIONS
from tuisim.engine.core.driver.motor import STATES, Command, SetPoints
from tuisim.engine.core.driver.regulator import StopAction
from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.protocol import MotorRegisters
from tuisim.engine.shim.device_files import NumberWriter, Reader, SimDevice, refuse
from tuisim.engine.shim.motor import COMMANDS, MAX_SET_POINT, SignedTacho

SET_POINTS = (
    "speed_sp",
    "position_sp",
    "duty_cycle_sp",
    "time_sp",
    "ramp_up_sp",
    "ramp_down_sp",
)
"""The motor attributes that are set points, in the order of the fields of `SetPoints`."""
STOP_ACTION = len(SET_POINTS)
SIGNED = ("speed_sp", "position_sp", "duty_cycle_sp")
FIRST_SET_POINTS = (*map(float, SetPoints()[:STOP_ACTION]), 0.0)
"""The values of `SET_POINTS`, and then the number of the stop action, of a motor after a reset."""


class DriverTacho(SignedTacho):
    """The driver of one motor on a port, which has the attributes of the kernel's `tacho-motor` class."""

    _motor: SimulatedMotor

    def _set_up(self) -> None:
        self._set_points = [*FIRST_SET_POINTS]
        self._look = lambda: self._now().noticed_ns

    def device(self) -> SimDevice:
        """Return the motor as a device of `/sys/class/tacho-motor`."""
        readers: dict[str, Reader] = {
            "position": lambda: self._now().position * self._sign,
            "speed": lambda: self._now().speed_dps * self._sign,
            "duty_cycle": lambda: self._now().duty * self._sign,
            "state": lambda: STATES[self._now().state_bits],
        }
        numbers: dict[str, NumberWriter] = {"position": self._set_position}
        for name in SET_POINTS:
            readers[name] = partial(self._set_point, name)
            numbers[name] = self._set_point_writer(name, *self._limits(name))
        for control, group in enumerate(CONTROLS):
            for constant, field in enumerate(CONSTANTS):
                name = f"{group}_pid/{field.capitalize()}"
                controller = getattr(self._motor, f"{group}_control")
                readers[name] = partial(getattr, controller, field)
                numbers[name] = self._constant_writer(control, constant)
        return self._device(readers, {}, numbers)

    def _now(self) -> SimulatedMotor:
        """Return the simulated motor, advanced to the present time."""
        motor = self._motor
        if not motor.is_at_rest:
            motor.run_until(self._session.now)
        return motor

    def registers(self) -> MotorRegisters:
        """Return the values that the program has written to the motor's attributes, and the motor's speed."""
        speed, position, time_ms = (
            self._set_point(name) for name in ("speed_sp", "position_sp", "time_sp")
        )
        speed_dps = self._motor.speed_dps * self._sign
        return MotorRegisters(
            self._last_command, self._polarity, speed, position, time_ms / 1000, speed_dps
        )

    def _set_point(self, name: str) -> int:
        number = int(self._set_points[SET_POINTS.index(name)])
        return number * self._sign if name in SIGNED else number

    def _set_point_writer(self, name: str, low: int, high: int) -> NumberWriter:
        index = SET_POINTS.index(name)
        signed = name in SIGNED
        set_points = self._set_points

        def write(value: int) -> None:
            if not low <= value <= high:
                raise refuse(str(value))
            set_points[index] = float(value * self._sign if signed else value)
            if name == "duty_cycle_sp":
                self._tell(Call.SET_DUTY, set_points[index])

        return write

    def _constant_writer(self, control: int, constant: int) -> NumberWriter:
        def write(value: int) -> None:
            if not 0 <= value <= MAX_SET_POINT:
                raise refuse(str(value))
            self._tell(Call.SET_CONSTANT, float(control), float(constant), float(value))

        return write

    def _set_position(self, value: int) -> None:
        self._tell(Call.RENUMBER, float(value * self._sign))

    def _set_stop_action(self, text: str) -> None:
        super()._set_stop_action(text)
        self._set_points[STOP_ACTION] = float(STOP_ACTIONS.index(StopAction(text)))

    def _command(self, text: str) -> None:
        if text not in COMMANDS:
            raise refuse(text)
        call = COMMAND_CALLS[Command(text)]
        self._session.command()
        self._tell(call, *self._set_points)
        if call is Call.RESET_DRIVER:
            self._set_points[:] = FIRST_SET_POINTS
            self._stop_action = "coast"
            self._set_polarity("normal")
