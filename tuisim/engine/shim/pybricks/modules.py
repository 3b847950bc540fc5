"""The modules of the library, by the names under which a program imports them."""

from __future__ import annotations

import sys
import types
from collections.abc import Mapping
from functools import partial
from typing import Any

from tuisim.engine.core.profile import Library, MotorLaw
from tuisim.engine.shim.brick import BuiltBrick, ports_hint
from tuisim.engine.shim.display import Screen
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.pybricks import (
    ev3devices,
    experimental,
    font,
    hubs,
    image,
    iodevices,
    media,
    messaging,
    micropython,
    motor,
    parameters,
    robotics,
    speaker,
    tools,
    version_1,
    wrappers,
)
from tuisim.engine.shim.pybricks.brick import Brick, Connected
from tuisim.engine.shim.pybricks.unsimulated import (
    IO_DEVICES,
    NXT_DEVICES,
    VERSION_4,
    OtherHub,
    refuse_all,
    refuse_hub,
    refused_classes,
)
from tuisim.engine.shim.pybricks.unsimulated import (
    MODULES as REFUSED,
)
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer
from tuisim.engine.shim.unsupported.modules import (
    BLUETOOTH,
    HardwareFinder,
    HardwareModule,
    OtherLibrary,
)


def _public(module: types.ModuleType, *names: str) -> dict[str, Any]:
    return {name: getattr(module, name) for name in names}


FILES = _public(media, "SoundFile", "ImageFile")
SENSORS = ("TouchSensor", "ColorSensor", "InfraredSensor", "UltrasonicSensor", "GyroSensor")
MODULES: Mapping[str, Mapping[str, Any]] = {
    "pybricks": {},
    "pybricks.hubs": _public(hubs, "EV3Brick"),
    "pybricks.display": _public(version_1, "Display", "Align") | _public(media, "ImageFile"),
    "pybricks.ev3devices": _public(wrappers, "Motor", "Stop")
    | {"CompatMotor": motor.Motor}
    | _public(ev3devices, *SENSORS),
    "pybricks.ev3brick": _public(version_1, "sound", "display", "light", "buttons", "battery")
    | _public(version_1, "Display", "Speaker")
    | _public(hubs, "EV3Brick"),
    "pybricks.experimental": _public(experimental, "run_parallel"),
    "pybricks.iodevices": _public(motor, "DCMotor")
    | _public(iodevices, "Ev3devSensor")
    | refused_classes("pybricks.iodevices", IO_DEVICES),
    "pybricks.messaging": _public(messaging, *messaging.__all__),
    "pybricks.nxtdevices": _public(motor, "Motor")
    | refused_classes("pybricks.nxtdevices", NXT_DEVICES),
    "pybricks.parameters": _public(
        parameters, "Port", "Stop", "Direction", "Button", "Color", "Align"
    )
    | FILES,
    "pybricks.robotics": _public(wrappers, "DriveBase", "Stop", "wait")
    | {"CompatDriveBase": robotics.DriveBase},
    "pybricks.speaker": _public(version_1, "Speaker", "wait")
    | _public(media, "SoundFile")
    | {"Ev3devSpeaker": speaker.Speaker},
    "pybricks.tools": _public(tools, "wait", "StopWatch", "DataLog", "localtime", "ticks_us")
    | {"print": print},
    "pybricks.media": {},
    "pybricks.media.ev3dev": _public(image, "Image") | _public(font, "Font") | FILES,
}
"""Names of each module of version 2.0."""


def _version_4() -> Mapping[str, Mapping[str, Any]]:
    """Return the names in each module of version 4."""
    from tuisim.engine.shim.pybricks import brick_4, matrix, version_4
    from tuisim.engine.shim.pybricks.earlier import EARLIER, EARLIER_MODULES

    changed: dict[str, Mapping[str, Any]] = {
        "pybricks": {"version": ("ev3", "4.0.0", "tuisim")},
        "pybricks.hubs": {"EV3Brick": brick_4.EV3Brick, "ThisHub": brick_4.EV3Brick},
        "pybricks.ev3devices": _public(
            version_4, "Motor", "ColorSensor", "GyroSensor", "InfraredSensor"
        ),
        "pybricks.parameters": _public(version_4, "Stop", "Color")
        | _public(matrix, "Axis", "Side")
        | _public(image, "Image")
        | _public(font, "Font"),
        "pybricks.robotics": _public(version_4, "DriveBase"),
        "pybricks.tools": _public(
            version_4, "StopWatch", "multitask", "read_input_byte", "run_task"
        )
        | _public(matrix, "Axis", "Matrix", "cross", "vector"),
    }
    refused = refuse_all(VERSION_4, "use the classes of pybricks.ev3devices")
    names = {
        module: {
            name: value for name, value in earlier.items() if name not in EARLIER.get(module, {})
        }
        for module, earlier in MODULES.items()
    }
    return {
        module: {}
        if module in EARLIER_MODULES
        else {**refused.get(module, {}), **names[module], **changed.get(module, {})}
        for module in names
    }


def _name_later(owner: str, name: str) -> str:
    """Return a hint, after a colon, that a class of version 4 has an attribute; empty if it has not."""
    later = next((names[owner] for names in _version_4().values() if owner in names), None)
    return ": Pybricks 4 has it, which --profile pybricks4 chooses" if hasattr(later, name) else ""


def _choose_names(brick: Brick, law: MotorLaw, hub: str) -> Mapping[str, Mapping[str, Any]]:
    """Return the names in each module for a run; also let the brick explain names of other versions.

    Args:
        brick: The brick.
        law: How the motors move, which tells the version of the library.
        hub: The robot's hub; empty for the EV3.
    """
    if not hub:
        sys.meta_path.insert(0, OtherHub())
        if law != MotorLaw.PYBRICKS_4:
            return MODULES
    from tuisim.engine.shim.pybricks.earlier import name_replacement, refuse_earlier

    brick.name_replacement = name_replacement
    if hub:
        from tuisim.engine.shim.pybricks.hub.modules import find_names

        names = find_names(hub)
    else:
        names = _version_4()
    return {name: {"__getattr__": partial(refuse_earlier, name), **names[name]} for name in names}


def install(
    session: DeviceSession, built: BuiltBrick, plugs: Plugs, screen: Screen, mixer: Mixer
) -> None:
    """Let a program import the library, and the modules of MicroPython."""
    sys.meta_path.insert(0, OtherLibrary(("ev3dev2", "ev3dev"), Library.PYBRICKS))
    sys.meta_path.append(HardwareFinder(Library.PYBRICKS))
    micropython.install(session)
    plugs.missing = OSError
    brick = Brick(session, built, plugs, screen, mixer, partial(ports_hint, session))
    law = session.sim.spec.profile.motor_law
    hub = session.sim.spec.robot.hub
    Connected.brick = brick
    brick.name_replacement = _name_later
    names = _choose_names(brick, law, hub)
    speaker.set_volumes(brick.mixer, speaker.START_VOLUMES)
    made = {name: types.ModuleType(name) for name in names}
    made |= {name: HardwareModule(name, hardware) for name, hardware in REFUSED.items()}
    vars(made["pybricks.bluetooth"]).update(BLUETOOTH)
    for name, module in made.items():
        vars(module).update(names.get(name, {}))
        parent, _, last = name.rpartition(".")
        if parent:
            setattr(made[parent], last, module)
        if any(other.startswith(f"{name}.") for other in made):
            module.__path__ = []
    vars(made["pybricks.hubs"])["__getattr__"] = partial(refuse_hub, hub)
    sys.modules.update(made)
