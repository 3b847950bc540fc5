"""Sensors: one file for each kind, and the table of kinds.

To add a sensor: write its frozen spec and add a field of `RobotSpec` in `engine.core.spec`, write its file, with
its columns and pure functions from an `Instant` to values, and add a line to `SENSORS`; its device and a line in
`DEVICES` go to `engine/shim/sensors.py`. Robot files, settings, breakpoints, the telemetry frame, the panels and the
contract test walk these tables.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from math import inf
from typing import Any, NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.engine.core.collision import TOUCH_MM, Solids
from tuisim.engine.core.columns import (
    MOTION,
    Column,
    find_column_name,
    list_measured_names,
    measure_motion,
)
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.motor_columns import find_motor_owners
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.sensors import color, gyro, infrared, touch, ultrasonic
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    RobotSpec,
    RunSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
    WorldSpec,
)
from tuisim.engine.core.state import Instant


@dataclass(frozen=True, slots=True)
class SensorKind:
    """The columns of one kind of sensor, how they are measured, and the sensor's names in the kernel."""

    driver_name: str
    """Name of the kernel driver; `ev3dev2` searches for this name."""
    spec: type
    columns: Callable[[Any], tuple[Column, ...]]
    """Takes a sensor's spec; returns the sensor's columns in telemetry."""
    measure: Callable[[Any, Instant, RunSpec, Field], tuple[float, ...]]
    """Takes a sensor's spec, an instant, the run's spec and the field; returns the values of the measured columns."""
    port_mode: str = "ev3-uart"
    """The port mode that the sensor needs; `ev3-analog` for a sensor without a processor of its own."""

    def names(self, sensor: Any) -> tuple[str, ...]:
        """Return the names of a sensor's measured columns."""
        return list_measured_names(self.columns(sensor))


SENSORS: Mapping[str, SensorKind] = {
    "color": SensorKind("lego-ev3-color", ColorSensorSpec, color.columns, color.measure),
    "ultrasonic": SensorKind("lego-ev3-us", UltrasonicSpec, ultrasonic.columns, ultrasonic.measure),
    "gyro": SensorKind("lego-ev3-gyro", GyroSpec, gyro.columns, gyro.measure),
    "touch": SensorKind("lego-ev3-touch", TouchSpec, touch.columns, touch.measure, "ev3-analog"),
    "infrared": SensorKind("lego-ev3-ir", InfraredSpec, infrared.columns, infrared.measure),
}
"""All kinds of sensors, in the order of the telemetry columns."""


Measure = Callable[[Instant, RunSpec, Field], tuple[float, ...]]
"""Takes the instant, the run's spec and the field; returns the values of an owner's measured columns."""


def list_owners(run: RunSpec) -> list[tuple[tuple[Column, ...], Measure]]:
    """Return the columns of the robot, of each sensor and of each motor with a driver.

    Each group of columns comes with the function that measures its values.
    """
    of_sensors = [
        (mount.columns, partial(mount.kind.measure, mount.sensor))
        for mount in list_mounted(run.robot)
    ]
    return [(MOTION, measure_motion), *of_sensors, *find_motor_owners(run)]


def list_columns(run: RunSpec) -> tuple[Column, ...]:
    """Return the columns of a run, in the order of telemetry."""
    return tuple(column for columns, _ in list_owners(run) for column in columns)


def list_column_names(run: RunSpec) -> tuple[str, ...]:
    """Return the names of all columns of a run, in the order of telemetry."""
    return tuple(column.name for column in list_columns(run))


def find_named_column(text: str, run: RunSpec) -> str:
    """Return the name of the column that a text such as `left_red_pc` names; see `find_column_name`.

    Earlier spellings of names are accepted, too.

    Raises:
        ConfigError: the run has no such column.
    """
    name = find_column_name(text, list_columns(run))
    if name is None:
        measured = list_column_names(replace(run, profile=PROFILES["ev3"]))
        hint = (
            "only profile ev3 has it" if text in measured else nearest(text, list_column_names(run))
        )
        raise ConfigError(f"this robot has no {text!r}", hint)
    return name


def build_reader(name: str, run: RunSpec) -> Callable[[Instant, RunSpec, Field], float] | None:
    """Return a function that returns the value of a column at an instant; None if the run has no such column.

    The instant must have been built with `with_motors=True`.
    """
    for columns, measure in list_owners(run):
        for column in columns:
            if column.name == name:
                return partial(_measure_value, column, list_measured_names(columns), measure)
    return None


def _measure_value(
    column: Column,
    names: tuple[str, ...],
    measure: Measure,
    instant: Instant,
    spec: RunSpec,
    field: Field,
) -> float:
    measured = measure(instant, spec, field)
    return (
        measured[names.index(column.name)] if column.of is None else column.of([measured], spec)[0]
    )


def measure_sensors(
    sensors: Iterable[SensorSpec], instant: Instant, spec: RunSpec, field: Field
) -> dict[str, float]:
    """Return the values of the sensors' measured columns at an instant, by the name of the column."""
    return {
        name: value
        for mount in map(build_mounted_sensor, sensors)
        for name, value in zip(
            mount.names,
            mount.kind.measure(mount.sensor, instant, spec, field),
            strict=True,
        )
    }


class MountedSensor(NamedTuple):
    """A sensor of a robot, with its kind and the columns that it has in telemetry."""

    kind: SensorKind
    sensor: Any
    """The sensor's spec."""
    columns: tuple[Column, ...]
    names: tuple[str, ...]
    """Names of the measured columns."""


_KINDS = {kind.spec: kind for kind in SENSORS.values()}


@lru_cache(maxsize=64)
def build_mounted_sensor(sensor: SensorSpec) -> MountedSensor:
    """Return a sensor together with its kind and its columns."""
    kind = _KINDS[type(sensor)]
    return MountedSensor(kind, sensor, kind.columns(sensor), kind.names(sensor))


@lru_cache(maxsize=16)
def list_mounted(robot: RobotSpec) -> tuple[MountedSensor, ...]:
    """Return the robot's sensors with their kinds and columns, in the order of the telemetry columns."""
    return tuple(map(build_mounted_sensor, robot.sensors))


def measure_obstacle(
    sensor: UltrasonicSpec | InfraredSpec, spec: RunSpec, world: WorldSpec, pose: Pose
) -> float:
    """Return the reading of a sensor that sees an obstacle of a world: in mm, or in percent for an infrared sensor.

    The result is infinite if the sensor sees no obstacle, or if the robot, at this pose, overlaps one.
    """
    bare = replace(world, obstacles=())
    if isinstance(sensor, UltrasonicSpec):
        distance = ultrasonic.measure_distance_mm(pose, sensor, world)
        free = ultrasonic.measure_distance_mm(pose, sensor, bare)
        is_seen = spec.profile.min_echo_mm <= distance < free
    else:
        distance = infrared.proximity(pose, sensor, world)
        is_seen = distance < infrared.proximity(pose, sensor, bare)
    gaps = Solids(world, spec.robot).measure_gaps_mm((pose.x_mm, pose.y_mm, pose.heading_deg))
    return distance if is_seen and min(gaps, default=0.0) >= -TOUCH_MM else inf
