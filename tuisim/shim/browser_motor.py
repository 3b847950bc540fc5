"""Tacho motors of the browser simulator: set points take effect at once, commands bypass the driver."""

from __future__ import annotations

from functools import partial

from tuisim.core.browser_motor import BrowserMotor
from tuisim.shim.devices import NumberWriter, Reader, SimDevice, Writer, refuse
from tuisim.shim.motor import COMMANDS, COUNT_PER_ROT, KINDS, POLARITIES, STOP_ACTIONS
from tuisim.shim.session import Session

WITHOUT_EFFECT = (
    "duty_cycle_sp", "ramp_up_sp", "ramp_down_sp", "speed_pid/Kp", "speed_pid/Ki", "speed_pid/Kd", "hold_pid/Kp",
    "hold_pid/Ki", "hold_pid/Kd",
)  # fmt: skip
"""Attributes that are stored without effect."""


def plain(value: float) -> float:
    """Return a whole number as int, so that it is shown without a decimal point."""
    return int(value) if value.is_integer() else value


class BrowserTacho:
    """One motor on an output port.

    Args:
        session: Clock and simulation.
        motor: The simulated motor.
        port: Name of the port, such as `outB`.
        kind: One of `motor.KINDS`.
    """

    def __init__(self, session: Session, motor: BrowserMotor, port: str, kind: str = "large") -> None:
        self._session, self._motor, self._port, self._kind = session, motor, port, KINDS[kind]
        self._numbers = dict.fromkeys(WITHOUT_EFFECT, 0)
        self._position_sp, self._time_sp_s = 0, 0.0
        self._stop_action, self._polarity = "coast", "normal"

    def device(self) -> SimDevice:
        """Return the device that the library reads and writes."""
        motor = self._motor
        readers: dict[str, Reader] = {
            "address": lambda: f"ev3-ports:{self._port}",
            "driver_name": lambda: self._kind.driver_name,
            "commands": lambda: " ".join(COMMANDS),
            "stop_actions": lambda: " ".join(STOP_ACTIONS),
            "count_per_rot": lambda: COUNT_PER_ROT,
            "max_speed": lambda: self._kind.max_speed_dps,
            "position": lambda: plain(motor.position_deg),
            "speed": lambda: plain(motor.speed_dps),
            "duty_cycle": lambda: round(100 * motor.speed_dps / self._kind.max_speed_dps),
            "state": lambda: "running" if motor.mode else "",
            "speed_sp": lambda: int(motor.speed_sp),
            "position_sp": lambda: self._position_sp,
            # As in the browser simulator.
            "time_sp": lambda: int(motor.speed_sp),
            "stop_action": lambda: self._stop_action,
            "polarity": lambda: self._polarity,
        }
        readers |= {name: partial(self._numbers.__getitem__, name) for name in WITHOUT_EFFECT}
        writers: dict[str, Writer] = {
            "command": self._command,
            "stop_action": self._set_stop_action,
            "polarity": self._set_polarity,
            "time_sp": self._set_time,
        }
        numbers: dict[str, NumberWriter] = {name: partial(self._numbers.__setitem__, name) for name in WITHOUT_EFFECT}
        numbers |= {
            "speed_sp": lambda value: setattr(motor, "speed_sp", float(value)),
            "position_sp": self._set_position_sp,
            "position": lambda value: setattr(motor, "position_deg", float(value)),
        }
        return SimDevice(self._session, readers, writers, None, numbers)

    def _command(self, text: str) -> None:
        motor = self._motor
        match text:
            case "run-forever":
                motor.run(motor.speed_sp)
            case "run-timed":
                sim = self._session.sim
                # Counted from the last completed tick: the fraction of a tick since then is ignored.
                motor.run_until(motor.speed_sp, sim.tick + self._time_sp_s * sim.spec.profile.tick_hz)
            case "run-to-rel-pos":
                motor.run_to(motor.position_deg + self._position_sp, motor.speed_sp, self._position_sp < 0)
            case "run-to-abs-pos":
                motor.run_to(float(self._position_sp), motor.speed_sp, self._position_sp < 0)
            case "run-direct":
                motor.speed_sp = float(self._numbers["duty_cycle_sp"])
            case "stop" | "reset":
                motor.stop()
            case _:
                raise refuse(text)

    def _set_position_sp(self, value: int) -> None:
        # Its sign takes effect at once, also during and after a move.
        self._position_sp, self._motor.backwards = value, value < 0

    def _set_time(self, text: str) -> None:
        try:
            self._time_sp_s = float(text)
        except ValueError:
            raise refuse(text) from None

    def _set_stop_action(self, text: str) -> None:
        if text not in STOP_ACTIONS:
            raise refuse(text)
        self._stop_action = text

    def _set_polarity(self, text: str) -> None:
        if text not in POLARITIES:
            raise refuse(text)
        self._polarity, self._motor.roll_sign = text, -1.0 if text == "inversed" else 1.0
