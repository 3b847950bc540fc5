"""The battery: a rechargeable one whose voltage depends on its charge and the current.

The open-circuit voltage falls linearly over the capacity, from `FULL_V` (or the robot's own voltage, if its motors
depend on that) to `EMPTY_V`; a current lowers it by that current times the internal resistance. The brick always draws
`BRICK_A`, a running motor `RUNNING_A`, and up to `SPEED_A` more at full speed, a blocked one `BLOCKED_A`. The charge
drawn is the sum over the recorded ticks, so only the wheel motors are included. The same world at the same tick has the
same voltage, no matter how often it was measured.
"""

from __future__ import annotations

from tuisim.engine.core.motors import STOPPED, Motor
from tuisim.engine.core.tick_record import FLAG_LEFT_RUNNING, FLAG_RIGHT_RUNNING
from tuisim.engine.shim.device_files import SimDevice
from tuisim.engine.shim.session import DeviceSession

POWER_CLASS = "power_supply"
BATTERY = "lego-ev3-battery"
"""The kernel's name of the battery, whose class is `POWER_CLASS`."""

FULL_V, EMPTY_V = 8.1, 6.0
MAX_DESIGN_V, MIN_DESIGN_V = 8.4, 6.0
CAPACITY_AH = 2.05
INNER_OHM = 0.25
BRICK_A, RUNNING_A, SPEED_A, BLOCKED_A = 0.17, 0.06, 0.12, 1.8

MICRO = 1_000_000
S_PER_H = 3600


class Battery:
    """The battery of the brick in one run."""

    def __init__(self, session: DeviceSession) -> None:
        self._session = session
        self._max_dps = session.sim.spec.profile.max_speed_dps
        self._full_v = session.sim.spec.robot.battery_v if session.sim.notices else FULL_V
        self._records = 0
        self._drawn_as = 0.0
        """Charge, in ampere seconds, that the brick has drawn in the first `_records` records of the run."""

    def device(self) -> SimDevice:
        """Return the battery as a device of `/sys/class/power_supply`."""
        return SimDevice(
            self._session,
            {
                "current_now": lambda: round(self.current_a() * MICRO),
                "voltage_now": lambda: round(self.voltage_v() * MICRO),
                "voltage_max_design": lambda: round(MAX_DESIGN_V * MICRO),
                "voltage_min_design": lambda: round(MIN_DESIGN_V * MICRO),
                "technology": lambda: "Li-ion",
                "type": lambda: "Battery",
                "scope": lambda: "System",
            },
            {},
        )

    def current_a(self) -> float:
        """Return the present current in amperes."""
        return BRICK_A + sum(map(self._motor_a, self._session.sim.motors))

    def _motor_a(self, motor: Motor) -> float:
        if motor.mode == STOPPED:
            return 0.0
        if motor.blocked_ticks:
            return BLOCKED_A
        return self._turning_a(motor.speed_dps)

    def _turning_a(self, speed_dps: float) -> float:
        return RUNNING_A + SPEED_A * abs(speed_dps) / self._max_dps

    def voltage_v(self) -> float:
        """Return the present voltage in volts."""
        used = self._charge_used_as() / S_PER_H / CAPACITY_AH
        full_v = self._full_v
        open_v = full_v - max(full_v - EMPTY_V, 0.0) * used
        return max(min(EMPTY_V, full_v), open_v) - INNER_OHM * self.current_a()

    def _charge_used_as(self) -> float:
        """Return the charge drawn since the start, in ampere seconds."""
        sim = self._session.sim
        tick_s = 1 / sim.spec.profile.tick_hz
        for record in sim.read_records(self._records):
            self._records += 1
            left_dps = record[7]
            right_dps = record[8]
            flags = int(record[10])
            drawn_a = BRICK_A
            if flags & FLAG_LEFT_RUNNING:
                drawn_a += self._turning_a(left_dps)
            if flags & FLAG_RIGHT_RUNNING:
                drawn_a += self._turning_a(right_dps)
            self._drawn_as += drawn_a * tick_s
        return self._drawn_as
