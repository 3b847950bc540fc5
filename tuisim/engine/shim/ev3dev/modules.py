"""The patches of each module of `ev3dev2` and `ev3dev`, which are applied when a program imports it."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from functools import partial
from typing import Any, NoReturn

from tuisim.base.errors import NotSimulated
from tuisim.base.source import PYBRICKS
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.profile import Library, MotorLaw
from tuisim.engine.core.sensors.color import WHITE, percent
from tuisim.engine.shim.brick import BuiltBrick, ports_hint
from tuisim.engine.shim.buttons import patch_button_module
from tuisim.engine.shim.console import Terminal, patch_console_module
from tuisim.engine.shim.device_files import DeviceFiles, free_of_charge, plain
from tuisim.engine.shim.display import draw_with_the_bricks_font
from tuisim.engine.shim.ev3dev import older_python
from tuisim.engine.shim.ev3dev.library import connect, patch_motor_module, patch_sensor_module
from tuisim.engine.shim.ev3dev.older_library import MissingLibrary, finish_core, surroundings
from tuisim.engine.shim.evdev.devices import evdev_modules
from tuisim.engine.shim.fonts import patch_fonts_module
from tuisim.engine.shim.leds import patch_led_module
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.sensors import ColorDevice
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer, patch_sound_module
from tuisim.engine.shim.unsupported.modules import HardwareFinder, refuse_other
from tuisim.engine.shim.unsupported.parts import (
    OTHER_BOARDS,
    PROCESSES,
    REFUSED,
    refuse_board,
    refuse_classes,
)

NAME = "ev3dev2.sensor.virtual"
_UNSIMULATED = ("CameraSensor", "LaserRangeSensor", "LidarSensor", "ObjectTracker", "Radio")
_MORE_PORTS = range(5, 13)
"""The numbers of the inputs that the simulator Gears has and a real brick lacks; Gears has its virtual devices there.

"""


class _Unsimulated:
    """A part of the simulator Gears that is not simulated: programs can create an object of it, but not use it."""

    def __init__(self, *_given: object, **_named: object) -> None: ...

    def __getattr__(self, name: str) -> NoReturn:
        if name.startswith("__"):
            raise AttributeError(name)
        used = f"{NAME}.{type(self).__name__}.{name}"
        raise NotSimulated(
            f"tuisim does not simulate {used}, a part of the simulator Gears",
            "of this module, it simulates GPSSensor and Pen",
        )


def virtual_module(session: DeviceSession) -> types.ModuleType:
    """Return the module of the simulator Gears, with its classes for a pen and for the robot's true position."""
    module = types.ModuleType(
        NAME, "Parts of the simulator Gears: a pen, and the true place of the robot."
    )
    sim = session.sim
    cost_ns = session.sim.spec.profile.attribute_read_ns

    class GPSSensor:
        """A sensor of the robot's true position, in cm from the lower left corner of the mat."""

        def __init__(self, address: object = None) -> None:
            self.address = address

        @property
        def position(self) -> list[float]:
            """The robot's x, y and altitude in cm."""
            session.charge(cost_ns)
            return [sim.pose.x_mm / 10, sim.pose.y_mm / 10, 0.0]

        x = property(lambda self: self.position[0])
        y = property(lambda self: self.position[1])
        altitude = property(lambda self: self.position[2])

    class Pen:
        """The robot's pen, which a program can lower and lift."""

        def __init__(self, address: object = None) -> None:
            self.address = address

        def down(self) -> None:
            """Lower the pen, which draws from now on."""
            session.charge(cost_ns)
            obey(sim, session.now, 0, Call.MOVE_PEN, 1.0)

        def up(self) -> None:
            """Lift the pen, which then draws no more."""
            session.charge(cost_ns)
            obey(sim, session.now, 0, Call.MOVE_PEN, 0.0)

        def setColor(self, *_given: object, **_named: object) -> None:  # noqa: N802
            """Do nothing: the robot's pen has only one colour, which the option --pen-color sets."""

        def setWidth(self, *_given: object, **_named: object) -> None:  # noqa: N802
            """Do nothing: the robot's pen has only one width, which the option --pen-width sets."""

    kinds: list[Any] = [GPSSensor, Pen, *(type(name, (_Unsimulated,), {}) for name in _UNSIMULATED)]
    names = {kind.__name__: kind for kind in kinds}
    for kind in kinds:
        kind.__module__ = NAME
    names |= {f"INPUT_{number}": f"virtual:in{number}" for number in _MORE_PORTS}
    vars(module).update(names, __all__=list(names))
    return module


AROUND: Mapping[str, Callable[[], AbstractContextManager[None]]] = dict.fromkeys(
    ("ev3dev.core", "ev3dev.fonts"), surroundings
)
"""Functions that return the context manager in which a module is imported, by the module's name."""


def finishers(
    session: DeviceSession, built: BuiltBrick, plugs: Plugs, terminal: Terminal, mixer: Mixer
) -> dict[str, Callable[[types.ModuleType], None]]:
    """Return the functions that patch modules of the library after their import, by the module's name."""
    brick = built.files
    colors = built.colors
    is_brick = not session.sim.spec.profile.mend_library
    return {
        **(older_python.FINISHERS if is_brick else {}),
        "ev3dev.core": lambda module: finish_core(
            session, module, plugs, partial(ports_hint, session)
        ),
        "ev3dev.fonts": patch_fonts_module,
        **dict.fromkeys(OTHER_BOARDS, refuse_board),
        "ev3dev2.button": lambda module: patch_button_module(session, module),
        "ev3dev2.console": lambda module: patch_console_module(module, terminal),
        "ev3dev2.display": lambda module: draw_with_the_bricks_font(vars(module)["Display"]),
        "ev3dev2.fonts": patch_fonts_module,
        "ev3dev2.led": lambda module: patch_led_module(session, module),
        "ev3dev2.motor": lambda module: patch_motor_module(session, module, brick, plugs),
        "ev3dev2.sensor": lambda module: patch_sensor_module(session, module, brick, plugs),
        "ev3dev2.sensor.lego": lambda module: patch_lego_module(session, module, brick, colors),
        "ev3dev2.sound": lambda module: patch_sound_module(session, module, mixer),
        **dict.fromkeys(REFUSED, refuse_classes),
        **PROCESSES,
    }


def install(session: DeviceSession, built: BuiltBrick, plugs: Plugs) -> None:
    """Make the libraries for ev3dev importable by the program, with the simulated devices behind them.

    Args:
        session: The run.
        built: The brick.
        plugs: Adds missing devices to the robot.
    """
    sys.meta_path.insert(0, refuse_other((PYBRICKS,), Library.EV3DEV2))
    sys.meta_path.append(MissingLibrary())
    sys.meta_path.append(HardwareFinder(Library.EV3DEV2))
    if not session.sim.spec.profile.mend_library:
        older_python.install(session)
    connect(session, built.files, plugs, partial(ports_hint, session))
    sys.modules["ev3dev2_glue"] = glue_module(session)
    sys.modules[NAME] = virtual_module(session)
    sys.modules.update(evdev_modules(session))


def patch_lego_module(
    session: DeviceSession,
    module: types.ModuleType,
    brick: DeviceFiles,
    colors: dict[str, ColorDevice],
) -> None:
    """Add the course's properties to the classes of `ev3dev2.sensor.lego`.

    The properties of `ColorSensor` are:

    - `reflected_light_intensity`: int(red), 0 … 255, if the profile says so (in the library: 0 … 100)
    - `reflected_light_intensity_pc`: 100 · int(red) / 255
    - `full_reflected_light_intensity`: 100 · (int(red) + int(green) + int(blue)) / 765
    - `red`, `green`, `blue`: integers, 0 … 255, if the profile says so (in the library: 0 … 1020, 300 on white)

    Args:
        session: The run.
        module: The module.
        brick: The devices.
        colors: The colour sensors, by the path of their device.
    """
    lego: Any = module
    color_sensor = lego.ColorSensor

    def channel(index: int) -> property:
        return property(lambda self: colors[self._path].read("RGB-RAW")[index])

    def reflected(self: Any) -> int:
        return colors[self._path].read("COL-REFLECT")[0]

    if session.sim.spec.profile.reflected_max == WHITE:
        color_sensor.reflected_light_intensity = property(reflected)
        color_sensor.red, color_sensor.green, color_sensor.blue = channel(0), channel(1), channel(2)

    def red_percent(self: Any) -> float:
        return percent(colors[self._path].read("COL-REFLECT")[0], WHITE)

    def mean_percent(self: Any) -> float:
        return percent(sum(colors[self._path].read("RGB-RAW")), 3 * WHITE)

    color_sensor.reflected_light_intensity_pc = property(red_percent)
    color_sensor.full_reflected_light_intensity = property(mean_percent)
    # The library's constructor reads the initial angle; this read must not take simulated time.
    lego.GyroSensor.__init__ = free_of_charge(session, lego.GyroSensor.__init__)


def glue_module(session: DeviceSession) -> types.ModuleType:
    """Return the module `ev3dev2_glue`, which programs of the course import."""
    glue = types.ModuleType("ev3dev2_glue", "Simulated time and messages, as the course has them.")

    def get_clock() -> float:
        """Return the simulated seconds since the program started."""
        seconds = session.sim.tick / session.sim.spec.profile.tick_hz
        return (
            plain(seconds)
            if session.sim.spec.profile.motor_law == MotorLaw.NBEV3DEVSIM
            else seconds
        )

    def pyState() -> dict[str, list[Any]]:
        """Return `{"messages": [...]}` with all answers of the notebook's `roboSim.responder`, oldest first.

        The list is empty if the notebook has no responder. The call waits, without simulated time, until the responder
        has answered every printed line.
        """
        return {"messages": session.messages()}

    vars(glue).update(get_clock=get_clock, pyState=pyState)
    return glue
