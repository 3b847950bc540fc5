"""The modules of the library, by the names under which a program imports them."""

from __future__ import annotations

import sys
import types
from functools import partial
from importlib import import_module
from pkgutil import walk_packages
from typing import Any, NoReturn

from tuisim.base.source import HUB_DEVICES
from tuisim.engine.core.hub_spec import HUBS_WITH_MATRIX
from tuisim.engine.core.profile import Library, MotorLaw
from tuisim.engine.shim.brick import BuiltBrick, ports_hint
from tuisim.engine.shim.display import Screen
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.pybricks import micropython, speaker
from tuisim.engine.shim.pybricks.brick import Brick, Connected
from tuisim.engine.shim.pybricks.unsimulated import (
    HUB_CLASSES,
    IO_DEVICES,
    MODULES,
    NXT_DEVICES,
    VERSION_4,
    explain_hub,
    refuse_all,
    refuse_hub,
    refused_classes,
)
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer
from tuisim.engine.shim.unsupported.modules import (
    BLUETOOTH,
    HardwareFinder,
    HardwareModule,
    RefusedImports,
    refuse_other,
    refused_as,
)

Names = dict[str, dict[str, Any]]
"""The names in each module of Pybricks with their values, by the module's name."""


def _read_names(version: str) -> Names:
    """Return the names and values in the modules of a folder of `engine/shim/names`: a dictionary for each module."""
    package = import_module(f"tuisim.engine.shim.names.{version}")
    prefix = f"{package.__name__}."
    return {
        name.removeprefix(prefix): {
            key: value
            for key, value in vars(import_module(name)).items()
            if not key.startswith("__")
        }
        for _, name, _ in walk_packages(package.__path__, prefix)
    }


def read_version_2() -> Names:
    """Return the names and values of each module of Pybricks 2.0: a dictionary for each module."""
    names = _read_names("version_2")
    names["pybricks.iodevices"] |= refused_classes("pybricks.iodevices", IO_DEVICES)
    names["pybricks.nxtdevices"] |= refused_classes("pybricks.nxtdevices", NXT_DEVICES)
    return names


def read_version_4(hub: str = "") -> Names:
    """Return the names and values of each module of Pybricks 4: a dictionary for each module.

    Args:
        hub: The robot's hub, one of `HUBS`; empty for the EV3.
    """
    names = _read_names("hub" if hub else "version_4")
    names["pybricks"]["version"] = (hub.lower() or "ev3", "4.0.0", "tuisim")
    if not hub:
        refused = refuse_all(VERSION_4, "use the classes of pybricks.ev3devices")
    else:
        refused = refuse_all(
            HUB_CLASSES, "use Motor, ColorSensor, UltrasonicSensor and ForceSensor"
        )
        classes = names["pybricks.hubs"]
        own = classes[hub]
        names["pybricks.hubs"] = {name: known for name, known in classes.items() if known is own}
        names["pybricks.hubs"]["ThisHub"] = own
        if hub not in HUBS_WITH_MATRIX:
            del names["pybricks.parameters"]["Icon"], names["pybricks.tools"]["hub_menu"]
    for module, classes in refused.items():
        names[module] |= classes
    return names


def _name_later(owner: str, name: str) -> str:
    """Return a hint that Pybricks 4 has an attribute, for the end of an error message; it begins with a colon.

    Args:
        owner: The name of the class.
        name: The name of the attribute; if the class does not have it in Pybricks 4 either, the hint is empty.
    """
    later = next((names[owner] for names in read_version_4().values() if owner in names), None)
    return ": Pybricks 4 has it, which --profile pybricks4 chooses" if hasattr(later, name) else ""


def _choose_names(brick: Brick, law: MotorLaw, hub: str) -> Names:
    """Return the names and values that each module of the library has in a run: a dictionary for each module.

    Also prepare the run for this version of the library: set its version of MicroPython, and the function that gives
    hints on names of other versions.

    Args:
        brick: The brick.
        law: How the motors move, which determines the version of the library.
        hub: The robot's hub; empty for the EV3.
    """
    if not hub:
        sys.meta_path.insert(0, RefusedImports({HUB_DEVICES: explain_hub(HUB_DEVICES)}))
        if law != MotorLaw.PYBRICKS_4:
            brick.name_replacement = _name_later
            return read_version_2()
    from tuisim.engine.shim.pybricks.earlier import EARLIER_MODULES, name_replacement

    brick.name_replacement = name_replacement
    vars(sys.implementation)["version"] = (1, 26, 0)
    names: Names = {name: {} for name in EARLIER_MODULES}
    names |= read_version_4(hub)
    return {name: {"__getattr__": partial(refuse_name, hub, name), **names[name]} for name in names}


def refuse_name(hub: str, module: str, name: str) -> NoReturn:
    """Raise the error for a name that a module of Pybricks 4 does not have.

    Raises:
        NotSimulated: the name exists in Pybricks 2.0, in another module or on another hub; the error is also an
            ImportError.
        AttributeError: the name exists nowhere in Pybricks.
    """
    from tuisim.engine.shim.pybricks.earlier import EARLIER, EARLIER_MODULES

    hint = EARLIER_MODULES.get(module) or EARLIER.get(module, {}).get(name)
    is_inner = name.startswith("__")
    if hint and not is_inner:
        raise refused_as(ImportError, f"{module}.{name} is not in Pybricks 4", hint)
    for owner in dict.fromkeys(() if is_inner else (hub, "", "PrimeHub")):
        for place, names in read_version_4(owner).items():
            if name in names:
                hint = f"{place} of {owner or 'the EV3'} has it"
                raise refused_as(ImportError, f"{module}.{name}: {hub or 'the EV3'} lacks it", hint)
    raise AttributeError(f"module {module!r} has no attribute {name!r}")


def install(
    session: DeviceSession, built: BuiltBrick, plugs: Plugs, screen: Screen, mixer: Mixer
) -> None:
    """Make the library, and the modules of MicroPython, importable by the program."""
    sys.meta_path.insert(0, refuse_other(("ev3dev2", "ev3dev"), Library.PYBRICKS))
    sys.meta_path.append(HardwareFinder(Library.PYBRICKS))
    micropython.install(session)
    plugs.missing = OSError
    brick = Brick(session, built, plugs, screen, mixer, partial(ports_hint, session))
    law = session.sim.spec.profile.motor_law
    hub = session.sim.spec.robot.hub
    Connected.brick = brick
    names = _choose_names(brick, law, hub)
    speaker.set_volumes(brick.mixer, speaker.START_VOLUMES)
    made = {name: types.ModuleType(name) for name in names}
    made |= {name: HardwareModule(name, hardware) for name, hardware in MODULES.items()}
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
