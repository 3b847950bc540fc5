"""Finds the name that was meant by a name that does not exist: a similar one, or one that is not imported."""

from __future__ import annotations

import types
from collections.abc import Mapping, Sequence, Set
from contextlib import suppress
from functools import cache
from importlib import import_module

from tuisim.base.errors import closest

_MAX_NAMES = 3
_MIN_LETTERS = 3
"""The fewest letters of a word that is looked for inside names: a shorter one is in too many."""
_LIKENESS = 0.65
_ON = frozenset({"backward", "drive", "forward", "forwards", "go", "move", "straight"})
"""Wrong names of a method for which `on` may be meant: what a motor does while it is on."""
_WELL_KNOWN = ("time", "random", "math", "statistics", "threading", "datetime")
"""Modules of the standard library that programs for robots use, in the order in which a name is looked for."""
_EV3DEV2 = {
    "ev3dev2.motor": "LargeMotor MediumMotor Motor MoveDifferential MoveJoystick MoveSteering MoveTank "
    "OUTPUT_A OUTPUT_B OUTPUT_C OUTPUT_D "
    "SpeedDPM SpeedDPS SpeedNativeUnits SpeedPercent SpeedRPM SpeedRPS",
    "ev3dev2.sensor": "INPUT_1 INPUT_2 INPUT_3 INPUT_4",
    "ev3dev2.sensor.lego": "ColorSensor GyroSensor InfraredSensor LightSensor SoundSensor TouchSensor "
    "UltrasonicSensor",
    "ev3dev2.button": "Button",
    "ev3dev2.console": "Console",
    "ev3dev2.display": "Display",
    "ev3dev2.led": "Leds",
    "ev3dev2.power": "PowerSupply",
    "ev3dev2.sound": "Sound",
    "ev3dev2.wheel": "EV3EducationSetRim EV3EducationSetTire EV3Rim EV3Tire",
    "ev3dev2_glue": "get_clock",
}
"""Names of the library by their modules."""


def find_meant_names(wrong: str, names: Set[str]) -> list[str]:
    """Return the names that may be meant by a wrong name, the most likely first; empty if there are none.

    The result has the names that begin with the wrong name. If there are none, it has the most similar name. If no name
    is similar, it has `on` for a wrong name such as `forward`, else the names that contain the wrong name.

    Args:
        wrong: The wrong name.
        names: The names that exist. Those with `_` at the start are never returned.
    """
    public = sorted((name for name in names if not name.startswith("_")), key=lambda n: (len(n), n))
    containing = [name for name in public if wrong in name] if len(wrong) >= _MIN_LETTERS else []
    if begun := [name for name in containing if name.startswith(wrong)]:
        return _find_shortest(begun)
    if close := closest(wrong, public, 1, _LIKENESS):
        return close
    return ["on"] if wrong in _ON and "on" in names else _find_shortest(containing)


def _find_shortest(names: Sequence[str]) -> list[str]:
    """Return names in their order, without those that begin with an earlier name; at most `_MAX_NAMES`."""
    shortest: list[str] = []
    for name in names:
        if not name.startswith(tuple(shortest)):
            shortest.append(name)
    return shortest[:_MAX_NAMES]


@cache
def map_modules() -> Mapping[str, str]:
    """Return the names of `ev3dev2` that programs use, each with its module."""
    return {name: module for module, names in _EV3DEV2.items() for name in names.split()}


@cache
def map_functions() -> Mapping[str, str]:
    """Return the functions of the standard library that are common in programs for robots, each with its module."""
    modules = {}
    for name in reversed(_WELL_KNOWN):
        # A program may have changed how modules are found.
        with suppress(ImportError):
            modules[name] = import_module(name)
    return {
        name: module
        for module, loaded in modules.items()
        for name in dir(loaded)
        if _is_function(loaded, name)
    }


def _is_function(module: types.ModuleType, name: str) -> bool:
    value = getattr(module, name)
    return (
        name[0] != "_"
        and callable(value)
        and getattr(value, "__module__", None) in (module.__name__, None)
    )
