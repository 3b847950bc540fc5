"""The electric motor: how its axle turns under a mean voltage, in closed form.

`engine.core.driver.figures` has the source of each constant.
"""

from __future__ import annotations

from dataclasses import replace
from math import degrees, exp, inf, log

from tuisim.base.data_class import dataclass

NS_PER_S = 1_000_000_000
STEP_NS = 2_000_000
"""Period of the control in a motor's driver, in ns."""
STEP_S = STEP_NS / NS_PER_S


@dataclass(frozen=True, slots=True)
class PlantSpec:
    """The physical constants of a motor together with the load that it moves, such as its inertia and friction."""

    resistance_ohm: float
    """Resistance of the winding, the bridge and the battery."""
    back_emf_v_s: float
    torque_nm_per_a: float
    inertia_kg_m2: float
    damping_nm_s: float
    friction_nm: float
    """Torque of the friction that slows a turning axle, in Nm."""
    breakaway_nm: float
    """Largest torque, in Nm, at which an axle at rest does not yet turn."""

    def add_load(self, inertia_kg_m2: float, friction_nm: float) -> PlantSpec:
        """Return the constants of the motor with a further load."""
        return replace(
            self,
            inertia_kg_m2=self.inertia_kg_m2 + inertia_kg_m2,
            friction_nm=self.friction_nm + friction_nm,
            breakaway_nm=self.breakaway_nm + friction_nm,
        )


LARGE = PlantSpec(
    resistance_ohm=6.832749,
    back_emf_v_s=0.459966,
    torque_nm_per_a=0.304767,
    inertia_kg_m2=0.001502739,
    damping_nm_s=0.000726962,
    friction_nm=0.0118,
    breakaway_nm=0.0232,
)
MEDIUM = PlantSpec(
    resistance_ohm=10.71,
    back_emf_v_s=0.2915,
    torque_nm_per_a=0.2276,
    inertia_kg_m2=0.0003,
    damping_nm_s=0.0005,
    friction_nm=0.0092,
    breakaway_nm=0.012,
)


@dataclass(frozen=True, slots=True)
class Circuit:
    """Values that are computed once from a motor's constants and its battery, such as the steady speed.

    A motor has two such objects: one for the time in which it is powered or brakes, one for the time in which it
    coasts.
    """

    dps_per_percent: float
    """Steady speed per percent of duty, without friction; 0 while it coasts."""
    friction_dps: float
    """How much friction lowers the steady speed, in degrees per second."""
    breakaway_dps: float
    """An axle at rest does not start if its steady speed without friction would be lower than this."""
    time_constant_s: float
    step_decay: float
    """Share of the difference between the speed and the steady speed that remains after one step of the control."""


def build_circuit(plant: PlantSpec, battery_v: float | None) -> Circuit:
    """Return the circuit of a motor on a battery; if `battery_v` is None, that of a motor that coasts."""
    damping = plant.damping_nm_s
    torque_per_percent = 0.0
    if battery_v is not None:
        per_v = plant.torque_nm_per_a / plant.resistance_ohm
        damping += per_v * plant.back_emf_v_s
        torque_per_percent = per_v * battery_v / 100
    time_constant_s = plant.inertia_kg_m2 / damping
    return Circuit(
        dps_per_percent=degrees(torque_per_percent / damping),
        friction_dps=degrees(plant.friction_nm / damping),
        breakaway_dps=degrees(plant.breakaway_nm / damping),
        time_constant_s=time_constant_s,
        step_decay=exp(-STEP_NS / NS_PER_S / time_constant_s),
    )


class Axle:
    """The axle of a motor. At the beginning it is at rest, and the motor coasts.

    Args:
        plant: The motor, with its load.
        battery_v: The voltage of the battery without load.
    """

    __slots__ = (
        "_coasting",
        "_powered",
        "angle_deg",
        "circuit",
        "goal_dps",
        "high_deg",
        "low_deg",
        "speed_dps",
    )

    def __init__(self, plant: PlantSpec, battery_v: float) -> None:
        self._powered, self._coasting = build_circuit(plant, battery_v), build_circuit(plant, None)
        self.circuit = self._coasting
        self.goal_dps = 0.0
        """The steady speed to which the duty would lead without friction, in degrees per second."""
        self.angle_deg = 0.125
        """Angle from the counter's zero; the axle begins in the middle of a count."""
        self.speed_dps = 0.0
        self.low_deg, self.high_deg = -inf, inf
        """An obstacle keeps the axle between these angles."""

    def change_load(self, plant: PlantSpec, battery_v: float) -> None:
        """Change the load that the motor moves from now on.

        Args:
            plant: The motor, with its new load.
            battery_v: The voltage of the battery without load.
        """
        is_powered = self.circuit is self._powered
        self._powered, self._coasting = build_circuit(plant, battery_v), build_circuit(plant, None)
        self.circuit = self._powered if is_powered else self._coasting

    @property
    def stands(self) -> bool:
        """Whether the axle is at rest, and its motor is too weak to turn it."""
        return self.speed_dps == 0.0 and abs(self.goal_dps) <= self.circuit.breakaway_dps

    @property
    def is_blocked(self) -> bool:
        """Whether the axle is at rest only because of an obstacle: the motor is strong enough to turn it."""
        return not (self.speed_dps or self.stands or self._can_start(self.goal_dps > 0.0))

    @property
    def turns_freely(self) -> bool:
        """Whether the axle turns, its motor does not coast, and no obstacle limits the axle."""
        return (
            self.circuit is self._powered
            and self.speed_dps != 0.0
            and self.low_deg == -inf
            and self.high_deg == inf
        )

    def power(self, duty: float | None) -> None:
        """Set the power of the motor in percent, called duty: 0 brakes the motor, and None lets it coast."""
        self.circuit = self._coasting if duty is None else self._powered
        self.goal_dps = 0.0 if duty is None else duty * self._powered.dps_per_percent

    def turn_step(self) -> bool:
        """Turn the axle for one step of the control; return whether it has turned.

        If the axle would come to rest or meet an obstacle during the step, nothing changes and the result is False.
        """
        circuit = self.circuit
        speed_dps = self.speed_dps
        if speed_dps > 0.0:
            end_dps = self.goal_dps - circuit.friction_dps
            after_dps = end_dps + (speed_dps - end_dps) * circuit.step_decay
            if after_dps <= 0.0:
                return False
        else:
            end_dps = self.goal_dps + circuit.friction_dps
            after_dps = end_dps + (speed_dps - end_dps) * circuit.step_decay
            if after_dps >= 0.0 or speed_dps == 0.0:
                return False
        turned_deg = end_dps * STEP_S + (speed_dps - after_dps) * circuit.time_constant_s
        angle_deg = self.angle_deg + turned_deg
        if not self.low_deg <= angle_deg <= self.high_deg:
            return False
        self.angle_deg = angle_deg
        self.speed_dps = after_dps
        return True

    def advance(self, duration_ns: float) -> float:
        """Turn the axle for a time, or until friction stops it; return the time that is then left, in ns.

        The result is 0 if an obstacle stops the axle, or if the axle was at rest and does not start.
        """
        circuit = self.circuit
        speed_dps = self.speed_dps
        forwards = speed_dps > 0.0 if speed_dps else self.goal_dps > 0.0
        if not speed_dps and not self._can_start(forwards):
            return 0.0
        constant_s = circuit.time_constant_s
        decay = circuit.step_decay
        if duration_ns != STEP_NS:
            decay = exp(-duration_ns / NS_PER_S / constant_s)
        end_dps = self.goal_dps - (circuit.friction_dps if forwards else -circuit.friction_dps)
        after_dps = end_dps + (speed_dps - end_dps) * decay
        left_ns = 0.0
        if after_dps < 0.0 if forwards else after_dps > 0.0:
            until_rest_ns = constant_s * log(1.0 - speed_dps / end_dps) * NS_PER_S
            after_dps = 0.0
            left_ns = max(duration_ns - until_rest_ns, 0.0)
            duration_ns = until_rest_ns
        self.angle_deg += end_dps * duration_ns / NS_PER_S + (speed_dps - after_dps) * constant_s
        self.speed_dps = after_dps
        if not self.low_deg <= self.angle_deg <= self.high_deg:
            self.angle_deg = min(max(self.angle_deg, self.low_deg), self.high_deg)
            self.speed_dps = left_ns = 0.0
        return left_ns

    def _can_start(self, forwards: bool) -> bool:
        """Return whether an axle at rest begins to turn: the motor is strong enough, and no obstacle is in the way.

        `forwards` is the direction in which the motor pushes.
        """
        if abs(self.goal_dps) <= self.circuit.breakaway_dps:
            return False
        return self.angle_deg < self.high_deg if forwards else self.angle_deg > self.low_deg
