"""Patches the library's modules when the program imports them."""

from __future__ import annotations

import importlib.machinery
import sys
import types
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from types import MappingProxyType

from tuisim.core.profile import Library
from tuisim.core.servo.motor import ServoMotor
from tuisim.shim.brick import BuiltBrick, build_brick, ports_hint
from tuisim.shim.buttons import DEVICE_PATHS, ButtonsFile, patch_button_module
from tuisim.shim.console import Terminal, patch_console_module
from tuisim.shim.display import DisplayFile, Screen, draw_with_the_bricks_font
from tuisim.shim.evdev.devices import evdev_modules
from tuisim.shim.files.entries import TextFile
from tuisim.shim.files.open_files import OpenFiles
from tuisim.shim.files.patches import FilePatches
from tuisim.shim.files.tree import DeviceTree
from tuisim.shim.fonts import patch_fonts_module, quiet_pillow
from tuisim.shim.leds import patch_led_module
from tuisim.shim.library import connect, patch_motor_module, patch_sensor_module
from tuisim.shim.older_library import MissingLibrary, finish_core, surroundings
from tuisim.shim.robolab import glue_module, patch_lego_module
from tuisim.shim.session import DeviceSession
from tuisim.shim.shell.commands import Shell
from tuisim.shim.shell.processes import Replace, System, finish_asyncio
from tuisim.shim.sound import Mixer, patch_sound_module
from tuisim.shim.unsupported.modules import HardwareFinder, OtherLibrary
from tuisim.shim.unsupported.parts import OTHER_BOARDS, PROCESSES, REFUSED, refuse_board, refuse_classes
from tuisim.source import PYBRICKS

Finish = Callable[[types.ModuleType], None]
Around = Callable[[], AbstractContextManager[None]]


CACHES = {"/tmp/current_platform": "ev3\n"}
"""Files in which libraries keep what they found out about the brick: they shall not look at this computer instead."""


class FinishingFinder:
    """Calls a function on a module right after its import.

    Args:
        finishers: Functions by module name.
        is_own: Whether a file belongs to the program: such a module may have any name.
        around: Contexts in which to import, by module name.
    """

    def __init__(
        self, finishers: Mapping[str, Finish], is_own: Callable[[str], bool], around: Mapping[str, Around]
    ) -> None:
        self._finishers, self._is_own, self._around = finishers, is_own, around

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Find the module as usual and wrap its loader."""
        finish = self._finishers.get(fullname)
        if finish is None:
            return None
        spec = importlib.machinery.PathFinder.find_spec(fullname, path, target)
        if spec is None or spec.loader is None or self._is_own(spec.origin or "<unknown>"):
            return None
        load = spec.loader.exec_module

        def load_and_finish(module: types.ModuleType) -> None:
            with self._around.get(fullname, nullcontext)():
                load(module)
            finish(module)

        spec.loader.exec_module = load_and_finish  # type: ignore[method-assign]
        return spec


def finish_imports(
    finishers: Mapping[str, Finish], is_own: Callable[[str], bool], around: Mapping[str, Around] = MappingProxyType({})
) -> None:
    """Call functions on modules, by name, right after their import; at once if already imported.

    Args:
        finishers, is_own, around: As for `FinishingFinder`.
    """
    for name, finish in finishers.items():
        if (there := sys.modules.get(name)) is not None:
            finish(there)
    sys.meta_path.insert(0, FinishingFinder(finishers, is_own, around))


def install(
    session: DeviceSession,
    files: OpenFiles,
    more_finishers: Mapping[str, Finish],
    replace: Replace,
    is_own: Callable[[str], bool],
) -> None:
    """Prepare the import of the program's library, and show it the brick's files.

    Args:
        session: Clock and simulation.
        files: Remembers the device files that the program opens.
        more_finishers: Functions for other modules, by name.
        replace: Replaces a function of a module.
        is_own: Whether a file belongs to the program.
    """
    built = build_brick(session)
    screen = Screen(session)
    terminal, mixer = Terminal(session, screen), Mixer()
    system = System(session, Shell(session, terminal, mixer))
    system.patch_os(replace)
    tree = DeviceTree(
        built.files,
        (
            DisplayFile(session, screen),
            *(ButtonsFile(session, path) for path in DEVICE_PATHS),
            *(TextFile(path, text) for path, text in CACHES.items()),
        ),
    )
    patches = FilePatches(tree, files, replace)
    patches.apply()
    finishers: dict[str, Finish] = {
        "PIL": quiet_pillow,
        "glob": patches.finish_glob,
        "subprocess": system.finish_subprocess,
        "asyncio.base_events": finish_asyncio,
        **more_finishers,
    }
    if session.sim.spec.profile.motor_law.library == Library.PYBRICKS:
        finish_imports(finishers, is_own)
        _install_pybricks(session, built, screen, mixer)
        return
    finishers = _of_ev3dev(session, built, terminal, mixer) | finishers
    finish_imports(finishers, is_own, dict.fromkeys(("ev3dev.core", "ev3dev.fonts"), surroundings))
    sys.meta_path.insert(0, OtherLibrary((PYBRICKS,), "choose --profile lego-micropython"))
    sys.meta_path.append(MissingLibrary())
    sys.meta_path.append(HardwareFinder())
    connect(built.files, partial(ports_hint, session))
    sys.modules["ev3dev2_glue"] = glue_module(session)
    sys.modules.update(evdev_modules(session))


def _of_ev3dev(session: DeviceSession, built: BuiltBrick, terminal: Terminal, mixer: Mixer) -> dict[str, Finish]:
    """Return what to do with the modules of `ev3dev2` and `ev3dev`."""
    brick, colors = built.files, built.colors
    return {
        "ev3dev.core": lambda module: finish_core(session, module, partial(ports_hint, session)),
        "ev3dev.fonts": patch_fonts_module,
        **dict.fromkeys(OTHER_BOARDS, refuse_board),
        "ev3dev2.button": lambda module: patch_button_module(session, module),
        "ev3dev2.console": lambda module: patch_console_module(module, terminal),
        "ev3dev2.display": lambda module: draw_with_the_bricks_font(vars(module)["Display"]),
        "ev3dev2.fonts": patch_fonts_module,
        "ev3dev2.led": lambda module: patch_led_module(session, module),
        "ev3dev2.motor": lambda module: patch_motor_module(session, module, brick),
        "ev3dev2.sensor": lambda module: patch_sensor_module(session, module, brick),
        "ev3dev2.sensor.lego": lambda module: patch_lego_module(session, module, brick, colors),
        "ev3dev2.sound": lambda module: patch_sound_module(session, module, mixer),
        **dict.fromkeys(REFUSED, refuse_classes),
        **PROCESSES,
    }


def _install_pybricks(session: DeviceSession, built: BuiltBrick, screen: Screen, mixer: Mixer) -> None:
    """Prepare the program's `import pybricks`."""
    # Imported on demand: other programs start faster without it.
    from tuisim.shim.pybricks import modules
    from tuisim.shim.pybricks.brick import Brick

    motors = {port: motor for port, motor in built.motors.items() if isinstance(motor, ServoMotor)}
    hint = partial(ports_hint, session)
    sys.meta_path.insert(0, OtherLibrary(("ev3dev2", "ev3dev"), "choose --profile ev3"))
    sys.meta_path.append(HardwareFinder())
    modules.install(Brick(session, motors, built.sensors, built.lights, built.battery, screen, mixer, hint))
