"""Sensors, motors and addresses that no robot here can have, and what a program can use instead."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Any

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.sensors import SENSORS
from tuisim.engine.shim.motor import KINDS
from tuisim.engine.shim.unsupported.modules import CAMERA, Hardware, refused_as

SIMULATED = frozenset(
    {kind.driver_name for kind in SENSORS.values()} | {kind.driver_name for kind in KINDS.values()}
)
"""Names of the drivers of all sensors and motors that a simulated robot can have."""


_LIGHT = "use a ColorSensor: it measures reflected and ambient light"
_DISTANCE = "use an UltrasonicSensor or an InfraredSensor"
_TURN = "use a GyroSensor"
_MUX = "plug each sensor directly into one of the brick's four inputs"
_MOTOR = "use a LargeMotor or a MediumMotor"
_ALONE = "the simulated sensors are those of ev3dev2.sensor.lego for colour, distance, turning, touch and infrared"

DRIVERS: Mapping[str, Hardware] = {
    "lego-nxt-light": Hardware("the NXT light sensor", _LIGHT),
    "lego-nxt-sound": Hardware(
        "the NXT sound sensor",
        "the simulated world has no sound: start with a TouchSensor or a Button",
    ),
    "lego-nxt-touch": Hardware("the NXT touch sensor", "use the one of the EV3, lego-ev3-touch"),
    "lego-nxt-us": Hardware("the NXT ultrasonic sensor", "use the one of the EV3, lego-ev3-us"),
    "lego-nxt-motor": Hardware("the NXT motor", "use a LargeMotor, lego-ev3-l-motor"),
    "lego-nxt-*": Hardware("an NXT sensor", _ALONE),
    "lego-power-storage": Hardware(
        "the energy meter", "PowerSupply has the voltage and the current of the battery"
    ),
    "ht-nxt-smux": Hardware("the HiTechnic multiplexer", _MUX),
    "ht-nxt-color*": Hardware("the HiTechnic colour sensor", _LIGHT),
    "ht-nxt-eopd": Hardware("the HiTechnic EOPD", _LIGHT),
    "ht-nxt-ir-*": Hardware("the HiTechnic infrared sensor", "use an InfraredSensor"),
    "ht-nxt-pir": Hardware("the HiTechnic PIR sensor", _DISTANCE),
    "ht-nxt-compass": Hardware("the HiTechnic compass", _TURN),
    "ht-nxt-gyro": Hardware("the HiTechnic gyro", _TURN),
    "ht-nxt-angle": Hardware("the HiTechnic angle sensor", "a motor has its own: position"),
    "ht-*": Hardware("a HiTechnic sensor", _ALONE),
    "mi-*": Hardware("the Microinfinity gyro", _TURN),
    "ms-*mux": Hardware("a mindsensors multiplexer", _MUX),
    "ms-8ch-servo": Hardware("the mindsensors servo controller", _MOTOR),
    "ms-nxtmmx": Hardware(
        "the mindsensors motor multiplexer", "a robot has up to four motors, outA to outD"
    ),
    "ms-light-array": Hardware(
        "the mindsensors light array", "use ColorSensors: a robot can have four"
    ),
    "ms-line-leader": Hardware(
        "the mindsensors line leader", "use ColorSensors: a robot can have four"
    ),
    "ms-absolute-imu": Hardware("the mindsensors IMU", _TURN),
    "ms-nxtcam*": Hardware("the mindsensors camera", CAMERA),
    "ms-pixy-adapter": Hardware("the Pixy camera", CAMERA),
    "ms-*": Hardware("a mindsensors sensor", _ALONE),
    "pixy-*": Hardware("the Pixy camera", CAMERA),
    "fcl-*": Hardware("a FatcatLab sensor", _ALONE),
    "di-*": Hardware("a sensor of Dexter Industries", _ALONE),
    "wedo-*": Hardware("the WeDo hub with its sensors", _ALONE),
    "nxt-analog": Hardware("an analog sensor", _ALONE),
    "nxt-i2c-*": Hardware("an I2C sensor", _ALONE),
    "ev3-analog-*": Hardware("an analog sensor", _ALONE),
    "ev3-uart-*": Hardware("an UART sensor", _ALONE),
    "act-l12-*": Hardware("a linear motor of Actuonix", _MOTOR),
    "fi-l12-*": Hardware("a linear motor of Firgelli", _MOTOR),
    "rcx-motor": Hardware("a motor without a rotation sensor", _MOTOR),
    "rcx-led": Hardware("a lamp on a motor port", "use Leds, the lights of the brick"),
}
"""The hardware that is not simulated, by patterns of the driver's name; the first pattern that matches counts."""

_OTHER = Hardware(
    "a device that tuisim does not know",
    f"the simulated drivers are {', '.join(sorted(SIMULATED))}",
)

CLASSES: Mapping[str, Hardware] = {
    "dc-motor": Hardware("a motor without a rotation sensor", _MOTOR),
    "servo-motor": Hardware(
        "a servo motor", "use a MediumMotor: on_to_position() turns it to an angle"
    ),
}
"""The hardware that is not simulated for the kernel's classes that no simulated robot has, by the class's name."""

PORT_MODES: Mapping[str, Hardware] = {"dc-motor": DRIVERS["rcx-motor"], "led": DRIVERS["rcx-led"]}
"""The hardware that is not simulated for the modes of a port that serve only one kind of device, by mode."""

_PORT = re.compile(r"(?:ev3-ports:)?(?:in[1-4]|out[A-D]):.")
"""Matches the beginning of the address of a device that is connected through other hardware on a port, such as
`ev3-ports:in1:i2c80:mux1`.
"""
ADDRESSES: Mapping[str, Hardware] = {
    "mux": Hardware("a sensor multiplexer", _MUX),
    "i2c": Hardware("an I2C sensor", _ALONE),
    "": Hardware("a device behind a multiplexer", _MUX),
}
"""The hardware that is not simulated for an address that `_PORT` matches, by a part of the address; the first part
found counts.
"""
_BOARDS = ("spi0.1:", "serial0-0:", "ttyAMA0:", "pistorms:")
_BOARD = Hardware(
    "a port of a BrickPi or PiStorms",
    "the simulated brick is an EV3: use OUTPUT_A to OUTPUT_D, INPUT_1 to INPUT_4",
)

FOREIGN_MODES: Mapping[str, str] = {
    **dict.fromkeys(("ALL", *(f"SIG{n}" for n in range(1, 8))), "pixy-lego"),
    **dict.fromkeys(("AC", "AC-ALL", "DC", "DC-ALL"), "ht-nxt-ir-seek-v2"),
    **dict.fromkeys(("REFLECT", "AMBIENT"), "lego-nxt-light"),
    **dict.fromkeys(("DB", "DBA"), "lego-nxt-sound"),
    **dict.fromkeys(("CAL", "UNCAL"), "ms-light-array"),
    "COMPASS": "ht-nxt-compass",
    "PID": "ms-line-leader",
}
"""For each mode that only sensors have which are not simulated, the driver that is best known for it."""


def of_driver(name: str) -> Hardware | None:
    """Return the hardware that an ev3dev driver is for; None if the driver is simulated.

    As in the library, `name` may also be only a part of the name of a simulated driver.
    """
    if any(name in simulated for simulated in SIMULATED):
        return None
    return next((kind for pattern, kind in DRIVERS.items() if fnmatchcase(name, pattern)), _OTHER)


def foreign_mode(mode: str, port: str, plugged: str) -> NotSimulated | None:
    """Return the error for a mode of a sensor that is not simulated, such as a compass; None for any other mode.

    Args:
        mode: The mode, which the sensor on the port does not have.
        port: The port.
        plugged: The driver of the sensor on the port.
    """
    driver = FOREIGN_MODES.get(mode, "")
    kind = of_driver(driver)
    return (
        None
        if kind is None
        else NotSimulated(*kind.explain(f"mode {mode} on {port}, where {plugged} is", driver))
    )


def refused_device(device: Any, class_name: str, missing: type[Exception]) -> Exception | None:
    """Return the error for a missing device that is not simulated; None if another simulated robot could have it.

    Args:
        device: Object of the library; its `kwargs` are the values that the device must have.
        class_name: Kernel name of the class that was searched.
        missing: The library's error for a device that is not connected. The returned error is also of this class,
            because a program may catch it to find out which devices there are.
    """
    wanted: Mapping[str, object] = device.kwargs
    found = _refused(class_name, _texts(wanted.get("driver_name")), _texts(wanted.get("address")))
    if found is None:
        return None
    kind, name = found
    return refused_as(missing, *kind.explain(_named(type(device)), name))


def _refused(
    class_name: str, drivers: list[str], addresses: list[str]
) -> tuple[Hardware, str] | None:
    if class_name in CLASSES:
        return CLASSES[class_name], class_name
    kinds = [of_driver(name) for name in drivers]
    if kinds and kinds[0] is not None and None not in kinds:
        return kinds[0], drivers[0]
    for address in addresses:
        if address.startswith(_BOARDS):
            return _BOARD, address
        if _PORT.match(address):
            return next(kind for part, kind in ADDRESSES.items() if part in address), address
    return None


def _texts(value: object) -> list[str]:
    """Return the texts in a value as a list: the value itself if it is a text, or the texts in a list or tuple."""
    return [
        one
        for one in (value if isinstance(value, list | tuple) else [value])
        if isinstance(one, str)
    ]


def _named(kind: type) -> str:
    """Return the full name of a class of the library; for a program's own class, that of its base class."""
    for one in kind.__mro__:
        if one.__module__.partition(".")[0] in ("ev3dev", "ev3dev2"):
            return f"{one.__module__}.{one.__qualname__}"
    return kind.__qualname__


def other_sensors_note(device: Any, class_name: str) -> str:
    """Return a note for the error about a missing sensor, which says which sensors are simulated.

    The note is empty if the program has named the sensor's driver, and for devices that are not sensors.
    """
    if class_name != "lego-sensor" or "driver_name" in device.kwargs:
        return ""
    return "If it is none of the sensors of ev3dev2.sensor.lego, it is not simulated."
