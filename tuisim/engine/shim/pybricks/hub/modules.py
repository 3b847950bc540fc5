"""The names of the library's modules on a hub, in place of those of the EV3."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tuisim.engine.core.hub_spec import HUBS_WITH_MATRIX
from tuisim.engine.shim.pybricks import matrix, tools, version_4
from tuisim.engine.shim.pybricks import parameters as common
from tuisim.engine.shim.pybricks.hub import controllers, display, hubs, parameters, pupdevices
from tuisim.engine.shim.pybricks.unsimulated import VERSION_4, refuse_all

_NO_DEVICE = "use Motor, ColorSensor, UltrasonicSensor and ForceSensor"
REFUSED: Mapping[str, tuple[str, ...]] = {
    "pybricks.pupdevices": (
        *("ColorDistanceSensor", "ColorLightMatrix", "DuploTrain", "InfraredSensor", "Light"),
        *("MarioHub", "PFMotor", "TechnicMoveHub", "TiltSensor"),
    ),
    **VERSION_4,
}
"""Classes that can be imported but not used, by module."""


def find_names(hub: str) -> Mapping[str, Mapping[str, Any]]:
    """Return the names in each module of the library for a hub, which is one of `engine.core.spec.HUBS`."""
    hub_class = hubs.CLASSES[hub]
    own = {name: known for name, known in hubs.CLASSES.items() if known is hub_class}
    names: dict[str, dict[str, Any]] = {
        "pybricks": {"version": (hub.lower(), "4.0.0", "tuisim")},
        "pybricks.hubs": {**own, "ThisHub": hub_class},
        "pybricks.pupdevices": {
            "Motor": version_4.Motor,
            "DCMotor": version_4.Motor,
            "ColorSensor": pupdevices.ColorSensor,
            "UltrasonicSensor": pupdevices.UltrasonicSensor,
            "ForceSensor": pupdevices.ForceSensor,
            "Remote": controllers.Remote,
        },
        "pybricks.iodevices": {"XboxController": controllers.XboxController},
        "pybricks.parameters": {
            "Port": parameters.Port,
            "Button": parameters.Button,
            "Direction": common.Direction,
            "Stop": version_4.Stop,
            "Color": version_4.Color,
            "Axis": matrix.Axis,
            "Side": matrix.Side,
        },
        "pybricks.robotics": {
            "DriveBase": version_4.DriveBase,
            "GyroDriveBase": version_4.GyroDriveBase,
        },
        "pybricks.tools": {
            "wait": tools.wait,
            "StopWatch": version_4.StopWatch,
            "read_input_byte": version_4.read_input_byte,
            "Axis": matrix.Axis,
            "Matrix": matrix.Matrix,
            "vector": matrix.vector,
            "cross": matrix.cross,
            "run_task": version_4.run_task,
            "multitask": version_4.multitask,
        },
    }
    if hub in HUBS_WITH_MATRIX:
        names["pybricks.parameters"]["Icon"] = display.Icon
        names["pybricks.tools"]["hub_menu"] = display.hub_menu
    for module, classes in refuse_all(REFUSED, _NO_DEVICE).items():
        names.setdefault(module, {}).update(classes)
    return names
