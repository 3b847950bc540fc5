"""Sensors, motors and addresses that no robot here can have, and what a program can use instead."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

from tuisim.core.sensors import SENSORS
from tuisim.errors import NotSimulated, shortened
from tuisim.shim.motor import KINDS

SIMULATED = frozenset({kind.driver_name for kind in SENSORS.values()} | {kind.driver_name for kind in KINDS.values()})
"""Drivers of the devices that a robot can have."""


@dataclass(frozen=True, slots=True)
class Unsimulated:
    """A kind of device that no robot here can have."""

    title: str
    instead: str
    """What a program can do instead."""


_LIGHT = "use a ColorSensor: it measures reflected and ambient light"
_DISTANCE = "use an UltrasonicSensor or an InfraredSensor"
_TURN = "use a GyroSensor"
_MUX = "plug each sensor directly into one of the brick's four inputs"
_SEE = "use a ColorSensor for colours, and an UltrasonicSensor for distances"
_MOTOR = "use a LargeMotor or a MediumMotor"
_ALONE = "the simulated sensors are those of ev3dev2.sensor.lego for colour, distance, turning, touch and infrared"

DRIVERS: Mapping[str, Unsimulated] = {
    "lego-nxt-light": Unsimulated("the NXT light sensor", _LIGHT),
    "lego-nxt-sound": Unsimulated("the NXT sound sensor", "it is silent here: start by a TouchSensor or a Button"),
    "lego-nxt-touch": Unsimulated("the NXT touch sensor", "use the one of the EV3, lego-ev3-touch"),
    "lego-nxt-us": Unsimulated("the NXT ultrasonic sensor", "use the one of the EV3, lego-ev3-us"),
    "lego-nxt-motor": Unsimulated("the NXT motor", "use a LargeMotor, lego-ev3-l-motor"),
    "lego-nxt-*": Unsimulated("an NXT sensor", _ALONE),
    "lego-power-storage": Unsimulated("the energy meter", "PowerSupply has the voltage and the current of the battery"),
    "ht-nxt-smux": Unsimulated("the HiTechnic multiplexer", _MUX),
    "ht-nxt-color*": Unsimulated("the HiTechnic colour sensor", _LIGHT),
    "ht-nxt-eopd": Unsimulated("the HiTechnic EOPD", _LIGHT),
    "ht-nxt-ir-*": Unsimulated("the HiTechnic infrared sensor", "use an InfraredSensor"),
    "ht-nxt-pir": Unsimulated("the HiTechnic PIR sensor", _DISTANCE),
    "ht-nxt-compass": Unsimulated("the HiTechnic compass", _TURN),
    "ht-nxt-gyro": Unsimulated("the HiTechnic gyro", _TURN),
    "ht-nxt-angle": Unsimulated("the HiTechnic angle sensor", "a motor has its own: position"),
    "ht-*": Unsimulated("a HiTechnic sensor", _ALONE),
    "mi-*": Unsimulated("the Microinfinity gyro", _TURN),
    "ms-*mux": Unsimulated("a mindsensors multiplexer", _MUX),
    "ms-8ch-servo": Unsimulated("the mindsensors servo controller", _MOTOR),
    "ms-nxtmmx": Unsimulated("the mindsensors motor multiplexer", "a robot has up to four motors, outA to outD"),
    "ms-light-array": Unsimulated("the mindsensors light array", "use ColorSensors: a robot can have four"),
    "ms-line-leader": Unsimulated("the mindsensors line leader", "use ColorSensors: a robot can have four"),
    "ms-absolute-imu": Unsimulated("the mindsensors IMU", _TURN),
    "ms-nxtcam*": Unsimulated("the mindsensors camera", _SEE),
    "ms-pixy-adapter": Unsimulated("the Pixy camera", _SEE),
    "ms-*": Unsimulated("a mindsensors sensor", _ALONE),
    "pixy-*": Unsimulated("the Pixy camera", _SEE),
    "fcl-*": Unsimulated("a FatcatLab sensor", _ALONE),
    "di-*": Unsimulated("a sensor of Dexter Industries", _ALONE),
    "wedo-*": Unsimulated("the WeDo hub with its sensors", _ALONE),
    "nxt-analog": Unsimulated("an analog sensor", _ALONE),
    "nxt-i2c-*": Unsimulated("an I2C sensor", _ALONE),
    "ev3-analog-*": Unsimulated("an analog sensor", _ALONE),
    "ev3-uart-*": Unsimulated("an UART sensor", _ALONE),
    "act-l12-*": Unsimulated("a linear motor of Actuonix", _MOTOR),
    "fi-l12-*": Unsimulated("a linear motor of Firgelli", _MOTOR),
    "rcx-motor": Unsimulated("a motor without a rotation sensor", _MOTOR),
    "rcx-led": Unsimulated("a lamp on a motor port", "use Leds, the lights of the brick"),
}
"""Kinds of devices, by patterns of driver names; the first that matches tells."""

_OTHER = Unsimulated("a device that tuisim does not know", f"the simulated drivers are {', '.join(sorted(SIMULATED))}")

CLASSES: Mapping[str, Unsimulated] = {
    "dc-motor": Unsimulated("a motor without a rotation sensor", _MOTOR),
    "servo-motor": Unsimulated("a servo motor", "use a MediumMotor: on_to_position() turns it to an angle"),
}
"""Classes of devices without any that a robot can have, by their kernel names."""

PORT_MODES: Mapping[str, Unsimulated] = {"dc-motor": DRIVERS["rcx-motor"], "led": DRIVERS["rcx-led"]}
"""Port modes that are for a single kind of device."""

_PORT = re.compile(r"(?:ev3-ports:)?(?:in[1-4]|out[A-D]):.")
"""The beginning of an address behind a port, such as `ev3-ports:in1:i2c80:mux1`."""
ADDRESSES: Mapping[str, Unsimulated] = {
    "mux": Unsimulated("a sensor multiplexer", _MUX),
    "i2c": Unsimulated("an I2C sensor", _ALONE),
    "": Unsimulated("a device behind a multiplexer", _MUX),
}
"""What is behind a port, by a part of the address."""
_BOARDS = ("spi0.1:", "serial0-0:", "ttyAMA0:", "pistorms:")
_BOARD = Unsimulated("a port of a BrickPi or PiStorms", "this is an EV3: use OUTPUT_A to OUTPUT_D, INPUT_1 to INPUT_4")

FOREIGN_MODES: Mapping[str, str] = {
    **dict.fromkeys(("ALL", *(f"SIG{n}" for n in range(1, 8))), "pixy-lego"),
    **dict.fromkeys(("AC", "AC-ALL", "DC", "DC-ALL"), "ht-nxt-ir-seek-v2"),
    **dict.fromkeys(("REFLECT", "AMBIENT"), "lego-nxt-light"),
    **dict.fromkeys(("DB", "DBA"), "lego-nxt-sound"),
    **dict.fromkeys(("CAL", "UNCAL"), "ms-light-array"),
    "COMPASS": "ht-nxt-compass",
    "PID": "ms-line-leader",
}
"""Modes of sensors that are not simulated, by the driver that is best known for the mode."""


def of_driver(name: str) -> Unsimulated | None:
    """Return the kind of a driver; None if it is simulated, which part of a name suffices for, as in the library."""
    if any(name in simulated for simulated in SIMULATED):
        return None
    return next((kind for pattern, kind in DRIVERS.items() if fnmatchcase(name, pattern)), _OTHER)


def refusal(where: str, kind: Unsimulated, name: str = "") -> NotSimulated:
    """Return the error about the use of a kind.

    Args:
        where: What the program used.
        kind: What it asks for.
        name: Its driver, address or mode, as the program wrote it.
    """
    called = f" ({shortened(name, 80)})" if name else ""
    return NotSimulated(f"{where}: {kind.title}{called} is not simulated", kind.instead)


def foreign_mode(mode: str, port: str, plugged: str) -> NotSimulated | None:
    """Return the error for a mode that the sensor on a port does not have; None if it is known from no other one."""
    driver = FOREIGN_MODES.get(mode, "")
    kind = of_driver(driver)
    return None if kind is None else refusal(f"mode {mode} on {port}, where {plugged} is", kind, driver)


def refused_device(device: Any, class_name: str, missing: type[Exception]) -> Exception | None:
    """Return the error for a device that was looked for in vain; None if another robot could have it.

    Args:
        device: Object of the library; its `kwargs` say what it was to match.
        class_name: Kernel name of the class that was searched.
        missing: The library's error for a device that is not connected, which the error is, too: a program may try
            what there is.
    """
    wanted: Mapping[str, object] = device.kwargs
    found = _refused(class_name, _texts(wanted.get("driver_name")), _texts(wanted.get("address")))
    if found is None:
        return None
    told = refusal(_named(type(device)), *found)
    both: Any = type("NotSimulated", (NotSimulated, missing), {"__module__": NotSimulated.__module__})
    error: Exception = both(told.message, told.hint)
    return error


def _refused(class_name: str, drivers: list[str], addresses: list[str]) -> tuple[Unsimulated, str] | None:
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
    """Return the texts that an attribute may match; none of what is no text."""
    return [one for one in (value if isinstance(value, list | tuple) else [value]) if isinstance(one, str)]


def _named(kind: type) -> str:
    """Return the library's name of a class: a program's own is derived from one of them."""
    for one in kind.__mro__:
        if one.__module__.partition(".")[0] in ("ev3dev", "ev3dev2"):
            return f"{one.__module__}.{one.__qualname__}"
    return kind.__qualname__


def other_sensors_note(device: Any, class_name: str) -> str:
    """Return what to add to the error about a sensor of no particular kind that is not there; otherwise empty."""
    if class_name != "lego-sensor" or "driver_name" in device.kwargs:
        return ""
    return "If it is none of the sensors of ev3dev2.sensor.lego, it is not simulated."
