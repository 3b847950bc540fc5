"""Sensors: one file for each kind, and the table of kinds.

To add a sensor: write its frozen spec and add its place on the robot (`MOUNTS` in `core.spec`), write its file, with
its columns and pure functions from an `Instant` to values, and add a line to `SENSORS`; its device and a line in
`DEVICES` go to `shim/sensors.py`. Robot files, settings, breakpoints, the telemetry frame, the panels and the contract
test walk these tables.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from tuisim.core.columns import MOTION, Column, measured_names, motion_of
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
    columns: Callable[[Any], tuple[Column, ...]]
    """Takes a sensor's spec; returns its columns."""
    measure: Callable[[Any, Instant, RunSpec, Field], tuple[float, ...]]
    """Takes spec and instant; returns the values of those columns that are measured."""
    port_mode: str = "ev3-uart"
    """The port mode it needs; `ev3-analog` for a sensor without a processor of its own."""

    def names(self, sensor: Any) -> tuple[str, ...]:
        """Return the names of what is measured of a sensor: its columns of telemetry."""
        return measured_names(self.columns(sensor))


SENSORS: Mapping[str, SensorKind] = {
    "color": SensorKind("lego-ev3-color", ColorSensorSpec, color.columns, color.measure),
    "ultrasonic": SensorKind("lego-ev3-us", UltrasonicSpec, ultrasonic.columns, ultrasonic.measure),
    "gyro": SensorKind("lego-ev3-gyro", GyroSpec, gyro.columns, gyro.measure),
    "touch": SensorKind("lego-ev3-touch", TouchSpec, touch.columns, touch.measure, "ev3-analog"),
    "infrared": SensorKind("lego-ev3-ir", InfraredSpec, infrared.columns, infrared.measure),
}
"""All kinds of sensors, in the order of the telemetry columns."""


@dataclass(frozen=True, slots=True)
class ColumnSource:
    """What measures columns: a sensor, or the robot itself."""

    columns: tuple[Column, ...]
    measure: Callable[[Instant, RunSpec, Field], tuple[float, ...]]
    """Returns the values of the columns that are measured."""

    @property
    def names(self) -> tuple[str, ...]:
        """The names of what is measured."""
        return measured_names(self.columns)

    def values(self, names: Container[str], measured: Sequence[float], robot: RobotSpec) -> dict[str, float]:
        """Return those of its values that have some names, from what is measured at an instant."""
        known = dict(zip(self.names, measured, strict=True))
        return {
            column.name: known[column.name] if column.of is None else float(column.of(measured, robot))
            for column in self.columns
            if column.name in names
        }


def sources(robot: RobotSpec) -> list[ColumnSource]:
    """Return what measures the columns of a robot, in the order of the telemetry columns."""
    of_sensors = [ColumnSource(kind.columns(sensor), partial(kind.measure, sensor)) for kind, sensor in mounted(robot)]
    return [ColumnSource(MOTION, lambda instant, _spec, _field: motion_of(instant)), *of_sensors]


def columns_of(robot: RobotSpec) -> tuple[Column, ...]:
    """Return the columns that every run of a robot has."""
    return tuple(column for source in sources(robot) for column in source.columns)


def reader_of(name: str, robot: RobotSpec) -> Callable[[Instant, RunSpec, Field], float] | None:
    """Return a function that gives the value of a column at an instant; None if the robot has no such column."""
    source = next((one for one in sources(robot) if any(column.name == name for column in one.columns)), None)
    if source is None:
        return None
    measure, values = source.measure, source.values
    return lambda instant, spec, field: values((name,), measure(instant, spec, field), robot)[name]


def mounted(robot: RobotSpec) -> list[tuple[SensorKind, Any]]:
    """Return the robot's sensors as (kind, spec), in the order of the telemetry columns."""
    return with_kinds(robot.sensors)


def with_kinds(sensors: Iterable[SensorSpec]) -> list[tuple[SensorKind, Any]]:
    """Return each sensor with its kind, as (kind, spec)."""
    kinds = {kind.spec: kind for kind in SENSORS.values()}
    return [(kinds[type(sensor)], sensor) for sensor in sensors]
