"""Prepares the brick's files and the library for a program before it runs."""

from __future__ import annotations

import importlib.machinery
import sys
import types
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from types import MappingProxyType

from tuisim.engine.core.profile import Library
from tuisim.engine.shim.brick import build_brick
from tuisim.engine.shim.buttons import DEVICE_PATHS, ButtonsFile
from tuisim.engine.shim.console import Terminal
from tuisim.engine.shim.display import DisplayFile, Screen
from tuisim.engine.shim.files.entries import TextFile
from tuisim.engine.shim.files.open_files import OpenFiles
from tuisim.engine.shim.files.patches import FilePatches
from tuisim.engine.shim.files.tree import DeviceTree
from tuisim.engine.shim.fonts import quiet_pillow
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.shell.commands import Shell
from tuisim.engine.shim.shell.processes import Replace, System, finish_asyncio
from tuisim.engine.shim.sound import Mixer

Finish = Callable[[types.ModuleType], None]
Around = Callable[[], AbstractContextManager[None]]


CACHES = {"/tmp/current_platform": "ev3\n"}
"""Contents of the files in which libraries store the platform that they found, by path; with them, no library examines
this computer.
"""


class FinishingFinder:
    """Module finder that calls a function on certain modules right after their import.

    Args:
        finishers: The functions to call, by the name of the module.
        is_own: Returns whether a file belongs to the program. No function is called on such a module, whatever its
            name.
        around: Contexts in which modules are imported, by the name of the module.
    """

    def __init__(
        self,
        finishers: Mapping[str, Finish],
        is_own: Callable[[str], bool],
        around: Mapping[str, Around],
    ) -> None:
        self._finishers = finishers
        self._is_own = is_own
        self._around = around

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Return the spec of a module, with a loader that calls the module's function; None for other modules."""
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
    finishers: Mapping[str, Finish],
    is_own: Callable[[str], bool],
    around: Mapping[str, Around] = MappingProxyType({}),
) -> None:
    """Call a function on certain modules right after their import, or now if they are imported already.

    Args:
        finishers: The functions to call, by the name of the module.
        is_own: Returns whether a file belongs to the program. No function is called on such a module.
        around: Contexts in which modules are imported, by the name of the module.
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
    """Make the library and the brick's files available to the program.

    Args:
        session: Clock and simulation.
        files: Remembers the device files that the program opens.
        more_finishers: Functions to call after the import of other modules, by the name of the module.
        replace: Replaces a function of a module.
        is_own: Returns whether a file belongs to the program.
    """
    built = build_brick(session)
    plugs = Plugs(built)
    screen = Screen(session)
    terminal = Terminal(session, screen)
    mixer = Mixer()
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
    # Imported on demand: a program uses only one of the two libraries.
    if session.sim.spec.profile.motor_law.library == Library.PYBRICKS:
        from tuisim.engine.shim.pybricks import modules as pybricks

        finish_imports(finishers, is_own)
        pybricks.install(session, built, plugs, screen, mixer)
    else:
        from tuisim.engine.shim.ev3dev import modules as ev3dev

        finish_imports(
            ev3dev.finishers(session, built, plugs, terminal, mixer) | finishers,
            is_own,
            ev3dev.AROUND,
        )
        ev3dev.install(session, built, plugs)
