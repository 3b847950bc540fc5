"""The names of the libraries for a brick and their meaning: ports, devices, pairs of motors, wheels, moves.

To add a device: add its class to `DEVICES`. To add a class that drives two wheels: add it to `PAIRS`.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from enum import StrEnum

from tuisim.base.data_class import dataclass
from tuisim.engine.core.profile import Library
from tuisim.engine.core.spec import INPUT_PORTS, OUTPUT_PORTS

COURSE_MODULE = "ev3dev2_glue"


class DeviceKind(StrEnum):
    """A kind of device that a program creates on a port; the value is its usual name."""

    LARGE = "large motor"
    MEDIUM = "medium motor"
    MOTOR = "motor"
    """A motor of any kind."""
    COLOR = "colour sensor"
    ULTRASONIC = "ultrasonic sensor"
    GYRO = "gyro"
    TOUCH = "touch sensor"
    INFRARED = "infrared sensor"
    LIGHT = "light"
    SENSOR = "sensor"
    """A sensor of a kind that the program does not say."""

    @property
    def is_motor(self) -> bool:
        """Whether the device is a motor, which is connected to an output port."""
        return self in (DeviceKind.LARGE, DeviceKind.MEDIUM, DeviceKind.MOTOR)


SENSES_WALLS = frozenset({DeviceKind.ULTRASONIC, DeviceKind.INFRARED, DeviceKind.TOUCH})
"""The kinds of sensors that can sense a wall."""

DEVICES: Mapping[str, DeviceKind] = {
    "LargeMotor": DeviceKind.LARGE,
    "MediumMotor": DeviceKind.MEDIUM,
    "Motor": DeviceKind.MOTOR,
    "ColorSensor": DeviceKind.COLOR,
    "UltrasonicSensor": DeviceKind.ULTRASONIC,
    "GyroSensor": DeviceKind.GYRO,
    "TouchSensor": DeviceKind.TOUCH,
    "InfraredSensor": DeviceKind.INFRARED,
    "ForceSensor": DeviceKind.TOUCH,
    "Light": DeviceKind.LIGHT,
    "Sensor": DeviceKind.SENSOR,
    "RemoteControl": DeviceKind.INFRARED,
    "BeaconSeeker": DeviceKind.INFRARED,
    "DCMotor": DeviceKind.MOTOR,
    "Ev3devSensor": DeviceKind.SENSOR,
}
"""The classes of devices that are simulated, in all libraries."""

OTHER_HARDWARE = frozenset({"pybricks.nxtdevices"})
"""Modules whose classes are for other hardware, also where they have the same names."""

PORT_NAMES = ("address", "port")
"""The names of the first argument of classes of devices."""
DIRECTION = "positive_direction"
GEARS = "gears"
"""Arguments of the motors of Pybricks, after the port."""

WITHOUT_PORT = frozenset({"RemoteControl", "BeaconSeeker"})
"""Classes of devices whose first argument is no port."""

MOTOR_SET = "MotorSet"


@dataclass(frozen=True, slots=True)
class PairClass:
    """A class of a library whose first two arguments are a left and a right motor, or their ports."""

    left: str
    right: str
    """Names of the two arguments."""
    rank: int = 1
    """Of several pairs in a program, the one with the highest rank is the wheels."""
    kind: DeviceKind = DeviceKind.LARGE
    """Kind of its motors, unless the argument `motor_class` says otherwise."""
    needs: tuple[DeviceKind, ...] = ()
    """Further devices that it makes, without a port."""
    usual: tuple[str, str] = ("", "")
    """The ports where the arguments are missing."""
    reverses: bool = False
    """Whether it inverts the polarity of its motors by default."""
    takes_motors: bool = False
    """Whether it is made with motors."""


_PORTS = ("left_motor_port", "right_motor_port")
_HELPER = ("left_motor", "right_motor")
PAIRS: Mapping[str, PairClass] = {
    "MoveDifferential": PairClass(*_PORTS, rank=3),
    "MoveTank": PairClass(*_PORTS, rank=2),
    "MoveSteering": PairClass(*_PORTS, rank=2),
    "MoveJoystick": PairClass(*_PORTS, rank=2),
    "WebControlledTank": PairClass(*_HELPER, rank=2),
    "RemoteControlledTank": PairClass(*_PORTS, rank=2, needs=(DeviceKind.INFRARED,), reverses=True),
    "GyroBalancer": PairClass(
        *_PORTS, needs=(DeviceKind.GYRO, DeviceKind.TOUCH), usual=("outD", "outA")
    ),
    "DriveBase": PairClass(*_HELPER, rank=3, takes_motors=True),
    "GyroDriveBase": PairClass(*_HELPER, rank=3, takes_motors=True),
    "Tank": PairClass(*_HELPER, rank=2),
    "LargeMotorPair": PairClass(*_HELPER),
    "MotorPair": PairClass(*_HELPER),
    "MediumMotorPair": PairClass(*_HELPER, rank=0, kind=DeviceKind.MEDIUM),
}
"""The classes that drive two motors together."""

WHEEL_CLASS = "wheel_class"
DISTANCE = "wheel_distance_mm"
"""Arguments of `MoveDifferential`, after the ports."""
WHEEL_DIAMETER = "wheel_diameter"
AXLE_TRACK = "axle_track"
"""Arguments of `DriveBase`, after the motors."""
POLARITY = "polarity"
"""Argument of a class that turns the polarity of its motors, after the ports."""
MOTOR_CLASS = "motor_class"
MOTOR_CLASS_INDEX: Mapping[str, int] = {
    "MoveTank": 3,
    "MoveSteering": 3,
    "MoveJoystick": 3,
    "MoveDifferential": 5,
    "WebControlledTank": 4,
}
"""Where the argument `motor_class` stands."""

WHEEL = "Wheel"
WHEELS: Mapping[str, tuple[float, float]] = {
    "EV3Rim": (30.0, 20.0),
    "EV3Tire": (43.2, 21.0),
    "EV3EducationSetRim": (43.0, 26.0),
    "EV3EducationSetTire": (56.0, 28.0),
}
"""Diameter and width in mm of the wheels of `ev3dev2.wheel`."""

CONSTANTS: Mapping[str, str] = {
    **{f"OUTPUT_{port[-1]}": port for port in OUTPUT_PORTS},
    **{f"INPUT_{port[-1]}": port for port in INPUT_PORTS},
    "POLARITY_NORMAL": "normal",
    "POLARITY_INVERSED": "inversed",
    "STATE_STALLED": "stalled",
}
"""Names of the library with the value that matters here."""

INVERSED = CONSTANTS["POLARITY_INVERSED"]
NORMAL = CONSTANTS["POLARITY_NORMAL"]

MEMBERS: Mapping[str, Mapping[str, str]] = {
    "Port": {
        **{
            (port[-1] if port.startswith("out") else f"S{port[-1]}"): port
            for port in (*OUTPUT_PORTS, *INPUT_PORTS)
        },
        "E": "outE",
        "F": "outF",
    },
    "Direction": {"CLOCKWISE": NORMAL, "COUNTERCLOCKWISE": INVERSED},
}
"""The enumerations of Pybricks that matter here, with the value of each member."""

CLASSES = frozenset({*DEVICES, *PAIRS, *WHEELS, *MEMBERS, MOTOR_SET, WHEEL})
"""Every class of the libraries that says something about the robot."""


@dataclass(frozen=True, slots=True)
class Moves:
    """A library's methods that move one or two motors, with the names of their arguments."""

    endless: frozenset[str]
    """Methods after which a motor keeps moving."""
    ending: frozenset[str]
    """Methods that end by themselves."""
    unsigned: frozenset[str]
    """Those of `ending` whose arguments do not say in which direction a motor turns: moves to a place, and turns."""
    speeds: tuple[str, ...]
    """The names of speeds."""
    lengths: tuple[str, ...]
    """The names of lengths and of places."""
    length_at: Mapping[str, int]
    """Where a length or a place stands in a call of a motor; for two motors one place later."""
    of_both: frozenset[str] = frozenset()
    """Methods with one speed or length for two motors."""
    stalling: frozenset[str] = frozenset()
    """Methods that end when something stops the motor."""


MOVES: Mapping[Library, Moves] = {
    Library.EV3DEV2: Moves(
        endless=frozenset({"on", "run_forever", "run_direct"}),
        ending=frozenset(
            {
                "on_for_degrees",
                "on_for_rotations",
                "on_for_seconds",
                "on_to_position",
                "run_to_rel_pos",
                "run_to_abs_pos",
                "run_timed",
            }
        ),
        unsigned=frozenset({"on_to_position", "run_to_abs_pos"}),
        speeds=("speed", "speed_sp", "duty_cycle_sp"),
        lengths=("degrees", "position", "position_sp", "rotations"),
        length_at=dict.fromkeys(("on_for_degrees", "on_for_rotations", "on_to_position"), 1),
    ),
    Library.PYBRICKS: Moves(
        endless=frozenset({"run", "dc", "drive"}),
        ending=frozenset(
            {
                "run_time",
                "run_angle",
                "run_target",
                "track_target",
                "straight",
                "turn",
                "drive_time",
            }
        ),
        unsigned=frozenset({"run_target", "track_target", "turn"}),
        speeds=("speed", "duty", "drive_speed", "distance"),
        lengths=("rotation_angle", "target_angle"),
        length_at={"run_angle": 1, "run_target": 1, "track_target": 0},
        of_both=frozenset({"drive", "straight", "drive_time"}),
        stalling=frozenset({"run_until_stalled"}),
    ),
}
"""The moves of each library."""

_DRIVERS: Mapping[str, DeviceKind] = {
    "lego-ev3-l-motor": DeviceKind.LARGE,
    "lego-ev3-m-motor": DeviceKind.MEDIUM,
    "lego-ev3-color": DeviceKind.COLOR,
    "lego-ev3-us": DeviceKind.ULTRASONIC,
    "lego-ev3-gyro": DeviceKind.GYRO,
    "lego-ev3-touch": DeviceKind.TOUCH,
    "lego-ev3-ir": DeviceKind.INFRARED,
}
_MODES: Mapping[str, DeviceKind] = {
    "COL-": DeviceKind.COLOR,
    "REF-RAW": DeviceKind.COLOR,
    "RGB-RAW": DeviceKind.COLOR,
    "US-": DeviceKind.ULTRASONIC,
    "GYRO-": DeviceKind.GYRO,
    "TILT-": DeviceKind.GYRO,
    "TOUCH": DeviceKind.TOUCH,
    "IR-": DeviceKind.INFRARED,
}
_PORT = re.compile(r"(?:ev3-ports:)?(out[A-F]|in[1-4])")


def parse_port(text: object) -> str:
    """Return the short name of a port, such as `outA`, from the text that a program gives; empty for other texts."""
    match = _PORT.fullmatch(text.strip()) if isinstance(text, str) else None
    return match[1] if match else ""


def find_driver_kind(text: object) -> DeviceKind | None:
    """Return the kind of device for a driver's name in ev3dev, such as `lego-ev3-us`; None if it is not simulated."""
    return _DRIVERS.get(text) if isinstance(text, str) else None


def find_mode_kind(text: object) -> DeviceKind | None:
    """Return the kind of sensor that has a mode such as `US-DIST-CM`; None if the mode is unknown."""
    if not isinstance(text, str):
        return None
    return next((kind for prefix, kind in _MODES.items() if text.startswith(prefix)), None)


def list_names(node: ast.AST) -> tuple[str, ...]:
    """Return the names and texts in an expression that may say what a device is for, without names of ports."""
    names = []
    for inner in ast.walk(node):
        match inner:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.Constant(value=str(name)):
                if name not in CONSTANTS and not parse_port(name):
                    names.append(name)
    return tuple(names)
