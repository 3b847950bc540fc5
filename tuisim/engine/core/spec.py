"""The specification of a run: robot, world, noise and profile as frozen data.

Lengths are in mm, angles in degrees, x to the right of the robot and y forward of the
midpoint between its wheels. Defaults are those of the original course's Default_Robot.

To add a value: add a line to its spec, `later=True`. Files, options, magic lines, forms and tables then have it.
To add a sensor: add its spec, and a field of `RobotSpec`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import MISSING
from typing import Any, NamedTuple

from tuisim.base.errors import ObstacleError, RobotError
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.hub_spec import (
    CONTROLLERS,
    EV3_MOTORS,
    HUB_MOTORS,
    HUB_PORTS,
    HUBS,
    INSIDE,
    check_motor_kinds,
    require_one_of,
)
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.remote_spec import MAX_POSITION_MM, REMOTE_BY_HAND, BeaconSpec, RemotePress
from tuisim.engine.core.spec_fields import (
    Spec,
    choice,
    color,
    flag,
    named_number,
    named_part,
    number,
    numbers,
    part,
    parts,
    seed,
    spec,
    text,
    whole,
)
from tuisim.engine.core.values import Number, Part, Parts, list_values

FIELD_WIDTH_MM = 2362
"""Width of the field; one mat pixel is one mm."""

FIELD_HEIGHT_MM = 1143
"""Height of the field."""

OUTPUT_PORTS = ("outA", "outB", "outC", "outD")
NO_PORT = "none"
"""Stands for the ports of both wheels if the robot has no wheels."""
INPUT_PORTS = ("in1", "in2", "in3", "in4")

ROBOT_WEIGHTS: Mapping[str, float] = {"weightless": 0.0, "light": 3.0, "medium": 6.0, "heavy": 9.0}
"""Names for `RobotSpec.weight`: a motor accelerates by 5000 / weight degrees per second each second."""

STRATEGIES = ("mean", "gaussian", "centre")
"""How a colour sensor weights the pixels of its disc: equally, by a bell curve, or the centre threefold."""

BACKGROUND_FITS = ("stretch", "fit", "centre", "corner")
"""How the user's image becomes a mat: stretched over the field, as large as fits, or pixel for pixel in the
centre or from the upper left corner."""

MOTOR_KINDS = (*EV3_MOTORS, *HUB_MOTORS)
"""Kinds of motors, for `MotorSpec.kind` and the wheel motors: those of the EV3, and those of hubs."""

EMPTY_MAT = "Empty_Map"
"""The mat without anything on it."""

BUTTONS = ("up", "down", "left", "right", "enter", "backspace")
"""The brick's buttons, by their names in the library."""

TOUCH = "touch"
"""Name in `PRESSABLE` that stands for every touch sensor of the robot."""

PRESSABLE = (
    *(*BUTTONS, TOUCH, *INPUT_PORTS, *REMOTE_BY_HAND, *HUB_PORTS),
    *(key for keys in CONTROLLERS.values() for key in keys),
)
"""What can be pressed by hand: buttons, touch sensors by their ports, remote controls and a game controller."""

MOTOR_ENDS = ("low", "high")
"""Ends of the range of a motor with end stops, for `TouchSpec.pressed_at`."""

MIN_RANGE_DEG = 5.0
"""Smallest distance between the end stops of a motor."""

_MAX_RANGE_DEG = 100_000


def _build_x(default: Any = MISSING) -> Any:
    return number(
        -500,
        500,
        default=default,
        unit="mm",
        label="x mm",
        help="to the right of the robot's centre",
    )


def _build_y(default: Any = MISSING) -> Any:
    return number(-500, 500, default=default, unit="mm", label="y mm", help="forward of the axle")


def _build_direction() -> Any:
    about = "counter-clockwise from straight ahead"
    return number(-360, 360, default=0.0, unit="°", label="Angle °", help=about)


_INPUT_HELP = "in1 … in4; of a hub A … F"


def _build_input_port(default: str) -> Any:
    ports = (*INPUT_PORTS, *HUB_PORTS)
    return choice(ports, what="port", default=default, label="Port", help=_INPUT_HELP)


def _build_output_port(default: str, label: str) -> Any:
    ports = (*OUTPUT_PORTS, NO_PORT, *HUB_PORTS)
    about = "outA … outD; of a hub A … F"
    return choice(ports, what="port", default=default, label=label, help=about)


def _build_sensor_name(default: str) -> Any:
    return text(what="sensor name", pattern=SENSOR_NAME, default=default)


SENSOR_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
"""The names that sensors can have."""


@spec
class MotorSpec(Spec):
    """A motor on a port, which may have end stops.

    An end stop is an angle of the motor in degrees, relative to its position at the start; None is no end stop.

    A motor that is mounted the other way round needs no value of its own: only the angles of its end stops differ.
    """

    port: str = choice((*OUTPUT_PORTS, NO_PORT, *HUB_PORTS), what="port")
    kind: str = choice(
        MOTOR_KINDS,
        what="kind of motor",
        default="medium",
        help=f"large or medium; of a hub {', '.join(HUB_MOTORS)}",
    )
    low_deg: float | None = number(
        -_MAX_RANGE_DEG,
        0,
        default=None,
        later=True,
        unit="°",
        help="end stop backwards, relative to the position at the start",
    )
    """The end stop in the backward direction, 0 or below; None for no stop."""
    high_deg: float | None = number(
        0,
        _MAX_RANGE_DEG,
        default=None,
        later=True,
        unit="°",
        help="end stop forwards, relative to the position at the start",
    )
    """The end stop in the forward direction, 0 or above; None for no stop."""

    def check(self) -> None:
        if (
            self.low_deg is not None
            and self.high_deg is not None
            and self.high_deg - self.low_deg < MIN_RANGE_DEG
        ):
            raise RobotError(f"must be at least {MIN_RANGE_DEG:g} above low_deg", key="high_deg")


@spec
class SensorSpec(Spec):
    """Base class of the specs of sensors, each of which has a name and a port."""

    name: str = _build_sensor_name("sensor")
    """Prefix of its telemetry columns, such as `left`."""
    port: str = _build_input_port("in1")

    def name_key(self, name: str) -> str:
        return f"{self.name}.{name}"


@spec
class TouchSpec(SensorSpec):
    """A touch sensor: it is pressed while its bumper touches an obstacle or a wall, or a motor is at its end stop."""

    name: str = _build_sensor_name("touch")
    port: str = _build_input_port("in1")
    x_mm: float = _build_x(0.0)
    y_mm: float = _build_y(45.0)
    width_mm: float = number(
        1, 500, default=20.0, unit="mm", label="width mm", help="of the bumper, across the robot"
    )
    """Width of the bumper, across the robot."""
    pressed_by: str = choice(
        (*OUTPUT_PORTS, "", *HUB_PORTS),
        what="port",
        default="",
        later=True,
        help="port of the motor that presses it, in place of obstacles and walls",
    )
    """Port of the motor that presses the sensor at an end stop; empty for a bumper, which obstacles and walls press."""
    pressed_at: str = choice(
        MOTOR_ENDS,
        what="end",
        default="low",
        later=True,
        help="low or high: the end stop of the motor that presses it",
    )
    """The end stop at which the motor on the port `pressed_by` presses the sensor, one of `MOTOR_ENDS`."""


@spec
class InfraredSpec(SensorSpec):
    """An infrared sensor: it measures distances and the direction to a beacon, and receives a remote control."""

    name: str = _build_sensor_name("infrared")
    port: str = _build_input_port("in4")
    x_mm: float = _build_x(0.0)
    y_mm: float = _build_y(20.0)
    angle_deg: float = _build_direction()
    """Direction, counter-clockwise from straight ahead."""


@spec
class ColorSensorSpec(SensorSpec):
    """A colour sensor that looks down at the mat: it measures the mean colour of the pixels in a disc."""

    name: str = text(what="sensor name", pattern=SENSOR_NAME)
    port: str = choice((*INPUT_PORTS, *HUB_PORTS), what="port", label="Port", help=_INPUT_HELP)
    x_mm: float = _build_x()
    y_mm: float = _build_y()
    # The minimum is 2, because a disc of 1 pixel has no pixel strictly inside it.
    diameter_mm: int = whole(
        2, 100, default=20, unit="mm", label="⌀ mm", help="of the visible disc, whole mm"
    )
    strategy: str = choice(
        STRATEGIES,
        what="strategy",
        default="mean",
        label="Weighing",
        help="weights of the disc's pixels: mean, gaussian or centre",
    )
    """How the pixels of the disc are weighted, one of `STRATEGIES`."""
    white_percent: float | None = number(
        50,
        100,
        default=None,
        later=True,
        unit="%",
        label="White %",
        help="reflected light of white; the default depends on the profile",
    )
    """Reflected light of white; None: `ProfileSpec.white_percent`."""
    black_percent: float | None = number(
        0,
        49,
        default=None,
        later=True,
        unit="%",
        label="Black %",
        help="reflected light of black; the default depends on the profile",
    )
    """Reflected light of black; None: `ProfileSpec.black_percent`."""


@spec
class UltrasonicSpec(SensorSpec):
    """An ultrasonic sensor: it sends a fan of rays, and measures how far the nearest surface is that echoes a ray."""

    name: str = _build_sensor_name("ultrasonic")
    port: str = _build_input_port("in1")
    x_mm: float = _build_x(0.0)
    y_mm: float = _build_y(20.0)
    angle_deg: float = _build_direction()
    max_range_mm: float = number(
        1, 10_000, default=2550.0, unit="mm", label="Range mm", help="reported when no echo returns"
    )
    """Reading when no echo returns (EV3 sensor data sheet)."""
    ray_angles_deg: tuple[float, ...] = numbers(
        -360,
        360,
        100,
        default=(-21.0, -14.0, -7.0, 0.0, 7.0, 14.0, 21.0),
        unit="°",
        label="Rays °",
        help="directions of the rays; the nearest echo counts",
    )
    noise_mm: float = number(
        0,
        1000,
        default=0.0,
        unit="mm",
        label="Noise ± mm",
        help="uniform, plus or minus this value",
    )
    """Every measured distance has a random error, uniform from -noise_mm to +noise_mm."""


@spec
class GyroSpec(SensorSpec):
    """A gyro: it measures the angle since its last reset and the rate of turn, both clockwise."""

    name: str = _build_sensor_name("gyro")
    port: str = choice(
        (*INPUT_PORTS, *HUB_PORTS, INSIDE),
        what="port",
        default="in4",
        label="Port",
        help=f"{_INPUT_HELP}, or inside",
    )
    keeps_angle: bool = flag(
        default=False,
        later=True,
        label="Keeps angle",
        help="a newer sensor, from date code N4 on: keeps its angle when the mode changes",
    )
    """Whether a change of mode leaves the gyro's angle as it is, even if the profile has `gyro_restarts`."""


@spec
class PenSpec(Spec):
    """The robot's pen: its place on the robot, its colour and width, and whether it is down at the start."""

    KEY = "pen"

    x_mm: float = _build_x(0.0)
    y_mm: float = _build_y(0.0)
    color: str = color(
        default="red",
        label="Colour",
        flags=("-P", "--pencolor"),
        help="colour of the pen: a CSS name, or #rrggbb",
    )
    """Any CSS colour name, or #rrggbb."""
    width_mm: float = number(
        0.1,
        200,
        default=6.0,
        unit="mm",
        label="Width mm",
        flags=("--pen-width",),
        in_config=False,
        help="width of the trace",
    )
    down: bool = flag(
        default=False,
        label="Down",
        flags=("-p", "--pendown"),
        in_config=False,
        help="start with the pen down",
    )


@spec
class RobotSpec(Spec):
    """A robot with two wheels, or one that stands and only moves other motors."""

    name: str = text(what="name", default="Default_Robot", label="Name", most=100)
    wheel_diameter_mm: float = number(1, 500, default=56.0, unit="mm", label="Wheel ⌀ mm")
    wheel_spacing_mm: float = number(
        1,
        1000,
        default=180.0,
        unit="mm",
        label="Spacing mm",
        help="between the centres of the wheels",
    )
    wheel_width_mm: float = number(1, 200, default=20.0, unit="mm", label="Width mm")
    back_mm: float = number(
        -1000,
        0,
        default=-120.0,
        unit="mm",
        label="Back mm",
        help="how far the body reaches behind the axle, as a negative y",
    )
    """How far the body extends behind the axle, as a negative y."""
    weight: float = named_number(
        0,
        1000,
        ROBOT_WEIGHTS,
        default=ROBOT_WEIGHTS["medium"],
        label="Weight",
        help=f"{', '.join(f'{name} ({weight:g})' for name, weight in ROBOT_WEIGHTS.items())}, or a number: "
        "wheels gain 5000 / weight °/s²; only under robolab and nbev3devsim",
    )
    """With 0 the speed changes immediately; otherwise the acceleration is 5000 / weight degrees per second squared."""
    left_port: str = _build_output_port("outB", "Left motor")
    """Port of the motor of the left wheel; `NO_PORT`, as `right_port`, on a robot without wheels."""
    right_port: str = _build_output_port("outC", "Right motor")
    color_sensors: tuple[ColorSensorSpec, ...] = parts(
        ColorSensorSpec,
        default=(
            ColorSensorSpec("left", "in2", -20.0, 30.0),
            ColorSensorSpec("right", "in3", 20.0, 30.0),
        ),
        standard=True,
    )
    ultrasonic: UltrasonicSpec | None = part(
        UltrasonicSpec, default=UltrasonicSpec(), optional=True, standard=True
    )
    gyro: GyroSpec | None = part(GyroSpec, default=GyroSpec(), optional=True, standard=True)
    pen: PenSpec = part(PenSpec, default=PenSpec())
    extra_motors: tuple[MotorSpec, ...] = parts(MotorSpec, default=())
    """Motors that do not drive a wheel."""
    extra_ultrasonics: tuple[UltrasonicSpec, ...] = parts(
        UltrasonicSpec, default=(), key="ultrasonics"
    )
    touch_sensors: tuple[TouchSpec, ...] = parts(TouchSpec, default=())
    infrared: InfraredSpec | None = part(InfraredSpec, default=None)
    extra_infrareds: tuple[InfraredSpec, ...] = parts(
        InfraredSpec, default=(), key="infrareds", later=True
    )
    left_motor: str = choice(
        MOTOR_KINDS, what="kind of motor", default="large", later=True, label="Left kind"
    )
    """Kind of the motor of the left wheel, one of `MOTOR_KINDS`."""
    right_motor: str = choice(
        MOTOR_KINDS, what="kind of motor", default="large", later=True, label="Right kind"
    )
    left_reversed: bool = flag(
        default=False,
        later=True,
        label="Left rev.",
        help="mounted the other way round: positive speeds turn the wheel backwards",
    )
    """Whether the motor of the left wheel is mounted the other way round: positive speeds turn the wheel backwards."""
    right_reversed: bool = flag(
        default=False,
        later=True,
        label="Right rev.",
        help="mounted the other way round: positive speeds turn the wheel backwards",
    )
    gear_ratio: float = number(
        0.01, 100, default=1.0, later=True, label="Gear ratio", help="motor turns per wheel turn"
    )
    """Turns of a wheel's motor for one turn of the wheel: above 1 the robot is slower than its motors."""
    mass_kg: float = number(
        0.1,
        20,
        default=0.95,
        unit="kg",
        later=True,
        label="Mass kg",
        help="with brick and battery; only under ev3, and of Pybricks where a motor runs by dc or coasts",
    )
    battery_v: float = number(
        5,
        9,
        default=8.0,
        unit="V",
        later=True,
        label="Battery V",
        help="without a load: it sets the highest speed, only where mass_kg counts",
    )
    hub: str = choice(
        ("", *HUBS),
        what="hub",
        default="",
        later=True,
        help="the hub of Pybricks in place of the EV3, such as PrimeHub",
    )
    """The hub in place of the EV3, one of `HUBS`; empty for the EV3."""

    @property
    def output_ports(self) -> tuple[str, ...]:
        """The names of the ports for motors on the robot's brick or hub."""
        return tuple(HUBS[self.hub].ports) if self.hub else OUTPUT_PORTS

    @property
    def input_ports(self) -> tuple[str, ...]:
        """The names of the ports for sensors on the robot's brick or hub."""
        return tuple(HUBS[self.hub].ports) if self.hub else INPUT_PORTS

    @property
    def has_wheels(self) -> bool:
        """Whether the robot has wheels that motors drive."""
        return self.left_port != NO_PORT

    @property
    def wheel_motors(self) -> tuple[MotorSpec, MotorSpec]:
        """The motors of the left and the right wheel; on a robot without wheels, their port is `NO_PORT`."""
        return MotorSpec.restore(port=self.left_port, kind=self.left_motor), MotorSpec.restore(
            port=self.right_port, kind=self.right_motor
        )

    @property
    def motors(self) -> tuple[MotorSpec, ...]:
        """All motors of the robot, the two wheel motors first."""
        return *self.wheel_motors, *self.extra_motors

    @property
    def sensors(self) -> tuple[SensorSpec, ...]:
        """All sensors of the robot, in the order of the telemetry columns."""
        return tuple(sensor for mount in MOUNTS for sensor in self.list_sensors(mount))

    @property
    def further_sensors(self) -> tuple[SensorSpec, ...]:
        """Sensors that are not standard equipment, in the order of the telemetry columns."""
        return tuple(
            sensor for mount in MOUNTS if not mount.standard for sensor in self.list_sensors(mount)
        )

    def list_sensors(self, mount: Mount) -> tuple[SensorSpec, ...]:
        """Return the robot's sensors of one class, given by its `Mount`; empty if the robot has no such sensor."""
        sensors = getattr(self, mount.field)
        if mount.many:
            return tuple(sensors)
        return () if sensors is None else (sensors,)

    def check(self) -> None:
        used = self._check_wheel_ports()
        wheels = {"left_motor": self.left_motor, "right_motor": self.right_motor}
        others = {f"motors.{motor.port}": motor.kind for motor in self.extra_motors}
        check_motor_kinds(self.hub, {**wheels, **others})
        for motor in self.extra_motors:
            require_one_of(motor.port, "port", self.output_ports, "motors")
            if motor.port in used:
                raise RobotError(
                    f"two motors are on {motor.port}", "give each its own port", key="motors"
                )
            used.add(motor.port)
        for sensor in self.sensors:
            if sensor.port != INSIDE:
                require_one_of(sensor.port, "port", self.input_ports, f"{sensor.name}.port")
            if sensor.port in used:
                raise RobotError(
                    f"two {'parts' if self.hub else 'sensors'} are on {sensor.port}",
                    "give each its own port, or remove one, such as `ultrasonic = false`",
                    key=f"{sensor.name}.port",
                )
            used.add(sensor.port)
        self._check_names()
        for touch in self.touch_sensors:
            self._check_presser(touch)

    def _check_wheel_ports(self) -> set[str]:
        """Check that the wheels' motors have valid ports, and return these ports."""
        if self.left_port == self.right_port == NO_PORT:
            return set()
        for key in ("left_port", "right_port"):
            require_one_of(getattr(self, key), "port", self.output_ports, key)
        if self.left_port == self.right_port:
            raise RobotError(
                f"both motors are on {self.left_port}", "give each its own port", key="right_port"
            )
        return {self.left_port, self.right_port}

    def _check_names(self) -> None:
        names = [sensor.name for sensor in self.color_sensors]
        if len(set(names)) < len(names):
            raise RobotError(
                "two colour sensors have the same name", "give each its own", key="color_sensors"
            )
        if len({sensor.name for sensor in self.sensors}) < len(self.sensors):
            raise RobotError("two sensors have the same name", "give each its own", key="sensors")

    def _check_presser(self, touch: TouchSpec) -> None:
        port = touch.pressed_by
        end = f"{touch.pressed_at}_deg"
        motors = {motor.port: motor for motor in self.extra_motors}
        if port and port not in motors:
            what = "drives a wheel" if port in (self.left_port, self.right_port) else "has no motor"
            raise RobotError(
                f"{port} {what}", "the port of another motor", key=f"{touch.name}.pressed_by"
            )
        if port and getattr(motors[port], end) is None:
            raise RobotError(
                f"the motor on {port} has no such end stop",
                f"give it {end}",
                key=f"{touch.name}.pressed_at",
            )


class Mount(NamedTuple):
    """The field of `RobotSpec` that has the sensors of one class."""

    field: str
    """The field of `RobotSpec`."""
    spec: type[SensorSpec]
    """Class of the sensors in this field."""
    many: bool
    """Whether the field is a tuple; otherwise it is one sensor or None."""
    standard: bool
    """Whether panels and files have a dedicated place for this field; all other fields are handled generically."""
    key: str
    """Key of the sensors in a robot file."""


MOUNTS = tuple(
    Mount(name, value.of, isinstance(value, Parts), value.standard, value.key or name)
    for name, value in list_values(RobotSpec).items()
    if isinstance(value, Part) and issubclass(value.of, SensorSpec)
)
"""All fields for sensors, in the order of the telemetry columns."""


@spec
class Obstacle(Spec):
    """An upright box, seen from above: lower-left corner and size in mm."""

    ERROR = ObstacleError

    x_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")
    y_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")
    width_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")
    height_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")

    def check(self) -> None:
        for key in ("width_mm", "height_mm"):
            if getattr(self, key) <= 0:
                raise ObstacleError(f"must be above 0, got {getattr(self, key)!r}", key=key)


@spec
class NoiseSpec(Spec):
    """The limits of the random errors of colour sensors and wheel speeds."""

    KEY = "noise"

    light: int = whole(
        0,
        128,
        default=0,
        label="Light",
        flags=("-N", "--sensornoise"),
        help="light noise, ± 0 … 128 on each pixel of 0 … 255",
    )
    """Every pixel and channel that a colour sensor sees has a random error, uniform from -light to +light (0 … 128)."""
    motor: int = whole(
        0,
        500,
        default=0,
        unit="°/s",
        label="Motor",
        flags=("-M", "--motornoise"),
        help="motor noise, ± 0 … 500 on each wheel and tick",
    )
    """Each tick, a wheel's speed has a random error, uniform from -motor to +motor degrees per second (0 … 500)."""


START_VALUES = {
    "x_mm": Number(
        -MAX_POSITION_MM,
        MAX_POSITION_MM,
        unit="mm",
        flags=("-x", "--x", "--xpos"),
        in_config=False,
        label="X",
        help="start x in mm",
    ),
    "y_mm": Number(
        -MAX_POSITION_MM,
        MAX_POSITION_MM,
        unit="mm",
        flags=("-y", "--y", "--ypos"),
        in_config=False,
        label="Y",
        help="start y in mm",
    ),
    "heading_deg": Number(
        -36_000,
        36_000,
        unit="°",
        flags=("-a", "--angle"),
        in_config=False,
        label="Angle",
        help="start heading, counter-clockwise from +x",
    ),
}
"""The values of a start pose; a run may go on from any other pose."""


@spec
class WorldSpec(Spec):
    """The robot's environment: mat, obstacles and walls, start pose, and the errors of wheels and sensors."""

    background: str = text(what="name of a mat", default=EMPTY_MAT)
    obstacles: tuple[Obstacle, ...] = parts(Obstacle, default=())
    walls: bool = flag(
        default=True, label="Walls", flags=("--walls",), help="walls on the edges of the field"
    )
    """Whether the field has walls on its four edges: they echo, and stop the robot if `solid`."""
    solid: bool = flag(
        default=False,
        label="Solid",
        flags=("--solid",),
        off_flag="--no-solid",
        in_config=False,
        help="obstacles and walls stop the robot",
        off_help="the robot drives through obstacles and walls",
    )
    """Whether obstacles and walls stop the robot."""
    background_fit: str = choice(
        BACKGROUND_FITS,
        default=BACKGROUND_FITS[0],
        label="Image fit",
        flags=("--background-fit",),
        in_config=False,
        help="how an image is placed on the field",
    )
    """One of `BACKGROUND_FITS`, for the user's image."""
    pen_marks: bool = flag(
        default=False,
        label="Marks mat",
        flags=("--pen-marks",),
        in_config=False,
        help="the sensors see what the pen draws",
    )
    """Whether the pen marks the mat that the sensors see."""
    start: Pose = part(Pose, values=START_VALUES, default=Pose(100.0, 800.0, 0.0))
    noise: NoiseSpec = part(NoiseSpec, default=NoiseSpec())
    drift: DriftSpec = named_part(
        DriftSpec,
        default=NO_DRIFT,
        later=True,
        label="Drift",
        flags=("--drift",),
        help="errors of wheels and sensors: none, typical, or values",
    )
    """Errors of wheels and sensors that a program does not know of."""
    floor: bool = flag(
        default=False,
        later=True,
        help="where there are no walls, the ground continues around the mat in the colour of its edges",
    )
    """Whether the mat lies on a floor of its own colour."""
    beacon: BeaconSpec | None = part(BeaconSpec, default=None)
    """An infrared beacon."""
    remote: tuple[RemotePress, ...] = parts(RemotePress, default=())
    """Presses of buttons on the infrared remote control."""

    @property
    def is_open(self) -> bool:
        """Whether the robot may leave the field for a floor that goes on around it."""
        return self.floor and not self.walls


@spec
class RunSpec(Spec):
    """Everything that determines a run besides the program: the same spec gives the same log."""

    robot: RobotSpec = part(RobotSpec)
    world: WorldSpec = part(WorldSpec)
    profile: ProfileSpec = part(ProfileSpec)
    seed: int = seed(
        default=0,
        label="Seed",
        flags=("--seed",),
        in_config=False,
        help="seed for noise, drift, `random`, and an EV3's clock",
    )
