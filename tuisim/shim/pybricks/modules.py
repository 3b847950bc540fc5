"""The modules of the library, by the names under which a program imports them."""

from __future__ import annotations

import sys
import types
from collections.abc import Mapping
from typing import Any

from tuisim.shim.pybricks import (
    ev3devices,
    experimental,
    hubs,
    iodevices,
    messaging,
    micropython,
    motor,
    parameters,
    robotics,
    tools,
)
from tuisim.shim.pybricks.brick import Brick, Connected
from tuisim.shim.pybricks.unsimulated import IO_DEVICES, NXT_DEVICES, refused_classes


def _public(module: types.ModuleType, *names: str) -> dict[str, Any]:
    return {name: getattr(module, name) for name in names}


MODULES: Mapping[str, Mapping[str, Any]] = {
    "pybricks": {},
    "pybricks.hubs": _public(hubs, "EV3Brick"),
    "pybricks.ev3devices": _public(motor, "Motor")
    | _public(ev3devices, "TouchSensor", "ColorSensor", "InfraredSensor", "UltrasonicSensor", "GyroSensor"),
    "pybricks.experimental": _public(experimental, "run_parallel"),
    "pybricks.iodevices": _public(motor, "DCMotor")
    | _public(iodevices, "Ev3devSensor")
    | refused_classes("pybricks.iodevices", IO_DEVICES),
    "pybricks.messaging": _public(messaging, *messaging.__all__),
    "pybricks.nxtdevices": _public(motor, "Motor") | refused_classes("pybricks.nxtdevices", NXT_DEVICES),
    "pybricks.parameters": _public(parameters, "Port", "Stop", "Direction", "Button", "Color", "Align"),
    "pybricks.robotics": _public(robotics, "DriveBase"),
    "pybricks.tools": _public(tools, "wait", "StopWatch", "DataLog") | {"print": print},
}
"""Names of each module."""


def install(brick: Brick) -> None:
    """Let a program import the library, and the modules of MicroPython."""
    micropython.install(brick.session)
    Connected.brick = brick
    made = {name: types.ModuleType(name) for name in MODULES}
    for name, module in made.items():
        vars(module).update(MODULES[name])
        parent, _, last = name.rpartition(".")
        if parent:
            setattr(made[parent], last, module)
        if any(other.startswith(f"{name}.") for other in MODULES):
            module.__path__ = []
    sys.modules.update(made)
