"""Modules for hardware that the simulated brick does not have, and notes for errors about other missing modules.

A module of the brick that controls its radio, its bus or its USB port can be imported; using a name in it raises
NotSimulated. A module for another computer cannot be imported on a brick either: the import raises NotSimulated, which
is also an ImportError, for programs that can run without the module.
"""

from __future__ import annotations

import sys
import types
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from functools import wraps
from importlib.machinery import ModuleSpec
from pkgutil import iter_modules
from typing import Any, NoReturn

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated, closest, shortened
from tuisim.base.repository import find_module_folder
from tuisim.base.source import SPIKE_MODULES
from tuisim.engine.core.profile import Library


@dataclass(frozen=True, slots=True)
class Instead:
    """What a program can use instead of hardware that is not simulated, by the names that its library has for it."""

    library: str
    sensors: str
    sound: str
    remote: str
    queue: str


INSTEAD: Mapping[Library, Instead] = {
    Library.EV3DEV2: Instead(
        "ev3dev2", "ev3dev2.sensor.lego", "ev3dev2.sound", "RemoteControlledTank", "queue.Queue"
    ),
    Library.PYBRICKS: Instead(
        "pybricks",
        "pybricks.ev3devices",
        "EV3Brick().speaker",
        "an InfraredSensor",
        "mailboxes of pybricks.messaging",
    ),
}

_RADIO = (
    "to drive by hand, use the brick's buttons or {remote}; parts of a program can talk by {queue}"
)
_BUS = "the sensors of {sensors} are simulated"
CAMERA = "use a ColorSensor for colours, and an UltrasonicSensor for distances"
_GAMEPAD = "to drive by hand, use the brick's buttons or {remote}"
_KEYS = f"{_GAMEPAD}; input() asks for whole lines"
_MICROPHONE = (
    "the simulated world has no sound: start with a TouchSensor or a button; {sound} makes sounds"
)


@dataclass(frozen=True, slots=True)
class Hardware:
    """Hardware that no simulated robot has, such as Bluetooth, and what a program can use instead."""

    title: str
    instead: str
    """What a program can do instead, for the error's hint; `told_to` fills in fields such as `{remote}` from `Instead`.
    """
    names: tuple[str, ...] = ()
    """The names that `from … import *` imports from the module that controls the hardware."""

    def told_to(self, library: Library) -> Hardware:
        """Return this hardware with advice that uses the names of one library."""
        return replace(self, instead=self.instead.format_map(asdict(INSTEAD[library])))

    def explain(self, where: str, name: str = "") -> tuple[str, str]:
        """Return the message and the hint of the error for using this hardware.

        Args:
            where: The name, port or mode that the program used.
            name: Its driver, address or mode, as the program wrote it; empty for none.
        """
        called = f" ({shortened(name, 80)})" if name else ""
        return f"{where}: {self.title}{called} is not simulated", self.instead


_SMBUS = Hardware("the I2C bus of the brick", _BUS, ("SMBus",))
_USB = Hardware("the brick's USB port", _BUS)
_SOUND_CARD = Hardware("the brick's sound card", _MICROPHONE)
_KEYBOARD = Hardware("a keyboard", _KEYS)

ON_THE_BRICK: Mapping[str, Hardware] = {
    "bluetooth": Hardware(
        "Bluetooth",
        _RADIO,
        (
            "BluetoothError",
            "BluetoothSocket",
            "DeviceDiscoverer",
            "HCI",
            "L2CAP",
            "PORT_ANY",
            "RFCOMM",
            "SCO",
            "SERIAL_PORT_CLASS",
            "SERIAL_PORT_PROFILE",
            "advertise_service",
            "discover_devices",
            "find_service",
            "get_available_port",
            "is_valid_address",
            "is_valid_uuid",
            "lookup_name",
            "read_local_bdaddr",
            "stop_advertising",
        ),
    ),
    "smbus": _SMBUS,
    "smbus2": Hardware(_SMBUS.title, _BUS, ("SMBus", "i2c_msg")),
    "serial": Hardware("a serial port", _BUS, ("Serial", "SerialException")),
    "usb": _USB,
    "hid": _USB,
    "pyudev": _USB,
    "pixycamev3": Hardware("the Pixy camera", CAMERA),
    "approxeng": Hardware("a gamepad", _GAMEPAD),
    "keyboard": _KEYBOARD,
    "pynput": _KEYBOARD,
    "getch": _KEYBOARD,
    "alsaaudio": _SOUND_CARD,
    "pyaudio": _SOUND_CARD,
    "sounddevice": _SOUND_CARD,
}
"""Modules on a real brick that a program here can import but not use, as their hardware is not simulated, by name."""

_PI = Hardware("the Raspberry Pi", "the simulated brick is an EV3: use {library}")
_PI_CAMERA = Hardware("the camera of the Raspberry Pi", CAMERA)
_FROM_PC = Hardware(
    "a brick that a computer drives from outside",
    "leave it out, and import {library}: the program runs on the simulated brick",
)
_BRICKPI = Hardware("the BrickPi", "the simulated brick is an EV3: use {library}")

ELSEWHERE: Mapping[str, Hardware] = {
    "RPi": _PI,
    "gpiozero": _PI,
    "pigpio": _PI,
    "spidev": _PI,
    "wiringpi": _PI,
    "picamera": _PI_CAMERA,
    "picamera2": _PI_CAMERA,
    "brickpi": _BRICKPI,
    "brickpi3": _BRICKPI,
    "microbit": Hardware("the micro:bit", "the simulated brick is an EV3: use {library}"),
    **{
        name: Hardware("LEGO's own Python for SPIKE", f"in Pybricks, for the same hub: {instead}")
        for name, instead in SPIKE_MODULES.items()
    },
    "rpyc": _FROM_PC,
    "ev3_dc": _FROM_PC,
    "ev3sim": Hardware(
        "the simulator ev3sim", "leave out its import: the rest of the program needs only {library}"
    ),
}
"""Modules for other devices than the brick, whose import fails with an error about the hardware, by name."""

PACKAGES: Mapping[str, str] = {
    "cv2": "opencv-python-headless",
    "ev3dev": "python-ev3dev",
    "paho": "paho-mqtt",
    "sklearn": "scikit-learn",
    "skimage": "scikit-image",
    "yaml": "PyYAML",
    "zmq": "pyzmq",
}
"""The package to install for each module whose name differs from that of the package."""

_ERRORS = ("Error", "Exception", "Timeout")
"""A name with one of these endings in a module that controls hardware is a class of exceptions, so that handlers can
name it.
"""


def refused_as(kind: type[Exception], message: str, hint: str) -> Exception:
    """Return an error that is both NotSimulated and of another class, so that programs can catch it as either."""
    both: Any = type("NotSimulated", (NotSimulated, kind), {"__module__": NotSimulated.__module__})
    error: Exception = both(message, hint)
    return error


class _Part(type):
    """Metaclass of the stand-ins for names in a module that controls hardware; see `refused_part`.

    Programs can derive classes from these objects; all other uses raise NotSimulated.
    """

    full_name: str
    hardware: Hardware

    def _use(cls, *_: object, **__: object) -> NoReturn:
        raise NotSimulated(*cls.hardware.explain(cls.full_name))

    __call__ = __getitem__ = __iter__ = __len__ = __int__ = __index__ = __float__ = __enter__ = (
        __exit__
    ) = _use
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __lt__ = __le__ = __gt__ = (
        __ge__
    ) = _use
    __and__ = __rand__ = __or__ = __ror__ = __xor__ = __rxor__ = __lshift__ = __rlshift__ = (
        __invert__
    ) = _use

    def __getattr__(cls, name: str) -> Any:
        return _kept_part(cls, cls.full_name, name, cls.hardware)

    def __repr__(cls) -> str:
        return f"<{cls.full_name}, which is not simulated>"


def refused_part(path: str, name: str, hardware: Hardware) -> Any:
    """Return a stand-in for a name in a module that controls hardware: a program can import it, but not use it.

    Args:
        path: The full name of the module.
        name: The name in it.
        hardware: The hardware.
    """
    words = {"full_name": f"{path}.{name}", "hardware": hardware, "__module__": path}
    return type(name, (OSError,), words) if name.endswith(_ERRORS) else _Part(name, (), words)


def _kept_part(place: Any, path: str, name: str, hardware: Hardware) -> Any:
    """Return a `refused_part` for a name, and store it as an attribute, so that it is built only once.

    Args:
        place: The module in which the program uses the name, or another refused part.
        path: The full name of the module or part.
        name: The name in it.
        hardware: The hardware that it is for.

    Raises:
        AttributeError: the name begins with two underscores.
    """
    if name.startswith("__"):
        raise AttributeError(f"{path} has no attribute {name!r}")
    made = refused_part(path, name, hardware)
    setattr(place, name, made)
    return made


class HardwareModule(types.ModuleType):
    """A stand-in for a module that controls hardware, or for its submodule: a program can import it, but not use it.

    Args:
        name: Its full name.
        hardware: The hardware.
    """

    def __init__(self, name: str, hardware: Hardware) -> None:
        super().__init__(name, f"{hardware.title}, which is not simulated.")
        vars(self)["_hardware"] = hardware

    def __getattr__(self, name: str) -> Any:
        return _kept_part(self, self.__name__, name, vars(self)["_hardware"])


class RefusedImports:
    """Module finder that refuses to import some modules; it is the first finder.

    Args:
        reasons: For each module the message of the error, and its hint.
    """

    def __init__(self, reasons: Mapping[str, tuple[str, str]]) -> None:
        self._reasons = reasons

    def find_spec(self, fullname: str, *_: object) -> None:
        """Return None for modules that are not refused.

        Raises:
            NotSimulated: the module is refused; the error is also an ImportError.
        """
        if fullname in self._reasons:
            raise refused_as(ImportError, *self._reasons[fullname])


def refuse_other(names: Sequence[str], library: Library) -> RefusedImports:
    """Return a module finder that refuses the packages of a library which does not fit the profile of this run.

    Args:
        names: The packages.
        library: The library of this run.
    """
    hint = "a program uses one of the two libraries"
    return RefusedImports(
        {name: (f"{name}: this program runs by the rules of {library}", hint) for name in names}
    )


class HardwareFinder:
    """Module finder for modules that control hardware which is not simulated, such as `bluetooth`.

    It is the last finder, so that files of the program and installed packages come first.

    Args:
        library: The library of the program.
    """

    def __init__(self, library: Library) -> None:
        self._library = library

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        """Return the spec of a module that controls hardware; None for other modules."""
        top = fullname.partition(".")[0]
        if top == fullname:
            known = top in ON_THE_BRICK or top in ELSEWHERE
        else:
            known = top in ON_THE_BRICK and isinstance(sys.modules.get(top), HardwareModule)
        loader: Any = self
        return (
            ModuleSpec(fullname, loader, origin="not simulated", is_package=True) if known else None
        )

    def create_module(self, spec: ModuleSpec) -> types.ModuleType:
        """Return a stand-in for a module that exists on a real brick.

        Raises:
            NotSimulated: the module is for other computers only; the error is also an ImportError.
        """
        if (top := spec.name.partition(".")[0]) in ELSEWHERE:
            raise refused_as(ImportError, *ELSEWHERE[top].told_to(self._library).explain(spec.name))
        module = HardwareModule(spec.name, ON_THE_BRICK[top].told_to(self._library))
        if spec.name == top:
            vars(module)["__all__"] = list(ON_THE_BRICK[top].names)
        return module

    def exec_module(self, module: types.ModuleType) -> None:
        """Do nothing: the names in the module are created when they are used."""


BLUETOOTH: Mapping[str, Any] = {
    "AF_BLUETOOTH": 31,
    "BTPROTO_L2CAP": 0,
    "BTPROTO_HCI": 1,
    "BTPROTO_SCO": 2,
    "BTPROTO_RFCOMM": 3,
    "BDADDR_ANY": "00:00:00:00:00:00",
    "BDADDR_LOCAL": "00:00:00:FF:FF:FF",
}
"""Values of the names that `socket` lacks where Python was built without Bluetooth."""


def refuse_bluetooth(module: types.ModuleType, library: Library) -> None:
    """Patch `socket` after its import, so that it refuses sockets for Bluetooth.

    Args:
        module: The module `socket`.
        library: The library of the program.
    """
    names: Any = vars(module)
    told = ON_THE_BRICK["bluetooth"].told_to(library)
    for name, value in BLUETOOTH.items():
        names.setdefault(name, value)
    real = module.socket.__init__

    @wraps(real)
    def __init__(self: Any, family: int = -1, *given: Any, **named: Any) -> None:  # noqa: N807
        if family == names["AF_BLUETOOTH"]:
            raise NotSimulated(*told.explain("socket.AF_BLUETOOTH"))
        real(self, family, *given, **named)

    module.socket.__init__ = __init__


_TERMINALS = ("termios", "_curses")
"""Modules that raise their class `error` when a program reads single keys, as it has no terminal."""


def point_at_keys(error: BaseException, library: Library) -> None:
    """Add a note to the error of a program that reads single keys from a terminal; it says what to use instead."""
    # The classes are compared, not their names: a program's own class may raise an error when its name is read.
    kinds = [vars(sys.modules[name]).get("error") for name in _TERMINALS if name in sys.modules]
    if type(error) in kinds:
        instead = _KEYBOARD.told_to(library).instead
        error.add_note(f"A program has no terminal here, and no single keys ({instead}).")


def point_at_package(error: BaseException, folder: str) -> None:
    """Add a note to the error about a missing module that says where to get the module.

    Args:
        error: Any error of the program.
        folder: The folder of the program.
    """
    if not isinstance(error, ModuleNotFoundError) or not isinstance(error.name, str):
        return
    top = error.name.partition(".")[0]
    package_name, _, name = error.name.rpartition(".")
    places = getattr(sys.modules.get(package_name), "__path__", ()) if package_name else None
    names = {module.name for module in iter_modules(places)}
    names |= set() if package_name else sys.stdlib_module_names
    if name not in names and (close := closest(name, names, 1, 0.85)):
        error.add_note(f"Did you mean {'.'.join(filter(None, (package_name, *close)))}?")
        return
    if not top.isidentifier() or top in sys.modules or top in sys.stdlib_module_names:
        return
    if place := find_module_folder(top, folder):
        error.add_note(
            f"{top} is in {place}, which Python does not search: PYTHONPATH={place} finds it."
        )
        return
    package = PACKAGES.get(top, top)
    error.add_note(
        f"{top} is neither beside the program nor installed. A package of Python is installed with "
        f"`pip install {package}`, in the environment of tuisim."
    )
