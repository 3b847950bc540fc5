"""LEGO sensors: modes and values, as the kernel driver exposes them."""

from __future__ import annotations

import errno
import struct
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NoReturn

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.drift import find_drift
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.sensors import SENSORS, color, infrared, touch, ultrasonic
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.engine.runs.readings import READING_CODES
from tuisim.engine.shim.device_files import SimDevice, Writer, refuse
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.unsupported.devices import foreign_mode

RAW_WHITE = 300
"""Value of each channel of `RGB-RAW` on white; ev3dev2 divides by this number until the program calibrates the sensor.
"""
MAX_TENTHS_INCH = 1003
"""Highest reading in tenths of an inch, 100.3 inches, which the ultrasonic sensor also gives when no echo returns."""
MAX_RATE_DPS = 440
"""Highest rate of turn in degrees per second that the gyro measures; a higher one reads as this."""

FORMS = {"s8": "b", "s16": "h"}
"""The format characters of `struct` for the values in `bin_data`, by the driver's name of the format."""


@dataclass(frozen=True, slots=True)
class Mode:
    """One mode of a sensor: how it measures, the time that this takes, and the format of its values."""

    measure: Callable[[], tuple[int, ...]]
    cost_ns: int
    decimals: int = 0
    units: str = ""
    form: str = "s8"
    """Format of a value in `bin_data`, one of `FORMS`."""


def _no_commands(_text: str = "") -> NoReturn:
    raise OSError(errno.EOPNOTSUPP, "this sensor has no commands")


class LegoSensor:
    """The driver of a sensor on an input port.

    Reading `value0` makes the sensor measure again, which takes time. `value1` and the following ones belong to the
    same measurement, and take no time if they are read directly after `value0`.
    """

    def __init__(
        self,
        session: DeviceSession,
        port: str,
        driver_name: str,
        modes: Mapping[str, Mode],
        default_mode: str,
        switch_ns: int | None = None,
    ) -> None:
        self._session = session
        self._port = port
        self.driver_name = driver_name
        self.modes = dict(modes)
        self._codes = {mode: READING_CODES[port, mode] for mode in modes}
        self.mode = default_mode
        self._values: tuple[int, ...] = ()
        self._next_free = (-1, -1)
        self._old_values: tuple[int, ...] = ()
        self._old_until_ns = 0
        """Simulated time in ns until which a sensor, after a change of its mode, returns `_old_values` if there are
        any.
        """
        mode_switch_ns = session.sim.spec.profile.mode_switch_ns
        self._switch_ns = mode_switch_ns if switch_ns is None else switch_ns

    def writers(self) -> dict[str, Writer]:
        """Return the functions that accept text written to the sensor's attributes, by attribute."""
        return {"mode": self.set_mode, "command": _no_commands}

    def device(self) -> SimDevice:
        """Return the sensor as a device of `/sys/class/lego-sensor`."""
        session = self._session
        readers: dict[str, Callable[[], object]] = {
            "address": lambda: f"ev3-ports:{self._port}",
            "driver_name": lambda: self.driver_name,
            "modes": lambda: " ".join(self.modes),
            "mode": lambda: self.mode,
            "commands": _no_commands,
            "decimals": lambda: self.modes[self.mode].decimals,
            "units": lambda: self.modes[self.mode].units,
            "num_values": lambda: len(self.modes[self.mode].measure()),
            "bin_data_format": lambda: self.modes[self.mode].form,
            "bin_data": self._binary,
        }
        # The readers of these attributes let time pass themselves: only the first value of a measurement takes time.
        costs = {"bin_data": 0}
        for n in range(8):
            readers[f"value{n}"] = partial(self._value, n)
            costs[f"value{n}"] = 0
        return SimDevice(session, readers, self.writers(), costs)

    def set_mode(self, text: str) -> None:
        """Switch the sensor to a mode; if it is another mode, let the time of the change pass."""
        if text not in self.modes:
            raise foreign_mode(text, self._port, self.driver_name) or refuse(text)
        if text != self.mode:
            self.switch(text)

    def switch(self, mode: str) -> None:
        """Switch the sensor to a mode, even if it is in this mode, and let the time of the change pass."""
        self.mode = mode
        if self._switch_ns:
            self._session.charge(self._switch_ns)

    def measure(self, mode: str) -> tuple[int, ...]:
        """Return the numbers that the sensor measures in a mode, and let the time of the measurement pass.

        They are the numbers of the driver's attributes `value0`, `value1` and so on.
        """
        chosen = self.modes[mode]
        session = self._session
        if not session.free:
            session.spend(chosen.cost_ns, self._codes[mode])
        if session.now < self._old_until_ns and self._old_values:
            return self._old_values
        return chosen.measure()

    def measure_switched(self, mode: str) -> tuple[int, ...]:
        """Return the numbers of the first measurement after a change of mode.

        No time passes: the change of mode has already taken the time of this measurement.
        """
        session = self._session
        if not session.free:
            session.note_reading(self._codes[mode])
        return self.modes[mode].measure()

    def _binary(self) -> bytes:
        values = self.measure(self.mode)
        return struct.pack(f"<{len(values)}{FORMS[self.modes[self.mode].form]}", *values)

    def _value(self, n: int) -> int:
        now = self._session.now
        if not (n and self._next_free == (n, now) and n < len(self._values)):
            self._values = self.measure(self.mode)
        if n >= len(self._values):
            raise refuse(f"value{n}")
        self._next_free = (n + 1, self._session.now)
        return self._values[n]

    def refuse_value(self, number: int) -> NotSimulated | None:
        """Return the error for reading `value{number}` if no mode of the sensor has that value; None if a mode has it.

        A program that reads such a value was written for a sensor that is not simulated.
        """
        count = max(len(mode.measure()) for mode in self.modes.values())
        if number < count:
            return None
        return NotSimulated(
            f"value({number}) on {self._port}: {self.driver_name} has no such value; no other sensor is simulated",
            "the simulated sensors are those of ev3dev2.sensor.lego for colour, distance, turning, touch and infrared",
        )


class ColorDevice(LegoSensor):
    """The driver of a colour sensor, with the readings that courses add to the library."""

    def __init__(self, session: DeviceSession, spec: ColorSensorSpec) -> None:
        profile = session.sim.spec.profile
        modes = self._build_modes(spec, profile)
        super().__init__(session, spec.port, SENSORS["color"].driver_name, modes, "COL-REFLECT")
        self._read_ns = profile.color_read_ns
        self._stale_ns = profile.stale_reading_ns
        self._left_values: dict[str, tuple[int, ...]] = {}
        self._spec = spec
        self._clear = color.build_rgb_reader(spec, profile, session.field)
        self._noisy = color.build_noisy_rgb_reader(spec, profile, session.field)
        drift = find_drift(session.sim.spec)
        self._in_full = (
            session.sim.spec.world.pen_marks or drift.light_pc > 0 or drift.light_gain_pc > 0
        )
        self._seen = (0, 0, 0)
        self._seen_tick, self._seen_actions = -1, -1

    def _build_modes(self, spec: ColorSensorSpec, profile: ProfileSpec) -> dict[str, Mode]:
        read = profile.color_read_ns

        def reflected() -> tuple[int]:
            return (self.channels()[0] * 100 // color.WHITE,)

        white = sum(color.find_response(spec, profile))

        def ambient() -> tuple[int]:
            return (sum(self.channels()) * profile.ambient_percent // (3 * white),)

        tell_color = color.find_brick_color_code if profile.brick_colors else color.find_color_code

        return {
            "COL-REFLECT": Mode(reflected, read, units="pct"),
            "COL-AMBIENT": Mode(ambient, read, units="pct"),
            "COL-COLOR": Mode(
                lambda: (tell_color(*self.channels()),),
                profile.color_code_read_ns,
                units="col",
            ),
            "REF-RAW": Mode(lambda: (self._raw()[0], 0), read, form="s16"),
            "RGB-RAW": Mode(self._raw, read, form="s16"),
            "COL-CAL": Mode(lambda: (*self._raw(), 0), read, form="s16"),
        }

    def channels(self) -> tuple[int, int, int]:
        """Return red, green and blue, each 0 to 255, without time passing; they are measured once per tick."""
        sim = self._session.sim
        if sim.tick != self._seen_tick or sim.actions != self._seen_actions:
            self._seen_tick, self._seen_actions = sim.tick, sim.actions
            light = sim.noise.light
            drive = sim.drive
            if self._in_full or (light and self._spec.strategy != "mean"):
                self._seen = color.measure_color(
                    self._spec, sim.build_instant(), self._session.field
                ).rgb
            elif light:
                place = drive.x_mm, drive.y_mm, drive.heading_deg
                self._seen = self._noisy(*place, light, sim.spec.seed, sim.tick)
            else:
                self._seen = self._clear(drive.x_mm, drive.y_mm, drive.heading_deg)
        return self._seen

    def _raw(self) -> tuple[int, int, int]:
        # The library computes int(raw * 255 / 300): rounding up here restores the channel exactly.
        red, green, blue = self.channels()
        return (
            -(-red * RAW_WHITE // 255),
            -(-green * RAW_WHITE // 255),
            -(-blue * RAW_WHITE // 255),
        )

    def read(self, mode: str) -> tuple[int, int, int]:
        """Switch to a mode, return red, green and blue, each 0 to 255, and let the time of a reading pass."""
        self.set_mode(mode)
        session = self._session
        if not session.free:
            session.spend(self._read_ns, self._codes[mode])
        return self.channels()

    def switch(self, mode: str) -> None:
        """Switch to a mode.

        For a short time after that, the sensor still returns the values that it last had in this mode.
        """
        if self._stale_ns and not self._session.free:
            self._left_values[self.mode] = self.modes[self.mode].measure()
            self._old_until_ns = self._session.now + self._stale_ns
        self._old_values = self._left_values.get(mode, ())
        super().switch(mode)


def ultrasonic_sensor(
    session: DeviceSession, spec: UltrasonicSpec, others: Sequence[LegoSensor]
) -> LegoSensor:
    """Return the driver of an ultrasonic sensor.

    Args:
        session: The run.
        spec: The sensor.
        others: All sensors of the robot, this one included, whose pings it may hear; more may be added later.
    """
    sim = session.sim
    read = sim.spec.profile.ultrasonic_read_ns
    period = sim.spec.profile.ultrasonic_period_ticks
    last = (-1, -1, 0)

    def distance_mm() -> int:
        nonlocal last
        ping = sim.tick // period
        if last[:2] != (ping, sim.actions):
            last = (
                ping,
                sim.actions,
                ultrasonic.measure_noisy_mm(spec, sim.build_instant(), sim.spec.world),
            )
        return last[2]

    def inches() -> tuple[int]:
        return (min(MAX_TENTHS_INCH, round(distance_mm() / 2.54)),)

    def heard() -> tuple[int]:
        return (
            int(any(other is not sensor and other.mode.startswith("US-DIST") for other in others)),
        )

    modes = {
        "US-DIST-CM": Mode(lambda: (distance_mm(),), read, 1, "cm", "s16"),
        "US-DIST-IN": Mode(inches, read, 1, "in", "s16"),
        "US-LISTEN": Mode(heard, read),
        "US-SI-CM": Mode(lambda: (distance_mm(),), read, 1, "cm", "s16"),
        "US-SI-IN": Mode(inches, read, 1, "in", "s16"),
    }
    sensor = LegoSensor(session, spec.port, SENSORS["ultrasonic"].driver_name, modes, "US-DIST-CM")
    return sensor


class GyroDevice(LegoSensor):
    """The driver of a gyro. A calibration resets its angle to 0; so does a change of mode if the profile says so."""

    def __init__(self, session: DeviceSession, spec: GyroSpec) -> None:
        sim = session.sim
        read = sim.spec.profile.gyro_read_ns

        def angle() -> int:
            return sim.build_instant().gyro_deg

        def rate() -> int:
            return max(-MAX_RATE_DPS, min(MAX_RATE_DPS, sim.build_instant().gyro_rate_dps))

        modes = {
            "GYRO-ANG": Mode(lambda: (angle(),), read, 0, "deg", "s16"),
            "GYRO-RATE": Mode(lambda: (rate(),), read, 0, "d/s", "s16"),
            "GYRO-FAS": Mode(lambda: (rate(),), read, form="s16"),
            "GYRO-G&A": Mode(lambda: (angle(), rate()), read, form="s16"),
            "GYRO-CAL": Mode(lambda: (0, 0, 0, 0), read, form="s16"),
            # The robot always stands level, so its tilt is 0.
            "TILT-ANG": Mode(lambda: (0,), read, 0, "deg", "s16"),
            "TILT-RATE": Mode(lambda: (0,), read, 0, "d/s", "s16"),
        }
        super().__init__(session, spec.port, SENSORS["gyro"].driver_name, modes, "GYRO-ANG")
        self.restarts = sim.spec.profile.gyro_restarts and not spec.keeps_angle

    def writers(self) -> dict[str, Writer]:
        """Return the functions for text written to attributes: those of every sensor, and one to reset the angle."""
        return super().writers() | {"direct": lambda _text: self._reset()}

    def switch(self, mode: str) -> None:
        """Switch the gyro to a mode, even if it is in this mode, and let the time of the change pass.

        The angle becomes 0 if the profile says so, and always at the end of a calibration.
        """
        restarts = self.restarts or self.mode == "GYRO-CAL"
        super().switch(mode)
        if restarts:
            self._reset()

    def _reset(self) -> None:
        obey(self._session.sim, self._session.now, 0, Call.RESET_GYRO)


def touch_sensor(session: DeviceSession, spec: TouchSpec) -> LegoSensor:
    """Return the driver of a touch sensor."""
    sim = session.sim

    def pressed() -> tuple[int]:
        return (int(touch.measure(spec, sim.build_instant(), sim.spec, session.field)[0]),)

    modes = {"TOUCH": Mode(pressed, sim.spec.profile.attribute_read_ns)}
    return LegoSensor(session, spec.port, SENSORS["touch"].driver_name, modes, "TOUCH")


def infrared_sensor(session: DeviceSession, spec: InfraredSpec) -> LegoSensor:
    """Return the driver of an infrared sensor."""
    sim = session.sim
    world = sim.spec.world
    read = sim.spec.profile.ultrasonic_read_ns

    def time_s() -> float:
        return sim.tick / sim.spec.profile.tick_hz

    modes = {
        "IR-PROX": Mode(lambda: (infrared.proximity(sim.pose, spec, world),), read, units="pct"),
        "IR-SEEK": Mode(lambda: infrared.seek(sim.pose, spec, world), read, units="pct"),
        "IR-REMOTE": Mode(
            lambda: infrared.remote(time_s(), world, session.pressed), read, units="btn"
        ),
        "IR-REM-A": Mode(
            lambda: (infrared.compute_remote_bits(time_s(), world, session.pressed),),
            read,
            form="s16",
        ),
        "IR-CAL": Mode(lambda: (0, 0), read, form="s16"),
    }
    driver_name = SENSORS["infrared"].driver_name
    switch_ns = sim.spec.profile.infrared_switch_ns
    return LegoSensor(session, spec.port, driver_name, modes, "IR-PROX", switch_ns)


DEVICES: Mapping[type, Callable[[DeviceSession, Any, Sequence[LegoSensor]], LegoSensor]] = {
    ColorSensorSpec: lambda session, spec, _others: ColorDevice(session, spec),
    UltrasonicSpec: ultrasonic_sensor,
    GyroSpec: lambda session, spec, _others: GyroDevice(session, spec),
    TouchSpec: lambda session, spec, _others: touch_sensor(session, spec),
    InfraredSpec: lambda session, spec, _others: infrared_sensor(session, spec),
}
"""Functions that make a sensor's driver, by the class of the sensor's spec; they take the session, the spec and the
drivers made before.
"""
