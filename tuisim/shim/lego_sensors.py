"""Lego sensors: modes and values of colour, ultrasonic and gyro, as the kernel driver has them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tuisim.core.sensors import SENSORS, color, gyro, ultrasonic
from tuisim.core.spec import ColorSensorSpec, GyroSpec, UltrasonicSpec
from tuisim.shim.devices import SimDevice, Writer, refuse
from tuisim.shim.session import Session

RAW_WHITE = 300
"""What the raw channels give on white; the library scales by it until it is calibrated."""


@dataclass(frozen=True, slots=True)
class Mode:
    """One mode of a sensor."""

    measure: Callable[[], tuple[int, ...]]
    cost_ns: int
    decimals: int = 0
    units: str = ""


class LegoSensor:
    """A sensor on an input port.

    Reading `value0` takes a new measurement and costs its time; `value1` and the following
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

    def device(self, extra_writers: Mapping[str, Writer] | None = None) -> SimDevice:
        """Return the device that the library reads and writes."""
        session = self._session
        readers: dict[str, Callable[[], object]] = {
            "address": lambda: f"ev3-ports:{self._port}",
            "driver_name": lambda: self._driver_name,
            "modes": lambda: " ".join(self.modes),
            "mode": lambda: self.mode,
            "commands": lambda: "",
            "decimals": lambda: self.modes[self.mode].decimals,
            "units": lambda: self.modes[self.mode].units,
            "num_values": lambda: len(self.modes[self.mode].measure()),
        }
        costs = {}
        for n in range(8):
            readers[f"value{n}"] = lambda n=n: self._value(n)  # type: ignore[misc]
            # A value charges for itself: only the first of a measurement costs.
            costs[f"value{n}"] = 0
        return SimDevice(session, readers, {"mode": self.set_mode, **(extra_writers or {})}, costs)

    def set_mode(self, text: str) -> None:
        """Switch the mode; costs nothing."""
        if text not in self.modes:
            raise refuse(text)
        self.mode = text

    def measure(self, mode: str) -> tuple[int, ...]:
        """Take one measurement in a mode, after its cost."""
        chosen = self.modes[mode]
        session = self._session
        if not session.free:
            session.charge(chosen.cost_ns)
        return chosen.measure()

    def _value(self, n: int) -> int:
        now = self._session.now
        if not (n and self._next_free == (n, now) and n < len(self._values)):
            self._values = self.measure(self.mode)
        if n >= len(self._values):
            raise refuse(f"value{n}")
        self._next_free = (n + 1, self._session.now)
        return self._values[n]


class ColorDevice(LegoSensor):
    """A colour sensor, with the readings that the course's overlay uses."""

    def __init__(self, session: Session, spec: ColorSensorSpec) -> None:
        profile = session.sim.spec.profile
        read = self._read_ns = profile.color_read_ns

        def reflected() -> tuple[int]:
            return (self.channels()[0] * 100 // color.WHITE,)

        def raw() -> tuple[int, int, int]:
            # The library gives int(raw * 255 / 300): rounding up here returns the whole channel exactly.
            red, green, blue = self.channels()
            return -(-red * RAW_WHITE // 255), -(-green * RAW_WHITE // 255), -(-blue * RAW_WHITE // 255)

        modes = {
            "COL-REFLECT": Mode(reflected, read, units="pct"),
            "COL-AMBIENT": Mode(lambda: (0,), read, units="pct"),
            "COL-COLOR": Mode(lambda: (color.color_code(*self.channels()),), profile.color_code_read_ns, units="col"),
            "REF-RAW": Mode(lambda: (raw()[0], 0), read),
            "RGB-RAW": Mode(raw, read),
        }
        super().__init__(session, spec.port, SENSORS["color"].driver_name, modes, "COL-REFLECT")
        self._spec = spec
        self._clear = color.rgb_reader(spec, session.field)
        self._seen = (0, 0, 0)
        self._seen_tick, self._seen_actions = -1, -1

    def channels(self) -> tuple[int, int, int]:
        """Return the whole channels that the sensor sees now, free of charge; measured once a tick."""
        sim = self._session.sim
        if sim.tick != self._seen_tick or sim.actions != self._seen_actions:
            self._seen_tick, self._seen_actions = sim.tick, sim.actions
            if sim.noise.light or sim.spec.world.pen_marks:
                self._seen = color.reading(self._spec, sim.instant(), self._session.field).rgb
            else:
                self._seen = self._clear(sim.x_mm, sim.y_mm, sim.heading_deg)
        return self._seen

    def read(self, mode: str) -> tuple[int, int, int]:
        """Switch to a mode and return the whole channels, after the cost of a reading."""
        self.mode = mode
        session = self._session
        if not session.free:
            session.spend(self._read_ns)
        return self.channels()


def ultrasonic_sensor(session: Session, spec: UltrasonicSpec) -> LegoSensor:
    """Return an ultrasonic sensor."""
    sim = session.sim
    read, period = sim.spec.profile.ultrasonic_read_ns, sim.spec.profile.ultrasonic_period_ticks
    last = (-1, -1, 0)

    def distance_mm() -> int:
        nonlocal last
        ping = sim.tick // period
        if last[:2] != (ping, sim.actions):
            last = (ping, sim.actions, ultrasonic.reading_mm(spec, sim.instant(), sim.spec.world))
        return last[2]

    def inches() -> tuple[int]:
        return (round(distance_mm() / 2.54),)

    modes = {
        "US-DIST-CM": Mode(lambda: (distance_mm(),), read, 1, "cm"),
        "US-DIST-IN": Mode(inches, read, 1, "in"),
        "US-LISTEN": Mode(lambda: (0,), read),
        "US-SI-CM": Mode(lambda: (distance_mm(),), read, 1, "cm"),
        "US-SI-IN": Mode(inches, read, 1, "in"),
    }
    return LegoSensor(session, spec.port, SENSORS["ultrasonic"].driver_name, modes, "US-DIST-CM")


def gyro_sensor(session: Session, spec: GyroSpec) -> tuple[LegoSensor, dict[str, Writer]]:
    """Return a gyro and the attribute through which it is reset."""
    sim = session.sim
    read = sim.spec.profile.gyro_read_ns

    def angle() -> int:
        return gyro.angle_deg(sim.instant())

    def rate() -> int:
        return gyro.rate_dps(sim.instant())

    modes = {
        "GYRO-ANG": Mode(lambda: (angle(),), read, units="deg"),
        "GYRO-RATE": Mode(lambda: (rate(),), read, units="d/s"),
        "GYRO-FAS": Mode(lambda: (rate(),), read),
        "GYRO-G&A": Mode(lambda: (angle(), rate()), read),
        "GYRO-CAL": Mode(lambda: (0,), read),
        "TILT-ANG": Mode(lambda: (0,), read, units="deg"),
        "TILT-RATE": Mode(lambda: (0,), read, units="d/s"),
    }
    return (
        LegoSensor(session, spec.port, SENSORS["gyro"].driver_name, modes, "GYRO-ANG"),
        {"direct": lambda _text: sim.reset_gyro()},
    )
