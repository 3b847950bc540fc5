"""LEGO sensors as the kernel driver exposes them: the base class, and the colour sensor."""

from __future__ import annotations

import errno
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import NoReturn

from tuisim.core.sensors import SENSORS, color
from tuisim.core.spec import ColorSensorSpec
from tuisim.shim.devices import SimDevice, Writer, refuse
from tuisim.shim.session import Session

RAW_WHITE = 300
"""Value of the raw channels on white; the library scales by it until it is calibrated."""


FORMS = {"s8": "b", "s16": "h"}
"""Formats of binary values: the driver's names and those of `struct`."""


@dataclass(frozen=True, slots=True)
class Mode:
    """One mode of a sensor."""

    measure: Callable[[], tuple[int, ...]]
    cost_ns: int
    decimals: int = 0
    units: str = ""
    form: str = "s8"
    """Format of a value in `bin_data`, one of `FORMS`."""


def _no_commands(_text: str = "") -> NoReturn:
    """Raise the driver's error for a sensor without commands."""
    raise OSError(errno.EOPNOTSUPP, "this sensor has no commands")


class LegoSensor:
    """A sensor on an input port.

    Reading `value0` takes a new measurement and costs its time; `value1` and the following ones
    read directly after it belong to the same measurement and cost nothing.
    """

    def __init__(
        self, session: Session, port: str, driver_name: str, modes: Mapping[str, Mode], default_mode: str
    ) -> None:
        self._session = session
        self._port, self._driver_name = port, driver_name
        self.modes = dict(modes)
        self.mode = default_mode
        self._values: tuple[int, ...] = ()
        self._next_free = (-1, -1)

    def writers(self) -> dict[str, Writer]:
        """Return the functions that accept text written to each attribute."""
        return {"mode": self.set_mode, "command": _no_commands}

    def device(self) -> SimDevice:
        """Return the device that the library reads and writes."""
        session = self._session
        readers: dict[str, Callable[[], object]] = {
            "address": lambda: f"ev3-ports:{self._port}",
            "driver_name": lambda: self._driver_name,
            "modes": lambda: " ".join(self.modes),
            "mode": lambda: self.mode,
            "commands": _no_commands,
            "decimals": lambda: self.modes[self.mode].decimals,
            "units": lambda: self.modes[self.mode].units,
            "num_values": lambda: len(self.modes[self.mode].measure()),
            "bin_data_format": lambda: self.modes[self.mode].form,
            "bin_data": self._binary,
        }
        # Values charge by themselves: only the first of a measurement costs time.
        costs = {"bin_data": 0}
        for n in range(8):
            readers[f"value{n}"] = partial(self._value, n)
            costs[f"value{n}"] = 0
        return SimDevice(session, readers, self.writers(), costs)

    def set_mode(self, text: str) -> None:
        """Switch the mode; costs nothing."""
        if text not in self.modes:
            raise refuse(text)
        self.mode = text

    def measure(self, mode: str) -> tuple[int, ...]:
        """Take one measurement in a mode. Charges its cost."""
        chosen = self.modes[mode]
        session = self._session
        if not session.free:
            session.charge(chosen.cost_ns)
        return chosen.measure()

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


class ColorDevice(LegoSensor):
    """A colour sensor, with the additional readings of the course's overlay."""

    def __init__(self, session: Session, spec: ColorSensorSpec) -> None:
        profile = session.sim.spec.profile
        read = self._read_ns = profile.color_read_ns

        def reflected() -> tuple[int]:
            return (self.channels()[0] * 100 // color.WHITE,)

        def raw() -> tuple[int, int, int]:
            # The library computes int(raw * 255 / 300): rounding up here restores the channel exactly.
            red, green, blue = self.channels()
            return -(-red * RAW_WHITE // 255), -(-green * RAW_WHITE // 255), -(-blue * RAW_WHITE // 255)

        def ambient() -> tuple[int]:
            return (sum(self.channels()) * profile.ambient_percent // (3 * color.WHITE),)

        modes = {
            "COL-REFLECT": Mode(reflected, read, units="pct"),
            "COL-AMBIENT": Mode(ambient, read, units="pct"),
            "COL-COLOR": Mode(lambda: (color.color_code(*self.channels()),), profile.color_code_read_ns, units="col"),
            "REF-RAW": Mode(lambda: (raw()[0], 0), read, form="s16"),
            "RGB-RAW": Mode(raw, read, form="s16"),
            "COL-CAL": Mode(lambda: (*raw(), 0), read, form="s16"),
        }
        super().__init__(session, spec.port, SENSORS["color"].driver_name, modes, "COL-REFLECT")
        self._spec = spec
        self._clear = color.rgb_reader(spec, session.field)
        self._seen = (0, 0, 0)
        self._seen_tick, self._seen_actions = -1, -1

    def channels(self) -> tuple[int, int, int]:
        """Return the channels as integers, free of charge; measured once per tick."""
        sim = self._session.sim
        if sim.tick != self._seen_tick or sim.actions != self._seen_actions:
            self._seen_tick, self._seen_actions = sim.tick, sim.actions
            if sim.noise.light or sim.spec.world.pen_marks:
                self._seen = color.reading(self._spec, sim.instant(), self._session.field).rgb
            else:
                drive = sim.drive
                self._seen = self._clear(drive.x_mm, drive.y_mm, drive.heading_deg)
        return self._seen

    def read(self, mode: str) -> tuple[int, int, int]:
        """Switch to a mode and return the channels as integers. Charges the cost of a reading."""
        self.mode = mode
        session = self._session
        if not session.free:
            session.spend(self._read_ns)
        return self.channels()
