"""What a run is made of: robot, world, noise and profile as frozen data.

Lengths in mm, angles in degrees, x to the right of the robot and y forward of the
midpoint between its wheels. Defaults are those of the seed course's Default_Robot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from tuisim.core.geometry import Pose
from tuisim.core.profile import ProfileSpec
from tuisim.errors import ObstacleError, RobotError

FIELD_WIDTH_MM = 2362
"""Width of the field; one mat pixel is one mm."""

FIELD_HEIGHT_MM = 1143
"""Height of the field."""

MAX_LIGHT_NOISE = 128
MAX_MOTOR_NOISE = 500

OUTPUT_PORTS = ("outA", "outB", "outC", "outD")
INPUT_PORTS = ("in1", "in2", "in3", "in4")

ROBOT_WEIGHTS: Mapping[str, float] = {"weightless": 0.0, "light": 3.0, "medium": 6.0, "heavy": 9.0}
"""Names for `RobotSpec.weight`: a motor gains 5000 / weight degrees per second each second."""


def _require(value: float, low: float, high: float, key: str) -> None:
    if not (isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)):
        raise RobotError(f"must be a number, got {value!r}", key=key)
    if not low <= value <= high:
        raise RobotError(f"must be from {low:g} to {high:g}, got {value!r}", key=key)


@dataclass(frozen=True, slots=True)
class ColorSensorSpec:
    """One downward colour sensor: the mean of a disc of mat pixels."""

    name: str
    """Prefix of its telemetry columns, such as `left`."""
    port: str
    x_mm: float
    y_mm: float
    diameter_mm: int = 20

    def __post_init__(self) -> None:
        _require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        _require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        _require(self.diameter_mm, 1, 100, f"{self.name}.diameter_mm")


@dataclass(frozen=True, slots=True)
class UltrasonicSpec:
    """The forward distance sensor: a fan of rays, the nearest echo counts."""

    name: str = "ultrasonic"
    port: str = "in1"
    x_mm: float = 0.0
    y_mm: float = 20.0
    angle_deg: float = 0.0
    max_range_mm: float = 2550.0
    """Reported when no echo returns (EV3 sensor data sheet)."""
    ray_angles_deg: tuple[float, ...] = (-21.0, -14.0, -7.0, 0.0, 7.0, 14.0, 21.0)

    def __post_init__(self) -> None:
        _require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        _require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        _require(self.angle_deg, -360, 360, f"{self.name}.angle_deg")
        _require(self.max_range_mm, 1, 10_000, f"{self.name}.max_range_mm")


@dataclass(frozen=True, slots=True)
class GyroSpec:
    """The gyro: clockwise turn since the last reset, and the rate of turn."""

    name: str = "gyro"
    port: str = "in4"


@dataclass(frozen=True, slots=True)
class PenSpec:
    """The pen that draws the robot's trace."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    color: str = "red"
    width_mm: float = 6.0
    down: bool = False


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A two-wheeled robot."""

    name: str = "Default_Robot"
    wheel_diameter_mm: float = 56.0
    wheel_spacing_mm: float = 180.0
    wheel_width_mm: float = 20.0
    back_mm: float = -120.0
    """How far the body reaches behind the axle, as a negative y."""
    weight: float = ROBOT_WEIGHTS["medium"]
    """0 changes speed at once; otherwise 5000 / weight degrees per second each second."""
    left_port: str = "outB"
    right_port: str = "outC"
    color_sensors: tuple[ColorSensorSpec, ...] = (
        ColorSensorSpec("left", "in2", -20.0, 30.0),
        ColorSensorSpec("right", "in3", 20.0, 30.0),
    )
    ultrasonic: UltrasonicSpec | None = field(default_factory=UltrasonicSpec)
    gyro: GyroSpec | None = field(default_factory=GyroSpec)
    pen: PenSpec = field(default_factory=PenSpec)

    def __post_init__(self) -> None:
        _require(self.wheel_diameter_mm, 1, 500, "wheel_diameter_mm")
        _require(self.wheel_spacing_mm, 1, 1000, "wheel_spacing_mm")
        _require(self.wheel_width_mm, 1, 200, "wheel_width_mm")
        _require(self.back_mm, -1000, 0, "back_mm")
        _require(self.weight, 0, 1000, "weight")
        for key in ("left_port", "right_port"):
            if getattr(self, key) not in OUTPUT_PORTS:
                raise RobotError(f"no such port {getattr(self, key)!r}", f"one of {', '.join(OUTPUT_PORTS)}", key=key)


@dataclass(frozen=True, slots=True)
class Obstacle:
    """An upright box, seen from above: lower-left corner and size in mm."""

    x_mm: float
    y_mm: float
    width_mm: float
    height_mm: float

    def __post_init__(self) -> None:
        for key in ("x_mm", "y_mm", "width_mm", "height_mm"):
            if not math.isfinite(getattr(self, key)):
                raise ObstacleError(f"must be a number, got {getattr(self, key)!r}", key=key)
        for key in ("width_mm", "height_mm"):
            if getattr(self, key) <= 0:
                raise ObstacleError(f"must be above 0, got {getattr(self, key)!r}", key=key)


@dataclass(frozen=True, slots=True)
class NoiseSpec:
    """How far readings and wheel speeds are disturbed."""

    light: int = 0
    """0 … 128: uniform ±light on every pixel and channel a colour sensor sees."""
    motor: int = 0
    """0 … 500: uniform ±motor degrees per second on the wheel speed, every tick."""

    def __post_init__(self) -> None:
        for key, high in (("light", MAX_LIGHT_NOISE), ("motor", MAX_MOTOR_NOISE)):
            value = getattr(self, key)
            if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= high:
                raise RobotError(f"must be a whole number from 0 to {high}, got {value!r}", key=f"noise.{key}")


@dataclass(frozen=True, slots=True)
class WorldSpec:
    """Everything the robot meets."""

    background: str = "Empty_Map"
    obstacles: tuple[Obstacle, ...] = ()
    walls: bool = True
    """Whether the four edges of the field echo."""
    start: Pose = Pose(100.0, 800.0, 0.0)
    noise: NoiseSpec = field(default_factory=NoiseSpec)


@dataclass(frozen=True, slots=True)
class RunSpec:
    """All that decides a run besides the program: the same spec gives the same log."""

    robot: RobotSpec
    world: WorldSpec
    profile: ProfileSpec
    seed: int = 0


def to_plain(spec: RunSpec) -> dict[str, Any]:
    """Return `spec` as dictionaries, lists, strings and numbers, ready for JSON."""
    return asdict(spec)


def from_plain(data: Mapping[str, Any]) -> RunSpec:
    """Rebuild what `to_plain` wrote.

    Raises:
        KeyError, TypeError: `data` was not written by `to_plain`.
        RobotError, ObstacleError: a value in it is impossible.
    """
    robot, world = dict(data["robot"]), dict(data["world"])
    robot["color_sensors"] = tuple(ColorSensorSpec(**sensor) for sensor in robot["color_sensors"])
    if robot["ultrasonic"] is not None:
        angles = tuple(robot["ultrasonic"]["ray_angles_deg"])
        robot["ultrasonic"] = UltrasonicSpec(**{**robot["ultrasonic"], "ray_angles_deg": angles})
    if robot["gyro"] is not None:
        robot["gyro"] = GyroSpec(**robot["gyro"])
    robot["pen"] = PenSpec(**robot["pen"])
    world["obstacles"] = tuple(Obstacle(**obstacle) for obstacle in world["obstacles"])
    world["start"] = Pose(**world["start"])
    world["noise"] = NoiseSpec(**world["noise"])
    return RunSpec(RobotSpec(**robot), WorldSpec(**world), ProfileSpec(**data["profile"]), int(data["seed"]))
