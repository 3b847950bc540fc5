"""Sensors: one file for each kind, and the table of kinds.

To add a sensor: write its frozen spec and add its place on the robot (`MOUNTS` in `core.spec`), write its file,
pure functions from an `Instant` to values, and add a line to `SENSORS`; its device and a line in `DEVICES` go to
`shim/sensors.py`. Robot files, settings, breakpoints, the telemetry frame, the panels and the contract test walk
these tables.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from tuisim.core.field import Field
from tuisim.core.sensors import color, gyro, infrared, touch, ultrasonic
from tuisim.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    RobotSpec,
    RunSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.core.state import Instant


@dataclass(frozen=True, slots=True)
class SensorKind:
    """How one kind of sensor is measured and named."""

    driver_name: str
    """Name of the kernel driver; `ev3dev2` searches for this name."""
    spec: type
    columns: Callable[[Any], tuple[str, ...]]
    """Takes a sensor's spec; returns the names of its telemetry columns."""
    measure: Callable[[Any, Instant, RunSpec, Field], tuple[float, ...]]
    """Takes spec and instant; returns the values of those columns."""
    port_mode: str = "ev3-uart"
    """The port mode it needs; `ev3-analog` for a sensor without a processor of its own."""


SENSORS: Mapping[str, SensorKind] = {
    "color": SensorKind("lego-ev3-color", ColorSensorSpec, color.columns, color.measure),
    "ultrasonic": SensorKind("lego-ev3-us", UltrasonicSpec, ultrasonic.columns, ultrasonic.measure),
    "gyro": SensorKind("lego-ev3-gyro", GyroSpec, gyro.columns, gyro.measure),
    "touch": SensorKind("lego-ev3-touch", TouchSpec, touch.columns, touch.measure, "ev3-analog"),
    "infrared": SensorKind("lego-ev3-ir", InfraredSpec, infrared.columns, infrared.measure),
}
"""All kinds of sensors, in the order of the telemetry columns."""


def mounted(robot: RobotSpec) -> list[tuple[SensorKind, Any]]:
    """Return the robot's sensors as (kind, spec), in the order of the telemetry columns."""
    return with_kinds(robot.sensors)


def with_kinds(sensors: Iterable[SensorSpec]) -> list[tuple[SensorKind, Any]]:
    """Return each sensor with its kind, as (kind, spec)."""
    kinds = {kind.spec: kind for kind in SENSORS.values()}
    return [(kinds[type(sensor)], sensor) for sensor in sensors]
