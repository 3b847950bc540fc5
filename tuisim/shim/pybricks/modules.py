"""The modules of the library, by the names under which a program imports them."""

from __future__ import annotations

import sys
import types
from collections.abc import Mapping
from typing import Any

from tuisim.shim.pybricks import ev3devices, font, hubs, image, media, motor, parameters, robotics, speaker, tools
from tuisim.shim.pybricks.brick import Brick, Connected


def _public(module: types.ModuleType, *names: str) -> dict[str, Any]:
    return {name: getattr(module, name) for name in names}


FILES = _public(media, "SoundFile", "ImageFile")
MODULES: Mapping[str, Mapping[str, Any]] = {
    "pybricks": {},
    "pybricks.hubs": _public(hubs, "EV3Brick"),
    "pybricks.ev3devices": _public(motor, "Motor")
    | _public(ev3devices, "TouchSensor", "ColorSensor", "InfraredSensor", "UltrasonicSensor", "GyroSensor"),
    "pybricks.parameters": _public(parameters, "Port", "Stop", "Direction", "Button", "Color", "Align") | FILES,
    "pybricks.robotics": _public(robotics, "DriveBase"),
    "pybricks.tools": _public(tools, "wait", "StopWatch", "DataLog") | {"print": print},
    "pybricks.media": {},
    "pybricks.media.ev3dev": _public(image, "Image") | _public(font, "Font") | FILES,
}
"""Names of each module."""


def install(brick: Brick) -> None:
    """Let a program import the library."""
    Connected.brick = brick
    speaker.set_volumes(brick.mixer, speaker.VOLUMES)
    made = {name: types.ModuleType(name) for name in MODULES}
    for name, module in made.items():
        vars(module).update(MODULES[name])
        parent, _, last = name.rpartition(".")
        if parent:
            setattr(made[parent], last, module)
        if any(other.startswith(f"{name}.") for other in MODULES):
            module.__path__ = []
    sys.modules.update(made)
