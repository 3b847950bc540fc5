"""Where on a robot its further sensors sit, and what they are called."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tuisim.engine.core.sensor_places import LOOKS, ORDERS, Body, place_sensor
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    RobotSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.programs.robot.library import DeviceKind
from tuisim.programs.robot.mentions import Mention
from tuisim.programs.robot.words import Side, find_side, is_aside

_ASIDE = (Side.LEFT, Side.RIGHT, Side.BACK)
_ROW = (Side.LEFT, Side.MIDDLE, Side.RIGHT)


def add_sides(mentions: Sequence[Mention]) -> list[Mention]:
    """Return the mentions; if one call creates three colour sensors in a row, name them left, centre and right.

    This is done only if none of the program's own names for the three sensors says a side.
    """
    calls = [
        mention.call for mention in mentions if mention.kind is DeviceKind.COLOR and mention.port
    ]
    rows = [call for call in calls if call is not None and calls.count(call) == len(_ROW)]
    unsaid = [
        mention
        for mention in mentions
        if mention.call in rows and find_side(mention.names) is Side.NONE
    ]
    sides = dict(zip(unsaid, _ROW, strict=True)) if len(unsaid) == len(_ROW) else {}
    return [
        replace(mention, names=(sides[mention], *mention.names)) if mention in sides else mention
        for mention in mentions
    ]


def say_other_sides(mentions: Mapping[str, Mention], usual: Mapping[str, SensorSpec]) -> bool:
    """Return whether a program's names put one of its colour sensors on another side than the usual robot has it.

    If all ports of the program's colour sensors have a colour sensor in the usual robot, too, the result is True only
    if the names of all these sensors say left or right.

    Args:
        mentions: The devices that the program creates, by port.
        usual: The sensors of the usual robot, by port.
    """
    colors = {
        port: mention for port, mention in mentions.items() if mention.kind is DeviceKind.COLOR
    }
    known = {
        port: usual[port].name for port in colors if isinstance(usual.get(port), ColorSensorSpec)
    }
    sides = {port: find_side(colors[port].names) for port in known}
    are_said = all(side in (Side.LEFT, Side.RIGHT) for side in sides.values())
    return (len(known) < len(colors) or are_said) and any(
        side and side != known[port] for port, side in sides.items()
    )


def choose_likeliest(sensors: list[SensorSpec], mention: Mention) -> SensorSpec:
    """Return the sensor on the side that the program's name for it says, as in `left_sensor`; else the first one."""
    side = find_side(mention.names)
    return next((sensor for sensor in sensors if sensor.name == side), sensors[0])


def place_sensors(
    new: Mapping[str, Mention],
    placed: Mapping[str, SensorSpec],
    body: Body,
    doubts: list[str],
) -> dict[str, SensorSpec]:
    """Return new sensors by port, with positions and names that no other sensor has.

    Args:
        new: The devices that the program creates and the usual robot does not have, by port.
        placed: The other sensors, by port.
        body: The robot's body.
        doubts: A list to which a sentence is added for each sensor that cannot be built.
    """
    sensors: dict[str, SensorSpec] = {}
    for kind, spec in SENSOR_SPECS.items():
        mentions = {port: mention for port, mention in sorted(new.items()) if mention.kind is kind}
        known = [*placed.values(), *sensors.values()]
        names = {sensor.name for sensor in known}
        if kind is DeviceKind.GYRO:
            mounted = any(isinstance(sensor, GyroSpec) for sensor in known)
            for port in list(mentions)[0 if mounted else 1 :]:
                doubts.append(f"a robot has one gyro: that on {port} is not built")
                del mentions[port]
        sides = _choose_sides(
            mentions,
            first_free=not any(isinstance(sensor, spec) for sensor in known),
            kind=kind,
        )
        for port, side in sides.items():
            sensor = place_sensor(spec, port, side, names, body)
            names.add(sensor.name)
            sensors[port] = sensor
    return sensors


SENSOR_SPECS: Mapping[DeviceKind, type[SensorSpec]] = {
    DeviceKind.COLOR: ColorSensorSpec,
    DeviceKind.ULTRASONIC: UltrasonicSpec,
    DeviceKind.GYRO: GyroSpec,
    DeviceKind.TOUCH: TouchSpec,
    DeviceKind.INFRARED: InfraredSpec,
}
"""The class of spec of each kind of sensor."""


def _choose_sides(
    mentions: Mapping[str, Mention], *, first_free: bool, kind: DeviceKind
) -> dict[str, Side]:
    """Return the side of each sensor by port: the side that the sensor's name says, else the next free side.

    Args:
        mentions: The sensors, by port.
        first_free: Whether no other sensor of the kind is on the robot.
        kind: The kind of the sensors.
    """
    sides = {port: find_side(mention.names) for port, mention in mentions.items()}
    if kind is DeviceKind.TOUCH and first_free and len(sides) == 1 and Side.NONE in sides.values():
        return dict.fromkeys(sides, Side.FRONT)
    orders = [Side(side) for side in ORDERS[SENSOR_SPECS[kind]]]
    taken = {*sides.values()} | (
        set() if first_free or kind in (DeviceKind.TOUCH, DeviceKind.COLOR) else {Side.FRONT}
    )
    for port, side in sides.items():
        if side is Side.NONE or [*sides.values()].count(side) > 1:
            free = [other for other in orders if other not in taken]
            sides[port] = free[0] if free else orders[-1]
            taken.add(sides[port])
    return sides


def on_port(sensor: Any, port: str) -> SensorSpec:
    """Return a copy of a sensor on another port."""
    moved: SensorSpec = replace(sensor, port=port)
    return moved


def mount(sensor: SensorSpec, mention: Mention) -> SensorSpec:
    """Return a distance sensor turned to the side or back if the program's name for the sensor says this.

    Other sensors are returned unchanged.
    """
    side = find_side(mention.names) or (Side.RIGHT if is_aside(mention.names) else Side.NONE)
    if not isinstance(sensor, UltrasonicSpec | InfraredSpec) or side not in _ASIDE:
        return sensor
    x_mm, y_mm, angle_deg = LOOKS[side]
    return replace(sensor, x_mm=x_mm, y_mm=y_mm, angle_deg=angle_deg)


def build_fields(placed: Mapping[str, SensorSpec], usual: RobotSpec) -> dict[str, Any]:
    """Return sensors as values by field name of `RobotSpec`.

    In each field, the sensors of the usual robot come first, in its order, and then all others.
    """
    order = [sensor.name for sensor in usual.sensors]
    sensors = sorted(
        placed.values(),
        key=lambda part: order.index(part.name) if part.name in order else len(order),
    )
    colors = [part for part in sensors if isinstance(part, ColorSensorSpec)]
    ultrasonics = [part for part in sensors if isinstance(part, UltrasonicSpec)]
    infrareds = [part for part in sensors if isinstance(part, InfraredSpec)]
    front = next((part for part in ultrasonics if part.name == UltrasonicSpec().name), None)
    infrared = next((part for part in infrareds if part.name == InfraredSpec().name), None)
    return {
        "color_sensors": tuple(colors),
        "ultrasonic": front,
        "gyro": next((part for part in sensors if isinstance(part, GyroSpec)), None),
        "extra_ultrasonics": tuple(part for part in ultrasonics if part is not front),
        "touch_sensors": tuple(part for part in sensors if isinstance(part, TouchSpec)),
        "infrared": infrared,
        "extra_infrareds": tuple(part for part in infrareds if part is not infrared),
    }


KINDS: Mapping[type, DeviceKind] = {spec: kind for kind, spec in SENSOR_SPECS.items()}
"""The kind of each sensor, by the class of its spec."""


def name_sensor(sensor: SensorSpec) -> str:
    """Return a sensor in words, such as `left colour sensor`."""
    kind = KINDS[type(sensor)]
    return f"{sensor.name} {kind}" if kind is DeviceKind.COLOR else str(kind)


def find_path(sensor: SensorSpec) -> str:
    """Return the key of a sensor in a robot file, such as `color_sensors.left`."""
    match sensor:
        case ColorSensorSpec():
            return f"color_sensors.{sensor.name}"
        case TouchSpec():
            return f"touch_sensors.{sensor.name}"
        case UltrasonicSpec() if sensor.name != UltrasonicSpec().name:
            return f"ultrasonics.{sensor.name}"
        case InfraredSpec() if sensor.name != InfraredSpec().name:
            return f"infrareds.{sensor.name}"
    return sensor.name
