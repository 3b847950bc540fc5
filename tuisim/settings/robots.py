"""Robots by name or from a file: TOML, or the JSON of the course's browser simulator; written so that they read back.

To add a robot: add an entry to `ROBOTS`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, RobotError, closest, did_you_mean
from tuisim.engine import files
from tuisim.engine.core.hub_spec import HUB_PORTS, INSIDE
from tuisim.engine.core.spec import (
    MOTOR_KINDS,
    MOUNTS,
    OUTPUT_PORTS,
    ROBOT_WEIGHTS,
    SENSOR_NAME,
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    MotorSpec,
    Mount,
    NoiseSpec,
    PenSpec,
    RobotSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.engine.core.values import Part, Value, list_values, quote
from tuisim.engine.files import Location, Scalar


@dataclass(frozen=True, slots=True)
class RobotChoice:
    """A robot from a file, with the other settings in that file."""

    spec: RobotSpec
    motor_noise: int | None = None
    """The default motor noise of a run."""
    own_places: bool = True
    """Whether its colour sensors keep their positions on a mat that defines its own."""
    light_noise: int | None = None
    """The default light noise of a run."""
    notes: tuple[str, ...] = ()
    """Warnings about the file, to be shown to the user."""

    @classmethod
    def load(cls, robot: str | RobotChoice, key: str = "") -> RobotChoice:
        """Return the robot that a setting names: one of tuisim's, or the one in a TOML or JSON file.

        Args:
            robot: The name of the robot, or the path of the file. A robot that was loaded before is returned unchanged.
            key: The option that gives the name, for errors.

        Raises:
            RobotError: the name is unknown, or the file is wrong.
        """
        if isinstance(robot, RobotChoice):
            return robot
        if robot in ROBOTS:
            return cls(ROBOTS[robot], own_places=False)
        data, name, location = files.read_named(robot, "robot", ROBOTS, RobotError, key)
        return (parse_json_robot if robot.lower().endswith(".json") else cls.parse)(
            data, name, location
        )

    @classmethod
    def parse(
        cls, data: object, name: str, location: Location, changes_to: RobotSpec | None = None
    ) -> RobotChoice:
        """Return the robot in a table of a robot or world file.

        Args:
            data: The table.
            name: The name of the robot, unless the table gives one.
            location: The location of the table, for errors.
            changes_to: The robot that provides keys missing in the table, unless the table names its base.

        Raises:
            RobotError: a key or a value is wrong.
        """
        table = files.table(data, location, _TOP_KEYS)
        named = ROBOTS[files.one_of(table.get("base", DEFAULT_ROBOT), location.at("base"), ROBOTS)]
        base = named if changes_to is None or "base" in table else changes_to
        changes: dict[str, Any] = {"name": name}
        changes |= {
            key: files.read_value(table[key], _VALUES[key], location.at(key))
            for key in _BODY_KEYS
            if key in table
        }
        if "pen" in table:
            changes["pen"] = files.read_part(table["pen"], base.pen, location.at("pen"))
        if "motors" in table:
            changes |= _parse_motors(table, base, location)
        for mount in MOUNTS:
            if mount.key in table:
                read = _parse_named if mount.many else _parse_single
                changes[mount.field] = read(table[mount.key], mount, base, location.at(mount.key))
        sensors = table.get("color_sensors", {}).values()
        own_places = any(isinstance(sensor, dict) and "x_mm" in sensor for sensor in sensors)
        return cls(files.with_values(base, changes, location), own_places=own_places)


def _build_sensor_pair(
    x_mm: float, y_mm: float, left_diameter_mm: int, right_diameter_mm: int
) -> tuple[ColorSensorSpec, ...]:
    """Return two colour sensors, symmetric to the robot's axis.

    Args:
        x_mm: Distance of each from the axis.
        y_mm: Distance in front of the midpoint between the wheels.
        left_diameter_mm: Diameter of the left sensor's spot.
        right_diameter_mm: Diameter of the right sensor's spot.
    """
    return (
        ColorSensorSpec("left", "in2", -x_mm, y_mm, left_diameter_mm),
        ColorSensorSpec("right", "in3", x_mm, y_mm, right_diameter_mm),
    )


_SMALL = RobotSpec(
    name="Small_Robot",
    wheel_diameter_mm=28.0,
    wheel_spacing_mm=90.0,
    back_mm=-60.0,
    weight=ROBOT_WEIGHTS["weightless"],
    color_sensors=_build_sensor_pair(10.0, 15.0, 10, 10),
    ultrasonic=UltrasonicSpec(y_mm=10.0),
)

ROBOTS: Mapping[str, RobotSpec] = {
    robot.name: robot
    for robot in (
        RobotSpec(),
        _SMALL,
        replace(
            _SMALL,
            name="Small_Robot_Wide_Eyes",
            color_sensors=_build_sensor_pair(30.0, 15.0, 10, 10),
        ),
        RobotSpec(
            name="Sensor_Diameter_Config", color_sensors=_build_sensor_pair(20.0, 30.0, 30, 10)
        ),
        RobotSpec(
            name="Explorer",
            color_sensors=(ColorSensorSpec("left", "in2", 0.0, 30.0),),
            ultrasonic=None,
            extra_motors=(MotorSpec("outA", "medium"),),
            touch_sensors=(TouchSpec("bumper", "in1", 0.0, 60.0, 60.0),),
            infrared=InfraredSpec(port="in3"),
        ),
        RobotSpec(
            name="Prime_Robot",
            wheel_spacing_mm=112.0,
            back_mm=-70.0,
            left_port="A",
            right_port="B",
            color_sensors=(),
            ultrasonic=None,
            gyro=GyroSpec("imu", INSIDE),
            left_motor="medium-angular",
            right_motor="medium-angular",
            left_reversed=True,
            hub="PrimeHub",
        ),
    )
}
"""Every robot by name."""

DEFAULT_ROBOT = "Default_Robot"
_VALUES = list_values(RobotSpec)
_BODY_KEYS = tuple(
    key
    for key, value in _VALUES.items()
    if not isinstance(value, Part) and key not in ("left_motor", "right_motor")
)
"""Keys whose values are those of the fields; the kinds of motors stand in the table `motors`."""
_MOTOR_KEYS = ("kind", "low_deg", "high_deg")
_PEN_KEYS = ("x_mm", "y_mm", "color", "width_mm", "down")
_TOP_KEYS = ("base", *_BODY_KEYS, "motors", *(mount.key for mount in MOUNTS), "pen")

_TABLES: Mapping[str, type] = {
    "": RobotSpec,
    "motors": MotorSpec,
    "pen": PenSpec,
    **{mount.key: mount.spec for mount in MOUNTS},
}


def list_table_values(table: str) -> Mapping[str, Value]:
    """Return the descriptions of the values that a table of a robot file can have, by key.

    Args:
        table: The key of the table, such as `ultrasonic`.
    """
    return list_values(_TABLES[table.partition(".")[0]])


_HEAD = (
    "# A robot for tuisim. Lengths in mm, angles in degrees; x to the right of the midpoint between the wheels,",
    "# y forward of it.",
)


def _parse_motors(robot: Mapping[str, Any], base: RobotSpec, location: Location) -> dict[str, Any]:
    """Return the motors of a robot's table as values by field name of `RobotSpec`.

    The motors of the base robot stay, unless the table changes them, or removes them by `false`.

    Args:
        robot: The robot's table.
        base: The base robot.
        location: The location of the table, for errors.
    """
    wheels = {robot.get(key, getattr(base, key)): key for key in ("left_port", "right_port")}
    motors = {motor.port: motor for motor in base.extra_motors}
    fields: dict[str, Any] = {}
    location = location.at("motors")
    for port, data in files.table(robot["motors"], location, (*OUTPUT_PORTS, *HUB_PORTS)).items():
        wheel = wheels.get(port)
        if wheel and data is False:
            raise location.at(port).wrong(
                "drives a wheel", f"it cannot be removed; {wheel} sets its port"
            )
        if wheel:
            key = wheel.replace("port", "motor")
            motor = _parse_motor(data, MotorSpec(port, getattr(base, key)), location.at(port))
            if (motor.low_deg, motor.high_deg) != (None, None):
                raise location.at(port).wrong(
                    "drives a wheel, which has no end stops", "only its kind can be set here"
                )
            fields[key] = motor.kind
        elif data is False:
            motors.pop(port, None)
        else:
            motors[port] = _parse_motor(data, motors.get(port, MotorSpec(port)), location.at(port))
    return {**fields, "extra_motors": tuple(motors.values())}


def _parse_motor(data: object, base: MotorSpec, location: Location) -> MotorSpec:
    """Return a motor with the changes that a file gives.

    Args:
        data: The motor's kind, or a table of its values.
        base: The motor before the changes.
        location: The location of the data, for errors.
    """
    if not isinstance(data, dict):
        return replace(base, kind=files.one_of(data, location, MOTOR_KINDS))
    return files.read_part(data, base, location, port=base.port)


def _parse_single(
    data: object, mount: Mount, base: RobotSpec, location: Location
) -> SensorSpec | None:
    """Return a sensor of which a robot has at most one, such as the gyro, from its value in a robot's table.

    The value `false` removes the sensor: the result is None. Keys missing in a table are as in the base robot's sensor.

    Args:
        data: The value in the table.
        mount: The kind of sensor.
        base: The robot that the table changes.
        location: The location of the value, for errors.
    """
    return (
        None
        if data is False
        else files.read_part(data, getattr(base, mount.field) or mount.spec(), location)
    )


def _parse_named(
    data: object, mount: Mount, base: RobotSpec, location: Location
) -> tuple[SensorSpec, ...]:
    """Return all sensors of one kind that a robot has after the changes in its table.

    Args:
        data: Tables by name of the sensor: a known name changes that sensor, or removes it if the value is `false`; an
            unknown name adds a sensor.
        mount: The kind of sensor.
        base: The robot that is changed.
        location: The location of `data`, for errors.
    """
    sensors = {sensor.name: sensor for sensor in base.list_sensors(mount)}
    names = files.table(data, location)
    for name, sensor in names.items():
        place = location.at(name)
        if sensor is False:
            sensors.pop(name, None)
        elif not SENSOR_NAME.fullmatch(name):
            wrong = location.at(quote(name)[1:-1]).wrong
            raise wrong(
                "is not a valid sensor name", "letters, digits and _, a letter first, at most 31"
            )
        elif name in sensors:
            sensors[name] = files.read_part(sensor, sensors[name], place)
        else:
            # A new sensor needs a port, which has no default.
            if isinstance(sensor, dict) and "port" not in files.table(
                sensor, place, [*list_values(mount.spec)][1:]
            ):
                hint = did_you_mean(closest(name, sensors))
                raise place.at("port").wrong("is missing", hint)
            sensors[name] = files.read_part(sensor, mount.spec, place, name=name)
    # A file that names all sensors also sets their order.
    order = [name for name in names if name in sensors]
    return tuple(sensors[name] for name in (order if len(order) == len(sensors) else sensors))


_COLOR_SENSOR = {"x": "x_mm", "y": "y_mm", "diameter": "diameter_mm"}
_JSON_PARTS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "pen": ("pen", {"x": "x_mm", "y": "y_mm", "color": "color", "width": "width_mm"}),
    "sensor1": ("color_sensors.left", _COLOR_SENSOR),
    "sensor2": ("color_sensors.right", _COLOR_SENSOR),
    "ultrasonic": (
        "ultrasonic",
        {"x": "x_mm", "y": "y_mm", "angle": "angle_deg", "noise": "noise_mm"},
    ),
    "gyro": ("gyro", {}),
}
"""The key of each part in a robot's TOML table, and the names of its keys there."""

_JSON_KEYS = {
    "wheeldiameter": "wheel_diameter_mm",
    "wheelSpacing": "wheel_spacing_mm",
    "back": "back_mm",
    "weight": "weight",
}
_WHEEL_NOISE, _SENSOR_NOISE = "wheelNoise", "sensorNoise"
_DEFAULT_NOISE = 1
"""The simulator's default for motor and ultrasonic noise."""

_KEYS_SHOWN = 5

_WITHOUT_EFFECT = ("baseWeight", "width", "height")
"""Keys of saved files that do not affect a run."""


def parse_json_robot(data: object, name: str, location: Location) -> RobotChoice:
    """Return the robot in a file that the course's browser simulator saved.

    Missing keys are as in Default_Robot. The file's noise settings become those of the run. Keys that neither that
    simulator nor tuisim knows are ignored, and listed in the robot's notes. The other keys are translated to those of a
    robot's TOML table, so both formats are checked by the same rules.

    Args:
        data: The contents of the file.
        name: The name of the robot, unless the file gives one.
        location: The file, for errors.

    Raises:
        RobotError: a key or a value is wrong.
    """
    table = files.table(data, location)
    ours: dict[str, Any] = {"color_sensors": {}}
    theirs: dict[str, str] = {}
    unknown: list[str] = []
    for key, value in table.items():
        if key in _JSON_KEYS:
            if key == "weight" and value in (None, ""):
                # An empty weight is medium, as without the key.
                continue
            ours[_JSON_KEYS[key]] = value
            theirs[_JSON_KEYS[key]] = key
        elif key in _JSON_PARTS:
            place, keys = _JSON_PARTS[key]
            theirs |= {place: key, f"{place}.port": key} | {
                f"{place}.{to}": f"{key}.{of}" for of, to in keys.items()
            }
            outer, _, inner = place.rpartition(".")
            part = files.table(value, location.at(key))
            (ours[outer] if outer else ours)[inner] = _parse_json_part(part, keys, location.at(key))
            unknown += [f"{key}.{name}" for name in part if name not in ("enabled", *keys)]
        elif key not in (_WHEEL_NOISE, _SENSOR_NOISE, *_WITHOUT_EFFECT):
            unknown.append(key)
    motor = _parse_json_noise(table, _WHEEL_NOISE, "motor", location)
    light = _parse_json_noise(table, _SENSOR_NOISE, "light", location)
    try:
        choice = RobotChoice.parse(ours, name, location)
    except ConfigError as error:
        raise files.with_location(error, location.file, theirs.get(error.key, error.key)) from None
    notes = (f"{location.file}: ignored unknown keys: {shorten_keys(unknown)}",) if unknown else ()
    return replace(
        choice,
        motor_noise=_DEFAULT_NOISE if motor is None else motor,
        light_noise=light,
        notes=notes,
    )


def _parse_json_noise(
    robot: Mapping[str, object], key: str, kind: str, location: Location
) -> int | None:
    value = robot.get(key)
    return (
        None
        if value is None
        else files.read_value(value, list_values(NoiseSpec)[kind], location.at(key))
    )


def _parse_json_part(
    part: Mapping[str, object], keys: Mapping[str, str], location: Location
) -> dict[str, object] | bool:
    """Return a sensor or the pen from the browser simulator's file, its values under the keys of a TOML table.

    The result is False for a sensor that is disabled.

    Args:
        part: The sensor or the pen in the file.
        keys: The key of the TOML table for each key in the file; other keys are left out.
        location: The location of the part, for errors.
    """
    if location.key != "pen" and not files.convert(
        part.get("enabled", True), bool, location.at("enabled")
    ):
        return False
    values = {keys[key]: value for key, value in part.items() if key in keys}
    if "noise" in keys and values.get("noise_mm") is None:
        values["noise_mm"] = _DEFAULT_NOISE
    return values


def shorten_keys(keys: Sequence[str]) -> str:
    """Return a list of keys for a message, shortened in number and length."""
    names = [quote(key)[1:-1] for key in keys[:_KEYS_SHOWN]]
    return ", ".join(names) + (
        f" and {len(keys) - _KEYS_SHOWN} more" if len(keys) > _KEYS_SHOWN else ""
    )


def save_robot(spec: RobotSpec, path: Path | str) -> None:
    """Write a robot atomically to a TOML file; `RobotChoice.load` returns an equal one. Comments in the file are kept.

    Raises:
        RobotError: the file cannot be written, or cannot represent the robot, such as a name of two lines.
    """
    path = Path(path)
    location = Location(str(path), RobotError)
    files.save_toml(
        path,
        format_robot_file(spec),
        location,
        lambda data: RobotChoice.parse(data, files.name_of(path), location).spec,
        spec,
    )


def format_robot_file(spec: RobotSpec) -> list[str]:
    """Return the lines of a robot file."""
    return [*_HEAD, "", *format_robot(spec)]


def format_robot(
    spec: RobotSpec, parent: str = "", pen_keys: Iterable[str] = _PEN_KEYS
) -> list[str]:
    """Return a robot as TOML lines, with every value.

    Args:
        spec: The robot.
        parent: The name of its table; empty for a file of its own.
        pen_keys: The keys of the pen to include.
    """
    under = f"{parent}." if parent else ""
    lines = [f"[{parent}]"] if parent else []
    lines += files.value_lines(spec, [key for key in _BODY_KEYS if not _is_left_out(spec, key)])
    names = [sensor.name for sensor in spec.color_sensors]
    if gone := [
        sensor.name for sensor in ROBOTS[DEFAULT_ROBOT].color_sensors if sensor.name not in names
    ]:
        lines += [
            "",
            f"[{under}color_sensors]",
            *(f"{files.toml_key(name)} = false" for name in gone),
        ]
    for mount in MOUNTS:
        if mount.standard and not mount.many and not spec.list_sensors(mount):
            # Keys of the robot itself must precede its first table.
            lines.insert(1 if parent else 0, f"{mount.key} = false")
    for mount in MOUNTS:
        for sensor in spec.list_sensors(mount):
            place = f"{mount.key}.{files.toml_key(sensor.name)}" if mount.many else mount.key
            keys = [
                key
                for key in list_values(mount.spec)
                if key != "name" and not _is_no_presser(sensor, key)
            ]
            lines += ["", f"[{under}{place}]", *files.value_lines(sensor, keys)]
    lines += _format_motors(spec, f"{under}motors")
    return [*lines, "", f"[{under}pen]", *files.value_lines(spec.pen, pen_keys)]


def _is_left_out(spec: RobotSpec, key: str) -> bool:
    """Return whether robot files leave out a value: it equals its default, and the first versions did not have it."""
    return _VALUES[key].later and getattr(spec, key) == RobotSpec.__dataclass_fields__[key].default


def _is_no_presser(sensor: SensorSpec, key: str) -> bool:
    return isinstance(sensor, TouchSpec) and not sensor.pressed_by and key.startswith("pressed_")


def _format_motors(spec: RobotSpec, table: str) -> list[str]:
    """Return TOML lines for the wheel motors that are not large, and for all other motors.

    Motors before the first one with an end stop are lines `PORT = KIND`; that one and all after it are tables.
    """
    motors = (*(motor for motor in spec.wheel_motors if motor.kind != "large"), *spec.extra_motors)
    # TOML tables must follow the keys, and the order of the motors must be kept.
    plain = list(takewhile(lambda motor: motor.low_deg is motor.high_deg is None, motors))
    kinds: dict[str, Scalar] = {motor.port: motor.kind for motor in plain}
    lines = ["", f"[{table}]", *files.toml_lines(kinds)] if kinds else []
    for motor in motors[len(plain) :]:
        lines += ["", f"[{table}.{motor.port}]", *files.value_lines(motor, _MOTOR_KEYS)]
    return lines
