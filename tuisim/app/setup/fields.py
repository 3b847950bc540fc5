"""The editable fields of the next run's plan: one line per field.

Values of robot, pen and world are here if their spec gives them a label.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from tuisim.app.setup.next_run import (
    NextRun,
    change_profile,
    change_robot,
    change_values,
    edit_robot,
)
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, RobotError
from tuisim.engine.core import tree
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import (
    INPUT_PORTS,
    MOUNTS,
    OUTPUT_PORTS,
    ColorSensorSpec,
    GyroSpec,
    PenSpec,
    RobotSpec,
    SensorSpec,
    UltrasonicSpec,
)
from tuisim.engine.core.values import Flag, Number, Numbers, Value, WrongValue, list_values
from tuisim.settings.options import RUN_VALUES
from tuisim.settings.robots import ROBOTS

SWITCHED = (Flag.ON, Flag.OFF)
MAX_LABEL = 12


@dataclass(frozen=True, slots=True)
class FormField:
    """One value of the next run's plan that the user can edit in a form."""

    id: str
    label: str
    """The label with its unit, at most `MAX_LABEL` characters."""
    read: Callable[[NextRun], str]
    """Returns the value as text."""
    write: Callable[[NextRun, str], NextRun]
    """Applies a typed or chosen text; raises ConfigError."""
    choices: tuple[str, ...] = ()
    """The possible values; empty for a free text field."""


@dataclass(frozen=True, slots=True)
class FieldGroup:
    """The fields of a form under one heading."""

    title: str
    edits: tuple[FormField, ...]


def build_sections(plan: NextRun) -> list[FieldGroup]:
    """Return the fields of the form for a plan, in groups; which fields there are depends on the robot's sensors."""
    sensors = {
        sensor.name: sensor
        for sensor in (*plan.robot.spec.color_sensors, *plan.robot_choice.spec.color_sensors)
    }
    return [
        FieldGroup(
            "Program", (FormField("arguments", "Arguments", _format_arguments, _change_arguments),)
        ),
        FieldGroup("Robot", _build_body_fields()),
        *(
            FieldGroup(f"Sensor {name}", _build_color_sensor_fields(name, sensor, plan))
            for name, sensor in sensors.items()
        ),
        FieldGroup("Ultrasonic", _build_single_fields(plan, "ultrasonic", UltrasonicSpec)),
        FieldGroup("Gyro", _build_single_fields(plan, "gyro", GyroSpec)),
        *(
            FieldGroup(part.name.capitalize(), _build_sensor_fields(part))
            for part in plan.robot_choice.spec.further_sensors
        ),
        FieldGroup("Pen", _build_pen_fields()),
        FieldGroup("World", _build_world_fields()),
    ]


def _parse_value(value: Value, text: str) -> Any:
    """Return the value that a typed or chosen text stands for; a decimal comma is accepted."""
    one_number = isinstance(value, Number) and not isinstance(value, Numbers)
    try:
        return value.parse_text(text.strip().replace(",", ".") if one_number else text.strip())
    except WrongValue as error:
        raise RobotError(error.message, error.hint) from None


# The following functions build the fields of the robot: they show the robot with the mat's changes, and edit the
# robot without these changes.


def _build_robot_field(
    edit_id: str,
    label: str,
    read: Callable[[RobotSpec], str],
    change: Callable[[RobotSpec, str], RobotSpec],
    choices: tuple[str, ...] = (),
) -> FormField:
    def write(plan: NextRun, text: str) -> NextRun:
        return edit_robot(plan, change(plan.robot_choice.spec, text))

    return FormField(edit_id, label, lambda plan: read(plan.spec.robot), write, choices)


def _build_value_field(edit_id: str, value: Value, path: Callable[[RobotSpec], str]) -> FormField:
    """Return the form field in which the user edits one value of the robot.

    Args:
        edit_id: Id of the field.
        value: The label and the limits of the value.
        path: Returns the path of the value in the settings of a robot, such as `gyro.port`.
    """

    def change(robot: RobotSpec, text: str) -> RobotSpec:
        is_none = value.optional and not text.strip()
        return tree.put(robot, path(robot), None if is_none else _parse_value(value, text))

    def read(robot: RobotSpec) -> str:
        known = tree.get_value(robot, path(robot))
        return "" if known is None else value.format_text(known)

    return _build_robot_field(edit_id, value.label, read, change, value.choices)


def _build_motor_port_field(key: str, value: Value) -> FormField:
    """Return the field for the port of a wheel motor; if the other motor is on the chosen port, the two swap ports."""
    other = "right_port" if key == "left_port" else "left_port"

    def change(robot: RobotSpec, port: str) -> RobotSpec:
        if not robot.has_wheels:
            raise RobotError("the robot has no wheels", "choose another robot")
        swapped = getattr(robot, key) if getattr(robot, other) == port else getattr(robot, other)
        return replace(robot, **{key: port, other: swapped})

    return _build_robot_field(
        key, value.label, lambda robot: str(getattr(robot, key)), change, OUTPUT_PORTS
    )


def _describe_robot(plan: NextRun) -> str:
    word = Path(plan.words.get("robot", plan.robot.spec.name)).name
    return f"{word}, edited" if plan.robot_is_edited else word


def _build_body_fields() -> tuple[FormField, ...]:
    def build_field(key: str, value: Value) -> FormField:
        if key.endswith("_port"):
            return _build_motor_port_field(key, value)
        return _build_value_field(key, value, lambda _: key)

    labelled = {key: value for key, value in list_values(RobotSpec).items() if value.label}
    return (
        FormField("preset", "", _describe_robot, change_robot, tuple(ROBOTS)),
        *(build_field(key, value) for key, value in labelled.items()),
    )


# Sensors


def _collect_sensors(robot: RobotSpec) -> dict[str, SensorSpec]:
    return {sensor.name: sensor for sensor in robot.sensors}


def _find_path(robot: RobotSpec, name: str, key: str) -> str:
    """Return the path in the settings of a robot at which a value of a sensor is, such as `gyro.port`.

    Args:
        robot: The robot.
        name: The name of the sensor.
        key: The name of the value.

    Raises:
        LookupError: the robot has no such sensor.
    """
    for mount in MOUNTS:
        for sensor in robot.list_sensors(mount):
            if sensor.name == name:
                return f"{mount.field}.{name}.{key}" if mount.many else f"{mount.field}.{key}"
    raise LookupError(name)


def _replace_sensors(robot: RobotSpec, *parts: SensorSpec) -> RobotSpec:
    """Return a robot with some of its sensors replaced, all in one step because two may have swapped ports."""
    changed = {part.name: part for part in parts}
    by_field: dict[str, Any] = {}
    for mount in MOUNTS:
        sensors = tuple(changed.get(part.name, part) for part in robot.list_sensors(mount))
        by_field[mount.field] = sensors if mount.many else next(iter(sensors), None)
    return replace(robot, **by_field)


def _build_sensor_fields(part: SensorSpec) -> tuple[FormField, ...]:
    """Return the fields of a sensor that the robot has."""

    def build_field(key: str, value: Value) -> FormField:
        if key == "port":
            return _build_sensor_port_field(part.name)
        return _build_value_field(
            f"{part.name}.{key}", value, lambda robot: _find_path(robot, part.name, key)
        )

    return tuple(
        build_field(key, value) for key, value in list_values(type(part)).items() if value.label
    )


def _build_sensor_port_field(name: str) -> FormField:
    """Return the field for the port of a sensor; if another sensor is on the chosen port, the two swap ports."""

    def change(robot: RobotSpec, port: str) -> RobotSpec:
        parts = _collect_sensors(robot)
        swapped = [
            replace(part, port=parts[name].port) for part in parts.values() if part.port == port
        ]
        return _replace_sensors(robot, *swapped, replace(parts[name], port=port))

    return _build_robot_field(
        f"{name}.port",
        "Port",
        lambda robot: _collect_sensors(robot)[name].port,
        change,
        INPUT_PORTS,
    )


def _build_presence_field(name: str, change: Callable[[RobotSpec, str], RobotSpec]) -> FormField:
    return _build_robot_field(
        f"{name}.used",
        "Used",
        lambda robot: Flag.ON if name in _collect_sensors(robot) else Flag.OFF,
        change,
        SWITCHED,
    )


def _find_free_port(robot: RobotSpec, preferred: str) -> str:
    used = {part.port for part in _collect_sensors(robot).values()}
    free = [port for port in (preferred, *INPUT_PORTS) if port not in used]
    if not free:
        raise RobotError("every port is in use", "switch another sensor off first")
    return free[0]


def _move_sensor(plan: NextRun, text: str, name: str) -> NextRun:
    """Return a plan in which the user has moved a colour sensor sideways.

    The other colour sensors keep the positions that the mat gives them.

    Args:
        plan: The plan.
        text: The new x in mm, as typed.
        name: The name of the sensor.
    """
    on_mat = {sensor.name: sensor for sensor in plan.spec.robot.color_sensors}
    robot = plan.robot_choice.spec
    x_mm = _parse_value(list_values(ColorSensorSpec)["x_mm"], text)
    sensors = [
        replace(sensor, x_mm=x_mm if sensor.name == name else on_mat[sensor.name].x_mm)
        for sensor in robot.color_sensors
    ]
    return edit_robot(plan, replace(robot, color_sensors=tuple(sensors)), moved=True)


def _build_color_sensor_fields(
    name: str, sensor: ColorSensorSpec, plan: NextRun
) -> tuple[FormField, ...]:
    def switch_sensor(robot: RobotSpec, word: str) -> RobotSpec:
        others = tuple(other for other in robot.color_sensors if other.name != name)
        if word == Flag.OFF:
            return replace(robot, color_sensors=others)
        if len(others) < len(robot.color_sensors):
            return robot
        again = replace(sensor, port=_find_free_port(robot, sensor.port))
        order = [other.name for other in plan.robot.spec.color_sensors]
        sensors = sorted(
            (*others, again),
            key=lambda one: order.index(one.name) if one.name in order else len(order),
        )
        return replace(robot, color_sensors=tuple(sensors))

    used = _build_presence_field(name, switch_sensor)
    if name not in _collect_sensors(plan.robot_choice.spec):
        return (used,)
    fields = _build_sensor_fields(sensor)
    return (
        used,
        *(
            replace(one, write=partial(_move_sensor, name=name))
            if one.id == f"{name}.x_mm"
            else one
            for one in fields
        ),
    )


def _build_single_fields(
    plan: NextRun, field: str, kind: type[SensorSpec]
) -> tuple[FormField, ...]:
    """Return the fields of the ultrasonic sensor or the gyro; the first field adds or removes the sensor.

    Args:
        plan: The plan, which has the robot.
        field: Name of the sensor's field in `RobotSpec`.
        kind: The class of the sensor.
    """
    mounted: SensorSpec | None = getattr(plan.robot_choice.spec, field)
    fresh: SensorSpec = mounted or getattr(plan.robot.spec, field) or kind()

    def switch_sensor(robot: RobotSpec, word: str) -> RobotSpec:
        if word == Flag.OFF:
            return tree.put(robot, field, None)
        if getattr(robot, field) is not None:
            return robot
        return tree.put(robot, field, replace(fresh, port=_find_free_port(robot, fresh.port)))

    used = _build_presence_field(fresh.name, switch_sensor)
    return (used,) if mounted is None else (used, *_build_sensor_fields(mounted))


# Pen and world


def _run_field(path: str) -> FormField:
    """Return the field of a value of the world or the pen, given by its path in the settings."""
    spec_path, value, _ = RUN_VALUES[path]
    return FormField(
        path,
        value.label or path.replace("_", " ")[:MAX_LABEL],
        lambda plan: value.format_text(tree.get_value(plan.spec, spec_path)),
        lambda plan, text: change_values(plan, {path: _parse_value(value, text)}),
        value.choices,
    )


def _build_pen_fields() -> tuple[FormField, ...]:
    def build_field(key: str, value: Value) -> FormField:
        path = f"pen.{key}"
        return (
            _run_field(path)
            if path in RUN_VALUES
            else _build_value_field(path, value, lambda _: path)
        )

    return tuple(build_field(key, value) for key, value in list_values(PenSpec).items())


def _build_world_fields() -> tuple[FormField, ...]:
    def profile(plan: NextRun) -> str:
        return Path(plan.words.get("profile", plan.spec.profile.name)).name

    # Pose, noise and seed have panels of their own, so they are not in this form.
    fields = [
        path
        for path, one in RUN_VALUES.items()
        if one.spec_path == f"world.{path}" and "." not in path
    ]
    return FormField("profile", "Profile", profile, change_profile, tuple(PROFILES)), *map(
        _run_field, fields
    )


def _format_arguments(plan: NextRun) -> str:
    return shlex.join(plan.settings["arguments"])


def _change_arguments(plan: NextRun, text: str) -> NextRun:
    try:
        words = tuple(shlex.split(text))
    except ValueError:
        raise ConfigError(
            "a quote is not closed", "put an argument with spaces in '…' or \"…\""
        ) from None
    return replace(plan, settings=plan.settings.changed({"arguments": words}))


def find(plan: NextRun, edit_id: str) -> FormField | None:
    """Return the form field with an id; None if the plan's robot has no such field."""
    return next(
        (edit for section in build_sections(plan) for edit in section.edits if edit.id == edit_id),
        None,
    )


def step(edit: FormField, plan: NextRun, by: int) -> str:
    """Return the value that is `by` steps after the present one in the choices of a field.

    After the last choice comes the first. If the present value is none of the choices, return the first choice.

    Args:
        edit: The field.
        plan: The plan, which has the present value.
        by: Number of steps; negative goes back.
    """
    now = edit.read(plan)
    choices = edit.choices
    return choices[(choices.index(now) + by) % len(choices)] if now in choices else choices[0]
