"""The editable fields of the next run's plan: one line per field.

To add a field: add a line in the function of its section.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from tuisim.app.form import reason, typed_number
from tuisim.app.setup.next_run import NextRun, with_arguments, with_profile, with_robot, with_robot_edited, with_values
from tuisim.config.options import MAX_PEN_MM, MIN_PEN_MM, number, pen_color
from tuisim.config.robots import ROBOTS
from tuisim.core.profile import PROFILES
from tuisim.core.spec import (
    BACKGROUND_FITS,
    INPUT_PORTS,
    MAX_RAYS,
    MOTOR_KINDS,
    MOUNTS,
    OUTPUT_PORTS,
    ROBOT_WEIGHTS,
    STRATEGIES,
    ColorSensorSpec,
    GyroSpec,
    PenSpec,
    RobotSpec,
    SensorSpec,
    UltrasonicSpec,
)
from tuisim.errors import ConfigError, RobotError

ON, OFF = "on", "off"
SWITCHED = (OFF, ON)
MAX_NAME = 100
MAX_LABEL = 12


@dataclass(frozen=True, slots=True)
class FormField:
    """An editable value of the plan."""

    id: str
    label: str
    """With its unit, at most `MAX_LABEL` characters."""
    read: Callable[[NextRun], str]
    """Returns the value as text."""
    write: Callable[[NextRun, str], NextRun]
    """Applies a typed or chosen text; raises ConfigError."""
    choices: tuple[str, ...] = ()
    """The possible values; empty for a free text field."""


@dataclass(frozen=True, slots=True)
class FieldGroup:
    """Fields under one heading."""

    title: str
    edits: tuple[FormField, ...]


def sections(plan: NextRun) -> list[FieldGroup]:
    """Return every field of a plan; the fields depend on the sensors of its robot."""
    sensors = {
        sensor.name: sensor for sensor in (*plan.robot.spec.color_sensors, *plan.robot_choice.spec.color_sensors)
    }
    return [
        FieldGroup("Program", (FormField("arguments", "Arguments", _arguments, _with_arguments),)),
        FieldGroup("Robot", _robot_fields()),
        *(FieldGroup(f"Sensor {name}", _color_sensor_fields(name, sensor, plan)) for name, sensor in sensors.items()),
        FieldGroup("Ultrasonic", _ultrasonic_fields(plan)),
        FieldGroup("Gyro", _gyro_fields(plan)),
        *(FieldGroup(part.name.capitalize(), _further_fields(part)) for part in plan.robot_choice.spec.further_sensors),
        FieldGroup("Pen", _pen_fields()),
        FieldGroup("World", _world_fields()),
    ]


def _shown(value: float) -> str:
    text = f"{value:.6g}"
    return "0" if text == "-0" else text


def _number(text: str) -> float:
    return typed_number(text, RobotError)


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise RobotError(f"must be a whole number, got {text.strip()[:20]!r}") from None


# The robot. The fields show the robot on its mat, and edit the robot as it was chosen.


def _robot_field(
    edit_id: str,
    label: str,
    read: Callable[[RobotSpec], str],
    change: Callable[[RobotSpec, str], RobotSpec],
    choices: tuple[str, ...] = (),
) -> FormField:
    def write(plan: NextRun, text: str) -> NextRun:
        return with_robot_edited(plan, change(plan.robot_choice.spec, text))

    return FormField(edit_id, label, lambda plan: read(plan.spec.robot), write, choices)


Part = TypeVar("Part", RobotSpec, PenSpec, SensorSpec)


def _with(part: Part, key: str, value: Any) -> Part:
    changed: dict[str, Any] = {key: value}
    return replace(part, **changed)


def _length(key: str, label: str) -> FormField:
    def change(robot: RobotSpec, text: str) -> RobotSpec:
        return _with(robot, key, _number(text))

    return _robot_field(key, label, lambda robot: _shown(getattr(robot, key)), change)


def _named(robot: RobotSpec, text: str) -> RobotSpec:
    name = text.strip()
    if not name or len(name) > MAX_NAME or not name.isprintable():
        raise RobotError(f"must be one line of 1 to {MAX_NAME} characters")
    return replace(robot, name=name)


def _weight_name(robot: RobotSpec) -> str:
    return next((name for name, weight in ROBOT_WEIGHTS.items() if weight == robot.weight), _shown(robot.weight))


def _weighed(robot: RobotSpec, text: str) -> RobotSpec:
    word = text.strip().lower()
    if word in ROBOT_WEIGHTS:
        return replace(robot, weight=ROBOT_WEIGHTS[word])
    try:
        return replace(robot, weight=_number(word))
    except RobotError as error:
        raise RobotError(reason(error), f"or {', '.join(ROBOT_WEIGHTS)}") from None


def _motor_port_field(key: str, label: str) -> FormField:
    """Return the field for the port of a wheel's motor; a motor that already uses the port gets the freed one."""
    other = "right_port" if key == "left_port" else "left_port"

    def change(robot: RobotSpec, port: str) -> RobotSpec:
        if not robot.has_wheels:
            raise RobotError("the robot has no wheels", "choose another robot")
        swapped = getattr(robot, key) if getattr(robot, other) == port else getattr(robot, other)
        return replace(robot, **{key: port, other: swapped})

    return _robot_field(key, label, lambda robot: str(getattr(robot, key)), change, OUTPUT_PORTS)


def _motor_kind_field(key: str, label: str) -> FormField:
    def change(robot: RobotSpec, kind: str) -> RobotSpec:
        return _with(robot, key, kind)

    return _robot_field(key, label, lambda robot: str(getattr(robot, key)), change, MOTOR_KINDS)


def _reversed_field(key: str, label: str) -> FormField:
    """Return the field for a motor that is mounted the other way round."""

    def change(robot: RobotSpec, word: str) -> RobotSpec:
        return _with(robot, key, word == ON)

    return _robot_field(key, label, lambda robot: ON if getattr(robot, key) else OFF, change, SWITCHED)


def _robot_word(plan: NextRun) -> str:
    word = Path(plan.words.get("robot", plan.robot.spec.name)).name
    return f"{word}, edited" if plan.robot_is_edited else word


def _robot_fields() -> tuple[FormField, ...]:
    return (
        FormField("preset", "", _robot_word, with_robot, tuple(ROBOTS)),
        _robot_field("name", "Name", lambda robot: robot.name, _named),
        _length("wheel_diameter_mm", "Wheel ⌀ mm"),
        _length("wheel_spacing_mm", "Spacing mm"),
        _length("wheel_width_mm", "Width mm"),
        _length("back_mm", "Back mm"),
        _robot_field("weight", "Weight", _weight_name, _weighed),
        _motor_port_field("left_port", "Left motor"),
        _motor_port_field("right_port", "Right motor"),
        _motor_kind_field("left_motor", "Left kind"),
        _motor_kind_field("right_motor", "Right kind"),
        _reversed_field("left_reversed", "Left rev."),
        _reversed_field("right_reversed", "Right rev."),
        _length("gear_ratio", "Gear ratio"),
    )


# Sensors


def _sensors(robot: RobotSpec) -> dict[str, SensorSpec]:
    return {sensor.name: sensor for sensor in robot.sensors}


def _with_sensors(robot: RobotSpec, *parts: SensorSpec) -> RobotSpec:
    """Return the robot with some sensors replaced, all at once because two may have swapped ports."""
    changed = {part.name: part for part in parts}
    found: dict[str, Any] = {}
    for mount in MOUNTS:
        sensors = tuple(changed.get(part.name, part) for part in robot.sensors_in(mount))
        found[mount.field] = sensors if mount.many else next(iter(sensors), None)
    return replace(robot, **found)


def _sensor_field(name: str, key: str, label: str, parse: Callable[[str], Any] = _number) -> FormField:
    def change(robot: RobotSpec, text: str) -> RobotSpec:
        return _with_sensors(robot, _with(_sensors(robot)[name], key, parse(text)))

    def read(robot: RobotSpec) -> str:
        value = getattr(_sensors(robot)[name], key)
        return value if isinstance(value, str) else _shown(value)

    return _robot_field(f"{name}.{key}", label, read, change, {"strategy": STRATEGIES}.get(key, ()))


def _sensor_port_field(name: str) -> FormField:
    """Return the field for a sensor's port; a sensor that already uses the port gets the freed one."""

    def change(robot: RobotSpec, port: str) -> RobotSpec:
        parts = _sensors(robot)
        swapped = [replace(part, port=parts[name].port) for part in parts.values() if part.port == port]
        return _with_sensors(robot, *swapped, replace(parts[name], port=port))

    return _robot_field(f"{name}.port", "Port", lambda robot: _sensors(robot)[name].port, change, INPUT_PORTS)


def _presence_field(name: str, change: Callable[[RobotSpec, str], RobotSpec]) -> FormField:
    return _robot_field(f"{name}.used", "Used", lambda robot: ON if name in _sensors(robot) else OFF, change, SWITCHED)


def _free_port(robot: RobotSpec, wanted: str) -> str:
    used = {part.port for part in _sensors(robot).values()}
    free = [port for port in (wanted, *INPUT_PORTS) if port not in used]
    if not free:
        raise RobotError("every port is in use", "switch another sensor off first")
    return free[0]


def _placed(plan: NextRun, text: str, name: str) -> NextRun:
    """Change a colour sensor's x; the other sensors stay where the mat has put them."""
    on_mat = {sensor.name: sensor for sensor in plan.spec.robot.color_sensors}
    robot = plan.robot_choice.spec
    sensors = [replace(sensor, x_mm=on_mat[sensor.name].x_mm) for sensor in robot.color_sensors]
    sensors = [replace(sensor, x_mm=_number(text)) if sensor.name == name else sensor for sensor in sensors]
    return with_robot_edited(plan, replace(robot, color_sensors=tuple(sensors)), moved=True)


def _color_sensor_fields(name: str, sensor: ColorSensorSpec, plan: NextRun) -> tuple[FormField, ...]:
    def switched(robot: RobotSpec, word: str) -> RobotSpec:
        others = tuple(other for other in robot.color_sensors if other.name != name)
        if word == OFF:
            return replace(robot, color_sensors=others)
        if len(others) < len(robot.color_sensors):
            return robot
        again = replace(sensor, port=_free_port(robot, sensor.port))
        order = [other.name for other in plan.robot.spec.color_sensors]
        sensors = sorted((*others, again), key=lambda one: order.index(one.name) if one.name in order else len(order))
        return replace(robot, color_sensors=tuple(sensors))

    used = _presence_field(name, switched)
    if name not in _sensors(plan.robot_choice.spec):
        return (used,)
    x = FormField(
        f"{name}.x_mm", "x mm", lambda now: _sensor_field(name, "x_mm", "").read(now), partial(_placed, name=name)
    )
    return (
        used,
        _sensor_port_field(name),
        x,
        _sensor_field(name, "y_mm", "y mm"),
        _sensor_field(name, "diameter_mm", "⌀ mm", _whole),
        _sensor_field(name, "strategy", "Weighing", str),
    )


def _single_used(name: str, field: str, fresh: SensorSpec) -> FormField:
    """Return the field that adds or removes the ultrasonic sensor or the gyro."""

    def switched(robot: RobotSpec, word: str) -> RobotSpec:
        if word == OFF:
            return _with(robot, field, None)
        if getattr(robot, field) is not None:
            return robot
        return _with(robot, field, replace(fresh, port=_free_port(robot, fresh.port)))

    return _presence_field(name, switched)


def _angles(text: str) -> tuple[float, ...]:
    angles = tuple(map(_number, text.replace(",", " ").split()))
    if not 1 <= len(angles) <= MAX_RAYS or not all(-360 <= angle <= 360 for angle in angles):
        raise RobotError(f"must be 1 to {MAX_RAYS} angles from -360 to 360, separated by spaces")
    return angles


def _ultrasonic_fields(plan: NextRun) -> tuple[FormField, ...]:
    mounted = plan.robot_choice.spec.ultrasonic
    fresh = mounted or plan.robot.spec.ultrasonic or UltrasonicSpec()
    used = _single_used(fresh.name, "ultrasonic", fresh)
    if mounted is None:
        return (used,)
    labels = (
        ("x_mm", "x mm"), ("y_mm", "y mm"), ("angle_deg", "Angle °"), ("max_range_mm", "Range mm"),
        ("noise_mm", "Noise ± mm"),
    )  # fmt: skip

    def fanned(robot: RobotSpec, text: str) -> RobotSpec:
        assert robot.ultrasonic is not None
        return replace(robot, ultrasonic=replace(robot.ultrasonic, ray_angles_deg=_angles(text)))

    def fan(robot: RobotSpec) -> str:
        return " ".join(map(_shown, robot.ultrasonic.ray_angles_deg)) if robot.ultrasonic else ""

    rays = _robot_field(f"{mounted.name}.ray_angles_deg", "Rays °", fan, fanned)
    return (
        used,
        _sensor_port_field(mounted.name),
        *(_sensor_field(mounted.name, key, label) for key, label in labels),
        rays,
    )


def _gyro_fields(plan: NextRun) -> tuple[FormField, ...]:
    gyro = plan.robot_choice.spec.gyro
    fresh = gyro or plan.robot.spec.gyro or GyroSpec()
    used = _single_used(fresh.name, "gyro", fresh)
    return (used,) if gyro is None else (used, _sensor_port_field(gyro.name))


def _further_fields(part: SensorSpec) -> tuple[FormField, ...]:
    keys = [field.name for field in fields(part) if type(getattr(part, field.name)) is float]
    labels = [key.replace("_deg", " °").replace("_", " ")[:MAX_LABEL] for key in keys]
    return (
        _sensor_port_field(part.name),
        *(_sensor_field(part.name, key, label) for key, label in zip(keys, labels, strict=True)),
    )


# Pen and world


def _pen_fields() -> tuple[FormField, ...]:
    def place(key: str) -> FormField:
        def change(robot: RobotSpec, text: str) -> RobotSpec:
            return replace(robot, pen=_with(robot.pen, key, _number(text)))

        label = key.replace("_", " ")
        return _robot_field(f"pen.{key}", label, lambda robot: _shown(getattr(robot.pen, key)), change)

    def width(plan: NextRun, text: str) -> NextRun:
        return with_values(plan, pen_width_mm=number(MIN_PEN_MM, MAX_PEN_MM)(text.strip().replace(",", "."), ""))

    return (
        _switch("pen.down", "Down", lambda plan: plan.spec.robot.pen.down, "pen_down"),
        FormField("pen.color", "Colour", lambda plan: plan.spec.robot.pen.color,
             lambda plan, text: with_values(plan, pen_color=pen_color(text.strip(), ""))),
        FormField("pen.width_mm", "Width mm", lambda plan: _shown(plan.spec.robot.pen.width_mm), width),
        place("x_mm"),
        place("y_mm"),
        _switch("pen.marks", "Marks mat", lambda plan: plan.spec.world.pen_marks, "pen_marks"),
    )  # fmt: skip


def _switch(id_: str, label: str, read: Callable[[NextRun], bool], field: str) -> FormField:
    return FormField(
        id_,
        label,
        lambda plan: ON if read(plan) else OFF,
        lambda plan, word: with_values(plan, **{field: word == ON}),
        SWITCHED,
    )


def _world_fields() -> tuple[FormField, ...]:
    def profile(plan: NextRun) -> str:
        return Path(plan.words.get("profile", plan.spec.profile.name)).name

    return (
        FormField("profile", "Profile", profile, with_profile, tuple(PROFILES)),
        _switch("solid", "Solid", lambda plan: plan.spec.world.solid, "solid"),
        _switch("walls", "Walls", lambda plan: plan.spec.world.walls, "walls"),
        FormField("background_fit", "Image fit", lambda plan: plan.spec.world.background_fit,
             lambda plan, word: with_values(plan, background_fit=word), BACKGROUND_FITS),
    )  # fmt: skip


def _arguments(plan: NextRun) -> str:
    return shlex.join(plan.settings.arguments)


def _with_arguments(plan: NextRun, text: str) -> NextRun:
    try:
        return with_arguments(plan, tuple(shlex.split(text)))
    except ValueError:
        raise ConfigError("a quote is not closed", "put an argument with spaces in '…' or \"…\"") from None


def find(plan: NextRun, edit_id: str) -> FormField | None:
    """Return a field by its id, None if this robot has no such field."""
    return next((edit for section in sections(plan) for edit in section.edits if edit.id == edit_id), None)


def step(edit: FormField, plan: NextRun, by: int) -> str:
    """Return the choice `by` steps after the current one."""
    now, choices = edit.read(plan), edit.choices
    return choices[(choices.index(now) + by) % len(choices)] if now in choices else choices[0]
