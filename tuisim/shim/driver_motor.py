"""Tacho motors of a brick with ev3dev: every attribute as the kernel's class of motors has it.

`polarity` negates what is read and what is written from then on: a set point that was written before it keeps its
direction.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from tuisim.core.driver.motor import (
    CONSTANT,
    DUTY,
    POSITION,
    RESET,
    STATES,
    Command,
    Constant,
    MotorCommand,
    SetPoints,
    Setting,
)
from tuisim.core.driver.regulator import StopAction
from tuisim.core.driver.simulated import SimulatedMotor
from tuisim.protocol import MotorRegisters
from tuisim.shim.device_files import NumberWriter, Reader, SimDevice, refuse
from tuisim.shim.motor import MAX_RAMP_MS, MAX_SET_POINT, Tacho
from tuisim.shim.session import DeviceSession

SET_POINTS = (
    "speed_sp",
    "position_sp",
    "duty_cycle_sp",
    "time_sp",
    "ramp_up_sp",
    "ramp_down_sp",
)
"""Attributes, in the order of `SetPoints`."""
STOP_ACTION = len(SET_POINTS)
SIGNED = ("speed_sp", "position_sp", "duty_cycle_sp")
COMMANDS: dict[str, Command] = {command.value: command for command in Command}
STOP_ACTIONS: dict[str, StopAction] = {action.value: action for action in StopAction}
STATE_TEXTS = tuple(map(" ".join, STATES))
CONSTANTS = {"Kp": "kp", "Ki": "ki", "Kd": "kd"}


class DriverTacho(Tacho):
    """One motor as the kernel's driver exposes it."""

    def __init__(
        self, session: DeviceSession, motor: SimulatedMotor, port: str, kind: str = "large"
    ) -> None:
        super().__init__(session, port, kind)
        self._motor, self._sign = motor, 1
        self._set_points: list[Any] = [*SetPoints()]
        self._look = lambda: self._now().noticed_ns

    def device(self) -> SimDevice:
        """Return the device that the library reads and writes."""
        readers: dict[str, Reader] = {
            "position": lambda: self._now().position * self._sign,
            "speed": lambda: self._now().speed_dps * self._sign,
            "duty_cycle": lambda: self._now().duty * self._sign,
            "state": lambda: STATE_TEXTS[self._now().state_bits],
        }
        max_speed = self._kind.max_speed_dps
        limits = dict.fromkeys(SET_POINTS, (0, MAX_SET_POINT)) | {
            "speed_sp": (-max_speed, max_speed),
            "duty_cycle_sp": (-100, 100),
            "position_sp": (-MAX_SET_POINT - 1, MAX_SET_POINT),
            "ramp_up_sp": (0, MAX_RAMP_MS),
            "ramp_down_sp": (0, MAX_RAMP_MS),
        }
        numbers: dict[str, NumberWriter] = {"position": self._set_position}
        for name in SET_POINTS:
            readers[name] = partial(self._set_point, name)
            numbers[name] = self._set_point_writer(name, *limits[name])
        motor = self._motor
        for group, control in (("speed", motor.speed_control), ("hold", motor.hold_control)):
            for name, field in CONSTANTS.items():
                readers[f"{group}_pid/{name}"] = partial(getattr, control, field)
                numbers[f"{group}_pid/{name}"] = self._constant_writer(group, field)
        return self._device(readers, {}, numbers)

    def _now(self) -> SimulatedMotor:
        """Return the motor as it is now."""
        motor = self._motor
        if not motor.is_at_rest:
            motor.run_until(self._session.now)
        return motor

    def registers(self) -> MotorRegisters:
        """Return what the program has written to the motor, and its speed."""
        speed, position, time_ms = (
            self._set_point(name) for name in ("speed_sp", "position_sp", "time_sp")
        )
        speed_dps = self._motor.speed_dps * self._sign
        return MotorRegisters(
            self._last_command, self._polarity, speed, position, time_ms / 1000, speed_dps
        )

    def _set_point(self, name: str) -> int:
        number: int = self._set_points[SET_POINTS.index(name)]
        return number * self._sign if name in SIGNED else number

    def _set_point_writer(self, name: str, low: int, high: int) -> NumberWriter:
        index, signed = SET_POINTS.index(name), name in SIGNED
        set_points = self._set_points

        def write(value: int) -> None:
            if not low <= value <= high:
                raise refuse(str(value))
            set_points[index] = value * self._sign if signed else value
            if name == "duty_cycle_sp":
                self._tell(DUTY, set_points[index])

        return write

    def _constant_writer(self, control: str, field: str) -> NumberWriter:
        def write(value: int) -> None:
            if not 0 <= value <= MAX_SET_POINT:
                raise refuse(str(value))
            self._tell(CONSTANT, Constant(control, field, value))

        return write

    def _set_position(self, value: int) -> None:
        self._tell(POSITION, value * self._sign)

    def _set_stop_action(self, text: str) -> None:
        super()._set_stop_action(text)
        self._set_points[STOP_ACTION] = STOP_ACTIONS[text]

    def _set_polarity(self, text: str) -> None:
        super()._set_polarity(text)
        self._sign = -1 if text == "inversed" else 1

    def _command(self, text: str) -> None:
        command = COMMANDS.get(text)
        if command is None:
            raise refuse(text)
        self._session.command()
        self._tell(command, SetPoints(*self._set_points))
        if command is RESET:
            self._set_points[:] = SetPoints()
            self._stop_action, self._polarity, self._sign = "coast", "normal", 1

    def _tell(self, call: Command | Setting, values: SetPoints | Constant | int) -> None:
        sim = self._session.sim
        sim.command_motor(
            MotorCommand(self._session.now, sim.find_number(self._motor), call, values)
        )
