"""The state of the world at one tick."""

from __future__ import annotations

from tuisim.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec
from tuisim.data_class import dataclass


@dataclass(frozen=True, slots=True)
class Instant:
    """One moment of a run: the values that the telemetry stores for a tick."""

    tick: int
    pose: Pose
    left_position_deg: float = 0.0
    right_position_deg: float = 0.0
    left_speed_dps: float = 0.0
    right_speed_dps: float = 0.0
    turn_rate_dps: float = 0.0
    """Counter-clockwise, over the last tick, as a gyro senses it."""
    gyro_zero_deg: float = 0.0
    """Heading at which the gyro reads 0."""
    end_flags: int = 0
    """Which end stops the motors are at that drive no wheel: the bits of `core.end_stops`."""
    noise: NoiseSpec = NoiseSpec()
    drift: DriftSpec = NO_DRIFT
    seed: int = 0
