"""Ultrasonic, gyro, touch and infrared sensors: modes and values, as the kernel driver exposes them."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.core.sensors import SENSORS, gyro, infrared, touch, ultrasonic
from tuisim.core.spec import GyroSpec, InfraredSpec, TouchSpec, UltrasonicSpec
from tuisim.shim.devices import Writer
from tuisim.shim.sensors.color import LegoSensor, Mode
from tuisim.shim.session import Session

MAX_TENTHS_INCH = 1003
"""Reading in inches when no echo returns."""
MAX_RATE_DPS = 440
"""Highest rate that the gyro measures."""


def ultrasonic_sensor(session: Session, spec: UltrasonicSpec, others: Sequence[LegoSensor]) -> LegoSensor:
    """Return an ultrasonic sensor.

    It hears those of the robot's sensors that ping; they include this one, and more may be added later.
    """
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
        return (min(MAX_TENTHS_INCH, round(distance_mm() / 2.54)),)

    def heard() -> tuple[int]:
        return (int(any(other is not sensor and other.mode.startswith("US-DIST") for other in others)),)

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
    """A gyro; a calibration resets it to 0."""

    def __init__(self, session: Session, spec: GyroSpec) -> None:
        sim = session.sim
        read = sim.spec.profile.gyro_read_ns

        def angle() -> int:
            return gyro.angle_deg(sim.instant())

        def rate() -> int:
            return max(-MAX_RATE_DPS, min(MAX_RATE_DPS, gyro.rate_dps(sim.instant())))

        modes = {
            "GYRO-ANG": Mode(lambda: (angle(),), read, 0, "deg", "s16"),
            "GYRO-RATE": Mode(lambda: (rate(),), read, 0, "d/s", "s16"),
            "GYRO-FAS": Mode(lambda: (rate(),), read, form="s16"),
            "GYRO-G&A": Mode(lambda: (angle(), rate()), read, form="s16"),
            "GYRO-CAL": Mode(lambda: (0, 0, 0, 0), read, form="s16"),
            # The robot stays level.
            "TILT-ANG": Mode(lambda: (0,), read, 0, "deg", "s16"),
            "TILT-RATE": Mode(lambda: (0,), read, 0, "d/s", "s16"),
        }
        super().__init__(session, spec.port, SENSORS["gyro"].driver_name, modes, "GYRO-ANG")

    def writers(self) -> dict[str, Writer]:
        """Return also the attribute that resets the sensor."""
        return super().writers() | {"direct": lambda _text: self._session.sim.reset_gyro()}

    def set_mode(self, text: str) -> None:
        """Switch the mode; a switch that ends a calibration resets the angle to 0."""
        calibrated = self.mode == "GYRO-CAL" != text
        super().set_mode(text)
        if calibrated:
            self._session.sim.reset_gyro()


def touch_sensor(session: Session, spec: TouchSpec) -> LegoSensor:
    """Return a touch sensor."""
    sim = session.sim

    def pressed() -> tuple[int]:
        return (int(touch.pressed(sim.pose, spec, sim.spec.world)),)

    modes = {"TOUCH": Mode(pressed, sim.spec.profile.attribute_read_ns)}
    return LegoSensor(session, spec.port, SENSORS["touch"].driver_name, modes, "TOUCH")


def infrared_sensor(session: Session, spec: InfraredSpec) -> LegoSensor:
    """Return an infrared sensor."""
    sim = session.sim
    world, read = sim.spec.world, sim.spec.profile.ultrasonic_read_ns

    def time_s() -> float:
        return sim.tick / sim.spec.profile.tick_hz

    modes = {
        "IR-PROX": Mode(lambda: (infrared.proximity(sim.pose, spec, world),), read, units="pct"),
        "IR-SEEK": Mode(lambda: infrared.seek(sim.pose, spec, world), read, units="pct"),
        "IR-REMOTE": Mode(lambda: infrared.remote(time_s(), world), read, units="btn"),
        "IR-REM-A": Mode(lambda: (infrared.remote_bits(time_s(), world),), read, form="s16"),
        "IR-CAL": Mode(lambda: (0, 0), read, form="s16"),
    }
    return LegoSensor(session, spec.port, SENSORS["infrared"].driver_name, modes, "IR-PROX")
