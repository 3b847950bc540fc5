"""Parts of the library that the simulated brick does not have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.core.profile import Library
from tuisim.engine.shim.unsupported.modules import (
    ON_THE_BRICK,
    Hardware,
    refused_as,
    refused_part,
)

LOGGER = Hardware(
    "the log of a motor",
    "tuisim records every motor: see the chart, or tuisim run --telemetry FILE",
)
MODEL = Hardware("the model of a motor", "angle() and speed() are exact here")
_LEGO = "use the sensors of pybricks.ev3devices, or Ev3devSensor"
_ANALOG = Hardware("an analog sensor", _LEGO)

IO_DEVICES: Mapping[str, Hardware] = {
    "AnalogSensor": _ANALOG,
    "I2CDevice": Hardware("an I2C device", _LEGO),
    "LUMPDevice": Hardware("a sensor with the protocol of LEGO's UART sensors", _LEGO),
    "UARTDevice": Hardware("an UART device", _LEGO),
}
"""Classes of `pybricks.iodevices` that can be imported but not used, by name."""

NXT_DEVICES: Mapping[str, Hardware] = {
    "AnalogSensor": _ANALOG,
    "ColorSensor": Hardware("the NXT colour sensor", "use pybricks.ev3devices.ColorSensor"),
    "EnergyMeter": Hardware(
        "the energy meter", "EV3Brick().battery has the voltage and the current of the battery"
    ),
    "LightSensor": Hardware("the NXT light sensor", "use pybricks.ev3devices.ColorSensor"),
    "SoundSensor": Hardware(
        "the NXT sound sensor",
        "the simulated world has no sound: start with a TouchSensor or a button",
    ),
    "TemperatureSensor": Hardware("the NXT temperature sensor", _LEGO),
    "TouchSensor": Hardware("the NXT touch sensor", "use pybricks.ev3devices.TouchSensor"),
    "UltrasonicSensor": Hardware(
        "the NXT ultrasonic sensor", "use pybricks.ev3devices.UltrasonicSensor"
    ),
    "VernierAdapter": Hardware("the adapter for Vernier sensors", _LEGO),
}
"""Classes of `pybricks.nxtdevices`, which can be imported but not used, by name."""

_BLUETOOTH = ON_THE_BRICK["bluetooth"].told_to(Library.PYBRICKS)
_INSIDE = Hardware("what version 1.0 has inside", "use EV3Brick(), and its parts")
MODULES: Mapping[str, Hardware] = {
    "pybricks.bluetooth": _BLUETOOTH,
    "pybricks.ev3devio": Hardware("the files of ev3dev", _LEGO),
    "pybricks.uev3dev": _INSIDE,
    **dict.fromkeys(
        (f"pybricks.uev3dev.{name}" for name in ("display", "i2c", "messaging", "sound", "util")),
        _INSIDE,
    ),
}
"""Modules that a program can import, but none of whose names it can use, by the module's name."""

VERSION_4: Mapping[str, tuple[str, ...]] = {
    "pybricks.iodevices": (*IO_DEVICES, "LWP3Device", "PUPDevice"),
    "pybricks.messaging": ("BLERadio",),
    "pybricks.tools": ("AppData",),
    "pybricks.robotics": ("Car", "SpikeBase"),
}
"""Classes of Pybricks 4 that can be imported but not used, on the EV3 and on hubs alike, by module."""
HUB_CLASSES: Mapping[str, tuple[str, ...]] = {
    "pybricks.pupdevices": (
        *("ColorDistanceSensor", "ColorLightMatrix", "DuploTrain", "InfraredSensor"),
        *("MarioHub", "PFMotor", "TechnicMoveHub", "TiltSensor"),
    ),
    **VERSION_4,
}
"""Classes of Pybricks 4 that can be imported but not used on hubs, by module; those of `VERSION_4` are among them."""


def refuse_hub(hub: str, name: str) -> NoReturn:
    """Raise the error for a name that `pybricks.hubs` does not have in this run.

    Args:
        hub: The hub of the robot; empty for the EV3.
        name: The name.

    Raises:
        NotSimulated: it is the name of another hub; the error is also an ImportError.
        AttributeError: no hub has this name.
    """
    if name in HUBS:
        raise refused_as(ImportError, *explain_hub(f"pybricks.hubs.{name}", hub))
    raise AttributeError(f"module 'pybricks.hubs' has no attribute {name!r}")


def explain_hub(name: str, hub: str = "") -> tuple[str, str]:
    """Return message and hint of the error for a name that belongs to another hub than the robot's.

    Args:
        name: The full name.
        hub: The robot's hub; empty for the EV3.
    """
    if hub:
        return (
            f"{name}: the hub of this run's robot is {hub}",
            "a program gets the first hub that it imports, unless -r names a robot",
        )
    return (
        f"{name}: the robot of this run has an EV3",
        "a program that uses no part of the EV3 gets the hub that it imports, unless -r names a robot",
    )


def refuse_all(classes: Mapping[str, Sequence[str]], instead: str) -> dict[str, dict[str, Any]]:
    """Return objects for classes that a program can import but not use, by module and then by name.

    Args:
        classes: The names of the classes, by module.
        instead: What a program can use instead.
    """
    return {
        module: refused_classes(
            module, {name: Hardware(f"the class {name}", instead) for name in names}
        )
        for module, names in classes.items()
    }


def refused_classes(module: str, classes: Mapping[str, Hardware]) -> dict[str, Any]:
    """Return objects for some classes of a module, by name; a program can import these objects, but not use them.

    Args:
        module: The module of the library.
        classes: The hardware that each class is for, by the name of the class.
    """
    return {name: refused_part(module, name, hardware) for name, hardware in classes.items()}
