"""What the names of the libraries `ev3dev2` and `ev3dev` stand for: ports, devices, pairs of motors, wheels.

To add a device: add its class to `DEVICES`. To add a class that drives two wheels: add it to `PAIRS`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from tuisim.core.spec import INPUT_PORTS, OUTPUT_PORTS

COURSE_MODULE = "ev3dev2_glue"


class DeviceKind(StrEnum):
    """What a program asks for on a port; the value is what people call it."""

    LARGE = "large motor"
    MEDIUM = "medium motor"
    MOTOR = "motor"
    """Of any kind."""
    COLOR = "colour sensor"
    ULTRASONIC = "ultrasonic sensor"
    GYRO = "gyro"
    TOUCH = "touch sensor"
    INFRARED = "infrared sensor"
    SENSOR = "sensor"
    """Of a kind that the program does not say."""

    @property
    def is_motor(self) -> bool:
        """Whether it belongs on an output port."""
        return self in (DeviceKind.LARGE, DeviceKind.MEDIUM, DeviceKind.MOTOR)


DEVICES: Mapping[str, DeviceKind] = {
    "LargeMotor": DeviceKind.LARGE,
    "MediumMotor": DeviceKind.MEDIUM,
    "Motor": DeviceKind.MOTOR,
    "ColorSensor": DeviceKind.COLOR,
    "UltrasonicSensor": DeviceKind.ULTRASONIC,
    "GyroSensor": DeviceKind.GYRO,
    "TouchSensor": DeviceKind.TOUCH,
    "InfraredSensor": DeviceKind.INFRARED,
    "Sensor": DeviceKind.SENSOR,
    "RemoteControl": DeviceKind.INFRARED,
    "BeaconSeeker": DeviceKind.INFRARED,
}
"""The classes of devices that are simulated, in both libraries."""

WITHOUT_PORT = frozenset({"RemoteControl", "BeaconSeeker"})
"""Classes of devices whose first argument is no port."""

MOTOR_SET = "MotorSet"


@dataclass(frozen=True, slots=True)
class PairClass:
    """A class that is made with the ports of a left and a right motor, as its first two arguments."""

    left: str
    right: str
    """Names of the two arguments."""
    rank: int = 1
    """Of several pairs in a program, the one with the highest rank is the wheels."""
    kind: DeviceKind = DeviceKind.LARGE
    """Of its motors, unless the argument `motor_class` says otherwise."""
    needs: tuple[DeviceKind, ...] = ()
    """What else it makes, without a port."""
    usual: tuple[str, str] = ("", "")
    """The ports where the arguments are missing."""
    reverses: bool = False
    """Whether it turns the polarity of its motors unless it is told not to."""


_PORTS = ("left_motor_port", "right_motor_port")
_HELPER = ("left_motor", "right_motor")
PAIRS: Mapping[str, PairClass] = {
    "MoveDifferential": PairClass(*_PORTS, rank=3),
    "MoveTank": PairClass(*_PORTS, rank=2),
    "MoveSteering": PairClass(*_PORTS, rank=2),
    "MoveJoystick": PairClass(*_PORTS, rank=2),
    "WebControlledTank": PairClass(*_HELPER, rank=2),
    "RemoteControlledTank": PairClass(*_PORTS, rank=2, needs=(DeviceKind.INFRARED,), reverses=True),
    "GyroBalancer": PairClass(*_PORTS, needs=(DeviceKind.GYRO, DeviceKind.TOUCH), usual=("outD", "outA")),
    "Tank": PairClass(*_HELPER, rank=2),
    "LargeMotorPair": PairClass(*_HELPER),
    "MotorPair": PairClass(*_HELPER),
    "MediumMotorPair": PairClass(*_HELPER, rank=0, kind=DeviceKind.MEDIUM),
}
"""The classes that drive two motors together."""

WHEEL_CLASS, DISTANCE = "wheel_class", "wheel_distance_mm"
"""Arguments of `MoveDifferential`, after the ports."""
POLARITY = "polarity"
"""Argument of a class that turns the polarity of its motors, after the ports."""
MOTOR_CLASS = "motor_class"
MOTOR_CLASS_AT: Mapping[str, int] = {
    "MoveTank": 3, "MoveSteering": 3, "MoveJoystick": 3, "MoveDifferential": 5, "WebControlledTank": 4,
}  # fmt: skip
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

CLASSES = frozenset({*DEVICES, *PAIRS, *WHEELS, MOTOR_SET, WHEEL})
"""Every class of the libraries that says something about the robot."""

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
_PORT = re.compile(r"(?:ev3-ports:)?(out[A-D]|in[1-4])")


def port_of(text: object) -> str:
    """Return the short name of a port, such as `outA`, from the text that a program gives; empty for other texts."""
    match = _PORT.fullmatch(text.strip()) if isinstance(text, str) else None
    return match[1] if match else ""


def kind_of_driver(text: object) -> DeviceKind | None:
    """Return the kind of device that a driver is for; None if it is not simulated."""
    return _DRIVERS.get(text) if isinstance(text, str) else None


def kind_of_mode(text: object) -> DeviceKind | None:
    """Return the kind of sensor that has a mode."""
    if not isinstance(text, str):
        return None
    return next((kind for prefix, kind in _MODES.items() if text.startswith(prefix)), None)
