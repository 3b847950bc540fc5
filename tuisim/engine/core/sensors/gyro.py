"""Gyro: clockwise turn in degrees since the last reset, and its rate."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from tuisim.engine.core.columns import Column

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import GyroSpec, RunSpec
    from tuisim.engine.core.state import Instant


def angle_deg(instant: Instant) -> int:
    """Return the clockwise angle since the last reset, in whole degrees, not wrapped."""
    return round(instant.gyro_zero_deg - instant.pose.heading_deg)


def rate_dps(instant: Instant) -> int:
    """Return the clockwise rate of turn, in whole degrees per second, as far as the sensor measures it."""
    fastest = instant.profile.gyro_max_dps or inf
    return round(max(-fastest, min(fastest, -instant.turn_rate_dps)))


def columns(spec: GyroSpec) -> tuple[Column, ...]:
    """Return the columns of a gyro."""
    name = spec.name
    return (
        Column(f"{name}_deg", is_traced=True, also=(name, f"{name} °")),
        Column(f"{name}_rate_dps", also=(f"{name}.rate",)),
    )


def measure(spec: GyroSpec, instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return the values of `columns`."""
    return float(angle_deg(instant)), float(rate_dps(instant))
