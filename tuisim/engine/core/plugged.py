"""Parts that are plugged in while a program runs, and the robot with these parts.

A run begins with its first robot. A part that is plugged in replaces the part that was on its port. New motors are
added after all others, so that a motor keeps its number.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import HUB_MOTORS, HUB_PORTS
from tuisim.engine.core.sensor_places import ORDERS, measure_body, place_sensor
from tuisim.engine.core.spec import (
    INPUT_PORTS,
    MOUNTS,
    NO_PORT,
    OUTPUT_PORTS,
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    MotorSpec,
    RobotSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)

MOTOR_PARTS: Mapping[str, str] = {"LargeMotor": "large", "MediumMotor": "medium"}
"""Kinds of motors of the EV3, by the classes of parts."""
HUB_MOTOR_PARTS: Mapping[str, str] = {
    f"{''.join(word.capitalize() for word in kind.split('-'))}Motor": kind for kind in HUB_MOTORS
}
"""Kinds of motors of the hubs, by the classes of parts, such as `MediumAngularMotor`."""
MOTOR_KIND_OF: Mapping[str, str] = {**MOTOR_PARTS, **HUB_MOTOR_PARTS}
"""Kinds of all motors, by the classes of parts."""
SENSOR_PARTS: Mapping[str, type[SensorSpec]] = {
    "ColorSensor": ColorSensorSpec,
    "UltrasonicSensor": UltrasonicSpec,
    "GyroSensor": GyroSpec,
    "TouchSensor": TouchSpec,
    "InfraredSensor": InfraredSpec,
}
"""Classes of sensors, by the classes of parts."""
PLUGGED_DIAMETER_MM = ColorSensorSpec("color", "in1", 0.0, 0.0).diameter_mm
"""Diameter of the disc that a plugged-in colour sensor sees."""
LEFT = "left"
RIGHT = "right"
LATE = "late"
ROLES = ("", LEFT, RIGHT, LATE)
"""What a plugged-in motor drives: no wheel, the left or right wheel, or no wheel only because it came too late."""


PART_CODES: Mapping[tuple[str, str, str], int] = {
    place: code
    for code, place in enumerate(
        (
            *product(ROLES, (*OUTPUT_PORTS, *INPUT_PORTS), (*MOTOR_PARTS, *SENSOR_PARTS)),
            *product(ROLES, HUB_PORTS, (*HUB_MOTOR_PARTS, *SENSOR_PARTS)),
        )
    )
    if place[1] in HUB_PORTS or (place[1] in OUTPUT_PORTS) == (place[2] in MOTOR_PARTS)
}
"""The number by which commands name a plugged-in part, for each role, port and class of part that fit together."""


@dataclass(frozen=True, slots=True)
class PluggedPart:
    """A motor or sensor that tuisim plugged into the robot during a run, because the program used it."""

    port: str
    part: str
    """The part's class, such as `ColorSensor`: a key of `MOTOR_KIND_OF` or `SENSOR_PARTS`."""
    tick: int
    """The part was plugged in after this tick and before the next."""
    line: int
    """The line of the program that needed the part; 0 if no line did."""
    role: str = ""
    """What the motor drives, one of `ROLES`. The entry of a left wheel's motor is followed by that of the right
    wheel's."""

    def __post_init__(self) -> None:
        if (self.role, self.port, self.part) not in PART_CODES:
            raise ValueError(f"there is no part {self.part!r} on {self.port!r} as {self.role!r}")

    def to_plain(self) -> dict[str, Any]:
        """Return the part as a dictionary for JSON, as it is stored with a run."""
        plain = {"port": self.port, "class": self.part, "tick": self.tick, "line": self.line}
        return {**plain, "role": self.role} if self.role else plain

    @classmethod
    def from_plain(cls, plain: Mapping[str, Any]) -> PluggedPart:
        """Return the part that `to_plain` has turned into a dictionary.

        Raises:
            KeyError, TypeError, ValueError: the data is not a part.
        """
        tick = int(plain["tick"])
        line = int(plain["line"])
        return cls(plain["port"], plain["class"], tick, line, plain.get("role", ""))


def plug_parts(robot: RobotSpec, parts: Sequence[PluggedPart]) -> RobotSpec:
    """Return the robot with these parts plugged in one after another; a part replaces an earlier one on its port."""
    for part, following in pairwise([*parts, None]):
        assert part is not None
        if part.role == LEFT:
            # A change of the wheels is two parts, the left and the right wheel: both are replaced together.
            robot = robot if following is None else _change_wheels(robot, part, following)
        elif part.role != RIGHT:
            robot = _plug_part(robot, part)
    return robot


def _plug_part(robot: RobotSpec, part: PluggedPart) -> RobotSpec:
    if part.part in SENSOR_PARTS:
        return _add_sensor(robot, part.port, SENSOR_PARTS[part.part])
    motor = MotorSpec(part.port, MOTOR_KIND_OF[part.part])
    others = _leave_out(robot.extra_motors, (part.port,))
    if part.port in (robot.left_port, robot.right_port):
        # A robot with one wheel cannot drive, so the motor of the other wheel is taken off its port, too.
        robot = _put_wheels(
            robot, *(replace(wheel_motor, port=NO_PORT) for wheel_motor in robot.wheel_motors)
        )
    return replace(robot, extra_motors=(*others, motor))


def _change_wheels(robot: RobotSpec, left: PluggedPart, right: PluggedPart) -> RobotSpec:
    others = _leave_out(robot.extra_motors, (left.port, right.port))
    wheels = (MotorSpec(side.port, MOTOR_KIND_OF[side.part]) for side in (left, right))
    return _put_wheels(replace(robot, extra_motors=others), *wheels)


def _put_wheels(robot: RobotSpec, left: MotorSpec, right: MotorSpec) -> RobotSpec:
    return replace(
        robot,
        left_port=left.port,
        right_port=right.port,
        left_motor=left.kind,
        right_motor=right.kind,
    )


def _leave_out(motors: Iterable[MotorSpec], ports: Iterable[str]) -> tuple[MotorSpec, ...]:
    return tuple(motor for motor in motors if motor.port not in ports)


def _add_sensor(robot: RobotSpec, port: str, kind: type[SensorSpec]) -> RobotSpec:
    """Return a robot with a new sensor on a port, at a free position of the body.

    It replaces the part on the port. A gyro also replaces the gyro that the robot had.

    Args:
        robot: The robot.
        port: The port.
        kind: The class of the sensor's spec.
    """
    others = [
        sensor
        for sensor in robot.sensors
        if sensor.port != port and not (kind is GyroSpec and isinstance(sensor, GyroSpec))
    ]
    names = {sensor.name for sensor in others}
    alike = [sensor for sensor in others if isinstance(sensor, kind)]
    body = measure_body(robot)
    sides = ORDERS[kind] if alike or kind is not TouchSpec else ("front",)
    choices = [place_sensor(kind, port, side, names, body) for side in sides]
    places = {_find_place(sensor) for sensor in alike}
    new = next((choice for choice in choices if _find_place(choice) not in places), choices[-1])
    return _put_sensors(robot, [*others, new])


def _find_place(sensor: Any) -> tuple[float, float]:
    return getattr(sensor, "x_mm", 0.0), getattr(sensor, "y_mm", 0.0)


def _put_sensors(robot: RobotSpec, sensors: Sequence[SensorSpec]) -> RobotSpec:
    """Return the robot with these sensors instead of its own; those of one kind are in the given order."""
    fields: dict[str, Any] = {}
    left = [*sensors]
    for mount in sorted(MOUNTS, key=lambda mount: mount.many):
        alike = [sensor for sensor in left if type(sensor) is mount.spec]
        if mount.many:
            fields[mount.field] = tuple(alike)
        else:
            before = getattr(robot, mount.field)
            first = next(
                (sensor for sensor in alike if sensor == before), alike[0] if alike else None
            )
            fields[mount.field], alike = first, alike[:0] if first is None else [first]
        left = [sensor for sensor in left if sensor not in alike]
    return replace(robot, **fields)
