"""What is done with each module of `ev3dev2` and `ev3dev` when a program imports it."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from functools import partial

from tuisim.base.source import PYBRICKS
from tuisim.engine.core.profile import Library
from tuisim.engine.shim.brick import BuiltBrick, ports_hint
from tuisim.engine.shim.buttons import patch_button_module
from tuisim.engine.shim.console import Terminal, patch_console_module
from tuisim.engine.shim.display import draw_with_the_bricks_font
from tuisim.engine.shim.ev3dev import virtual
from tuisim.engine.shim.ev3dev.library import connect, patch_motor_module, patch_sensor_module
from tuisim.engine.shim.ev3dev.older_library import MissingLibrary, finish_core, surroundings
from tuisim.engine.shim.ev3dev.robolab import glue_module, patch_lego_module
from tuisim.engine.shim.evdev.devices import evdev_modules
from tuisim.engine.shim.fonts import patch_fonts_module
from tuisim.engine.shim.leds import patch_led_module
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer, patch_sound_module
from tuisim.engine.shim.unsupported.modules import HardwareFinder, OtherLibrary
from tuisim.engine.shim.unsupported.parts import (
    OTHER_BOARDS,
    PROCESSES,
    REFUSED,
    refuse_board,
    refuse_classes,
)

AROUND: Mapping[str, Callable[[], AbstractContextManager[None]]] = dict.fromkeys(
    ("ev3dev.core", "ev3dev.fonts"), surroundings
)
"""Contexts in which modules are imported, by name."""


def finishers(
    session: DeviceSession, built: BuiltBrick, plugs: Plugs, terminal: Terminal, mixer: Mixer
) -> dict[str, Callable[[types.ModuleType], None]]:
    """Return the functions to call on modules after their import, by the module's name."""
    brick = built.files
    colors = built.colors
    return {
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
    """Let a program import the libraries."""
    sys.meta_path.insert(0, OtherLibrary((PYBRICKS,), Library.EV3DEV2))
    sys.meta_path.append(MissingLibrary())
    sys.meta_path.append(HardwareFinder(Library.EV3DEV2))
    connect(session, built.files, plugs, partial(ports_hint, session))
    sys.modules["ev3dev2_glue"] = glue_module(session)
    sys.modules[virtual.NAME] = virtual.virtual_module(session)
    sys.modules.update(evdev_modules(session))
