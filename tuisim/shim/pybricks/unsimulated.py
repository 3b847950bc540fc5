"""Parts of the library that the simulated brick does not have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tuisim.shim.unsupported.modules import Hardware, refused_part

LOGGER = Hardware(
    "the log of a motor",
    "tuisim records every motor: see the chart, or tuisim run --telemetry FILE",
)
_LEGO = "use the sensors of pybricks.ev3devices, or Ev3devSensor"

IO_DEVICES: Mapping[str, Hardware] = {
    "AnalogSensor": Hardware("an analog sensor", _LEGO),
    "I2CDevice": Hardware("an I2C device", _LEGO),
    "LUMPDevice": Hardware("a sensor with the protocol of LEGO's UART sensors", _LEGO),
    "UARTDevice": Hardware("an UART device", _LEGO),
}
"""Classes of `pybricks.iodevices`."""

NXT_DEVICES: Mapping[str, Hardware] = {
    "ColorSensor": Hardware("the NXT colour sensor", "use pybricks.ev3devices.ColorSensor"),
    "EnergyMeter": Hardware(
        "the energy meter", "EV3Brick().battery has the voltage and the current of the battery"
    ),
    "LightSensor": Hardware("the NXT light sensor", "use pybricks.ev3devices.ColorSensor"),
    "SoundSensor": Hardware(
        "the NXT sound sensor", "it is silent here: start by a TouchSensor or a button"
    ),
    "TemperatureSensor": Hardware("the NXT temperature sensor", _LEGO),
    "TouchSensor": Hardware("the NXT touch sensor", "use pybricks.ev3devices.TouchSensor"),
    "UltrasonicSensor": Hardware(
        "the NXT ultrasonic sensor", "use pybricks.ev3devices.UltrasonicSensor"
    ),
    "VernierAdapter": Hardware("the adapter for Vernier sensors", _LEGO),
}
"""Classes of `pybricks.nxtdevices`."""


def refused_classes(module: str, classes: Mapping[str, Hardware]) -> dict[str, Any]:
    """Return the classes of a module of the library that can be imported but not used, by name."""
    return {name: refused_part(module, name, hardware) for name, hardware in classes.items()}
