"""The specification of a run: robot, world, noise and profile as frozen data.

Lengths are in mm, angles in degrees, x to the right of the robot and y forward of the
midpoint between its wheels. Defaults are those of the original course's Default_Robot.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, ClassVar, Protocol

from tuisim.core.geometry import Pose
from tuisim.core.profile import ProfileSpec, profile_from_plain, profile_to_plain
from tuisim.errors import ObstacleError, RobotError, require, require_one_of

FIELD_WIDTH_MM = 2362
"""Width of the field; one mat pixel is one mm."""

FIELD_HEIGHT_MM = 1143
"""Height of the field."""

MAX_OBSTACLE_MM = 10_000.0
"""Largest absolute coordinate and size of an obstacle."""

MAX_RAYS = 100
"""Maximum number of rays of an ultrasonic sensor."""

MAX_LIGHT_NOISE = 128
MAX_MOTOR_NOISE = 500

OUTPUT_PORTS = ("outA", "outB", "outC", "outD")
NO_PORT = "none"
"""In place of the ports of both wheels: the robot has none."""
INPUT_PORTS = ("in1", "in2", "in3", "in4")

ROBOT_WEIGHTS: Mapping[str, float] = {"weightless": 0.0, "light": 3.0, "medium": 6.0, "heavy": 9.0}
"""Names for `RobotSpec.weight`: a motor accelerates by 5000 / weight degrees per second each second."""


STRATEGIES = ("mean", "gaussian", "centre")
"""How a colour sensor weights the pixels of its disc: equally, by a bell curve, or the centre threefold."""

BACKGROUND_FITS = ("stretch", "fit", "centre", "corner")
"""How the user's image becomes a mat: stretched over the field, as large as fits, or pixel for pixel in the
centre or from the upper left corner."""


MOTOR_KINDS = ("large", "medium")
"""Kinds of motors, for `MotorSpec.kind` and the wheel motors."""

REMOTE_BUTTONS = ("top_left", "bottom_left", "top_right", "bottom_right", "beacon")
"""Buttons of the remote control, by their names in ev3dev2."""

REMOTE_CHANNELS = (1, 2, 3, 4)
"""Channels of a remote control or beacon."""


MOTOR_ENDS = ("low", "high")
"""Ends of the range of a motor with end stops, for `TouchSpec.pressed_at`."""

MIN_RANGE_DEG = 5.0
"""Smallest distance between the end stops of a motor."""

MAX_RANGE_DEG = 100_000
"""Largest distance of an end stop from the motor's position at the start."""


@dataclass(frozen=True, slots=True)
class MotorSpec:
    """A motor on a port. Its end stops are in degrees of the motor from its position at the start; None is no stop.

    A motor that is mounted the other way round just has its stops at other degrees, so this is no value of its own.
    """

    port: str
    kind: str = "medium"
    """One of `MOTOR_KINDS`."""
    low_deg: float | None = None
    """The motor turns no further backwards than here; 0 or below."""
    high_deg: float | None = None
    """The motor turns no further forwards than here; 0 or above."""

    def __post_init__(self) -> None:
        require_one_of(self.kind, "kind of motor", MOTOR_KINDS, "motors")
        if self.low_deg is not None:
            require(self.low_deg, -MAX_RANGE_DEG, 0, "low_deg")
        if self.high_deg is not None:
            require(self.high_deg, 0, MAX_RANGE_DEG, "high_deg")
        if self.low_deg is not None and self.high_deg is not None and self.high_deg - self.low_deg < MIN_RANGE_DEG:
            raise RobotError(f"must be at least {MIN_RANGE_DEG:g} above low_deg", key="high_deg")


@dataclass(frozen=True, slots=True)
class TouchSpec:
    """A touch sensor: pressed while its bumper touches an obstacle or a wall, or by a motor at its end stop."""

    name: str = "touch"
    port: str = "in1"
    x_mm: float = 0.0
    y_mm: float = 45.0
    width_mm: float = 20.0
    """Width of the bumper, across the robot."""
    pressed_by: str = ""
    """Port of the motor that presses it at an end stop, in place of obstacles and walls; empty for a bumper."""
    pressed_at: str = "low"
    """The end stop at which that motor presses it, one of `MOTOR_ENDS`."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        require(self.width_mm, 1, 500, f"{self.name}.width_mm")
        if self.pressed_by:
            require_one_of(self.pressed_by, "port", OUTPUT_PORTS, f"{self.name}.pressed_by")
        require_one_of(self.pressed_at, "end", MOTOR_ENDS, f"{self.name}.pressed_at")


@dataclass(frozen=True, slots=True)
class InfraredSpec:
    """The infrared sensor: proximity, direction and distance of a beacon, buttons of a remote control."""

    name: str = "infrared"
    port: str = "in4"
    x_mm: float = 0.0
    y_mm: float = 20.0
    angle_deg: float = 0.0
    """Direction, counter-clockwise from straight ahead."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        require(self.angle_deg, -360, 360, f"{self.name}.angle_deg")


@dataclass(frozen=True, slots=True)
class BeaconSpec:
    """An infrared beacon on the field, in world coordinates."""

    x_mm: float
    y_mm: float
    channel: int = 1

    def __post_init__(self) -> None:
        require(self.x_mm, -10_000, 10_000, "beacon.x_mm", ObstacleError)
        require(self.y_mm, -10_000, 10_000, "beacon.y_mm", ObstacleError)
        require_one_of(self.channel, "channel", REMOTE_CHANNELS, "beacon.channel", ObstacleError)


@dataclass(frozen=True, slots=True)
class RemotePress:
    """Buttons of the remote control that are pressed for some time."""

    buttons: tuple[str, ...]
    """One or two of `REMOTE_BUTTONS`; `beacon` only alone, since the sensor cannot distinguish other combinations."""
    from_s: float = 0.0
    until_s: float = 1e9
    channel: int = 1

    def __post_init__(self) -> None:
        if frozenset(self.buttons) not in REMOTE_CODES:
            raise ObstacleError(
                f"the sensor does not report {', '.join(self.buttons) or 'no button'}",
                f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
                key="remote.buttons",
            )
        if not self.from_s <= self.until_s:
            raise ObstacleError("ends before it begins", key="remote.until_s")
        require_one_of(self.channel, "channel", REMOTE_CHANNELS, "remote.channel", ObstacleError)


REMOTE_CODES = {
    frozenset(buttons.split("+")): code
    for code, buttons in enumerate(
        (
            "top_left", "bottom_left", "top_right", "bottom_right", "top_left+top_right", "top_left+bottom_right",
            "bottom_left+top_right", "bottom_left+bottom_right", "beacon", "top_left+bottom_left",
            "top_right+bottom_right",
        ),
        start=1,
    )
}  # fmt: skip
"""Value of the sensor for each set of buttons; 0 is none."""


@dataclass(frozen=True, slots=True)
class ColorSensorSpec:
    """A downward colour sensor: the mean of a disc of mat pixels."""

    name: str
    """Prefix of its telemetry columns, such as `left`."""
    port: str
    x_mm: float
    y_mm: float
    diameter_mm: int = 20
    strategy: str = "mean"
    """How the pixels of the disc are weighted, one of `STRATEGIES`."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        # A disc of 1 pixel has no pixel strictly inside it.
        require(self.diameter_mm, 2, 100, f"{self.name}.diameter_mm", whole=True)
        require_one_of(self.port, "port", INPUT_PORTS, f"{self.name}.port")
        require_one_of(self.strategy, "strategy", STRATEGIES, f"{self.name}.strategy")


@dataclass(frozen=True, slots=True)
class UltrasonicSpec:
    """The forward distance sensor: the nearest echo of a fan of rays."""

    name: str = "ultrasonic"
    port: str = "in1"
    x_mm: float = 0.0
    y_mm: float = 20.0
    angle_deg: float = 0.0
    max_range_mm: float = 2550.0
    """Reading when no echo returns (EV3 sensor data sheet)."""
    ray_angles_deg: tuple[float, ...] = (-21.0, -14.0, -7.0, 0.0, 7.0, 14.0, 21.0)
    noise_mm: float = 0.0
    """Uniform ±noise_mm on every distance."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        require(self.angle_deg, -360, 360, f"{self.name}.angle_deg")
        require(self.max_range_mm, 1, 10_000, f"{self.name}.max_range_mm")
        require(self.noise_mm, 0, 1000, f"{self.name}.noise_mm")
        if not 1 <= len(self.ray_angles_deg) <= MAX_RAYS:
            raise RobotError(
                f"must be 1 to {MAX_RAYS} angles, got {len(self.ray_angles_deg)}", key=f"{self.name}.ray_angles_deg"
            )
        for at, angle_deg in enumerate(self.ray_angles_deg, start=1):
            require(angle_deg, -360, 360, f"{self.name}.ray_angles_deg[{at}]")
        require_one_of(self.port, "port", INPUT_PORTS, f"{self.name}.port")


@dataclass(frozen=True, slots=True)
class GyroSpec:
    """The gyro: clockwise angle since the last reset, and rate of turn."""

    name: str = "gyro"
    port: str = "in4"

    def __post_init__(self) -> None:
        require_one_of(self.port, "port", INPUT_PORTS, f"{self.name}.port")


class SensorSpec(Protocol):
    """Any sensor: a frozen dataclass with a name and a port."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def name(self) -> str: ...

    @property
    def port(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Mount:
    """Where `RobotSpec` stores sensors of one class."""

    field: str
    """The field of `RobotSpec`."""
    spec: type
    """Class of the sensors; all fields have defaults, except for colour sensors."""
    many: bool
    """Whether the field is a tuple; otherwise it is one sensor or None."""
    usual: bool = False
    """Whether panels and files have a dedicated place for it; all others are handled generically."""
    written: str = ""
    """Key in a robot file, if it differs from the field."""

    @property
    def key(self) -> str:
        """The key in a robot file."""
        return self.written or self.field


SENSOR_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
"""The names that sensors can have."""
MOUNTS = (
    Mount("color_sensors", ColorSensorSpec, many=True, usual=True),
    Mount("ultrasonic", UltrasonicSpec, many=False, usual=True),
    Mount("gyro", GyroSpec, many=False, usual=True),
    Mount("extra_ultrasonics", UltrasonicSpec, many=True, written="ultrasonics"),
    Mount("touch_sensors", TouchSpec, many=True),
    Mount("infrared", InfraredSpec, many=False),
    Mount("extra_infrareds", InfraredSpec, many=True, written="infrareds"),
)
"""All fields for sensors, in the order of the telemetry columns."""


@dataclass(frozen=True, slots=True)
class PenSpec:
    """The pen that draws the robot's trace."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    color: str = "red"
    """Any CSS colour name, or #rrggbb."""
    width_mm: float = 6.0
    down: bool = False

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, "pen.x_mm")
        require(self.y_mm, -500, 500, "pen.y_mm")
        require(self.width_mm, 0.1, 200, "pen.width_mm")


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot with two wheels, or one that stands and only moves other motors."""

    name: str = "Default_Robot"
    wheel_diameter_mm: float = 56.0
    wheel_spacing_mm: float = 180.0
    wheel_width_mm: float = 20.0
    back_mm: float = -120.0
    """How far the body extends behind the axle, as a negative y."""
    weight: float = ROBOT_WEIGHTS["medium"]
    """0 changes speed at once; otherwise the acceleration is 5000 / weight degrees per second each second."""
    left_port: str = "outB"
    """Port of the motor of the left wheel; `NO_PORT`, as `right_port`, on a robot without wheels."""
    right_port: str = "outC"
    color_sensors: tuple[ColorSensorSpec, ...] = (
        ColorSensorSpec("left", "in2", -20.0, 30.0),
        ColorSensorSpec("right", "in3", 20.0, 30.0),
    )
    ultrasonic: UltrasonicSpec | None = field(default_factory=UltrasonicSpec)
    gyro: GyroSpec | None = field(default_factory=GyroSpec)
    pen: PenSpec = field(default_factory=PenSpec)
    extra_motors: tuple[MotorSpec, ...] = ()
    """Motors that do not drive a wheel."""
    extra_ultrasonics: tuple[UltrasonicSpec, ...] = ()
    touch_sensors: tuple[TouchSpec, ...] = ()
    infrared: InfraredSpec | None = None
    extra_infrareds: tuple[InfraredSpec, ...] = ()
    left_motor: str = "large"
    """Kind of the motor of the left wheel, one of `MOTOR_KINDS`."""
    right_motor: str = "large"
    left_reversed: bool = False
    """Whether the motor of the left wheel is mounted the other way round: positive speeds turn the wheel backwards."""
    right_reversed: bool = False
    gear_ratio: float = 1.0
    """Turns of a wheel's motor for one turn of the wheel: above 1 the robot is slower than its motors."""

    @property
    def has_wheels(self) -> bool:
        """Whether motors drive the robot."""
        return self.left_port != NO_PORT

    @property
    def wheel_motors(self) -> tuple[MotorSpec, MotorSpec]:
        """The motors of the left and the right wheel, on no port if the robot has no wheels."""
        return MotorSpec(self.left_port, self.left_motor), MotorSpec(self.right_port, self.right_motor)

    @property
    def motors(self) -> tuple[MotorSpec, ...]:
        """All motors, wheel motors first."""
        return *self.wheel_motors, *self.extra_motors

    @property
    def sensors(self) -> tuple[SensorSpec, ...]:
        """All mounted sensors, in the order of the telemetry columns."""
        return tuple(sensor for mount in MOUNTS for sensor in self.sensors_in(mount))

    @property
    def further_sensors(self) -> tuple[SensorSpec, ...]:
        """Sensors that are not standard equipment, in the same order."""
        return tuple(sensor for mount in MOUNTS if not mount.usual for sensor in self.sensors_in(mount))

    def sensors_in(self, mount: Mount) -> tuple[SensorSpec, ...]:
        """Return the sensors of one mount."""
        found = getattr(self, mount.field)
        if mount.many:
            return tuple(found)
        return () if found is None else (found,)

    def __post_init__(self) -> None:
        require(self.wheel_diameter_mm, 1, 500, "wheel_diameter_mm")
        require(self.wheel_spacing_mm, 1, 1000, "wheel_spacing_mm")
        require(self.wheel_width_mm, 1, 200, "wheel_width_mm")
        require(self.back_mm, -1000, 0, "back_mm")
        require(self.weight, 0, 1000, "weight")
        require(self.gear_ratio, 0.01, 100, "gear_ratio")
        for key in ("left_motor", "right_motor"):
            require_one_of(getattr(self, key), "kind of motor", MOTOR_KINDS, key)
        used = self._check_wheel_ports()
        for motor in self.extra_motors:
            require_one_of(motor.port, "port", OUTPUT_PORTS, "motors")
            if motor.port in used:
                raise RobotError(f"two motors are on {motor.port}", "give each its own port", key="motors")
            used.add(motor.port)
        for sensor in self.sensors:
            require_one_of(sensor.port, "port", INPUT_PORTS, f"{sensor.name}.port")
            if sensor.port in used:
                raise RobotError(
                    f"two sensors are on {sensor.port}",
                    "give each its own port, or remove one, such as `ultrasonic = false`",
                    key=f"{sensor.name}.port",
                )
            used.add(sensor.port)
        self._check_names()
        for touch in self.touch_sensors:
            self._check_presser(touch)

    def _check_wheel_ports(self) -> set[str]:
        """Return the ports of the wheels."""
        if self.left_port == self.right_port == NO_PORT:
            return set()
        for key in ("left_port", "right_port"):
            require_one_of(getattr(self, key), "port", OUTPUT_PORTS, key)
        if self.left_port == self.right_port:
            raise RobotError(f"both motors are on {self.left_port}", "give each its own port", key="right_port")
        return {self.left_port, self.right_port}

    def _check_names(self) -> None:
        names = [sensor.name for sensor in self.color_sensors]
        if len(set(names)) < len(names):
            raise RobotError("two colour sensors have the same name", "give each its own", key="color_sensors")
        if len({sensor.name for sensor in self.sensors}) < len(self.sensors):
            raise RobotError("two sensors have the same name", "give each its own", key="sensors")

    def _check_presser(self, touch: TouchSpec) -> None:
        port, end = touch.pressed_by, f"{touch.pressed_at}_deg"
        motors = {motor.port: motor for motor in self.extra_motors}
        if port and port not in motors:
            what = "drives a wheel" if port in (self.left_port, self.right_port) else "has no motor"
            raise RobotError(f"{port} {what}", "the port of another motor", key=f"{touch.name}.pressed_by")
        if port and getattr(motors[port], end) is None:
            raise RobotError(
                f"the motor on {port} has no such end stop", f"give it {end}", key=f"{touch.name}.pressed_at"
            )


@dataclass(frozen=True, slots=True)
class Obstacle:
    """An upright box, seen from above: lower-left corner and size in mm."""

    x_mm: float
    y_mm: float
    width_mm: float
    height_mm: float

    def __post_init__(self) -> None:
        for key in ("x_mm", "y_mm", "width_mm", "height_mm"):
            require(getattr(self, key), -MAX_OBSTACLE_MM, MAX_OBSTACLE_MM, key, ObstacleError)
        for key in ("width_mm", "height_mm"):
            if getattr(self, key) <= 0:
                raise ObstacleError(f"must be above 0, got {getattr(self, key)!r}", key=key)


@dataclass(frozen=True, slots=True)
class NoiseSpec:
    """Amplitude of the noise on readings and wheel speeds."""

    light: int = 0
    """0 … 128: uniform ±light on every pixel and channel that a colour sensor sees."""
    motor: int = 0
    """0 … 500: uniform ±motor degrees per second on the wheel speed, every tick."""

    def __post_init__(self) -> None:
        for key, high in (("light", MAX_LIGHT_NOISE), ("motor", MAX_MOTOR_NOISE)):
            value = getattr(self, key)
            if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= high:
                raise RobotError(f"must be a whole number from 0 to {high}, got {value!r}", key=f"noise.{key}")


@dataclass(frozen=True, slots=True)
class WorldSpec:
    """The robot's environment."""

    background: str = "Empty_Map"
    obstacles: tuple[Obstacle, ...] = ()
    walls: bool = True
    """Whether the field has walls on its four edges: they echo, and stop the robot if `solid`."""
    solid: bool = False
    """Whether obstacles and walls stop the robot."""
    background_fit: str = "stretch"
    """One of `BACKGROUND_FITS`, for the user's image."""
    pen_marks: bool = False
    """Whether the pen marks the mat that the sensors see."""
    start: Pose = Pose(100.0, 800.0, 0.0)
    noise: NoiseSpec = field(default_factory=NoiseSpec)
    beacon: BeaconSpec | None = None
    """An infrared beacon."""
    remote: tuple[RemotePress, ...] = ()
    """Presses of buttons on the infrared remote control."""


@dataclass(frozen=True, slots=True)
class RunSpec:
    """Everything that determines a run besides the program: the same spec gives the same log."""

    robot: RobotSpec
    world: WorldSpec
    profile: ProfileSpec
    seed: int = 0


_FIRST_MOUNTS = ("color_sensors", "ultrasonic", "gyro", "extra_ultrasonics", "touch_sensors", "infrared")
_OMITTED_DEFAULTS: Mapping[str, Any] = {
    **{mount.field: () if mount.many else None for mount in MOUNTS if mount.field not in _FIRST_MOUNTS},
    "left_motor": "large",
    "right_motor": "large",
    "left_reversed": False,
    "right_reversed": False,
    "gear_ratio": 1.0,
}
"""Fields of a robot added since the first stored runs; omitted at these values, so that exports do not change."""
_OMITTED_PARTS: Mapping[str, Mapping[str, Any]] = {
    "extra_motors": {"low_deg": None, "high_deg": None},
    "touch_sensors": {"pressed_by": "", "pressed_at": "low"},
}
"""As `_OMITTED_DEFAULTS`, for the parts in a field of a robot."""


def to_plain(spec: RunSpec) -> dict[str, Any]:
    """Return `spec` as JSON-compatible data."""
    plain = asdict(spec)
    for key, usual in _OMITTED_DEFAULTS.items():
        if plain["robot"][key] == usual:
            del plain["robot"][key]
    for key, usual_values in _OMITTED_PARTS.items():
        plain["robot"][key] = tuple(
            {name: value for name, value in part.items() if name not in usual_values or value != usual_values[name]}
            for part in plain["robot"][key]
        )
    plain["profile"] = profile_to_plain(spec.profile)
    return plain


def from_plain(data: Mapping[str, Any]) -> RunSpec:
    """Rebuild a spec from the output of `to_plain`.

    Raises:
        KeyError, TypeError: `data` is not the output of `to_plain`.
        RobotError, ObstacleError: a value is invalid.
    """
    robot, world = dict(data["robot"]), dict(data["world"])
    for mount in MOUNTS:
        # Runs stored before such sensors existed have no such key.
        plain = robot[mount.field] if mount.usual else robot.get(mount.field)
        if mount.many:
            robot[mount.field] = tuple(_sensor(mount.spec, sensor) for sensor in plain or ())
        else:
            robot[mount.field] = None if plain is None else _sensor(mount.spec, plain)
    robot["pen"] = PenSpec(**robot["pen"])
    robot["extra_motors"] = tuple(MotorSpec(**motor) for motor in robot.get("extra_motors", ()))
    world["obstacles"] = tuple(Obstacle(**obstacle) for obstacle in world["obstacles"])
    world["start"] = Pose(**world["start"])
    world["noise"] = NoiseSpec(**world["noise"])
    if world.get("beacon") is not None:
        world["beacon"] = BeaconSpec(**world["beacon"])
    world["remote"] = tuple(
        RemotePress(**{**press, "buttons": tuple(press["buttons"])}) for press in world.get("remote", ())
    )
    return RunSpec(RobotSpec(**robot), WorldSpec(**world), profile_from_plain(data["profile"]), int(data["seed"]))


def _sensor(spec: type, data: Mapping[str, Any]) -> Any:
    sensor = spec(**{key: tuple(value) if isinstance(value, list) else value for key, value in data.items()})
    if not SENSOR_NAME.fullmatch(sensor.name):
        raise RobotError(f"{sensor.name!r} is not a valid sensor name")
    return sensor
