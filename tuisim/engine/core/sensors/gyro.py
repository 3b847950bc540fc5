"""Gyro: clockwise turn in degrees since the last reset, and its rate."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine.core.columns import Column

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import GyroSpec, RunSpec
    from tuisim.engine.core.state import Instant


def columns(spec: GyroSpec) -> tuple[Column, ...]:
    """Return the telemetry columns of a gyro: its angle and its rate of turn."""
    name = spec.name
    return (
        Column(f"{name}_deg", is_traced=True, also=(name, f"{name} °")),
        Column(f"{name}_rate_dps", also=(f"{name}.rate",)),
    )


def measure(spec: GyroSpec, instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return what a gyro shows at an instant: the angle in degrees and the rate in degrees per second, clockwise."""
    return float(instant.gyro_deg), float(instant.gyro_rate_dps)
