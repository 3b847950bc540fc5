"""The patches of the older library, `python-ev3dev` 1.x, which reads and writes device files itself."""

from __future__ import annotations

import importlib.machinery
import os
import sys
import types
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any

from tuisim.engine.shim.display import draw_with_the_bricks_font
from tuisim.engine.shim.ev3dev.library import refuse_values
from tuisim.engine.shim.leds import mend_trigger
from tuisim.engine.shim.plugs import Plugs
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.unsupported.devices import refused_device

NAME = "ev3dev"
INSTALL = "pip install 'tuisim[ev3dev]'"


class MissingLibrary:
    """Module finder that raises an error if `ev3dev` is not installed: the error says how to install it.

    It is the last finder, so it is only asked if no other finder has found `ev3dev`.
    """

    def find_spec(self, fullname: str, *_: object) -> importlib.machinery.ModuleSpec | None:
        """Return None for other modules than `ev3dev`.

        Raises:
            ModuleNotFoundError: the module is `ev3dev`.
        """
        if fullname == NAME:
            raise ModuleNotFoundError(f"No module named {NAME!r}: {INSTALL} installs it", name=NAME)
        return None


@contextmanager
def surroundings() -> Iterator[None]:
    """Return a context for the library's import, which provides `pkg_resources` and hides syntax warnings.

    Later versions of Python and setuptools would fail or warn at the import.
    """
    missing = "pkg_resources" not in sys.modules
    if missing:
        sys.modules["pkg_resources"] = _resources()
    try:
        with warnings.catch_warnings():
            # The library's regular expressions are not raw strings: later versions of Python warn about these.
            warnings.simplefilter("ignore")
            yield
    finally:
        if missing:
            del sys.modules["pkg_resources"]


def _resources() -> types.ModuleType:
    """Return a replacement of `pkg_resources` with the two functions that the library uses."""
    module = types.ModuleType("pkg_resources")

    def folder(package: str) -> str:
        return os.path.dirname(str(sys.modules[package].__file__))

    vars(module).update(
        resource_listdir=lambda package, _name: os.listdir(folder(package)),
        resource_filename=lambda package, name: os.path.join(folder(package), name),
    )
    return module


def finish_core(
    session: DeviceSession, module: types.ModuleType, plugs: Plugs, hint: Callable[[str], str]
) -> None:
    """Patch `ev3dev.core` after its import.

    The library then draws with the brick's font and runs motors by their duty cycle. Its errors about missing devices
    say which devices the robot has.

    Args:
        session: The run.
        module: The module.
        plugs: Adds missing devices to the robot.
        hint: Returns a hint for the error about a missing device, given the device's class.
    """
    core: Any = module
    draw_with_the_bricks_font(core.Screen)
    if session.sim.spec.profile.mend_library:
        mend_trigger(core.Led)
    _run_by_duty_cycle(core.Motor)

    def explained(access: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(access)
        def call(self: Any, *args: Any) -> Any:
            try:
                return access(self, *args)
            except Exception as error:
                # The library raises plain `Exception` for a device that is not connected.
                class_name = getattr(self, "SYSTEM_CLASS_NAME", "")
                if not self.connected and (
                    refused := refused_device(self, class_name, type(error))
                ):
                    raise refused from None
                if not self.connected and (addition := hint(class_name)):
                    error.args = (f"{error}. {addition}",)
                raise

        return call

    refuse_values(core.Sensor, plugs)
    device = core.Device
    device.__init__ = _look_up(device.__init__, plugs)
    device._get_attribute, device._set_attribute = (
        explained(device._get_attribute),
        explained(device._set_attribute),
    )


def _look_up(look_up: Callable[..., None], plugs: Plugs) -> Callable[..., None]:
    """Return a constructor for the library's devices: if the robot lacks the device, it is plugged in.

    Args:
        look_up: The library's own constructor, which searches for the device.
        plugs: Adds a missing device to the robot.
    """

    @wraps(look_up)
    def __init__(self: Any, class_name: str, *args: Any, **kwargs: Any) -> None:  # noqa: N807
        look_up(self, class_name, *args, **kwargs)
        if not self.connected and plugs.add_device(class_name, self.kwargs):
            look_up(self, class_name, *args, **kwargs)
        plugs.take_hold(self._path)

    return __init__


def _run_by_duty_cycle(motor: Any) -> None:
    """Patch `run_forever`: if no speed was ever set, it runs by the duty cycle, as under the kernel of 2015.

    Args:
        motor: The class of motors.
    """
    with_speed: set[str] = set()
    speed_sp = motor.speed_sp
    run_forever = motor.run_forever

    def set_speed(self: Any, value: Any) -> None:
        with_speed.add(self._path)
        speed_sp.fset(self, value)

    @wraps(run_forever)
    def run(self: Any, **given: Any) -> None:
        for name, value in given.items():
            setattr(self, name, value)
        by_duty = self._path not in with_speed and self.duty_cycle_sp
        self.command = self.COMMAND_RUN_DIRECT if by_duty else self.COMMAND_RUN_FOREVER

    motor.speed_sp = property(speed_sp.fget, set_speed, doc=speed_sp.__doc__)
    motor.run_forever = run
