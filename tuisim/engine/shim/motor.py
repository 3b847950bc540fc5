"""Tacho motors: set points, commands and state, as the kernel driver or the browser simulator exposes them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import partial

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.commands.calls import MAX_NUMBER, Call
from tuisim.engine.core.commands.driver import STOP_ACTIONS
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.driver.motor import Command
from tuisim.engine.core.hub_spec import HUB_MOTORS
from tuisim.engine.core.motors import MEDIUM_MAX_SPEED_DPS, POSITION, STOPPED, TIMED, Motor
from tuisim.engine.core.profile import MS
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.protocol import MotorRegisters
from tuisim.engine.runs.readings import MODES_BY_KIND, READING_CODES
from tuisim.engine.shim.device_files import NumberWriter, Reader, SimDevice, Writer, plain, refuse
from tuisim.engine.shim.session import DeviceSession

COMMANDS = (*Command,)
POLARITIES = ("normal", "inversed")
RAMPS = ("ramp_up_sp", "ramp_down_sp")
COUNT_PER_ROT = 360
MAX_RAMP_MS = 60_000
MAX_SET_POINT = 2**31 - 1
RUN = Call.RUN
RUN_UNTIL = Call.RUN_UNTIL
RUN_TO = Call.RUN_TO
STOP = Call.STOP
SET_COUNT = Call.SET_COUNT


@dataclass(frozen=True, slots=True)
class MotorKind:
    """The driver's constants for one kind of motor."""

    driver_name: str
    max_speed_dps: int
    hold_kp: int


KINDS = {
    "large": MotorKind("lego-ev3-l-motor", 1050, 80_000),
    "medium": MotorKind("lego-ev3-m-motor", int(MEDIUM_MAX_SPEED_DPS), 160_000),
    **{kind: MotorKind(f"spike-{kind}", 1000, 0) for kind in HUB_MOTORS},
}
"""The constants of the motor driver for each kind of motor, by `MotorSpec.kind`."""


class Tacho(ABC):
    """The driver of one motor on an output port, such as `outB`; the motor's kind is one of `KINDS`."""

    def __init__(self, session: DeviceSession, motor: Motor, port: str, kind: str) -> None:
        self._session = session
        self._port = port
        self._kind = KINDS[kind]
        self._motor = motor
        self._stop_action = "coast"
        self._polarity = "normal"
        self._last_command = ""
        self._look: Reader | None = None
        """Returns a value that changes whenever the driver reports a change of the motor's state; if None, the
        attribute `state` is compared instead.
        """
        self._set_up()

    @abstractmethod
    def _set_up(self) -> None:
        """Set the values that a program can write, and what else the class needs, as at the start of a run."""

    @abstractmethod
    def registers(self) -> MotorRegisters:
        """Return the values that the program has written to the motor's attributes, and the motor's speed."""

    def _tell(self, call: Call, *values: float) -> None:
        """Give a command with its values, cut off at the largest number, to the motor, at the present time."""
        sim = self._session.sim
        numbers = (max(-MAX_NUMBER, min(MAX_NUMBER, value)) for value in values)
        obey(sim, self._session.now, sim.find_number(self._motor), call, *numbers)

    @abstractmethod
    def device(self) -> SimDevice:
        """Return the motor as a device of `/sys/class/tacho-motor`."""

    def _device(
        self,
        readers: dict[str, Reader],
        writers: dict[str, Writer],
        numbers: dict[str, NumberWriter],
    ) -> SimDevice:
        """Return a device with the given attributes and those that all motors have.

        Args:
            readers: Functions that return the value of an attribute, by name.
            writers: Functions that accept the text written to an attribute, by name.
            numbers: Functions that accept a number written to an attribute, by name.
        """
        common: dict[str, Reader] = {
            "address": lambda: f"ev3-ports:{self._port}",
            "driver_name": lambda: self._kind.driver_name,
            "commands": lambda: " ".join(COMMANDS),
            "stop_actions": lambda: " ".join(STOP_ACTIONS),
            "count_per_rot": lambda: COUNT_PER_ROT,
            "max_speed": lambda: self._kind.max_speed_dps,
            "stop_action": lambda: self._stop_action,
            "polarity": lambda: self._polarity,
        }
        writers |= {
            "stop_action": self._set_stop_action,
            "polarity": self._set_polarity,
            "command": self._take_command,
        }
        notifying = {"state": self._look or readers["state"]}
        return SimDevice(
            self._session,
            common | readers,
            writers,
            None,
            numbers,
            notifying=notifying,
            codes={name: READING_CODES[self._port, name] for name in MODES_BY_KIND["motor"]},
        )

    def _limits(self, name: str) -> tuple[int, int]:
        """Return the lowest and the highest number that a program may write to the motor's attribute `name`."""
        max_speed = self._kind.max_speed_dps
        return {
            "speed_sp": (-max_speed, max_speed),
            "duty_cycle_sp": (-100, 100),
            "position_sp": (-MAX_SET_POINT - 1, MAX_SET_POINT),
            "ramp_up_sp": (0, MAX_RAMP_MS),
            "ramp_down_sp": (0, MAX_RAMP_MS),
        }.get(name, (0, MAX_SET_POINT))

    def _take_command(self, text: str) -> None:
        self._command(text)
        self._last_command = "" if text == "stop" else text

    @abstractmethod
    def _command(self, text: str) -> None: ...

    def _set_stop_action(self, text: str) -> None:
        if text not in STOP_ACTIONS:
            raise refuse(text)
        self._stop_action = text

    def _set_polarity(self, text: str) -> None:
        if text not in POLARITIES:
            raise refuse(text)
        self._polarity = text


class SignedTacho(Tacho):
    """Base class of motor drivers: with inversed polarity, all that programs read and write has the opposite sign."""

    _sign = 1

    def _set_polarity(self, text: str) -> None:
        super()._set_polarity(text)
        sign = -1 if text == "inversed" else 1
        if sign != self._sign:
            self._sign = sign
            self._tell(Call.SET_POLARITY, float(sign < 0))


class TachoMotor(SignedTacho):
    """The driver of one motor under the profiles of the course.

    A value that a program writes, such as `speed_sp`, takes effect with the next command.
    """

    _motor: BrickMotor

    def _set_up(self) -> None:
        self._numbers: dict[str, int] = {}
        self._direct = False
        self._standstill_tick = 0
        """Tick at which a motor that decelerates to the target speed 0 comes to a stop."""
        self._set_defaults()

    def _set_defaults(self) -> None:
        self._numbers |= {
            "speed_sp": 0,
            "position_sp": 0,
            "time_sp": 0,
            "duty_cycle_sp": 0,
            "ramp_up_sp": 0,
            "ramp_down_sp": 0,
            "speed_pid/Kp": 1000,
            "speed_pid/Ki": 60,
            "speed_pid/Kd": 0,
            "hold_pid/Kp": self._kind.hold_kp,
            "hold_pid/Ki": 0,
            "hold_pid/Kd": 0,
        }
        self._stop_action = "coast"
        self._set_polarity("normal")
        self._last_goal: float | None = None
        self._holding = False
        self._ramps = False
        """Whether `ramp_up_sp` or `ramp_down_sp` is above 0, so that changes of speed are limited."""

    def device(self) -> SimDevice:
        """Return the motor as a device of `/sys/class/tacho-motor`."""
        readers: dict[str, Reader] = {
            name: partial(self._numbers.__getitem__, name) for name in self._numbers
        }
        readers |= {
            "position": lambda: round(self._motor.position_deg) * self._sign,
            "speed": self._speed,
            "duty_cycle": self._duty_cycle,
            "state": self.state,
        }
        numbers = {name: self._number_writer(name, *self._limits(name)) for name in self._numbers}
        return self._device(readers, {}, {**numbers, "position": self._set_position})

    def registers(self) -> MotorRegisters:
        """Return the values that the program has written to the motor's attributes, and the motor's speed."""
        speed, position, time_ms = (
            self._numbers[name] for name in ("speed_sp", "position_sp", "time_sp")
        )
        return MotorRegisters(
            self._last_command, self._polarity, speed, position, time_ms / 1000, self._speed()
        )

    def _number_writer(self, name: str, low: int, high: int) -> NumberWriter:
        numbers = self._numbers

        def write(value: int) -> None:
            if not low <= value <= high:
                raise refuse(str(value))
            numbers[name] = value
            if name in RAMPS:
                self._ramps = any(numbers[ramp] for ramp in RAMPS)
            if self._direct and name == "duty_cycle_sp" and self._motor.mode != STOPPED:
                self._run_direct()

        return write

    def _speed(self) -> int:
        return round(self._motor.moving_dps) * self._sign

    def _duty_cycle(self) -> int:
        if self._direct and self._motor.mode != STOPPED:
            return self._numbers["duty_cycle_sp"]
        return round(100 * self._speed() / self._kind.max_speed_dps)

    def state(self) -> str:
        """Return the motor's states, separated by spaces, such as `running ramping`; empty if it is stopped."""
        motor = self._motor
        if motor.mode == STOPPED:
            return "holding" if self._holding else ""
        sim = self._session.sim
        if motor.blocked_ticks >= sim.stall_ticks:
            return "running overloaded stalled"
        if motor.target_dps == 0.0 and sim.tick >= self._standstill_tick + sim.stall_ticks:
            return "running stalled"
        return (
            "running ramping"
            if motor.speed_dps != motor.target_dps and not self._direct
            else "running"
        )

    def _set_position(self, value: int) -> None:
        self._tell(SET_COUNT, float(value * self._sign))
        self._last_goal = None

    def _command(self, text: str) -> None:
        if text not in COMMANDS:
            raise refuse(text)
        self._session.command()
        self._direct = text == "run-direct"
        speed = self._numbers["speed_sp"] * self._sign
        # At the end of a move, the stop action applies that was set at its start.
        self._holding = self._stop_action == "hold"
        if text == "run-forever":
            self._tell(RUN, float(speed))
        elif text == "run-timed":
            end_ns = self._session.now + self._numbers["time_sp"] * MS
            self._tell(RUN_UNTIL, float(speed), float(self._session.sim.count_ticks(end_ns)))
        elif text == "run-to-rel-pos":
            self._run_relative(float(speed))
            return
        elif text == "run-to-abs-pos":
            self._run_absolute(float(speed))
        elif text == "run-direct":
            self._run_direct()
        elif text == "stop":
            self._stop()
            return
        else:
            self._reset()
        self._last_goal = None
        self._begun()

    def _begun(self) -> None:
        """Limit the acceleration of a move that has just begun by the ramp attributes, unless it is `run-direct`.

        If the target speed is 0, also store the tick at which the motor will stand still.
        """
        if self._ramps and not self._direct:
            self._ramp()
        motor = self._motor
        if motor.target_dps == 0.0:
            step = motor.ramp_step
            self._standstill_tick = self._session.sim.tick + (
                math.ceil(abs(motor.speed_dps) / step) if step else 0
            )

    def _stop(self) -> None:
        """Stop the motor; if a ramp is set, decelerate first."""
        self._last_goal = None
        motor, sim, down = self._motor, self._session.sim, self._ramp_dps2("ramp_down_sp")
        if not down or not motor.moving_dps:
            self._tell(STOP)
            return
        if motor.mode == TIMED and motor.target_dps == 0.0:
            # The motor is decelerating already.
            return
        self._tell(Call.LIMIT_RAMPS, down, motor.approach_dps2)
        self._standstill_tick = sim.tick + math.ceil(abs(motor.speed_dps) / motor.ramp_step)
        self._tell(RUN_UNTIL, 0.0, float(self._standstill_tick))
        self._tell(Call.LIMIT_RAMPS, down, 0.0)

    def _run_direct(self) -> None:
        self._tell(
            RUN, self._kind.max_speed_dps * self._numbers["duty_cycle_sp"] / 100 * self._sign
        )
        self._begun()

    def _run_relative(self, speed: float) -> None:
        delta = self._numbers["position_sp"] * self._sign
        if delta == 0:
            self._stop()
            return
        base = self._motor.position_deg
        if self._last_goal is not None:
            base = self._last_goal
        self._last_goal = base + delta
        self._run_to(self._last_goal, speed)
        self._begun()

    def _run_to(self, goal_deg: float, speed_dps: float) -> None:
        self._tell(RUN_TO, goal_deg, speed_dps, float(goal_deg < self._motor.position_deg))

    def _ramp_dps2(self, name: str) -> float:
        """Return the acceleration in °/s² that a ramp attribute allows; 0 without a ramp."""
        ramp_ms = self._numbers[name]
        return self._kind.max_speed_dps / ramp_ms * 1000 if ramp_ms else 0.0

    def _ramp(self) -> None:
        """Limit acceleration and deceleration of the current move by the motor's ramp attributes."""
        motor = self._motor
        faster = abs(motor.target_dps) > abs(motor.speed_dps)
        slowest_dps2 = self._ramp_dps2("ramp_up_sp" if faster else "ramp_down_sp")
        ends = motor.mode in (TIMED, POSITION)
        approach_dps2 = self._ramp_dps2("ramp_down_sp") if ends else motor.approach_dps2
        self._tell(Call.LIMIT_RAMPS, slowest_dps2, approach_dps2)

    def _run_absolute(self, speed: float) -> None:
        self._run_to(float(self._numbers["position_sp"] * self._sign), speed)

    def _reset(self) -> None:
        self._tell(STOP)
        self._tell(SET_COUNT, 0.0)
        self._set_defaults()


WITHOUT_EFFECT = (
    "duty_cycle_sp",
    "ramp_up_sp",
    "ramp_down_sp",
    "speed_pid/Kp",
    "speed_pid/Ki",
    "speed_pid/Kd",
    "hold_pid/Kp",
    "hold_pid/Ki",
    "hold_pid/Kd",
)
"""Motor attributes that a program can write and read back, but which have no effect in the browser simulator."""


class BrowserTacho(Tacho):
    """The driver of one motor as in the browser simulator.

    A value that a program writes, such as `speed_sp`, takes effect immediately.
    """

    _motor: BrowserMotor

    def _set_up(self) -> None:
        self._numbers = dict.fromkeys(WITHOUT_EFFECT, 0)
        self._position_sp = 0
        self._time_sp_s = 0.0

    def device(self) -> SimDevice:
        """Return the motor as a device of `/sys/class/tacho-motor`."""
        motor = self._motor
        readers: dict[str, Reader] = {
            "position": lambda: plain(motor.position_deg),
            "speed": lambda: plain(motor.speed_dps),
            "duty_cycle": lambda: round(100 * motor.speed_dps / self._kind.max_speed_dps),
            "state": lambda: "running" if motor.mode else "",
            "speed_sp": lambda: int(motor.speed_sp),
            "position_sp": lambda: self._position_sp,
            # The browser simulator has this fault, too: it shows the speed here.
            "time_sp": lambda: int(motor.speed_sp),
        }
        readers |= {name: partial(self._numbers.__getitem__, name) for name in WITHOUT_EFFECT}
        numbers: dict[str, NumberWriter] = {
            name: partial(self._numbers.__setitem__, name) for name in WITHOUT_EFFECT
        }
        numbers |= {
            "speed_sp": lambda value: self._tell(Call.SET_SPEED, float(value)),
            "position_sp": self._set_position_sp,
            "position": lambda value: self._tell(SET_COUNT, float(value)),
        }
        return self._device(readers, {"time_sp": self._set_time}, numbers)

    def registers(self) -> MotorRegisters:
        """Return the values that the program has written to the motor's attributes, and the motor's speed."""
        motor = self._motor
        return MotorRegisters(
            self._last_command,
            self._polarity,
            motor.speed_sp,
            self._position_sp,
            self._time_sp_s,
            motor.speed_dps,
        )

    def _command(self, text: str) -> None:
        motor = self._motor
        match text:
            case "run-forever":
                self._tell(RUN, motor.speed_sp)
            case "run-timed":
                sim = self._session.sim
                # The time counts from the last complete tick: the browser simulator ignores the fraction of a tick
                # since then.
                end_tick = sim.tick + self._time_sp_s * sim.spec.profile.tick_hz
                self._tell(RUN_UNTIL, motor.speed_sp, end_tick)
            case "run-to-rel-pos":
                self._run_to(motor.position_deg + self._position_sp)
            case "run-to-abs-pos":
                self._run_to(float(self._position_sp))
            case "run-direct":
                self._tell(Call.SET_SPEED, float(self._numbers["duty_cycle_sp"]))
            case "stop" | "reset":
                self._tell(STOP)
            case _:
                raise refuse(text)

    def _run_to(self, goal_deg: float) -> None:
        self._tell(RUN_TO, goal_deg, self._motor.speed_sp, float(self._position_sp < 0))

    def _set_position_sp(self, value: int) -> None:
        # The sign of the position takes effect immediately, even during and after a move.
        self._position_sp = value
        self._tell(Call.SET_BACKWARDS, float(value < 0))

    def _set_time(self, text: str) -> None:
        try:
            self._time_sp_s = float(text)
        except ValueError:
            raise refuse(text) from None

    def _set_polarity(self, text: str) -> None:
        super()._set_polarity(text)
        self._tell(Call.SET_ROLL, -1.0 if text == "inversed" else 1.0)


class ServoTacho(Tacho):
    """The driver of one motor that the Pybricks firmware moves: it shows the motor's state, and refuses commands."""

    _motor: ServoMotor

    def _set_up(self) -> None: ...

    def device(self) -> SimDevice:
        """Return the motor as a device of `/sys/class/tacho-motor`."""
        motor = self._motor
        readers: dict[str, Reader] = {
            "position": lambda: round(motor.position_deg),
            "speed": lambda: round(motor.speed_dps),
            "duty_cycle": lambda: round(100 * motor.speed_dps / self._kind.max_speed_dps),
            "state": lambda: "running" if motor.mode else "",
        }
        return self._device(readers, {}, {})

    def registers(self) -> MotorRegisters:
        """Return the motor's state as values of the kernel's attributes: its speeds, its goal, and whether it runs."""
        motor = self._motor
        command = "run-direct" if motor.mode else ""
        return MotorRegisters(
            command, "normal", motor.aim_dps, round(motor.goal_deg), 0.0, motor.speed_dps
        )

    def _command(self, text: str) -> None:
        raise NotSimulated(
            f"the motor on {self._port}: the command {text!r} of its driver is not simulated in a Pybricks program",
            "use pybricks.ev3devices.Motor",
        )
